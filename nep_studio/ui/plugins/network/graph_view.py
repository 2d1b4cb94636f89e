"""The widget that shows the graph: pan, zoom, point, choose with mouse or keys."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.messages import announce
from nep_studio.ui.network_feed import Seen
from nep_studio.ui.node_style import (
    OTHER_ICON,
    TYPE_COLOURS,
    icon_of,
    node_words,
    short_rate,
    state_look,
    topic_words,
    type_words,
)
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look as StudioLook
from nep_studio.ui.words import count_words, is_right_to_left

from .graph import MARGIN, Curve, Graph, Key, Shapes, shapes_of

# Draws the graph of a network in the colours of the theme.

SMALL = 0.82
"""How large the second line of a box is, compared with the first."""


@dataclass(frozen=True)
class Look:
    """What the graph is drawn with: data, and what the person points at or has chosen."""

    seen: Seen = field(default_factory=Seen)
    statuses: Mapping[str, NodeStatus] = field(default_factory=dict)
    selected: Key | None = None
    hovered: Key | None = None
    has_focus: bool = False


class GraphPainter:
    """Draws shapes with one font and theme; the painter's camera is set already."""

    def __init__(self, painter: QPainter, theme: Theme, font: QFont) -> None:
        self._painter, self._theme = painter, theme
        self._font, self._small = QFont(font), QFont(font)
        self._font.setWeight(QFont.Weight.DemiBold)
        self._small.setPointSizeF(font.pointSizeF() * SMALL)
        self._line = QFontMetricsF(font).height()

    def draw(self, shapes: Shapes, look: Look, view: QRectF) -> None:
        """Draw what is in view: lines first, those of interest over the others."""
        chosen = {key for key in (look.selected, look.hovered) if key is not None}
        first = [curve for curve in shapes.curves if not chosen & {curve.start, curve.end}]
        second = [curve for curve in shapes.curves if chosen & {curve.start, curve.end}]
        for curve in (*first, *second):
            self._draw_curve(curve, look, is_chosen=bool(chosen & {curve.start, curve.end}))
        for curve in first:
            self._draw_rate(curve, look, is_chosen=False)
        for key, rect in shapes.rects.items():
            if rect.intersects(view):
                if key[0] == "node":
                    self._draw_node(key, rect, look)
                else:
                    self._draw_topic(key, rect, look)
                if key == look.selected and look.has_focus:
                    edge, round_ = self._line * 0.22, self._line * 0.7
                    self._painter.setBrush(Qt.BrushStyle.NoBrush)
                    self._painter.setPen(QPen(self._theme.colour("focus"), self._line * 0.14))
                    around = rect.adjusted(-edge, -edge, edge, edge)
                    self._painter.drawRoundedRect(around, round_, round_)
        for curve in second:
            self._draw_rate(curve, look, is_chosen=True)

    def _draw_curve(self, curve: Curve, look: Look, *, is_chosen: bool) -> None:
        rate_hz = _rate_of(curve, look.seen)
        colour = self._theme.colour("accent" if is_chosen else "field_line")
        if not is_chosen and rate_hz < 0.05:
            colour = self._theme.colour("line")
        width = self._line * (0.07 + 0.035 * math.log10(1 + rate_hz))
        pen = QPen(colour, width * (1.5 if is_chosen else 1.0))
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        self._painter.setPen(pen)
        self._painter.drawPath(curve.path)
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(colour)
        self._painter.drawPolygon(curve.arrow)

    def _draw_rate(self, curve: Curve, look: Look, *, is_chosen: bool) -> None:
        """The rate beside a line from a node; on other lines it would say the same again."""
        words = short_rate(_rate_of(curve, look.seen))
        if not words or not (curve.is_saying or is_chosen):
            return
        metrics = QFontMetricsF(self._small)
        rect = QRectF(0, 0, metrics.horizontalAdvance(words) + self._line * 0.5, metrics.height())
        rect.moveCenter(curve.label)
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(self._theme.colour("canvas"))
        self._painter.drawRoundedRect(rect, rect.height() / 2, rect.height() / 2)
        self._painter.setPen(self._theme.colour("text"))
        self._painter.setFont(self._small)
        self._painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)

    def _draw_node(self, key: Key, rect: QRectF, look: Look) -> None:
        painter, theme, line = self._painter, self._theme, self._line
        status = look.statuses.get(key[1])
        kind = status.type if status else ""
        colours = theme.block(TYPE_COLOURS.get(kind, "code"))
        self._box(rect, theme.colour("field"), colours.line, line * 0.5, key, look)
        strip = QRectF(rect.left(), rect.top(), line * 2.2, rect.height())
        if painter.layoutDirection() == Qt.LayoutDirection.RightToLeft:
            strip.moveRight(rect.right())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colours.fill)
        painter.drawRoundedRect(strip, line * 0.5, line * 0.5)
        inner = strip.adjusted(line * 0.45, 0, -line * 0.45, 0)
        name = icon_of(status.node, kind) if status else OTHER_ICON
        self._icon(inner, name, colours.text)
        words = self._beside(rect, strip)
        self._first_line(words, key[1])
        if status is None:
            self._second_line(words, type_words(""), theme.colour("muted"))
        else:
            state = state_look(status)
            self._second_line(words, state.word, theme.colour(state.colour), state.icon)

    def _beside(self, rect: QRectF, strip: QRectF) -> QRectF:
        gap, is_at_right = self._line * 0.4, strip.right() >= rect.right() - 1
        left = rect.left() if is_at_right else strip.right()
        right = strip.left() if is_at_right else rect.right()
        return QRectF(left + gap, rect.top(), right - left - 2 * gap, rect.height())

    def _draw_topic(self, key: Key, rect: QRectF, look: Look) -> None:
        theme, topic = self._theme, look.seen.topics.get(key[1])
        is_live = topic is not None and topic.rate_hz >= 0.05
        edge = theme.colour("accent" if is_live else "field_line")
        self._box(rect, theme.colour("panel_alt"), edge, rect.height() / 2, key, look)
        gap = self._line * 0.9
        words = rect.adjusted(gap, 0, -gap, 0)
        self._first_line(words, key[1], Qt.AlignmentFlag.AlignHCenter)
        if topic is None:
            return
        if topic.lost:
            lost = count_words(topic.lost, "1 lost", "{n} lost")
            self._second_line(words, lost, theme.colour("warning"), "triangle-alert")
        else:
            count = count_words(topic.count, "1 message", "{n} messages")
            middle = Qt.AlignmentFlag.AlignHCenter
            self._second_line(words, count, theme.colour("muted"), alignment=middle)

    def _box(
        self, rect: QRectF, fill: QColor, edge: QColor, round_: float, key: Key, look: Look
    ) -> None:
        is_chosen = key == look.selected
        self._painter.setBrush(self._theme.colour("selection") if is_chosen else fill)
        is_thick = key in (look.selected, look.hovered)
        self._painter.setPen(QPen(edge, self._line * (0.14 if is_thick else 0.08)))
        self._painter.drawRoundedRect(rect, round_, round_)

    def _first_line(
        self, rect: QRectF, words: str, alignment: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignLeading
    ) -> None:
        half = QRectF(rect.left(), rect.center().y() - self._line, rect.width(), self._line)
        self._text(half, words, self._font, self._theme.colour("text"), alignment)

    def _second_line(
        self,
        rect: QRectF,
        words: str,
        colour: QColor,
        icon_name: str = "",
        alignment: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignLeading,
    ) -> None:
        half = QRectF(rect.left(), rect.center().y(), rect.width(), self._line)
        if icon_name:
            side = self._line * 0.8
            is_mirrored = self._painter.layoutDirection() == Qt.LayoutDirection.RightToLeft
            left = half.right() - side if is_mirrored else half.left()
            square = QRectF(left, half.center().y() - side / 2, side, side)
            self._icon(square, icon_name, colour)
            room = side + self._line * 0.25
            half.adjust(0 if is_mirrored else room, 0, -room if is_mirrored else 0, 0)
        self._text(half, words, self._small, colour, alignment)

    def _icon(self, rect: QRectF, name: str, colour: QColor) -> None:
        side = min(rect.width(), rect.height())
        square = QRectF(0, 0, side, side)
        square.moveCenter(rect.center())
        ratio = self._painter.device().devicePixelRatioF() * self._painter.transform().m11()
        pixmap = _pixmap(name, colour.rgba(), round(side * ratio))
        self._painter.drawPixmap(square, pixmap, QRectF(pixmap.rect()))

    def _text(
        self, rect: QRectF, words: str, font: QFont, colour: QColor, alignment: Qt.AlignmentFlag
    ) -> None:
        shown = QFontMetricsF(font).elidedText(words, Qt.TextElideMode.ElideRight, rect.width())
        self._painter.setFont(font)
        self._painter.setPen(colour)
        self._painter.drawText(rect, alignment | Qt.AlignmentFlag.AlignVCenter, shown)


