"""The widget that shows the graph: pan, zoom, point, choose with mouse or keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QFocusEvent,
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.network_feed import Seen
from nep_studio.ui.node_style import node_words, topic_words, type_words
from nep_studio.ui.theme.look import Look as StudioLook
from nep_studio.ui.words import is_right_to_left

from .graph import MARGIN, Graph, Key, Shapes, shapes_of
from .graph_painter import GraphPainter, Look

SMALLEST, LARGEST = 0.25, 2.5
SMALLEST_FIT = 0.6
"""A graph that fits only smaller than this is not made smaller: it is moved about instead."""
ZOOM_STEP = 1.2
WHEEL_NOTCH = 120
ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, -1),
    Qt.Key.Key_Down: (0, 1),
}


class GraphView(QWidget):
    """Shows a graph; ``topic_chosen`` and ``node_chosen`` give a name."""

    topic_chosen = Signal(str)
    node_chosen = Signal(str)

    def __init__(self, look: StudioLook, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio_look = look
        self._graph = Graph()
        self._look = Look()
        self.shapes = Shapes()
        self._scale, self._corner = 1.0, QPointF()
        self._is_fitted = True
        self._pressed: QPointF | None = None
        self._has_moved = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        labelled(
            self,
            name="Network",
            description="The arrow keys go from one node or topic to the next, Enter opens it.",
        )
        look.theme_changed.connect(self._on_theme_changed)
        follow_words(self, self._on_theme_changed)  # it is read from the other side, too

    @property
    def selected(self) -> Key | None:
        """What is chosen."""
        return self._look.selected

    @property
    def scale(self) -> float:
        """How large it is shown."""
        return self._scale

    def show_graph(self, graph: Graph, seen: Seen, statuses: Mapping[str, NodeStatus]) -> None:
        """Show this; places change only when other nodes or lines are there."""
        selected = self._look.selected if self._look.selected in graph.keys else None
        self._look = replace(self._look, seen=seen, statuses=statuses, selected=selected)
        if graph != self._graph:
            self._graph = graph
            self._lay_out()
        self.update()

    def select(self, key: Key | None) -> None:
        """Choose something, and bring it into view."""
        self._look = replace(self._look, selected=key)
        if key is not None and key in self.shapes.rects:
            rect = self.shapes.rects[key]
            view = self._view()
            edge = self._line() * MARGIN
            wanted = rect.adjusted(-edge, -edge, edge, edge)
            dx = min(0.0, wanted.left() - view.left()) or max(0.0, wanted.right() - view.right())
            dy = min(0.0, wanted.top() - view.top()) or max(0.0, wanted.bottom() - view.bottom())
            if dx or dy:
                self._corner += QPointF(dx, dy)
                self._is_fitted = False
            announce(self, self._words(key).replace("\n", ". "))
        self.update()

    def fit(self) -> None:
        """Show all of it."""
        self._is_fitted = True
        bounds = self.shapes.bounds
        if bounds.isEmpty():
            return
        edge = self._line() * MARGIN
        bounds = bounds.adjusted(-edge, -edge, edge, edge)
        fitting = min(self.width() / bounds.width(), self.height() / bounds.height(), 1.0)
        self._scale = max(fitting, SMALLEST_FIT)
        self._corner = bounds.center() - QPointF(self.width(), self.height()) / (2 * self._scale)
        if bounds.width() * self._scale > self.width():
            is_mirrored = is_right_to_left()
            end = bounds.right() - self.width() / self._scale
            self._corner.setX(end if is_mirrored else bounds.left())
        if bounds.height() * self._scale > self.height():
            self._corner.setY(bounds.top())
        self.update()

    def zoom(self, factor: float, at: QPointF | None = None) -> None:
        """Make it larger or smaller; what is ``at`` a place of the widget stays there."""
        place = at or QPointF(self.width() / 2, self.height() / 2)
        scale = min(LARGEST, max(SMALLEST, self._scale * factor))
        self._corner += place / self._scale - place / scale
        self._scale, self._is_fitted = scale, False
        self.update()

    def pan(self, dx: float, dy: float) -> None:
        """Move it by pixels."""
        self._corner -= QPointF(dx, dy) / self._scale
        self._is_fitted = False
        self.update()

    def place_of(self, key: Key) -> QPointF:
        """Where the middle of an item is in the widget."""
        return (self.shapes.rects[key].center() - self._corner) * self._scale

    def sizeHint(self) -> QSize:
        """Room for a small network."""
        line = round(self._line())
        return QSize(line * 40, line * 16)

    def _line(self) -> float:
        return QFontMetricsF(self.font()).height()

    def _lay_out(self) -> None:
        self.shapes = shapes_of(self._graph, self._line(), is_mirrored=is_right_to_left())
        if self._is_fitted:
            self.fit()

    def _words(self, key: Key) -> str:
        seen = self._look.seen
        if key[0] == "topic":
            topic = seen.topics.get(key[1])
            return topic_words(topic) if topic else key[1]
        status, node = self._look.statuses.get(key[1]), seen.nodes.get(key[1])
        words = type_words(status.type if status else "")
        return node_words(node, words) if node else key[1]

    def _view(self) -> QRectF:
        return QRectF(
            self._corner, QPointF(self.width(), self.height()) / self._scale + self._corner
        )

    def _at(self, place: QPointF) -> Key | None:
        return self.shapes.at(place / self._scale + self._corner)

    def _open(self, key: Key | None) -> None:
        self.select(key)
        if key is not None:
            (self.topic_chosen if key[0] == "topic" else self.node_chosen).emit(key[1])

    # Events

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the graph."""
        theme = self._studio_look.theme
        painter = QPainter(self)
        painter.fillRect(self.rect(), theme.colour("canvas"))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(self.layoutDirection())
        painter.scale(self._scale, self._scale)
        painter.translate(-self._corner)
        look = replace(self._look, has_focus=self.hasFocus())
        GraphPainter(painter, theme, self.font()).draw(self.shapes, look, self._view())
        painter.end()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show all of it still."""
        if self._is_fitted:
            self.fit()

    def changeEvent(self, event: QEvent) -> None:
        """Lay it out anew in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._lay_out()

    def event(self, event: QEvent) -> bool:
        """Tell about what is under the mouse."""
        if event.type() == QEvent.Type.ToolTip:
            pointed = cast(QHelpEvent, event)
            key = self._at(QPointF(pointed.pos()))
            QToolTip.showText(pointed.globalPos(), self._words(key) if key else "", self)
            return True
        return super().event(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to move the graph, or to choose."""
        if event.button() in (Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton):
            self._pressed, self._has_moved = event.position(), False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the graph, or show what would be chosen."""
        if self._pressed is not None:
            way = event.position() - self._pressed
            if self._has_moved or way.manhattanLength() > self._line() / 3:
                self._has_moved = True
                self.setCursor(Qt.CursorShape.ClosedHandCursor)
                self.pan(way.x(), way.y())
                self._pressed = event.position()
            return
        hovered = self._at(event.position())
        if hovered != self._look.hovered:
            self._look = replace(self._look, hovered=hovered)
            pointing = Qt.CursorShape.PointingHandCursor
            self.setCursor(pointing if hovered else Qt.CursorShape.ArrowCursor)
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what is there."""
        was_click = self._pressed is not None and not self._has_moved
        self._pressed = None
        self.setCursor(Qt.CursorShape.ArrowCursor)
        if was_click and event.button() == Qt.MouseButton.LeftButton:
            self._open(self._at(event.position()))

    def leaveEvent(self, event: QEvent) -> None:
        """Point at nothing."""
        self._look = replace(self._look, hovered=None)
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom where the mouse is; with Shift move sideways."""
        turned = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or turned.x():
            self.pan(turned.x() or turned.y(), turned.y() if turned.x() else 0)
        else:
            self.zoom(ZOOM_STEP ** (turned.y() / WHEEL_NOTCH), event.position())
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows go on, Enter opens, + and - zoom, 0 shows all."""
        key = Qt.Key(event.key())
        if key in ARROWS:
            self._go(*ARROWS[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self._open(self.selected)
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal):
            self.zoom(ZOOM_STEP)
        elif key == Qt.Key.Key_Minus:
            self.zoom(1 / ZOOM_STEP)
        elif key == Qt.Key.Key_0:
            self.fit()
        else:
            super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show where the keyboard is."""
        super().focusInEvent(event)
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """The keyboard is elsewhere."""
        super().focusOutEvent(event)
        self.update()

    def _go(self, dx: int, dy: int) -> None:
        start = self.selected
        if start is None or start not in self.shapes.rects:
            first = next(iter(self._graph.keys), None)
            self.select(first)
            return
        following = self.shapes.next_to(start, dx, dy)
        if following is not None:
            self.select(following)

    def _on_theme_changed(self) -> None:
        self._lay_out()
        self.update()
