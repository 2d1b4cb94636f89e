"""The studio's network opened to other computers, or left for the one of another computer."""

from __future__ import annotations

import logging
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from faults import Fault, Text
from nep_core.errors import NepError, NetworkError
from nep_core.networks.security.addresses import endpoint_at, is_ours
from nep_core.networks.security.curve import NOT_LET_IN
from nep_core.networks.security.keys import Computer, Keys
from nep_core.networks.security.opening import DOOR_PORT, MASTER_PORT, Opening
from nep_core.networks.security.pairing import Code, DoorEvent
from nep_core.places import key_file
from nep_core.wire.messages import NodeState

from .run.local_network import LocalNetwork, UsedKeys, free_endpoint, pair_with
from .run.plan import STUDIO

log = logging.getLogger(__name__)


# Who was not let in to an opened network, from what the master, the nodes and the door tell.

RefusalKind = Literal["stranger", "own_program", "unable", "wrong_code", "code_used_up"]

MOST = 20

_TOLD: tuple[RefusalKind, ...] = ("stranger", "own_program", "unable")
"""Of these the network itself tells."""


@dataclass(frozen=True)
class Refusal:
    """Who was not let in, from where ("" when it is this computer), and when (time.time())."""

    kind: RefusalKind
    address: str
    time_s: float


