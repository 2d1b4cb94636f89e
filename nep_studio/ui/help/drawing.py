"""Pictures of blocks for the pages of the help, as sharp as the screen, in the theme in use."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QSizeF, Qt
from PySide6.QtGui import QFont, QPainter, QPixmap

from nep_studio.blocks.edits import MoveStack
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.layout import Layout
from nep_studio.ui.canvas.measures import Measures
from nep_studio.ui.canvas.page import boxes_of
from nep_studio.ui.canvas.texts import TextWidths
from nep_studio.ui.theme import Theme

EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)
GAP = 18.0
"""Between stacks, in units of the measures."""
CORNER = 40.0


@dataclass(frozen=True)
class PictureLook:
    """How pictures are drawn: theme, font of the blocks, side, pixels of the screen for each."""

    theme: Theme
    font: QFont
    is_mirrored: bool
    ratio: float
    scale: float
    widest: float

    @property
    def measures(self) -> Measures:
        """The measures of the blocks."""
        font = QFont(self.font)
        font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
        widths = TextWidths(font)
        return Measures(widths.line, widths, is_mirrored=self.is_mirrored)


def arrange(project: Project, language: Language, measures: Measures) -> None:
    """Put the stacks of each page one below the other, as close as they can be read."""
    layout = Layout(project, language.of(project), measures)
    for stacks in project.pages.values():
        y = CORNER
        for stack in stacks:
            MoveStack(stack.id, CORNER, y).apply(project)
            y += layout.chain(stack.body).height + measures.hat + 2 * GAP * measures.unit


class BlockPicture:
    """All stacks of a project, one below the other, laid out to be painted anywhere."""

    def __init__(self, project: Project, language: Language, look: PictureLook) -> None:
        self._language, self._look, self._measures = language.of(project), look, look.measures
        layout = Layout(project, self._language, self._measures)
        stacks = [stack for page in project.pages.values() for stack in page]
        self._chains = [layout.chain(stack.body) for stack in stacks]
        self.size = _place(self._chains, self._measures)

    def paint(self, painter: QPainter) -> None:
        """Paint them with all their words, into ``size`` from the painter's origin on."""
        look, measures = self._look, self._measures
        painter.translate(_origin(self.size, measures))
        blocks = BlockPainter(look.theme, self._language, measures, look.font)
        for chain in self._chains:
            blocks.paint(painter, boxes_of(chain, EVERYWHERE), 1.0)


def picture_of(project: Project, language: Language, look: PictureLook) -> QPixmap:
    """All stacks of a project, one below the other, no wider than there is room."""
    picture = BlockPicture(project, language, look)
    size = picture.size
    scale = min(look.scale, look.widest / size.width())
    pixmap = QPixmap((size * scale * look.ratio).toSize().expandedTo(_SMALLEST))
    pixmap.setDevicePixelRatio(look.ratio)
    pixmap.fill(Qt.GlobalColor.transparent)
    with QPainter(pixmap) as painter:
        painter.scale(scale, scale)
        picture.paint(painter)
    return pixmap


_SMALLEST = QSizeF(1, 1).toSize()


def _place(chains: list[Chain], measures: Measures) -> QSizeF:
    """Put chains one below the other; gives the room that they take, with their tabs."""
    y, width = 0.0, 1.0
    for chain in chains:
        chain.x, chain.y = 0.0, y
        y += chain.height + measures.notch_depth + GAP * measures.unit
        width = max(width, chain.width)
    margin = 2.0 * measures.unit
    return QSizeF(width + 2 * margin, max(1.0, y - GAP * measures.unit) + 2 * margin)


def _origin(size: QSizeF, measures: Measures) -> QPointF:
    margin = 2.0 * measures.unit
    return QPointF(size.width() - margin if measures.is_mirrored else margin, margin)
