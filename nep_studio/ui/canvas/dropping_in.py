"""A view onto which blocks and project files can be dropped from other windows."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDragMoveEvent, QDropEvent, QFont
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.ui.theme import Theme

from .gestures.external_drag import carry_in, clip_in, project_files
from .scrolling import ScrollingView

if TYPE_CHECKING:
    from .canvas import Canvas


class DropTarget(ScrollingView):
    """Blocks from outside are carried like those of the page; a file is only told of."""

    file_dropped = Signal(str)

    def __init__(
        self,
        editor: Editor,
        theme: Theme,
        *,
        font: QFont | None = None,
        is_mirrored: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(editor, theme, font=font, is_mirrored=is_mirrored, parent=parent)
        self.viewport().setAcceptDrops(True)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take project files, and the text of blocks."""
        canvas = cast("Canvas", self)
        if project_files(event.mimeData()):
            event.acceptProposedAction()
            return
        clip = clip_in(canvas, event.mimeData())
        if clip is not None:
            carry_in(canvas, clip, self.viewport().mapToGlobal(event.position().toPoint()))
            event.setDropAction(Qt.DropAction.CopyAction)
            event.accept()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Bring the blocks along."""
        cast("Canvas", self).pointing.move_to(event.position())
        event.accept()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """The blocks have left again."""
        cast("Canvas", self).cancel_gesture()

    def dropEvent(self, event: QDropEvent) -> None:
        """Put the blocks where they are, or tell which file was dropped."""
        files = project_files(event.mimeData())
        for path in files:
            self.file_dropped.emit(path)
        if not files:
            cast("Canvas", self).pointing.release_at(event.position())
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()
