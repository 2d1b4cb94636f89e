"""Pictures of programs, for cards and previews."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QSize, QSizeF, Qt
from PySide6.QtGui import QFont, QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.procedures import CALL
from nep_studio.blocks.program import Procedure, Project
from nep_studio.ui.theme.colours import Theme

from .host import CanvasHost
from .layout.boxes import Chain, Measures, TextWidths
from .layout.index import Camera, Rect
from .layout.layout import Layout
from .layout.page import PageLayout, boxes_of
from .painting.layers import paint_background
from .painting.painter import BlockPainter

MARGIN = 18.0
SMALLEST_SCALE = 0.56


def picture_of(
    editor: Editor, theme: Theme, font: QFont, size: QSize, ratio: float, *, is_mirrored: bool
) -> QPixmap:
    """The upper part of a program's first page, as much of it as can still be seen well."""
    font = QFont(font)
    font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    widths = TextWidths(font)
    measures = Measures(widths.line, widths.__getitem__, is_mirrored=is_mirrored)
    layout = PageLayout(editor.project, editor.language, measures)
    layout.show("behaviour")
    pixmap = QPixmap(size * ratio)
    pixmap.setDevicePixelRatio(ratio)
    pixmap.fill(Qt.GlobalColor.transparent)
    seen = _camera(layout.index.bounds(), size, is_mirrored)  # of the blocks, not the notes
    shown = Rect(seen.x, seen.y, size.width() / seen.scale, size.height() / seen.scale)
    with QPainter(pixmap) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.scale(seen.scale, seen.scale)
        painter.translate(-seen.x, -seen.y)
        paint_background(painter, shown, seen, theme)
        blocks = BlockPainter(theme, editor.language, measures, font)
        blocks.paint(painter, layout.boxes(shown), max(seen.scale, 0.7))  # with all words
    return pixmap


def _camera(bounds: Rect | None, size: QSize, is_mirrored: bool) -> Camera:
    """Look at the whole width where that can be read, from the corner where reading begins."""
    if bounds is None:
        return Camera()
    wide = size.width() / (bounds.width + 2 * MARGIN)
    high = size.height() / (bounds.height + 2 * MARGIN)
    scale = min(max(min(wide, high), SMALLEST_SCALE), 0.8)
    left = bounds.x - MARGIN
    if is_mirrored:
        left = bounds.right + MARGIN - size.width() / scale
    return Camera(left, bounds.y - MARGIN, scale)


# A widget that shows blocks as they look on the canvas.

EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)


class BlockPicture(QWidget):
    """Shows the stacks of a clip, or nothing; too large ones are made smaller."""

    def __init__(self, canvas: CanvasHost, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self._chain: Chain | None = None
        self._painter: BlockPainter | None = None
        self.setMinimumHeight(round(canvas.look.measures.row_height * 1.6))

    def show_clip(self, clip: Clip | None) -> None:
        """Show the first stack of a clip."""
        self._chain = None
        if clip is not None and clip.stacks:
            canvas = self._canvas
            language = canvas.editor.language.of(clip.project)
            layout = Layout(clip.project, language, canvas.look.measures)
            self._chain = layout.chain(clip.roots[0])
            self._painter = BlockPainter(
                canvas.look.theme, language, canvas.look.measures, canvas.look.block_font
            )
        self.update()

    def show_call(self, procedure: Procedure | None) -> None:
        """Show the block that calls an own block which is not in the program yet."""
        if procedure is None:
            self.show_clip(None)
            return
        project = Project()
        AddProcedure(procedure, 0).apply(project)
        language = self._canvas.editor.language.of(project)
        clip = clip_of(language, CALL + procedure.id)
        AddProcedure(procedure, 0).apply(clip.project)
        self.show_clip(clip)

    @property
    def is_empty(self) -> bool:
        """Whether nothing is shown."""
        return self._chain is None

    def sizeHint(self) -> QSize:
        """As large as the blocks."""
        if self._chain is None:
            return QSize(100, self.minimumHeight())
        return QSize(round(self._chain.width) + 8, round(self._chain.height) + 12)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the blocks in the middle."""
        if self._chain is None or self._painter is None:
            return
        chain, tab = self._chain, self._canvas.look.measures.notch_depth
        room_x, room_y = max(1, self.width() - 8), max(1, self.height() - 4)
        scale = min(1.0, room_x / chain.width, room_y / (chain.height + tab))
        left = (self.width() - chain.width * scale) / 2
        corner = QPointF(left, (self.height() - (chain.height + tab) * scale) / 2)
        if chain.is_mirrored:
            corner.setX(left + chain.width * scale)
        with QPainter(self) as painter:
            painter.translate(corner)
            painter.scale(scale, scale)
            self._painter.paint(painter, boxes_of(chain, EVERYWHERE), scale)


# Pictures of blocks for the pages of the help, as sharp as the screen, in the theme in use.

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
        return Measures(widths.line, widths.__getitem__, is_mirrored=self.is_mirrored)


def arrange(project: Project, language: Language, measures: Measures) -> None:
    """Put the stacks of each page one below the other, as close as they can be read."""
    layout = Layout(project, language.of(project), measures)
    for stacks in project.pages.values():
        y = CORNER
        for stack in stacks:
            MoveStack(stack.id, CORNER, y).apply(project)
            y += layout.chain(stack.body).height + measures.hat + 2 * GAP * measures.unit


class HelpPicture:
    """All stacks of a project, one below the other, laid out to be painted anywhere."""

    def __init__(self, project: Project, language: Language, look: PictureLook) -> None:
        self._language, self._look, self._measures = language.of(project), look, look.measures
        layout = Layout(project, self._language, self._measures)
        stacks = [stack for page in project.pages.values() for stack in page]
        self._chains = [layout.chain(stack.body) for stack in stacks]
        measures, y, width = self._measures, 0.0, 1.0
        for chain in self._chains:  # each takes its room, with its tab
            chain.x, chain.y = 0.0, y
            y += chain.height + measures.notch_depth + GAP * measures.unit
            width = max(width, chain.width)
        margin = 2.0 * measures.unit
        self.size = QSizeF(width + 2 * margin, max(1.0, y - GAP * measures.unit) + 2 * margin)

    def paint(self, painter: QPainter) -> None:
        """Paint them with all their words, into ``size`` from the painter's origin on."""
        look, measures = self._look, self._measures
        margin = 2.0 * measures.unit
        left = self.size.width() - margin if measures.is_mirrored else margin
        painter.translate(QPointF(left, margin))
        blocks = BlockPainter(look.theme, self._language, measures, look.font)
        for chain in self._chains:
            blocks.paint(painter, boxes_of(chain, EVERYWHERE), 1.0)


def help_picture_of(project: Project, language: Language, look: PictureLook) -> QPixmap:
    """All stacks of a project, one below the other, no wider than there is room."""
    picture = HelpPicture(project, language, look)
    size = picture.size
    scale = min(look.scale, look.widest / size.width())
    pixmap = QPixmap((size * scale * look.ratio).toSize().expandedTo(QSize(1, 1)))
    pixmap.setDevicePixelRatio(look.ratio)
    pixmap.fill(Qt.GlobalColor.transparent)
    with QPainter(pixmap) as painter:
        painter.scale(scale, scale)
        picture.paint(painter)
    return pixmap
