"""The Run menu, the buttons of it on the toolbar, and the words that say how it is going."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize, Qt
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QLabel, QMenu, QSizePolicy, QToolBar, QToolButton, QWidget

from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

    from .control import RunControl

RUN_BUTTONS = ("run", "stop", "pause", "step")
PACES = (
    (0.0, "Full speed"),
    (0.3, "Slow: a little while at each block"),
    (1.0, "Very slow: one second at each block"),
)
"""How long it stays at each block, in seconds, and what that is called."""

WITH_A_PROJECT = ("breakpoint", "clear_breakpoints", "end_on_error", "needs")


def fill_run_menu(menu: QMenu, host: Host) -> None:
    """Make the actions of the Run menu."""
    add = host.actions.add
    services = host.services
    run = add("run", "Run", lambda: services.runner.run(), icon_name="play", keys="F5")
    stop = add("stop", "Stop", lambda: services.running.stop(), icon_name="square", keys="Shift+F5")
    pause = add("pause", "Pause", lambda: services.runner.pause(), icon_name="pause", keys="F6")
    step = add(
        "step", "One step", lambda: services.runner.step(), icon_name="step-forward", keys="F10"
    )
    menu.addActions([run, stop, pause, step])
    menu.addSeparator()
    paces = menu.addMenu(icon("gauge", host.services.look.theme), "")
    _add_paces(labelled(paces, title="Speed"), host)
    toggle = add(
        "breakpoint",
        "Pause at this block",
        lambda: host.services.running.toggle_breakpoint(),
        icon_name="pin",
        keys="F9",
    )
    clear = add(
        "clear_breakpoints", "Pause nowhere", lambda: host.services.running.breakpoints.clear()
    )
    menu.addActions([toggle, clear])
    menu.addSeparator()
    needs = add(
        "needs",
        "What the program needs…",
        lambda: host.services.running.show_needs(),
        icon_name="list",
        keys="Shift+F8",
    )
    menu.addAction(needs)
    menu.addSeparator()  # below it, what is kept with the project
    ends = add(
        "end_on_error",
        "Stop everything when one rule fails",
        lambda: services.running.end_on_error(ends.isChecked()),
        tip="An error ends the rule in which it happens. This project's other rules go on, or not.",
    )
    ends.setCheckable(True)
    menu.addAction(ends)
    menu.aboutToShow.connect(lambda: _show_end_on_error(host))
    host.actions.enable(False, *RUN_BUTTONS, *WITH_A_PROJECT)


def _show_end_on_error(host: Host) -> None:
    """Let the mark be as it is in the open project, which may have been undone or read."""
    document = host.services.document
    is_set = document is not None and document.project.ends_on_error
    host.actions["end_on_error"].setChecked(is_set)


def follow_running(host: Host, toolbar: QToolBar) -> None:
    """Let the actions and the toolbar follow the program from now on."""
    RunLooks(host)
    for sign in toolbar.findChildren(RunState):
        sign.follow(host.services.running)


def _add_paces(menu: QMenu, host: Host) -> None:
    """One of several paces, with a mark before it."""
    group = QActionGroup(menu)
    for line_s, words in PACES:
        action = labelled(menu.addAction(""), text=words)
        action.setCheckable(True)
        action.setChecked(not line_s)
        action.setData(line_s)
        group.addAction(action)
    group.triggered.connect(lambda action: host.services.running.set_pace(action.data()))


class RunLooks(QObject):
    """Lets the actions follow the state of the program."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.actions)
        self._host = host
        host.services.runner.state_changed.connect(self.refresh)
        host.services.files.document_changed.connect(self.refresh)
        self.refresh()

    def refresh(self, *_: object) -> None:
        """Enable what can be done now."""
        actions, state = self._host.actions, self._host.services.runner.state
        is_open = self._host.services.document is not None
        actions.enable(is_open and state in ("idle", "running", "paused"), "run")
        actions.enable(state in ("starting", "running", "paused"), "stop")
        actions.enable(state == "running", "pause")
        actions.enable(state == "paused", "step")
        actions.enable(is_open, *WITH_A_PROJECT)
        _show_end_on_error(self._host)
        actions.label("run", RUN_WORDS.get(state, "Run"))


