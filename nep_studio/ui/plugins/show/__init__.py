"""Show mode: one project, very large, for museums and theatres."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from nep_studio.settings import ShowOptions
from nep_studio.ui.messages import Message
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

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

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.show: ShowWindow | None = None

    def begin(self, options: ShowOptions | None = None, path: Path | None = None) -> ShowWindow:
        """Cover the screen; ``path`` is a project that is opened when it is needed."""
        from .performance import Performance  # loaded for a show only
        from .window import ShowWindow

        if self.show is not None:
            return self.show
        window, chosen = self._window, options or self._window.settings.show_options
        performance = Performance(window, chosen, path)
        show = self.show = ShowWindow(window, performance, chosen)
        show.left.connect(self._on_left)
        window.messages.show_in(_Silence())
        show.open()
        window.hide()
        if chosen.runs_at_once:
            QTimer.singleShot(0, performance, performance.run)
        return show

    def _on_left(self) -> None:
        window, show = self._window, self.show
        if show is None:
            return
        self.show = None
        show.performance.retire()
        show.deleteLater()
        window.messages.show_in(window.message_area)
        window.show()
        window.activateWindow()


def add_show_mode(window: MainWindow) -> None:
    """Make the actions of show mode, for the View menu: ``show_mode`` and ``show_at_start``."""
    mode = window.findChild(ShowMode) or ShowMode(window)
    add = window.actions_by_name.add
    add("show_mode", tr("Show mode"), mode.begin, icon_name="monitor", keys="F11")
    add(
        "show_at_start",
        tr("Start with the computer…"),
        lambda: _open_startup(window),
        icon_name="power",
    )


def _open_startup(window: MainWindow) -> None:
    from .startup_dialog import StartupDialog

    StartupDialog(window).open()
