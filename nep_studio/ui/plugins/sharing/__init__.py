"""Lets other computers take part in the network of this one, or this one in theirs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.errors import NepError
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.labels import follow_words
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import count_words, tr

from .refusal_words import refusal_message, refusal_sentence

if TYPE_CHECKING:
    from nep_core.networks.security.keys import Keys
    from nep_studio.run.local_network import LocalNetwork
    from nep_studio.sharing import Refusal, Sharing

    from .dialog import SharingDialog


# Who takes part in the network, in a few words for a panel.


@dataclass(frozen=True)
class SharingTold:
    """Nothing in ``words`` while only this computer takes part."""

    words: str = ""
    more: str = ""
    icon_name: str = ""


def told_of(sharing: Sharing) -> SharingTold:
    """How the network is now."""
    if sharing.joined is not None:
        return SharingTold(joined_words(sharing.joined), "", "monitor")
    if sharing.opening is None:
        return SharingTold()
    words = tr("The network is open")
    if refusals := sharing.refusals.newest_first:
        return SharingTold(words, refusal_sentence(refusals[0]), "triangle-alert")
    count = len(sharing.computers)
    more = count_words(count, "1 computer may come in.", "{n} computers may come in.")
    return SharingTold(words, more if count else "", "monitor")


def joined_words(keys: Keys) -> str:
    """In whose network this studio is."""
    computer = keys.computers[0].name if keys.computers else keys.title
    return tr("In the network of “{computer}”", computer=computer)


# Puts “Open to other computers” into the window: its action, and what is told of it there.


def make(host: Host) -> Parts:
    """The action, in the Robots menu; the page Network shows that the network is open."""
    kit = SharingKit(host)
    kit.told.connect(lambda told: host.ask("network.show_sharing", *astuple(told)))
    kit.tell()
    action = NewAction(
        "open_network",
        "Open to other computers…",
        kit.open,
        "monitor",
        tip="Let other computers take part: their nodes and robots talk with yours.",
        menu="robots",
    )
    return Parts(actions=[action], commands={"sharing.open": kit.open})


class SharingKit(QObject):
    """What the action does, and what the window tells; the dialog is loaded when it is opened.

    ``told`` gives a SharingTold whenever something has changed.
    """

    told = Signal(object)

    def __init__(self, host: Host) -> None:
        super().__init__(host.actions)
        self._host = host
        self._runner = host.services.runner
        self._waiting: Callable[[], None] | None = None
        self._is_to_offer_run = False
        self._refused: Message | None = None
        self.dialog: SharingDialog | None = None
        self._sharing: Sharing | None = None
        self._runner.network_made.connect(self._on_network_made)
        follow_words(self, self.tell)
        if address := host.services.settings.kept_open_at:
            soon = QTimer(self, singleShot=True, interval=0)
            soon.timeout.connect(lambda: self.sharing.open(address))
            self._runner.closing.connect(soon.stop)
            soon.start()

    @property
    def sharing(self) -> Sharing:
        """What opens and joins networks; it is made with the first one."""
        _ = self._runner.local
        assert self._sharing is not None
        return self._sharing

    def _on_network_made(self, local: LocalNetwork) -> None:
        from nep_studio.sharing import Sharing  # loaded with the network

        settings = self._host.services.settings
        sharing = self._sharing = Sharing(local, self._host.services.running)
        sharing.went_down.connect(self._runner.disconnected)
        self._runner.closing.connect(sharing.end)
        local.master_options = lambda: ["--original"] if settings.lets_original_join else []
        sharing.changed.connect(self.tell)
        sharing.settled.connect(self._on_settled)
        sharing.refused.connect(self._on_refused)
        sharing.failed.connect(self._on_failed)

    def tell(self) -> None:
        """Tell how it is now."""
        self.told.emit(SharingTold() if self._sharing is None else told_of(self._sharing))

    def open(self) -> None:
        """Show the dialog."""
        from .dialog import SharingDialog

        if self.dialog is not None:
            self.dialog.raise_()
            self.dialog.activateWindow()
            return
        host, sharing, after = self._host, self.sharing, self._after_the_run
        dialog = self.dialog = SharingDialog(
            sharing, self._runner, host.services.settings, host.services.look, host.widget
        )
        dialog.open_asked.connect(lambda at: after(lambda: sharing.open(at)))
        dialog.join_asked.connect(lambda at, code: after(lambda: sharing.join(at, code)))
        dialog.close_asked.connect(lambda: after(sharing.close))
        dialog.begin_anew_asked.connect(lambda: after(sharing.begin_anew))
        dialog.finished.connect(self._on_finished)
        host.services.studio.words_changed.connect(dialog.reject)  # it speaks the one before
        dialog.begin()

    def _after_the_run(self, do: Callable[[], None]) -> None:
        """Stop the program first; it would lose its nodes while it runs."""
        self._is_to_offer_run = self._runner.state != "idle"
        if self._is_to_offer_run:
            if self._waiting is None:
                self._runner.state_changed.connect(self._on_run_changed)
            self._waiting = do
            self._runner.stop()
        else:
            do()

    def _on_run_changed(self, state: str) -> None:
        if state == "idle" and self._waiting is not None:
            self._runner.state_changed.disconnect(self._on_run_changed)
            do, self._waiting = self._waiting, None
            do()

    def _on_settled(self, state: str) -> None:
        joined = self.sharing.joined
        if self._refused is not None and state != "open":
            self._host.services.messages.withdraw(self._refused)
            self._refused = None
        if state == "open":
            self._confirm(tr("The network is open to other computers"))
        elif state == "joined" and joined is not None:
            self._confirm(joined_words(joined))
        elif state == "closed":
            self._host.services.settings.kept_open_at = ""
            self._confirm(tr("Only this computer takes part now"))

    def _confirm(self, title: str) -> None:
        run = Answer(tr("Run again"), self._runner.run)
        self._host.services.messages.confirm(title, *([run] if self._is_to_offer_run else []))
        self._is_to_offer_run = False

    def _on_refused(self, refusal: Refusal) -> None:
        messages = self._host.services.messages
        if self._refused is not None:
            messages.withdraw(self._refused)
        self._refused = refusal_message(refusal, self.sharing.key_path, self.open)
        messages.tell(self._refused)

    def _on_failed(self, error: NepError) -> None:
        if self.dialog is None:  # else the dialog tells it
            show = Answer(tr("Open to other computers…"), self.open)
            self._host.services.messages.tell_error(error, show)

    def _on_finished(self) -> None:
        self.dialog = None


plugin = Plugin("sharing", make, order=160)