@lru_cache(maxsize=256)
def _pixmap(name: str, colour: int, pixels: int) -> QPixmap:
    """An icon as a picture: to read its drawing again for every node would take too long."""
    return icon_pixmap(name, QColor.fromRgba(colour), pixels)


def _rate_of(curve: Curve, seen: Seen) -> float:
    """How many messages a second go along a line."""
    if curve.is_saying:
        flow = seen.flows.get((curve.start[1], curve.end[1]))
        return flow.rate_hz if flow else 0.0
    topic = seen.topics.get(curve.start[1])
    return topic.rate_hz if topic else 0.0


# The widget that shows the graph: pan, zoom, point, choose with mouse or keys.

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

    def __init__(self, look: StudioLook) -> None:
        super().__init__()
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
            end = bounds.right() - self.width() / self._scale
            self._corner.setX(end if is_right_to_left() else bounds.left())
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
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            key = self._at(QPointF(event.pos()))
            words = plain_tip(self._words(key)) if key else ""
            QToolTip.showText(event.globalPos(), words, self)
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

    def _go(self, dx: int, dy: int) -> None:
        start = self.selected
        if start is None or start not in self.shapes.rects:
            self.select(next(iter(self._graph.keys), None))
            return
        if following := self.shapes.next_to(start, dx, dy):
            self.select(following)

    def _on_theme_changed(self) -> None:
        self._lay_out()
        self.update()
