"""The card of one node: what it is, how it is doing, what it costs, and what can be done."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import cast, get_args

from PySide6.QtCore import Qt, Signal, SignalInstance
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QToolButton, QWidget

from nep_core.wire.messages import NodeType
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import PROGRAM, PlannedNode
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.network_feed import NodeSeen
from nep_studio.ui.node_style import (
    icon_of,
    is_running,
    manifest_of,
    rate_words,
    state_look,
    type_words,
)
from nep_studio.ui.theme.icons import icon, icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

# What the panel What runs has cards for: nodes that the project needs, and nodes that are there.

ORDER: Mapping[str, int] = {name: place for place, name in enumerate(get_args(NodeType))}


@dataclass(frozen=True)
class Entry:
    """A node with all that its card says; ``planned`` is None for one that nobody planned."""

    status: NodeStatus
    planned: PlannedNode | None = None
    is_ours: bool = False
    seen: NodeSeen | None = None

    @property
    def name(self) -> str:
        """Its name."""
        return self.status.name

    @property
    def is_program(self) -> bool:
        """Whether it is the program itself, which Run and Stop are for."""
        return self.name == PROGRAM

    @property
    def has_log(self) -> bool:
        """Whether the studio keeps what it writes."""
        return self.is_ours or self.is_program

    @property
    def is_foreign(self) -> bool:
        """Whether somebody else started it."""
        return not (self.is_ours or self.is_program or self.planned) or (
            self.planned is not None and not self.is_ours and is_running(self.status)
        )


def entries_of(
    statuses: Mapping[str, NodeStatus],
    planned: Iterable[PlannedNode],
    ours: Mapping[str, PlannedNode],
    seen: Mapping[str, NodeSeen],
) -> list[Entry]:
    """All nodes, from sensing to acting; ``ours`` are those that the studio was asked to start.

    One that nobody planned is shown while it is there, or is the program.
    """
    plans = {**ours, **{one.name: one for one in planned}}
    names = [*plans, *(name for name in statuses if name not in plans)]
    entries = [
        Entry(_status(name, statuses, plans), plans.get(name), name in ours, seen.get(name))
        for name in names
        if name in plans or name in seen or name == PROGRAM or is_running(statuses[name])
    ]
    return sorted(entries, key=lambda one: (ORDER.get(one.status.type, 9), one.name))


def _status(
    name: str, statuses: Mapping[str, NodeStatus], plans: Mapping[str, PlannedNode]
) -> NodeStatus:
    plan, status = plans.get(name), statuses.get(name)
    if plan is None:
        return statuses[name]
    type_ = cast(NodeType, plan.node.partition("/")[0])
    if status is None:
        return NodeStatus(name, type_, plan.node)
    return replace(status, node=status.node or plan.node)


LINES_WIDE = 19
ARROWS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Up: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Down: 1}


class NodeCard(QFrame):
    """Shows an entry; each signal gives the node's name, ``moved`` where the arrow keys go."""

    start_asked = Signal(str)
    stop_asked = Signal(str)
    restart_asked = Signal(str)
    log_asked = Signal(str)
    moved = Signal(int)

    def __init__(self, entry: Entry, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.entry, self._look = entry, look
        self._is_drawn_for = ""
        self.setProperty("kind", "card")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.sign, self.state_sign = QLabel(), QLabel()
        self.name, self.kind, self.state = ElidedLabel(), ElidedLabel(), ElidedLabel()
        self.name.setProperty("role", "heading")
        self.figures, self.reason = ElidedLabel(), ElidedLabel()
        for label in (self.kind, self.figures, self.reason):
            label.setProperty("role", "hint")
        self.start_button = self._tool("Start", "play", self.start_asked)
        self.stop_button = self._tool("Stop", "square", self.stop_asked)
        self.restart_button = self._tool("Restart", "refresh-cw", self.restart_asked)
        self.log_button = self._tool("Log", "scroll-text", self.log_asked)
        self.buttons = (self.start_button, self.stop_button, self.restart_button, self.log_button)
        self._lay_out()
        self._show()
        follow_words(self, self._say)

    def _lay_out(self) -> None:
        names = in_column(self.name, self.kind, spacing=0)
        head = in_row((self.sign, 0, Qt.AlignmentFlag.AlignTop), (names, 1))
        state, foot = in_row(self.state_sign, (self.state, 1)), in_row(*self.buttons, 1)
        gap = self.fontMetrics().height() // 5
        in_column(head, state, self.figures, self.reason, foot, of=self, spacing=gap)

    def show_entry(self, entry: Entry) -> None:
        """Show how the node is doing now; nothing is done when that is as it was."""
        if entry != self.entry:
            self.entry = entry
            self._show()
            self._say()

    def _show(self) -> None:
        entry = self.entry
        self._draw_signs()
        runs, is_known = is_running(entry.status), entry.planned is not None or entry.is_program
        self.start_button.setEnabled(is_known and not runs)
        self.stop_button.setEnabled(runs and (entry.is_ours or entry.is_program))
        self.restart_button.setEnabled(runs and entry.is_ours)  # the program is started by Run
        self.log_button.setEnabled(entry.has_log)
        for button in self.buttons:
            button.setVisible(not entry.is_foreign)

    def _say(self) -> None:
        entry = self.entry
        status, look = entry.status, state_look(entry.status)
        manifest = manifest_of(status.node)
        title = tr(manifest.title) if manifest else ""
        kind = type_words(status.type)
        described = tr(status.fault.sentence).partition("\n")[0].strip()
        self.name.set_words(entry.name)
        self.kind.set_words(f"{title} · {kind}" if title else kind)
        self.state.set_words(f"{look.word}: {described}" if described else look.word)
        self.figures.set_words(" · ".join(figures_of(entry)))
        self.reason.set_words(why_words(entry))
        words = (entry.name, kind, self.state.words, self.figures.words, self.reason.words)
        self.setAccessibleName(". ".join(word for word in words if word))

    def redraw(self) -> None:
        """Draw the icons in another theme or size."""
        self._is_drawn_for = ""
        self._draw_signs()
        names = ("play", "square", "refresh-cw", "scroll-text")
        for button, name in zip(self.buttons, names, strict=True):
            button.setIcon(icon(name, self._look.theme))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter opens the log, the arrow keys go to the next card."""
        key = Qt.Key(event.key())
        if key in ARROWS:
            self.moved.emit(ARROWS[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.entry.has_log:
            self.log_asked.emit(self.entry.name)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Show where the keyboard is."""
        super().paintEvent(event)
        if self.hasFocus():
            line = self.fontMetrics().height() / 8
            painter = QPainter(self)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(self._look.theme.colour("focus"), line))
            rect = self.rect().toRectF().adjusted(line / 2, line / 2, -line / 2, -line / 2)
            painter.drawRoundedRect(rect, line * 3, line * 3)
            painter.end()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Open the log."""
        if self.entry.has_log:
            self.log_asked.emit(self.entry.name)

    def _draw_signs(self) -> None:
        status, state = self.entry.status, state_look(self.entry.status)
        line = self.fontMetrics().height()
        wanted = f"{status.node} {status.type} {state.icon} {state.colour} {line}"
        if wanted == self._is_drawn_for:
            return
        self._is_drawn_for = wanted
        theme, ratio = self._look.theme, self.devicePixelRatioF()
        name = icon_of(status.node, status.type)
        self.sign.setPixmap(icon_pixmap(name, theme.colour("text"), line * 1.6, ratio))
        colour = theme.colour(state.colour)
        self.state_sign.setPixmap(icon_pixmap(state.icon, colour, line, ratio))
        self.state.setStyleSheet(f"color: {colour.name()}")

    def _tool(self, words: str, icon_name: str, asked: SignalInstance) -> QToolButton:
        button = labelled(explained(QToolButton(), words), text=words)
        button.setIcon(icon(icon_name, self._look.theme))
        button.clicked.connect(lambda: asked.emit(self.entry.name))
        return button


def figures_of(entry: Entry) -> list[str]:
    """What is measured of a node, in words."""
    found: list[str] = []
    if entry.seen is not None:
        found.append(rate_words(entry.seen.rate_hz))
        if use := entry.seen.use:
            found.append(tr("processor {percent} %", percent=f"{use.cpu_percent:.0f}"))
            found.append(tr("{size} MB", size=f"{use.memory_bytes / 1e6:,.0f}"))
    if entry.status.restarts:
        found.append(count_words(entry.status.restarts, "restarted once", "restarted {n} times"))
    return found


def why_words(entry: Entry) -> str:
    """Why the node is there."""
    if entry.is_foreign:
        return tr("Started elsewhere: it can be stopped there.")
    if entry.is_program:
        return tr("Your blocks, as a program: Run starts it.")
    planned = entry.planned
    if planned is not None and planned.reason:
        return tr("Needed: {reason}", reason=tr(planned.reason))
    is_on_page = planned is not None and planned.block_id
    return tr("Needed: it is on a page of your project") if is_on_page else ""
