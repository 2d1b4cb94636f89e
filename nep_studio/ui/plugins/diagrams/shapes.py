"""A diagram as shapes: how large its boxes are with their words, and how its lines run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainterPath, QPolygonF, QTextLayout, QTextOption

from .layout import Drawing, Edge, Extent, Gaps, Point, as_tree, in_layers, mirrored
from .model import Diagram, Item, Key, Line

SMALL = 0.85
"""How large small words are, compared with the others."""

# All in lines of text.
WIDEST, NARROWEST = 11.0, 5.0
WIDEST_WORDS = 9.0
PAD = 0.6
SIGN = 2.0
DIAMOND = 2.6
LOOP = 1.5
LOOP_STEP = 2.0
DOT = 0.32
DOT_AWAY = 1.9
ARROW = 0.6
BESIDE = 0.75
STATE_GAPS, TREE_GAPS = Gaps(1.2, 1.7), Gaps(1.2, 2.3)


class Measures:
    """The fonts of a diagram, and how words are broken into lines."""

    def __init__(self, font: QFont) -> None:
        self.plain, self.bold, self.small = QFont(font), QFont(font), QFont(font)
        self.bold.setWeight(QFont.Weight.DemiBold)
        if font.pointSizeF() > 0:
            self.small.setPointSizeF(font.pointSizeF() * SMALL)
        else:
            self.small.setPixelSize(round(font.pixelSize() * SMALL))
        self.line = QFontMetricsF(font).height()

    def broken(self, words: str, font: QFont, width: float, most: int) -> tuple[str, ...]:
        """Words in at most so many lines; what has no room is cut."""
        found, rest = list[str](), words
        while rest and len(found) < most:
            if len(found) == most - 1:
                metrics = QFontMetricsF(font)
                found.append(metrics.elidedText(rest, Qt.TextElideMode.ElideRight, width))
                break
            layout = QTextLayout(rest, font)
            option = QTextOption()
            option.setWrapMode(QTextOption.WrapMode.WrapAtWordBoundaryOrAnywhere)
            layout.setTextOption(option)
            layout.beginLayout()
            line = layout.createLine()
            line.setLineWidth(width)
            layout.endLayout()
            found.append(rest[: line.textLength()].strip())
            rest = rest[line.textLength() :].strip()
        return tuple(found)

    def width(self, lines: Sequence[str], font: QFont) -> float:
        """How wide lines are."""
        metrics = QFontMetricsF(font)
        return max((metrics.horizontalAdvance(line) for line in lines), default=0.0)

    def height(self, lines: Sequence[str], font: QFont) -> float:
        """How high lines are."""
        return len(lines) * QFontMetricsF(font).height()


@dataclass(frozen=True)
class Words:
    """Lines of words and how much room they take."""

    lines: tuple[str, ...] = ()
    width: float = 0.0
    height: float = 0.0


@dataclass(frozen=True)
class Box:
    """A box with its words; what is ``beside`` stands where the words of a sign are."""

    item: Item
    rect: QRectF
    title: Words
    small: Words
    beside: QRectF = field(default_factory=QRectF)

    @property
    def whole(self) -> QRectF:
        """The box with what stands beside it."""
        return self.rect.united(self.beside)


@dataclass(frozen=True)
class Arrow:
    """A line with its head, if it has one, and its words."""

    line: Line
    path: QPainterPath
    head: QPolygonF
    words: Words
    label: QRectF


@dataclass(frozen=True)
class Shapes:
    """All of a diagram, in pixels at scale 1."""

    boxes: Mapping[str, Box] = field(default_factory=dict)
    arrows: Mapping[str, Arrow] = field(default_factory=dict)
    dots: tuple[tuple[QPointF, QPainterPath, QPolygonF], ...] = ()
    """Where machines begin: a dot, and the arrow to the first state."""

    @cached_property
    def bounds(self) -> QRectF:
        """What holds all of it."""
        found = QRectF()
        for box in self.boxes.values():
            found = found.united(box.whole)
        for arrow in self.arrows.values():
            found = found.united(arrow.path.boundingRect()).united(arrow.label)
        for middle, path, _ in self.dots:
            found = found.united(path.boundingRect()).united(QRectF(middle, middle))
        return found

    @cached_property
    def rects(self) -> dict[Key, QRectF]:
        """What can be chosen, boxes first."""
        found: dict[Key, QRectF] = {("box", key): box.whole for key, box in self.boxes.items()}
        for key, arrow in self.arrows.items():
            if arrow.line.words:
                found["arrow", key] = arrow.label
        return found


def shapes_of(diagram: Diagram, measures: Measures, *, is_mirrored: bool = False) -> Shapes:
    """Lay a diagram out."""
    return _Shaping(diagram, measures, is_mirrored).shapes()


class _Shaping:
    """One diagram on its way to shapes."""

    def __init__(self, diagram: Diagram, measures: Measures, is_mirrored: bool) -> None:
        self._diagram, self._measures = diagram, measures
        self._line, self._side = measures.line, -1.0 if is_mirrored else 1.0
        self._loops: dict[str, list[Line]] = {}
        for line in diagram.lines:
            if line.start == line.end:
                self._loops.setdefault(line.start, []).append(line)
        self._words = {line.key: self._label(line) for line in diagram.lines}
        self._made = {item.key: self._box(item) for item in diagram.items}

    def shapes(self) -> Shapes:
        """The shapes in their places."""
        drawing = self._drawing()
        boxes = {key: self._placed(box, drawing.boxes[key]) for key, box in self._made.items()}
        arrows = {
            line.key: self._arrow(line, drawing)
            for line in self._diagram.lines
            if line.key in drawing.ways
        }
        for key, loops in self._loops.items():
            arrows |= self._looped(boxes[key].rect, loops)
        firsts = [box.rect for box in boxes.values() if box.item.is_first]
        return Shapes(boxes, arrows, tuple(map(self._dot, firsts)))

    def _drawing(self) -> Drawing:
        diagram, unit = self._diagram, self._line
        extents = {key: self._extent(box) for key, box in self._made.items()}
        if diagram.kind == "tree":
            children: dict[str, list[str]] = {}
            for line in diagram.lines:
                children.setdefault(line.start, []).append(line.end)
            drawing = as_tree(extents, children, diagram.first[0], _scaled(TREE_GAPS, unit))
        else:
            edges = [self._edge(line) for line in diagram.lines]
            drawing = in_layers(extents, edges, diagram.first, _scaled(STATE_GAPS, unit))
        return mirrored(drawing) if self._side < 0 else drawing

    def _edge(self, line: Line) -> Edge:
        words = self._words[line.key]
        return Edge(line.key, line.start, line.end, words.width, words.height)

    def _label(self, line: Line) -> Words:
        made = self._text(line.words, self._measures.small, WIDEST_WORDS, 2)
        room = self._line * 0.5
        return Words(made.lines, made.width + room, made.height + room / 2) if made.lines else made

    def _text(self, words: str, font: QFont, lines_wide: float, most: int) -> Words:
        measures = self._measures
        lines = measures.broken(words, font, lines_wide * self._line, most)
        return Words(lines, measures.width(lines, font), measures.height(lines, font))

    def _box(self, item: Item) -> Box:
        """A box whose middle is at the corner of the page."""
        measures, unit = self._measures, self._line
        if item.shape in ("sign", "diamond"):
            side = (SIGN if item.shape == "sign" else DIAMOND) * unit
            small = self._text(item.small, measures.small, WIDEST_WORDS, 3)
            return Box(item, _middled(side, side), Words(), small)
        title = self._text(item.title, measures.bold, WIDEST, 2)
        small = self._text(item.small, measures.small, WIDEST, 2 if item.shape == "leaf" else 1)
        wide = max(title.width + (1.4 * unit if item.sign else 0.0), small.width)
        round_ = unit if item.shape == "ellipse" else 0.0
        width = max(wide + 2 * (PAD * unit + round_), NARROWEST * unit)
        height = title.height + small.height + 2 * PAD * unit
        loops = len(self._loops.get(item.key, ()))
        return Box(item, _middled(width, max(height, loops * LOOP_STEP * unit)), title, small)

    def _extent(self, box: Box) -> Extent:
        unit, item = self._line, box.item
        left = right = box.rect.width() / 2
        if item.is_first:
            left += (DOT_AWAY + DOT) * unit
        if loops := self._loops.get(item.key, ()):
            right += LOOP * unit + max(self._words[loop.key].width for loop in loops)
        height = box.rect.height()
        if box.item.shape in ("sign", "diamond") and box.small.lines:
            right += box.small.width + BESIDE * unit
            height = max(height, box.small.height)
        return Extent(left, right, height)

    def _placed(self, box: Box, middle: Point) -> Box:
        rect = box.rect.translated(middle.x, middle.y)
        if box.item.shape not in ("sign", "diamond") or not box.small.lines:
            return Box(box.item, rect, box.title, box.small)
        beside = QRectF(0, 0, box.small.width, box.small.height)
        away = self._side * (rect.width() / 2 + BESIDE * self._line + box.small.width / 2)
        beside.moveCenter(rect.center() + QPointF(away, 0))
        return Box(box.item, rect, box.title, box.small, beside)

    def _arrow(self, line: Line, drawing: Drawing) -> Arrow:
        way, words = [QPointF(*place) for place in drawing.ways[line.key]], self._words[line.key]
        label = QRectF()
        if line.key in drawing.words and words.lines:
            label = QRectF(0, 0, words.width, words.height)
            label.moveCenter(QPointF(*drawing.words[line.key]))
        head = QPolygonF()
        if self._diagram.kind != "tree":
            tip = way[-1]
            towards = 1.0 if tip.y() > way[-2].y() else -1.0
            way[-1] = tip - QPointF(0, towards * ARROW * self._line)
            head = self._head(tip, way[-1])
        else:
            way = self._joined(line, way)
        return Arrow(line, _curve(way), head, words, label)

    def _joined(self, line: Line, way: list[QPointF]) -> list[QPointF]:
        """Lines of a tree begin and end at the shapes: rows are as high as their highest box."""
        start, end = self._made[line.start].rect, self._made[line.end].rect
        extents = [self._extent(self._made[key]).height for key in (line.start, line.end)]
        way[0] -= QPointF(0, (extents[0] - start.height()) / 2)
        way[-1] += QPointF(0, (extents[1] - end.height()) / 2)
        return way

    def _looped(self, rect: QRectF, loops: Sequence[Line]) -> dict[str, Arrow]:
        """Arrows from a box to itself, beside it."""
        unit, side = self._line, self._side
        edge = rect.right() if side > 0 else rect.left()
        found = {}
        for index, line in enumerate(loops):
            y = rect.center().y() + (index - (len(loops) - 1) / 2) * LOOP_STEP * unit
            half, out = 0.45 * unit, side * LOOP * unit
            start, tip = QPointF(edge, y - half), QPointF(edge, y + half)
            end = tip + QPointF(side * ARROW * unit, 0)
            path = QPainterPath(start)
            path.cubicTo(start + QPointF(out, 0), QPointF(edge + out * 1.2, y + half), end)
            words = self._words[line.key]
            label = QRectF(0, 0, words.width, words.height)
            label.moveCenter(QPointF(edge + out + side * words.width / 2, y))
            found[line.key] = Arrow(line, path, self._head(tip, end), words, label)
        return found

    def _dot(self, rect: QRectF) -> tuple[QPointF, QPainterPath, QPolygonF]:
        edge = rect.left() if self._side > 0 else rect.right()
        tip = QPointF(edge, rect.center().y())
        end = tip - QPointF(self._side * ARROW * self._line, 0)
        middle = tip - QPointF(self._side * DOT_AWAY * self._line, 0)
        path = QPainterPath(middle)
        path.lineTo(end)
        return middle, path, self._head(tip, end)

    def _head(self, tip: QPointF, end: QPointF) -> QPolygonF:
        way = tip - end
        across = QPointF(-way.y(), way.x()) * 0.5
        return QPolygonF([tip, end + across, end - across])


def _scaled(gaps: Gaps, unit: float) -> Gaps:
    return Gaps(gaps.beside * unit, gaps.between * unit)


def _middled(width: float, height: float) -> QRectF:
    return QRectF(-width / 2, -height / 2, width, height)


def _curve(way: Sequence[QPointF]) -> QPainterPath:
    """Bends between the points 2n and 2n + 1, straight between the others."""
    path = QPainterPath(way[0])
    for index, place in enumerate(way[1:], start=1):
        before = path.currentPosition()
        if index % 2:
            half = QPointF(0, (place.y() - before.y()) / 2)
            path.cubicTo(before + half, place - half, place)
        else:
            path.lineTo(place)
    return path
