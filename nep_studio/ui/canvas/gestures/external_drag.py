"""New blocks that are dragged in from elsewhere: from the palette, or from another window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QMimeData, QObject, QPoint, QPointF
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.errors import ProjectFileError
from nep_studio.blocks.operations.copying import Clip, from_text

from .cargo import NewBlocks
from .drag_blocks import DragBlocks
from .gesture import TOUCH_DRAG_PX

if TYPE_CHECKING:
    from ..canvas import Canvas

PROJECT_SUFFIX = ".nep"


class ExternalDrag(QObject):
    """Watches the mouse of the widget where the press was, until its button comes up.

    Before the mouse has moved far enough the widget has its press for itself, as for a click.
    """

    def __init__(self, canvas: Canvas, clip: Clip, pressed: QPoint, source: QWidget) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._clip = clip
        self._pressed = pressed
        self._gesture: DragBlocks | None = None
        source.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the moves and the release once blocks are carried."""
        if isinstance(event, QMouseEvent):
            if event.type() == QEvent.Type.MouseMove:
                return self._move(event.globalPosition().toPoint())
            if event.type() == QEvent.Type.MouseButtonRelease:
                watched.removeEventFilter(self)
                self.deleteLater()
                return self._release(event.globalPosition().toPoint())
        return False

    def _move(self, place: QPoint) -> bool:
        way = place - self._pressed
        if self._gesture is None:
            if way.manhattanLength() < TOUCH_DRAG_PX:
                return False
            self._gesture = carry_in(self._canvas, self._clip, self._pressed)
        if self._canvas.gesture is self._gesture:
            self._canvas.pointing.move_to(_in_view(self._canvas, place))
        return True

    def _release(self, place: QPoint) -> bool:
        if self._gesture is not None and self._canvas.gesture is self._gesture:
            self._canvas.pointing.release_at(_in_view(self._canvas, place))
        return self._gesture is not None


def carry_in(canvas: Canvas, clip: Clip, place: QPoint) -> DragBlocks:
    """Begin to carry new blocks, held by their first row at a place of the screen."""
    view = _in_view(canvas, place)
    page, grip = canvas.to_page(view), canvas.measures.row_height / 2
    cargo = NewBlocks(canvas, clip, (page.x(), page.y()), hold=(2 * grip, grip))
    gesture = DragBlocks(canvas, cargo, page)
    canvas.setFocus()
    canvas.begin(gesture)
    canvas.pointing.take_over(view)
    return gesture


def clip_in(canvas: Canvas, data: QMimeData) -> Clip | None:
    """The blocks in what is dragged over the canvas, or None when there are none."""
    text = data.text() if data.hasText() and not data.hasUrls() else ""
    if not text.lstrip().startswith("{"):
        return None
    try:
        clip = from_text(text, canvas.editor.language)
    except ProjectFileError:
        return None
    return clip if clip.stacks else None


def project_files(data: QMimeData) -> list[str]:
    """The project files in what is dragged over the canvas."""
    paths = [url.toLocalFile() for url in data.urls() if url.isLocalFile()]
    return [path for path in paths if path.lower().endswith(PROJECT_SUFFIX)]


def _in_view(canvas: Canvas, place: QPoint) -> QPointF:
    return QPointF(canvas.viewport().mapFromGlobal(place))
