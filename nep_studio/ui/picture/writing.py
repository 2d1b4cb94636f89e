"""Write pictures of programs: PNG, SVG and PDF files, and the clipboard."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from PySide6.QtCore import QBuffer, QByteArray, QIODevice, QMarginsF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QGuiApplication, QImage, QPageSize, QPainter, QPdfWriter
from PySide6.QtSvg import QSvgGenerator

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.copying import copy, to_text
from nep_studio.blocks.writing import to_bytes
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.words import tr

from . import png_chunk, svg_metadata
from .scene import MARGIN, Scene, What, paint_scene, scene_of
from .svg_text import fitted

Format = Literal["png", "svg", "pdf"]

LARGEST_SIDE = 30_000
LARGEST_PIXELS = 80_000_000
"""A larger picture is made with less detail: few programs could open it."""

SCALES = (1.0, 4.0)
POINTS_AN_INCH = 72.0


@dataclass(frozen=True)
class PictureOptions:
    """What is in a picture and how; ``scale`` is in pixels for each canvas unit."""

    what: What = "page"
    scale: float = 2.0
    is_transparent: bool = False
    margin: float = MARGIN
    has_program: bool = True


def write_picture(canvas: Canvas, path: Path, kind: Format, options: PictureOptions) -> None:
    """Write a picture into a file; raises EditRefused when there is nothing, or no room.

    A file that is there is replaced only once the new one is whole.
    """
    made = {"png": png_of, "svg": svg_of, "pdf": pdf_of}[kind](canvas, options)
    beside = path.with_name(f".{path.name}.part")
    try:
        beside.write_bytes(made)
        beside.replace(path)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise EditRefused(
            tr(
                "The picture cannot be written: {reason}.",
                reason=tr((error.strerror or str(error)).lower()),
            ),
            checklist=(tr("Choose another folder."),),
        ) from error


def copy_picture(canvas: Canvas, options: PictureOptions) -> None:
    """Put a picture on the clipboard; raises EditRefused when there is nothing to show."""
    QGuiApplication.clipboard().setImage(image_of(canvas, options))


def png_of(canvas: Canvas, options: PictureOptions) -> bytes:
    """A PNG file, with the program in it if it is asked for."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image_of(canvas, options).save(buffer, "PNG")  # type: ignore[call-overload]  # takes a device
    png = bytes(buffer.data().data())
    return png_chunk.with_program(png, program_of(canvas, options)) if options.has_program else png


def svg_of(canvas: Canvas, options: PictureOptions) -> bytes:
    """An SVG file, its words as text, with the program in it if it is asked for."""
    scene = _scene(canvas, options)
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    generator = QSvgGenerator(QSvgGenerator.SvgVersion.Svg11)
    generator.setOutputDevice(buffer)
    generator.setTitle(canvas.editor.project.name)
    generator.setResolution(96)
    size = QSize(round(scene.width), round(scene.height))
    generator.setSize(size)
    generator.setViewBox(QRectF(0, 0, scene.width, scene.height))
    with QPainter(generator) as painter:
        _paint(painter, scene, canvas, options, 1.0)
    svg = fitted(bytes(buffer.data().data()), canvas)
    if not options.has_program:
        return svg
    return svg_metadata.with_program(svg, program_of(canvas, options))


def pdf_of(canvas: Canvas, options: PictureOptions) -> bytes:
    """A PDF file with one page as large as the blocks, to be printed."""
    scene = _scene(canvas, options)
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    writer = QPdfWriter(buffer)
    writer.setTitle(canvas.editor.project.name)
    # as many dots as the screen, for which the font of the blocks is made: else its words are not
    # as large as their blocks
    dots_per_inch = QGuiApplication.primaryScreen().logicalDotsPerInchY()
    writer.setResolution(round(dots_per_inch))
    points = 0.75  # of a canvas unit, which is a pixel of 96 an inch
    size = QSizeF(scene.width * points, scene.height * points)
    writer.setPageSize(
        QPageSize(size, QPageSize.Unit.Point, "", QPageSize.SizeMatchPolicy.ExactMatch)
    )
    writer.setPageMargins(QMarginsF(0, 0, 0, 0))
    with QPainter(writer) as painter:
        scale = writer.resolution() / POINTS_AN_INCH * points
        painter.scale(scale, scale)
        _paint(painter, scene, canvas, options, 1.0)
    buffer.close()
    return bytes(data.data())


def image_of(canvas: Canvas, options: PictureOptions) -> QImage:
    """The picture; raises EditRefused when there is nothing to show."""
    scene = _scene(canvas, options)
    scale = fitting_scale(scene, options.scale)
    width, height = round(scene.width * scale), round(scene.height * scale)
    image = QImage(width, height, QImage.Format.Format_ARGB32_Premultiplied)
    if image.isNull():
        raise EditRefused(
            tr("The picture is too large for the memory of this computer."),
            checklist=(tr("Show less, or make the picture smaller."),),
        )
    image.fill(Qt.GlobalColor.transparent)
    with QPainter(image) as painter:
        painter.scale(scale, scale)
        _paint(painter, scene, canvas, options, scale)
    return image


def fitting_scale(scene: Scene, wanted: float) -> float:
    """The scale that is wanted, or the largest one that makes no giant picture."""
    side = LARGEST_SIDE / max(scene.width, scene.height)
    area = math.sqrt(LARGEST_PIXELS / (scene.width * scene.height))
    return min(wanted, side, area)


def program_of(canvas: Canvas, options: PictureOptions) -> bytes:
    """The text of the project that is shown, or of the selected blocks."""
    editor = canvas.editor
    if options.what == "selection":
        ids = canvas.selection.ids
        return to_text(copy(editor.project, editor.language, ids, canvas.corners(ids))).encode()
    return to_bytes(editor.project)


def _scene(canvas: Canvas, options: PictureOptions) -> Scene:
    scene = scene_of(canvas, options.what, options.margin)
    if not scene.parts:
        words = (
            tr("No blocks are selected, so that there is nothing to show.")
            if options.what == "selection"
            else tr("There are no blocks yet, so that there is nothing to show.")
        )
        raise EditRefused(words, checklist=(tr("Choose something else to show."),))
    return scene


def _paint(
    painter: QPainter, scene: Scene, canvas: Canvas, options: PictureOptions, scale: float
) -> None:
    if not options.is_transparent:
        whole = QRectF(0, 0, scene.width, scene.height)
        painter.fillRect(whole, canvas.theme.colour("canvas"))
    paint_scene(painter, scene, canvas, scale)