RUN_WORDS = {"paused": "Go on", "running": "Run again"}
"""What Run means in a state of the program, if it is not what it says."""


STATE_WORDS = {
    "starting": "Starting…",
    "running": "Running",
    "paused": "Paused",
    "stopping": "Stopping…",
}
"""How it is going, in a word or two."""

STATES = {
    "idle": ("", ""),
    "starting": ("refresh-cw", "info"),
    "running": ("play", "success"),
    "paused": ("pause", "warning"),
    "stopping": ("square", "error"),
}


class RunState(QWidget):
    """An icon and a word for the state of the program; nothing while it does not run.

    It has room for the usual words at all times, so that nothing moves when it says something.
    """

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self._running: RunControl | None = None
        self._sign, self.words = QLabel(), ElidedLabel()
        self._is_tight = False
        line = self.fontMetrics().height()
        in_row(self._sign, (self.words, 1), of=self, margins=(line // 2, 0, line // 2, 0))
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        look.theme_changed.connect(self.refresh)
        follow_words(self, self.refresh)

    def follow(self, running: RunControl) -> None:
        """Say how this goes, from now on."""
        self._running = running
        running.runner.state_changed.connect(self.show_state)
        running.became_stale.connect(self.refresh)
        self.refresh()

    def sizeHint(self) -> QSize:
        """Room for the usual words."""
        metrics, line = self.fontMetrics(), self.fontMetrics().height()
        widest = max(map(metrics.horizontalAdvance, map(tr, STATE_WORDS.values())))
        room = 0 if self._is_tight else widest
        return QSize(room + 3 * line, super().sizeHint().height())

    def be_tight(self, is_tight: bool) -> None:
        """Keep room for the sign alone, or for the words too; what is left over is taken anyway."""
        if is_tight != self._is_tight:
            self._is_tight = is_tight
            self.updateGeometry()

    def refresh(self) -> None:
        """Take the theme, or what is new."""
        self.show_state("idle" if self._running is None else self._running.runner.state)

    def show_state(self, state: str) -> None:
        """Say how it is going."""
        name, colour = STATES[state]
        running = self._running
        is_stale = running is not None and running.is_stale and state in ("running", "paused")
        stale = tr("Running as it was before your changes")
        self.words.set_words(stale if is_stale else tr(STATE_WORDS.get(state, "")))
        self.setToolTip(tr("Run again to use your changes") if is_stale else "")
        self._sign.setVisible(bool(name))
        if name:
            side = self.fontMetrics().height()
            picture = icon(name, self._look.theme.colour(colour))
            self._sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))


def style_buttons(bar: QToolBar, look: Look) -> None:
    """Give Run and Stop their colours; in a menu, their icons are like the others."""
    for action in bar.actions():
        name, button = action.objectName(), bar.widgetForAction(action)
        if name in ("run", "stop") and isinstance(button, QToolButton):
            button.setProperty("kind", name)
            dress = partial(_dress, button, look)
            action.changed.connect(dress)
            dress()


def _dress(button: QToolButton, look: Look) -> None:
    """The button takes the icon of its action each time that this changes."""
    action = button.defaultAction()
    name, sign = action.objectName(), {"run": "play", "stop": "square"}[action.objectName()]
    button.setIcon(icon(sign, look.theme, f"{name}_text"))


def keep_width(run: QToolButton) -> None:
    """Let Run be as wide as its widest words, so that Stop never moves under the pointer."""
    keep_room(run, map(tr, ("Run", *RUN_WORDS.values())))


def keep_room(button: QToolButton, all_words: Iterable[str]) -> None:
    """Let a button be as wide as the widest words that it says, whatever it says now."""
    button.ensurePolished()
    button.setMinimumWidth(0)
    if button.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly:
        return
    metrics, now = button.fontMetrics(), button.defaultAction().iconText()
    widths = [
        metrics.size(Qt.TextFlag.TextShowMnemonic, words).width() for words in (now, *all_words)
    ]
    button.setMinimumWidth(button.sizeHint().width() - widths[0] + max(widths))
