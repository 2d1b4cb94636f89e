"""Show mode: one project, very large, for museums and theatres."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from nep_studio.settings import ShowOptions
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Message, Place

if TYPE_CHECKING:
    from .window import ShowWindow


# Goes into show mode and out of it again; the window waits behind.


class _Silence:
    """Where messages go during a show: its own page tells what somebody must know."""

    def show_message(self, message: Message) -> None:
        """The public is not told."""

    def withdraw(self, message: Message) -> None:
        """There is nothing to withdraw."""

    def clear_passing(self) -> None:
        """There is nothing that passes."""


class ShowMode(QObject):
    """One show at a time over one window."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._host = host
        self.show: ShowWindow | None = None
        self._place: Place | None = None
        """Where the window shows messages, when there is no show."""

    def begin(self, options: ShowOptions | None = None, path: Path | None = None) -> ShowWindow:
        """Cover the screen; ``path`` is a project that is opened when it is needed."""
        from .performance import Performance  # loaded for a show only
        from .window import ShowWindow

        if self.show is not None:
            return self.show
        host, chosen = self._host, options or self._host.services.settings.show_options
        performance = Performance(host, chosen, path)
        show = self.show = ShowWindow(host, performance, chosen)
        show.left.connect(self._on_left)
        host.services.running.asks_over = show
        self._place = host.services.messages.show_in(_Silence())
        show.open()
        host.widget.hide()
        if chosen.runs_at_once:
            QTimer.singleShot(0, performance, performance.run)
        return show

    def _on_left(self) -> None:
        host, show = self._host, self.show
        if show is None:
            return
        self.show = None
        host.services.running.asks_over = None
        show.performance.retire()
        show.deleteLater()
        if self._place is not None:
            host.services.messages.show_in(self._place)
        host.widget.show()
        host.widget.activateWindow()


def make(host: Host) -> Parts:
    """The action of the View menu; ``nep-studio show`` begins a show at once."""
    mode = ShowMode(host)
    action = NewAction("show_mode", "Show mode", mode.begin, "monitor", "F11", menu="view")
    return Parts(actions=[action], commands={"show.begin": mode.begin})


plugin = Plugin("show", make, order=100, needs_project=True)
