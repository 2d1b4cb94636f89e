"""A diagram as a picture: a file that is sharp at any size, or one of pixels, or the clipboard."""

from __future__ import annotations

import math

from PySide6.QtCore import QBuffer, QIODevice, QRectF, QSize, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QImage, QPainter
from PySide6.QtSvg import QSvgGenerator

from nep_studio.project.picture_files import fitted
from nep_studio.ui.theme.colours import Theme

from .painting import FALLBACK, DiagramPainter, Marks
from .shapes import Measures, Shapes

SCALE = 2.0
"""A picture of pixels is so much larger than on the screen, to be printed well."""
LARGEST_PIXELS = 60e6
MARGIN = 1.0
"""What is left free around it, in lines of text."""


def png_of(shapes: Shapes, theme: Theme, font: QFont) -> bytes:
    """A PNG file."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image_of(shapes, theme, font).save(buffer, "PNG")  # type: ignore[call-overload]  # a device
    return bytes(buffer.data().data())


def image_of(shapes: Shapes, theme: Theme, font: QFont) -> QImage:
    """The diagram in pixels; one that would be a giant is smaller."""
    measures = Measures(font)
    bounds = _bounds(shapes, measures)
    area = bounds.width() * bounds.height()
    scale = min(SCALE, math.sqrt(LARGEST_PIXELS / area))
    size = QSize(math.ceil(bounds.width() * scale), math.ceil(bounds.height() * scale))
    image = QImage(size, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    with QPainter(image) as painter:
        painter.scale(scale, scale)
        _draw(painter, shapes, theme, measures, bounds)
    return image


def svg_of(shapes: Shapes, theme: Theme, font: QFont, title: str) -> bytes:
    """An SVG file, its words as text."""
    measures = Measures(font)
    bounds = _bounds(shapes, measures)
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    generator = QSvgGenerator(QSvgGenerator.SvgVersion.Svg11)
    generator.setOutputDevice(buffer)
    generator.setTitle(title)
    generator.setResolution(96)
    generator.setSize(bounds.size().toSize())
    generator.setViewBox(QRectF(0, 0, bounds.width(), bounds.height()))
    with QPainter(generator) as painter:
        _draw(painter, shapes, theme, measures, bounds)
    fonts = {int(font.weight()): font for font in (measures.small, measures.bold)}

    def width_of(words: str, weight: int) -> float | None:
        is_sign = words == FALLBACK  # it is larger
        known = None if is_sign else fonts.get(weight)
        return None if known is None else QFontMetricsF(known).horizontalAdvance(words)

    return fitted(bytes(buffer.data().data()), width_of)


def _bounds(shapes: Shapes, measures: Measures) -> QRectF:
    edge = MARGIN * measures.line
    return shapes.bounds.adjusted(-edge, -edge, edge, edge)


def _draw(
    painter: QPainter, shapes: Shapes, theme: Theme, measures: Measures, bounds: QRectF
) -> None:
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillRect(QRectF(0, 0, bounds.width(), bounds.height()), theme.colour("canvas"))
    painter.translate(-bounds.topLeft())
    DiagramPainter(painter, theme, measures).draw(shapes, Marks(), bounds)
