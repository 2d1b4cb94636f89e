"""Pictures of programs: PNG, SVG and PDF files, the clipboard, and the dialog that asks which."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast

from PySide6.QtCore import (
    QBuffer,
    QIODevice,
    QMarginsF,
    QRectF,
    QSize,
    QSizeF,
    Qt,
    Signal,
)
from PySide6.QtGui import QFont, QGuiApplication, QImage, QPageSize, QPainter, QPdfWriter
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QPushButton,
    QWidget,
)

from faults.files import whole_file
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.operations.copying import copy, to_text
from nep_studio.blocks.operations.selection import members, runs
from nep_studio.project import picture_files
from nep_studio.ui.canvas.fields.field_edit import ReasonBubble
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import PageLayout, boxes_of
from nep_studio.ui.canvas.painting.painter import BlockPainter
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.pages_bar import page_title

# What is in a picture: the stacks of a page, of all pages, or the selected blocks.

What = Literal["page", "selection", "pages"]

MARGIN = 24.0
"""The room around the blocks, in canvas units."""


@dataclass
class Part:
    """Stacks that lie on one page, with a title above them where there are several pages."""

    chains: list[Chain]
    bounds: Rect
    title: str = ""


@dataclass
class Scene:
    """Parts below each other; all sizes are in canvas units."""

    parts: list[Part] = field(default_factory=list)
    title_height: float = 0.0
    margin: float = MARGIN

    @property
    def width(self) -> float:
        """How wide all of it is."""
        return max((part.bounds.width for part in self.parts), default=0.0) + 2 * self.margin

    @property
    def height(self) -> float:
        """How high all of it is."""
        inside = sum(self._height_of(part) for part in self.parts)
        return inside + self.margin * (len(self.parts) + 1)

    def _height_of(self, part: Part) -> float:
        return part.bounds.height + (self.title_height if part.title else 0.0)


def scene_of(canvas: CanvasHost, what: What, margin: float = MARGIN) -> Scene:
    """What of a canvas is asked for; a scene without parts when there are no blocks."""
    scene = Scene(title_height=canvas.look.measures.line * 2.2, margin=margin)
    if what == "selection":
        chains = _selected(canvas)
        scene.parts = [Part(chains, _bounds(chains))] if chains else []
        return scene
    project = canvas.editor.project
    pages = list(project.pages) if what == "pages" else [canvas.page_layout.page]
    for page in pages:
        layout = PageLayout(project, canvas.editor.language, canvas.look.measures)
        layout.show(page)
        chains = list(layout.chains.values())
        if chains:
            title = page_title(project, page) if what == "pages" else ""
            scene.parts.append(Part(chains, _bounds(chains), title))
    return scene


def paint_scene(painter: QPainter, scene: Scene, canvas: CanvasHost, scale: float) -> None:
    """Paint it from (0, 0) on; the painter counts in canvas units."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    blocks = BlockPainter(
        canvas.look.theme, canvas.editor.language, canvas.look.measures, canvas.look.block_font
    )
    y = scene.margin
    for part in scene.parts:
        if part.title:
            font = QFont(canvas.look.block_font)
            font.setPointSizeF(font.pointSizeF() * 1.3)
            font.setBold(True)
            painter.setFont(font)
            painter.setPen(canvas.look.theme.colour("text"))
            row = QRectF(scene.margin, y, scene.width - 2 * scene.margin, scene.title_height)
            painter.drawText(row, part.title)
            y += scene.title_height
        left = scene.margin
        if canvas.look.measures.is_mirrored:
            left = scene.width - scene.margin - part.bounds.width
        painter.translate(left - part.bounds.x, y - part.bounds.y)
        for chain in part.chains:
            blocks.paint(painter, boxes_of(chain, part.bounds), max(scale, 1.0))
        painter.translate(part.bounds.x - left, part.bounds.y - y)
        y += part.bounds.height + scene.margin


