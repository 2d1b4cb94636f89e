"""A block as it is laid out: where its words, fields, plugged blocks and mouths are.

All positions are relative to the block's own top left corner, so that a box stays valid when the
block moves, and only the boxes around a changed block are made again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QStaticText

from nep_studio.blocks.slots import Mark

PieceKind = Literal["words", "field", "socket", "button"]
Outline = Literal["statement", "hat", "cap", "round", "square", "hexagon", "bracket", "pill", "gap"]


@dataclass(slots=True)
class Piece:
    """A part of a block that is drawn inside it.

    ``key`` is the slot of a field or socket, and the group of a button; ``shape`` how a field or
    socket is drawn; ``kind`` of slot or action of button ("add", "remove", "expand", "comment");
    ``hint`` says faintly what goes into an empty place; ``amount`` is how full a slider is (0 to
    1), the degrees of an angle, 1 for a tick; ``mark`` is what is drawn in a field, and one that
    ``opens`` has an arrow.
    """

    piece: PieceKind
    x: float
    y: float
    width: float
    height: float
    text: str = ""
    key: str = ""
    kind: str = ""
    shape: str = ""
    number: int = 0
    hint: str = ""
    amount: float = 0.0
    mark: Mark = ""
    opens: bool = False

    def holds(self, x: float, y: float) -> bool:
        """Whether a point of the block is on this piece."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height


@dataclass(slots=True)
class Plug:
    """A block plugged into the slot ``key``."""

    key: str
    x: float
    y: float
    width: float
    height: float
    box: Box


@dataclass(slots=True)
class Chain:
    """Boxes below each other; ``key`` is the body's slot, empty for the chain of a stack.

    ``ys`` are the tops of the boxes and, last, the end of the chain, all relative to it. The
    chain's ``x`` is where its boxes begin: their left, or their right when it ``is_mirrored``.
    """

    key: str
    x: float
    y: float
    boxes: list[Box]
    ys: list[float]
    width: float
    height: float
    is_mirrored: bool = False


@dataclass(slots=True)
class Box:
    """One block laid out; ``segments`` are the heights of its rows and mouths in turns.

    ``is_mirrored`` boxes have their left and right exchanged. A box without a block id is the gap
    that shows where blocks will go.
    """

    block: str
    type: str
    outline: Outline
    width: float
    height: float
    segments: tuple[float, ...]
    is_mirrored: bool = False
    pieces: list[Piece] = field(default_factory=list)
    plugs: list[Plug] = field(default_factory=list)
    mouths: list[Chain] = field(default_factory=list)
    reach: float = 0.0
    is_disabled: bool = False
    is_collapsed: bool = False


# The sizes of blocks, all taken from the height of a line of text.


class Measures:
    """Sizes in canvas units, and how wide a text is.

    ``line`` is the height of a line of text; everything else follows from it, so that a larger
    font makes larger blocks. ``is_mirrored`` lays blocks out from right to left.
    """

    def __init__(
        self, line: float, text_width: Callable[[str], float], *, is_mirrored: bool = False
    ) -> None:
        self.line = line
        self.text_width = text_width
        self.is_mirrored = is_mirrored
        unit = self.unit = line / 18.0
        self.gap = 6 * unit
        self.pad = 12 * unit
        self.value_pad = 4 * unit
        self.field_pad = 7 * unit
        self.field_height = line + 6 * unit
        self.row_pad = 6 * unit
        self.row_height = self.field_height + 2 * self.row_pad
        self.corner = 9 * unit
        self.notch_x = 18 * unit
        self.notch_width = 30 * unit
        self.notch_depth = 6 * unit
        self.indent = 18 * unit
        self.mouth_height = 30 * unit
        self.foot = 18 * unit
        self.hat = 16 * unit
        self.socket = 44 * unit
        self.button = line + 2 * unit
        self.widest = 460 * unit
        self.narrowest = 96 * unit
        self.narrowest_field = 24 * unit
        self.widest_field = 300 * unit


# Texts prepared for painting, one for each string.

MOST_TEXTS = 20_000


class Texts(dict[str, QStaticText]):
    """Static texts of one font; preparing one costs more than painting it often."""

    def __missing__(self, text: str) -> QStaticText:
        if len(self) > MOST_TEXTS:
            self.clear()
        made = self[text] = QStaticText(text)
        made.setTextFormat(Qt.TextFormat.PlainText)
        made.setPerformanceHint(QStaticText.PerformanceHint.AggressiveCaching)
        return made


class TextWidths(dict[str, float]):
    """How wide texts are in a font, rounded up to a whole unit, each measured once."""

    def __init__(self, font: QFont) -> None:
        self._metrics = QFontMetricsF(font)
        self.line = self._metrics.height()
        """The height of a line."""

    def __missing__(self, text: str) -> float:
        width = self[text] = float(-(-self._metrics.horizontalAdvance(text) // 1))
        return width
