"""The Run menu, the buttons of it on the toolbar, and the words that say how it is going."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QToolBar, QWidget

from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

RUN_BUTTONS = ("run", "stop", "pause", "step")


def add_run_menu(window: MainWindow) -> QMenu:
    """Make the Run menu."""
    menu, add = window.menuBar().addMenu(tr("&Run")), window.actions_by_name.add
    control = window.running
    runner = control.runner
    run = add("run", tr("Run"), runner.run, icon_name="play", keys="F5", colour="run_text")
    stop = add(
        "stop", tr("Stop"), control.stop, icon_name="square", keys="Shift+F5", colour="stop_text"
    )
    pause = add("pause", tr("Pause"), runner.pause, icon_name="pause", keys="F6")
    step = add("step", tr("One step"), runner.step, icon_name="step-forward", keys="F10")
    menu.addActions([run, stop, pause, step])
    menu.addSeparator()
    _add_paces(menu.addMenu(icon("gauge", window.look.theme), tr("Speed")), window)
    toggle = add(
        "breakpoint",
        tr("Pause at this block"),
        control.toggle_breakpoint,
        icon_name="pin",
        keys="F9",
    )
    clear = add("clear_breakpoints", tr("Pause nowhere"), control.breakpoints.clear)
    menu.addActions([toggle, clear])
    menu.addSeparator()
    needs = add(
        "needs",
        tr("What the program needs…"),
        control.show_needs,
        icon_name="list",
        keys="Shift+F8",
    )
    menu.addAction(needs)
    RunLooks(window)
    return menu


def _add_paces(menu: QMenu, window: MainWindow) -> None:
    """One of several paces, with a mark before it."""
    paces = (
        (0.0, tr("Full speed")),
        (0.3, tr("Slow: a little while at each block")),
        (1.0, tr("Very slow: one second at each block")),
    )
    group = QActionGroup(menu)
    for line_s, words in paces:
        action = menu.addAction(words)
        action.setCheckable(True)
        action.setChecked(line_s == window.running.line_s)
        action.setData(line_s)
        group.addAction(action)
    group.triggered.connect(lambda action: window.running.set_pace(action.data()))


class RunLooks(QObject):
    """Lets the actions follow the state of the program; it goes with the actions."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window.actions_by_name)
        self._window = window
        window.running.runner.state_changed.connect(self.refresh)
        window.files.document_changed.connect(self.refresh)
        self.refresh()

    def refresh(self, *_: object) -> None:
        """Enable what can be done now."""
        actions, state = self._window.actions_by_name, self._window.running.runner.state
        is_open = self._window.files.document is not None
        actions.enable(is_open and state in ("idle", "running", "paused"), "run")
        actions.enable(state in ("starting", "running", "paused"), "stop")
        actions.enable(state == "running", "pause")
        actions.enable(state == "paused", "step")
        actions.enable(is_open, "breakpoint", "clear_breakpoints", "needs")
        run = actions["run"]
        words = {"paused": tr("Go on"), "running": tr("Run again")}
        run.setText(words.get(state, tr("Run")))
        run.setIconText(run.text())


STATES = {
    "idle": ("", ""),
    "starting": ("refresh-cw", "info"),
    "running": ("play", "success"),
    "paused": ("pause", "warning"),
    "stopping": ("square", "error"),
}


class RunState(QWidget):
    """An icon and a word for the state of the program; nothing while it does not run."""

    def __init__(self, window: MainWindow, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = window
        self._sign, self.words = QLabel(), QLabel()
        line = self.fontMetrics().height()
        row = QHBoxLayout(self)
        row.setContentsMargins(line // 2, 0, line // 2, 0)
        row.addWidget(self._sign)
        row.addWidget(self.words)
        window.running.runner.state_changed.connect(self.show_state)
        window.look.theme_changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Take the theme."""
        self.show_state(self._window.running.runner.state)

    def show_state(self, state: str) -> None:
        """Say how it is going."""
        name, colour = STATES[state]
        words = {
            "starting": tr("Starting…"),
            "running": tr("Running"),
            "paused": tr("Paused"),
            "stopping": tr("Stopping…"),
        }
        self.words.setText(words.get(state, ""))
        is_stale = self._window.running.is_stale and state in ("running", "paused")
        if is_stale:
            self.words.setText(tr("Running as it was before your changes"))
        self.setToolTip(tr("Run again to use your changes") if is_stale else "")
        self._sign.setVisible(bool(name))
        if name:
            side = self.fontMetrics().height()
            picture = icon(name, self._window.look.theme.colour(colour))
            self._sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))


def dress_buttons(bar: QToolBar) -> None:
    """Give Run and Stop their colours."""
    for action in bar.actions():
        if action.objectName() in ("run", "stop"):
            bar.widgetForAction(action).setProperty("kind", action.objectName())
