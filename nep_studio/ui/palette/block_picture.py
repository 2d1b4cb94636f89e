"""A widget that shows blocks as they look on the canvas."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QSize
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.edits import AddProcedure
from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.procedures import CALL
from nep_studio.blocks.program import Procedure, Project
from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.layout import Layout
from nep_studio.ui.canvas.page import boxes_of

EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)


class BlockPicture(QWidget):
    """Shows the stacks of a clip, or nothing; too large ones are made smaller."""

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self._chain: Chain | None = None
        self._painter: BlockPainter | None = None
        self.setMinimumHeight(round(canvas.measures.row_height * 1.6))

    def show_clip(self, clip: Clip | None) -> None:
        """Show the first stack of a clip."""
        self._chain = None
        if clip is not None and clip.stacks:
            canvas = self._canvas
            language = canvas.editor.language.of(clip.project)
            layout = Layout(clip.project, language, canvas.measures)
            self._chain = layout.chain(clip.roots[0])
            self._painter = BlockPainter(canvas.theme, language, canvas.measures, canvas.block_font)
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
        chain, tab = self._chain, self._canvas.measures.notch_depth
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