def _selected(canvas: CanvasHost) -> list[Chain]:
    """The selected blocks, where they lie on the page."""
    project = canvas.editor.project
    layout = Layout(project, canvas.editor.language, canvas.look.measures)
    chains = []
    for run in runs(project, canvas.selection.ids):
        placed = canvas.page_layout.placed(run.first)
        if placed is None:
            continue
        chain = layout.chain(members(project, run), shown=True)
        side = placed.box.width if placed.box.is_mirrored else 0.0
        chain.x, chain.y = placed.x + side, placed.y
        chains.append(chain)
    return chains


def _bounds(chains: list[Chain]) -> Rect:
    """The rectangle around chains, with the tabs below them."""
    rects = []
    for chain in chains:
        left = chain.x - chain.width if chain.is_mirrored else chain.x
        rects.append(Rect(left, chain.y, chain.width, chain.height + 8.0))
    whole = rects[0]
    for rect in rects[1:]:
        whole = whole.united(rect)
    return whole


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


def write_picture(canvas: CanvasHost, path: Path, kind: Format, options: PictureOptions) -> None:
    """Write a picture into a file; raises EditRefused when there is nothing, or no room.

    A file that is there is replaced only once the new one is whole.
    """
    made = {"png": png_of, "svg": svg_of, "pdf": pdf_of}[kind](canvas, options)
    try:
        with whole_file(path) as file:
            file.write(made)
    except OSError as error:
        reason = tr((error.strerror or str(error)).lower())
        sentence = tr("The picture cannot be written: {reason}.", reason=reason)
        raise EditRefused(sentence, checklist=(tr("Choose another folder."),)) from error


def copy_picture(canvas: CanvasHost, options: PictureOptions) -> None:
    """Put a picture on the clipboard; raises EditRefused when there is nothing to show."""
    QGuiApplication.clipboard().setImage(image_of(canvas, options))


