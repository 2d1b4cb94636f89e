"""The five examples in every look and language, drawn on sheets to be looked at."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from image_window import Stage, quiet
from PySide6.QtCore import QPoint, QSize
from PySide6.QtGui import QColor, QImage, QPainter

from nep_studio import paths
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import themes
from nep_studio.ui.words import PSEUDO

LANGUAGES = ("en", "ja", PSEUDO)
LARGEST = QSize(760, 1800)
"""How much of an example is drawn, in units of the screen."""

EDGE = 24


def make_sheets(stage: Stage, folder: Path, scale: str, tell: Callable[[str], None]) -> None:
    """Draw one sheet for each language and theme; ``scale`` goes into its name."""
    folder.mkdir(parents=True, exist_ok=True)
    for language in LANGUAGES:
        for theme in themes():
            name = f"{language}-{theme}-{scale}.png"
            _beside(_examples(stage, language, theme)).save(str(folder / name))
            tell(name)


def _examples(stage: Stage, language: str, theme: str) -> list[QImage]:
    """The behaviour page of each example, as large as it is."""
    pictures = []
    for path in sorted(paths.examples().glob("*.nep")):
        with stage.window(theme=theme, language=language, example=path.stem) as window:
            pictures.append(_whole_page(window.workbench.canvas))
    return pictures


def _whole_page(canvas: Canvas) -> QImage:
    """All blocks of a page, drawn by a view that is large enough for them."""
    view = Canvas(
        canvas.editor,
        canvas.look.theme,
        font=canvas.look.block_font,
        is_mirrored=canvas.look.measures.is_mirrored,
    )
    bounds = view.page_layout.bounds()
    assert bounds is not None
    size = QSize(round(bounds.width) + 2 * EDGE, round(bounds.height) + 2 * EDGE)
    view.resize(size.boundedTo(LARGEST))
    view.show()
    view.sight.move_camera(bounds.x - EDGE, bounds.y - EDGE)
    quiet(120)
    image = view.viewport().grab().toImage()
    image.setDevicePixelRatio(1.0)
    view.hide()
    canvas.editor.history.unlisten(view._on_changes)
    view.deleteLater()
    return image


def _beside(pictures: list[QImage]) -> QImage:
    """Pictures beside each other."""
    width = sum(picture.width() for picture in pictures)
    height = max(picture.height() for picture in pictures)
    sheet = QImage(width, height, QImage.Format.Format_RGB32)
    sheet.fill(QColor("#808080"))
    with QPainter(sheet) as painter:
        left = 0
        for picture in pictures:
            painter.drawImage(QPoint(left, 0), picture)
            left += picture.width()
    return sheet
