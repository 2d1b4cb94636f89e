"""What is printed, laid out on sheets: pages of blocks, and the Python if it is asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtCore import QRectF, QSizeF
from PySide6.QtGui import QFont, QFontMetricsF

from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.page import boxes_of
from nep_studio.ui.picture.scene import Part, What, scene_of
from nep_studio.ui.theme import code_font

from .cutting import Span, cut

USUAL_SCALE = 0.75
"""Points of paper for each canvas unit: as large as on a screen of 96 dots an inch."""

SMALLEST_SCALE = 0.42
"""Smaller words cannot be read on paper: wider pages are cut into columns."""

TAB = 8.0
"""How far the tab of the last block reaches below it, in canvas units."""

CODE_POINTS = 9.0
LEAST_LETTERS = 20


@dataclass(frozen=True)
class PrintOptions:
    """What is printed."""

    what: What = "pages"
    has_code: bool = False


@dataclass(frozen=True)
class BlocksSheet:
    """A sheet with blocks: the part of the page that is on it, in canvas units."""

    title: str
    chains: tuple[Chain, ...]
    seen: QRectF
    scale: float


@dataclass(frozen=True)
class CodeSheet:
    """A sheet with lines of Python, each with its number, or none where a line goes on."""

    title: str
    lines: tuple[tuple[str, str], ...]


Sheet = BlocksSheet | CodeSheet


def on_paper(font: QFont, size: float) -> QFont:
    """A font for a painter that counts in points, or in canvas units; ``size`` is in those.

    A font in points would be enlarged twice: by the dots of the printer, and by the painter.
    """
    made = QFont(font)
    made.setPixelSize(round(size))
    made.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    return made


def block_sheets(canvas: Canvas, what: What, room: QSizeF) -> list[Sheet]:
    """The sheets of the blocks; ``room`` is what is free on one, in points."""
    scene = scene_of(canvas, what)
    return [sheet for part in scene.parts for sheet in _sheets(part, room)]


def code_sheets(code: str, title: str, room: QSizeF) -> list[Sheet]:
    """The sheets of a program's Python."""
    metrics = QFontMetricsF(on_paper(code_font(CODE_POINTS), CODE_POINTS))
    letters = max(LEAST_LETTERS, int(room.width() / metrics.horizontalAdvance("0")) - 5)
    rows = max(1, int(room.height() / metrics.lineSpacing()))
    lines = list(_numbered(code, letters))
    return [
        CodeSheet(title, tuple(lines[first : first + rows])) for first in range(0, len(lines), rows)
    ]


def _numbered(code: str, letters: int) -> Iterator[tuple[str, str]]:
    for number, line in enumerate(code.rstrip("\n").split("\n"), start=1):
        yield str(number), line[:letters]
        rest = line[letters:]
        while rest:
            yield "", rest[:letters]
            rest = rest[letters:]


def _sheets(part: Part, room: QSizeF) -> Iterator[BlocksSheet]:
    bounds = part.bounds
    scale = max(min(USUAL_SCALE, room.width() / bounds.width), SMALLEST_SCALE)
    width, height = room.width() / scale, room.height() / scale
    columns = max(1, math.ceil(bounds.width / width - 1e-9))
    for top, bottom in cut([_chain_spans(part), _box_spans(part), _row_spans(part)], height):
        for column in range(columns):
            seen = QRectF(bounds.x + column * width, top, width, bottom - top)
            inside = tuple(chain for chain in part.chains if _rect(chain).intersects(seen))
            if inside:
                yield BlocksSheet(part.title, inside, seen, scale)


def _chain_spans(part: Part) -> list[Span]:
    return [(_rect(chain).top(), _rect(chain).bottom()) for chain in part.chains]


def _box_spans(part: Part) -> list[Span]:
    """Where the blocks of the stacks lie, each with all that is in it."""
    return [
        (chain.y + top, chain.y + top + box.height)
        for chain in part.chains
        for box, top in zip(chain.boxes, chain.ys, strict=False)  # one more: the end
    ]


def _row_spans(part: Part) -> list[Span]:
    """Where the blocks lie that hold no others below each other."""
    placed = (one for chain in part.chains for one in boxes_of(chain, part.bounds))
    return [(one.y, one.y + one.box.height) for one in placed if not one.box.mouths]


def _rect(chain: Chain) -> QRectF:
    left = chain.x - chain.width if chain.is_mirrored else chain.x
    return QRectF(left, chain.y, chain.width, chain.height + TAB)