def png_of(canvas: CanvasHost, options: PictureOptions) -> bytes:
    """A PNG file, with the program in it if it is asked for."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image_of(canvas, options).save(buffer, "PNG")  # type: ignore[call-overload]  # takes a device
    png = bytes(buffer.data().data())
    if not options.has_program:
        return png
    return picture_files.png_with_program(png, program_of(canvas, options))


def svg_of(canvas: CanvasHost, options: PictureOptions) -> bytes:
    """An SVG file, its words as text, with the program in it if it is asked for."""
    scene = _scene(canvas, options)
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    generator = QSvgGenerator(QSvgGenerator.SvgVersion.Svg11)
    generator.setOutputDevice(buffer)
    generator.setTitle(canvas.editor.project.name)
    generator.setResolution(96)
    generator.setSize(QSize(round(scene.width), round(scene.height)))
    generator.setViewBox(QRectF(0, 0, scene.width, scene.height))
    with QPainter(generator) as painter:
        _paint(painter, scene, canvas, options, 1.0)
    look = canvas.look

    def width_of(words: str, weight: int) -> float | None:
        is_of_blocks = weight == int(look.block_font.weight())
        return look.measures.text_width(words) if is_of_blocks else None

    svg = picture_files.fitted(bytes(buffer.data().data()), width_of)
    if not options.has_program:
        return svg
    return picture_files.svg_with_program(svg, program_of(canvas, options))


def pdf_of(canvas: CanvasHost, options: PictureOptions) -> bytes:
    """A PDF file with one page as large as the blocks, to be printed."""
    scene = _scene(canvas, options)
    buffer = QBuffer()
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
    return bytes(buffer.data().data())


def image_of(canvas: CanvasHost, options: PictureOptions) -> QImage:
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


def program_of(canvas: CanvasHost, options: PictureOptions) -> bytes:
    """The text of the project that is shown, or of the selected blocks."""
    editor = canvas.editor
    if options.what == "selection":
        ids = canvas.selection.ids
        return to_text(
            copy(editor.project, editor.language, ids, canvas.page_layout.corners(ids))
        ).encode()
    return to_bytes(editor.project)


def _scene(canvas: CanvasHost, options: PictureOptions) -> Scene:
    scene = scene_of(canvas, options.what, options.margin)
    if not scene.parts:
        words = tr("There are no blocks yet, so that there is nothing to show.")
        if options.what == "selection":
            words = tr("No blocks are selected, so that there is nothing to show.")
        raise EditRefused(words, checklist=(tr("Choose something else to show."),))
    return scene


def _paint(
    painter: QPainter, scene: Scene, canvas: CanvasHost, options: PictureOptions, scale: float
) -> None:
    if not options.is_transparent:
        whole = QRectF(0, 0, scene.width, scene.height)
        painter.fillRect(whole, canvas.look.theme.colour("canvas"))
    paint_scene(painter, scene, canvas, scale)


# The dialog that saves or copies a picture of a program.


class PictureDialog(QDialog):
    """Asks what is to be in the picture and how large it is.

    ``folder`` and ``name`` are where the file dialog begins. ``done_well`` tells in words what
    became of the picture.
    """

    done_well = Signal(str)

    def __init__(
        self, canvas: CanvasHost, folder: Path, name: str, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent or canvas.area.window())
        self._canvas, self._folder, self._name = canvas, folder, name
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Picture of the blocks"))
        self.what = QComboBox(self)
        self.what.addItem(tr("This page"), "page")
        self.what.addItem(tr("All pages"), "pages")
        if canvas.selection.ids:
            self.what.addItem(tr("The selected blocks"), "selection")
        self.format = QComboBox(self)
        for kind, label in (
            ("png", tr("PNG, for documents and web pages")),
            ("svg", tr("SVG, sharp at any size")),
            ("pdf", tr("PDF, to print")),
        ):
            self.format.addItem(label, kind)
        self.scale = QDoubleSpinBox(self, singleStep=0.5, decimals=1)
        self.scale.setRange(*SCALES)
        self.scale.setValue(2.0)
        self.transparent = QCheckBox(tr("Nothing behind the blocks (transparent)"), self)
        self.program = QCheckBox(tr("With the program inside: the picture can be opened"), self)
        self.program.setChecked(True)
        self.reason = ReasonBubble(canvas.look.theme, self)
        self.format.currentIndexChanged.connect(self._on_format_changed)
        self._arrange()

    @property
    def options(self) -> PictureOptions:
        """What was chosen."""
        return PictureOptions(
            cast(What, self.what.currentData()),
            self.scale.value(),
            self.transparent.isChecked(),
            has_program=self.program.isChecked(),
        )

    @property
    def kind(self) -> Format:
        """The kind of file that was chosen."""
        return cast(Format, self.format.currentData())

    def save(self, path: Path) -> bool:
        """Write the picture; says why not when that fails."""
        if not path.suffix:
            path = path.with_suffix(f".{self.kind}")
        try:
            write_picture(self._canvas, path, self.kind, self.options)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            return False
        self.done_well.emit(tr("Saved “{name}”.", name=path.name))
        return True

    def _arrange(self) -> None:
        form = QFormLayout()
        form.addRow(tr("What"), self.what)
        form.addRow(tr("File"), self.format)
        form.addRow(tr("Size"), self.scale)
        form.addRow("", self.transparent)
        form.addRow("", self.program)
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Save | standard.Cancel)
        buttons.button(standard.Save).setText(tr("Save…"))
        buttons.button(standard.Cancel).setText(tr("Cancel"))
        copying = QPushButton(tr("Copy picture"), autoDefault=False)
        copying.clicked.connect(self._on_copied)
        buttons.addButton(copying, QDialogButtonBox.ButtonRole.ActionRole)
        buttons.accepted.connect(self._on_save)
        buttons.rejected.connect(self.reject)
        in_column(form, self.reason, 1, buttons, of=self)

    def _on_format_changed(self) -> None:
        self.scale.setEnabled(self.kind == "png")
        self.program.setEnabled(self.kind != "pdf")

    def _on_save(self) -> None:
        start = str(self._folder / f"{self._name}.{self.kind}")
        name, _filter = QFileDialog.getSaveFileName(
            self, tr("Save the picture"), start, f"{self.kind.upper()} (*.{self.kind})"
        )
        if name and self.save(Path(name)):
            self.accept()

    def _on_copied(self) -> None:
        try:
            copy_picture(self._canvas, self.options)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
        else:
            self.done_well.emit(tr("The picture is copied. Paste it where you like."))
            self.accept()