class Refusals:
    """The last ones, each once; who knocks again moves to the front."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str], Refusal] = {}

    def add(self, refusal: Refusal) -> bool:
        """Note one; whether it is news."""
        key = refusal.kind, refusal.address
        is_new = self._known.pop(key, None) is None
        self._known[key] = refusal
        while len(self._known) > MOST:
            del self._known[next(iter(self._known))]
        return is_new

    def clear(self) -> None:
        """Forget all."""
        self._known.clear()

    @property
    def newest_first(self) -> list[Refusal]:
        """All that are known."""
        return list(reversed(self._known.values()))


def refusals_in(fault: Fault) -> Iterator[Refusal]:
    """What a warning says of those who were refused; nothing when it is about something else."""
    if fault.code == NOT_LET_IN:
        yield from _refusals(fault.sentence)


def _refusals(text: Text) -> Iterator[Refusal]:
    for name, told in text.values.items():
        if not isinstance(told, Text):
            continue
        kind = next((one for one in _TOLD if one == name), None)
        if kind is None:
            yield from _refusals(told)  # a broker tells for its master too
            continue
        addresses = told.values.get("addresses")
        for address in addresses if isinstance(addresses, list) else ():
            yield Refusal(kind, str(address), time.time())


State = Literal["closed", "busy", "open", "joined"]

TITLE = "NEP Studio"
LOOK_MS = 1000


class Sharing(QObject):
    """Opens and closes the network of a window; what takes a while is done in a thread.

    ``changed``: its state or who is let in; ``settled`` gives the state that was asked for and is
    reached, ``failed`` the NepError of what was asked; ``happened`` a DoorEvent, ``refused`` a new
    Refusal; ``went_down`` tells that the network is about to be started anew.
    """

    changed = Signal()
    settled = Signal(str)
    happened = Signal(object)
    refused = Signal(object)
    failed = Signal(object)
    went_down = Signal()
    _heard = Signal(object)  # Fault
    _done = Signal(object)  # NepError | None

    def __init__(
        self,
        local: LocalNetwork,
        parent: QObject | None = None,
        *,
        keys: Path | None = None,
        ports: tuple[int, int] = (MASTER_PORT, DOOR_PORT),
        is_announced: bool = True,
    ) -> None:
        """``ports``: those of the master and the door, if they are free."""
        super().__init__(parent)
        self.opening: Opening | None = None
        self.joined: Keys | None = None
        self.refusals = Refusals()
        self.keys, self.ports, self.is_announced = keys, ports, is_announced
        self._local = local
        self._used = UsedKeys()
        self._usual_master = local.wanted_master
        self._thread: threading.Thread | None = None
        self._is_ended = False
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)
        self._heard.connect(self._on_heard)
        self._done.connect(self._on_done)
        self.happened.connect(self._on_happened)
        local.listen(self._on_message)

    # What it is like

    @property
    def state(self) -> State:
        """Whether the network is open, joined to another computer's, or neither."""
        if self._thread is not None:
            return "busy"
        if self.opening is not None:
            return "open"
        return "joined" if self.joined is not None else "closed"

    @property
    def code(self) -> Code | None:
        """The code that holds now."""
        return self.opening.code if self.opening is not None else None

    @property
    def computers(self) -> tuple[Computer, ...]:
        """The computers that are let in."""
        return self.opening.file.keys.computers if self.opening is not None else ()

    @property
    def address(self) -> str:
        """What is typed on the other computer; with a port where it is an unusual one."""
        if self.opening is None:
            return ""
        has_usual_port = self.opening.door_port == DOOR_PORT
        return self.opening.host if has_usual_port else self.opening.door_place

    @property
    def key_path(self) -> Path:
        """The key file of the network that this computer opens."""
        return self.keys or key_file()

    # What is asked

    def open(self, address: str) -> None:
        """Let other computers come to this one, at one of its addresses, if they know a code."""
        self._aside(lambda: self._open(address))

    def close(self) -> None:
        """Let nobody in any more, or leave the network of another computer."""
        self._aside(self._close)

    def join(self, address: str, code: str) -> None:
        """Take part in the network of another computer, which shows this code."""
        self._aside(lambda: self._join(address, code))

    def begin_anew(self) -> None:
        """Start master and nodes again, so that connections of removed computers end."""
        self._aside(lambda: self._restart(lambda: None))

    def new_code(self) -> None:
        """Make a code for one more computer."""
        if self.opening is not None:
            self.opening.new_code()
            self.changed.emit()

    def remove(self, computer: str) -> None:
        """Let a computer come in no more; connections that exist stay until ``begin_anew``."""
        if self.opening is not None:
            try:
                self.opening.file.forget(computer)
            except NepError as error:
                self.failed.emit(error)
            self.changed.emit()

    def end(self) -> None:
        """Close the door, as when the window goes; the network itself is closed by others."""
        self._is_ended = True
        self._local.unlisten(self._on_message)
        self._looking.stop()
        if self._thread is not None:
            self._thread.join()
        self._leave()
        self._give_back()

    # How it is done

    def _aside(self, do: Callable[[], None]) -> None:
        if self._thread is not None or self._is_ended:
            return

        def run() -> None:
            error: NepError | None = None
            try:
                do()
            except NepError as reason:
                error = reason
            except Exception:
                log.exception("the network could not be opened, closed or joined")
                error = NetworkError(
                    "The network could not be changed.",
                    checklist=("Try it once more.", "Start NEP Studio again."),
                )
            self._done.emit(error)

        self._thread = threading.Thread(target=run, name="nep-studio-sharing", daemon=True)
        self.changed.emit()
        self._thread.start()
        self._looking.start()

    def _on_done(self, error: NepError | None) -> None:
        """In the window's thread: who sees the new state has been told how it went, too."""
        if self._is_ended:
            return
        self._thread = None
        self.changed.emit()
        if error is None:
            self.settled.emit(self.state)
        else:
            self.failed.emit(error)

    def _open(self, address: str) -> None:
        if not is_ours(address):
            raise NetworkError(
                "This computer is not at {address} any more.",
                checklist=("Is it still in that network?", "Choose its address of now."),
                address=address,
            )
        free = [free_endpoint(endpoint_at(address, port)) for port in self.ports]
        master, door = (int(endpoint.rpartition(":")[2]) for endpoint in free)
        opening = Opening(
            self.key_path,
            title=TITLE,
            host=address,
            port=master,
            door_port=door,
            is_announced=self.is_announced,
            on_event=self.happened.emit,
        )
        self._leave()

        def prepare() -> None:
            self._give_back()
            self._used.take(self.key_path, address)
            self._local.wanted_master = opening.master

        self._restart_or_go_back(prepare, opening.start)
        self.opening = opening
        self.refusals.clear()
        opening.new_code()

    def _join(self, address: str, code: str) -> None:
        path, keys = pair_with(address, code, self.key_path.parent)
        self._leave()

        def prepare() -> None:
            self._give_back()
            self._used.take(path)
            self._local.joined_master = keys.master
            self._local.name = f"{STUDIO} {socket.gethostname()}"

        self._restart_or_go_back(prepare)
        if not self._local.is_open:
            self._local.open()
        self.joined = keys

    def _close(self) -> None:
        was_open = self._local.is_open
        self._leave()
        self._restart(self._give_back, is_wanted=was_open)

    def _leave(self) -> None:
        """End what there is with other computers; the network itself is still as it was."""
        opening, self.opening, self.joined = self.opening, None, None
        if opening is not None:
            opening.close()

    def _restart_or_go_back(
        self, prepare: Callable[[], None], then: Callable[[], None] = lambda: None
    ) -> None:
        """Start anew in another way; when that fails as before, with what ran."""
        was_open, nodes = self._local.is_open, self._local.running
        try:
            self._restart(prepare)
            then()
        except BaseException:
            self._leave()
            if was_open:
                self._local.reopen(self._give_back, nodes)
            else:
                self._local.close()
                self._give_back()
            raise

    def _restart(self, prepare: Callable[[], None], *, is_wanted: bool = True) -> None:
        nodes = self._local.running
        self.went_down.emit()
        if is_wanted:
            self._local.reopen(prepare, nodes)
        else:
            prepare()

    def _give_back(self) -> None:
        """Be as before: programs of this computer only."""
        self._used.give_back()
        self._local.wanted_master, self._local.joined_master = self._usual_master, ""
        self._local.name = STUDIO

    # What happens

    def _on_message(self, _topic: str, message: msgspec.Struct) -> None:
        """In a thread of the network: the master, or a node, tells whom it refused."""
        if isinstance(message, NodeState) and message.event == "warning":
            self._heard.emit(message.fault)

    def _on_look(self) -> None:
        """Once a second: whom our own sockets refused."""
        network = self._local.network
        if self.state == "closed":
            self._looking.stop()
        elif network is not None and (told := network.take_warning()):
            self._on_heard(told)

    def _on_heard(self, fault: Fault) -> None:
        for refusal in refusals_in(fault):
            self._note(refusal)

    def _on_happened(self, event: DoorEvent) -> None:
        if event.kind != "paired":
            self._note(Refusal(event.kind, event.address, time.time()))
        self.changed.emit()

    def _note(self, refusal: Refusal) -> None:
        if self.refusals.add(refusal):
            self.refused.emit(refusal)
        self.changed.emit()
