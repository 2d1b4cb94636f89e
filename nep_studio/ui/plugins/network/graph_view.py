"""The widget that shows the graph: pan, zoom, point, choose with mouse or keys."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPixmap

from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.labels import labelled
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
from nep_studio.ui.widgets.drawing_board import DrawingBoard
from nep_studio.ui.words import count_words, is_right_to_left

from .graph import Curve, Graph, Key, Shapes, shapes_of

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


# The widget that shows the graph.


class GraphView(DrawingBoard[Key]):
    """Shows a graph; ``topic_chosen`` and ``node_chosen`` give a name."""

    topic_chosen = Signal(str)
    node_chosen = Signal(str)

    def __init__(self, look: StudioLook) -> None:
        super().__init__(look)
        self._graph = Graph()
        self._seen, self._statuses = Seen(), dict[str, NodeStatus]()
        self.shapes = Shapes()
        labelled(
            self,
            name="Network",
            description="The arrow keys go from one node or topic to the next, Enter opens it.",
        )
        self.follow_words()

    def show_graph(self, graph: Graph, seen: Seen, statuses: Mapping[str, NodeStatus]) -> None:
        """Show this; places change only when other nodes or lines are there."""
        self._seen, self._statuses = seen, dict(statuses)
        if self.selected not in graph.keys:
            self.selected = None
        if graph != self._graph:
            self._graph = graph
            self.redo()
        self.update()

    def sizeHint(self) -> QSize:
        """Room for a small network."""
        line = round(self.line)
        return QSize(line * 40, line * 16)

    def bounds(self) -> QRectF:
        """What holds all of it."""
        return self.shapes.bounds

    def rects(self) -> Mapping[Key, QRectF]:
        """Where nodes and topics are."""
        return self.shapes.rects

    def lay_out(self) -> None:
        """Place everything anew."""
        self.shapes = shapes_of(self._graph, self.line, is_mirrored=is_right_to_left())

    def words_of(self, key: Key) -> str:
        """What a node or topic is."""
        if key[0] == "topic":
            topic = self._seen.topics.get(key[1])
            return topic_words(topic) if topic else key[1]
        status, node = self._statuses.get(key[1]), self._seen.nodes.get(key[1])
        words = type_words(status.type if status else "")
        return node_words(node, words) if node else key[1]

    def draw(self, painter: QPainter, view: QRectF) -> None:
        """Draw the graph."""
        look = Look(self._seen, self._statuses, self.selected, self.hovered, self.hasFocus())
        theme = self.studio_look.theme
        GraphPainter(painter, theme, self.font()).draw(self.shapes, look, view)

    def open(self, key: Key) -> None:
        """Tell which it is."""
        (self.topic_chosen if key[0] == "topic" else self.node_chosen).emit(key[1])
