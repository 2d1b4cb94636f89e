"""Pictures of programs, for cards and previews."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFont, QPainter, QPixmap

from nep_studio.blocks.editor import Editor
from nep_studio.ui.canvas.background import paint_background
from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.camera import Camera
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.measures import Measures
from nep_studio.ui.canvas.page import PageLayout
from nep_studio.ui.canvas.texts import TextWidths
from nep_studio.ui.theme import Theme

MARGIN = 18.0
SMALLEST_SCALE = 0.56


def picture_of(
    editor: Editor, theme: Theme, font: QFont, size: QSize, ratio: float, *, is_mirrored: bool
) -> QPixmap:
    """The upper part of a program's first page, as much of it as can still be seen well."""
    font = QFont(font)
    font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    widths = TextWidths(font)
    measures = Measures(widths.line, widths, is_mirrored=is_mirrored)
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
