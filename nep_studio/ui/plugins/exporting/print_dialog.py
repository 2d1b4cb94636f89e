"""Prints programs: sheets of blocks and Python, and the dialog with a preview of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from PySide6.QtCore import QDate, QLocale, QRectF, QSizeF, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontInfo, QFontMetricsF, QPageLayout, QPainter, QPen
from PySide6.QtPrintSupport import QPageSetupDialog, QPrintDialog, QPrinter, QPrintPreviewWidget
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFormLayout,
    QPushButton,
    QToolButton,
    QWidget,
)

from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import boxes_of
from nep_studio.ui.canvas.painting.painter import BlockPainter
from nep_studio.ui.theme.colours import LIGHT, Theme, load_theme
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import code_font, text_font
from nep_studio.ui.widgets.forms import fit_on_screen
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import is_right_to_left, tr
from nep_studio.ui.workbench.pages_bar import page_title

from .picture import Part, What, scene_of

# Where a long drawing is cut into pages: between its pieces, never through one that fits.

Span = tuple[float, float]
"""From where to where something lies, from above."""


def cut(levels: Sequence[Iterable[Span]], height: float) -> list[Span]:
    """Cut a drawing into pieces of at most ``height``, from above, without what is empty between.

    ``levels`` are where its things lie, then where their parts do, and so on. A piece ends where
    no thing is; else where no part is; and where even the finest parts leave no place, anywhere.
    """
    sorted_levels = [sorted(level) for level in levels]
    whole = sorted_levels[0] if sorted_levels else []
    if not whole or height <= 0:
        return []
    start, end = whole[0][0], max(bottom for _, bottom in whole)
    pieces = []
    while start < end:
        stop = end if start + height >= end else _stop(sorted_levels, start, height)
        pieces.append((start, stop))
        start = min((max(top, stop) for top, bottom in whole if bottom > stop), default=end)
    return pieces


def _stop(levels: Sequence[Sequence[Span]], start: float, height: float) -> float:
    """The lowest place on the page that is inside nothing of the coarsest level that has one."""
    limit = start + height
    for spans in levels:
        edges = sorted({edge for span in spans for edge in span if start < edge <= limit})
        free = [edge for edge in edges if not any(top < edge < bottom for top, bottom in spans)]
        if free:
            return free[-1]
    return limit


USUAL_SCALE = 0.75
"""Points of paper for each canvas unit: as large as on a screen of 96 dots an inch."""

SMALLEST_SCALE = 0.42
"""Smaller words cannot be read on paper: wider pages are cut into columns."""

TAB = 8.0
"""How far the tab of the last block reaches below it, in canvas units."""

CODE_POINTS = 9.0
LEAST_LETTERS = 20


@dataclass(frozen=True)
class PrintOptions:
    """What is printed."""

    what: What = "pages"
    has_code: bool = False


@dataclass(frozen=True)
class BlocksSheet:
    """A sheet with blocks: the part of the page that is on it, in canvas units."""

    title: str
    chains: tuple[Chain, ...]
    seen: QRectF
    scale: float


@dataclass(frozen=True)
class CodeSheet:
    """A sheet with lines of Python, each with its number, or none where a line goes on."""

    title: str
    lines: tuple[tuple[str, str], ...]


Sheet = BlocksSheet | CodeSheet


def on_paper(font: QFont, size: float) -> QFont:
    """A font for a painter that counts in points, or in canvas units; ``size`` is in those.

    A font in points would be enlarged twice: by the dots of the printer, and by the painter.
    """
    made = QFont(font)
    made.setPixelSize(round(size))
    made.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    return made


def block_sheets(canvas: CanvasHost, what: What, room: QSizeF) -> list[Sheet]:
    """The sheets of the blocks; ``room`` is what is free on one, in points."""
    scene = scene_of(canvas, what)
    return [sheet for part in scene.parts for sheet in _sheets(part, room)]


def code_sheets(code: str, title: str, room: QSizeF) -> list[Sheet]:
    """The sheets of a program's Python."""
    metrics = QFontMetricsF(on_paper(code_font(CODE_POINTS), CODE_POINTS))
    letters = max(LEAST_LETTERS, int(room.width() / metrics.horizontalAdvance("0")) - 5)
    rows = max(1, int(room.height() / metrics.lineSpacing()))
    lines = list(_numbered(code, letters))
    return [
        CodeSheet(title, tuple(lines[first : first + rows])) for first in range(0, len(lines), rows)
    ]


def _numbered(code: str, letters: int) -> Iterator[tuple[str, str]]:
    for number, line in enumerate(code.rstrip("\n").split("\n"), start=1):
        yield str(number), line[:letters]
        rest = line[letters:]
        while rest:
            yield "", rest[:letters]
            rest = rest[letters:]


def _sheets(part: Part, room: QSizeF) -> Iterator[BlocksSheet]:
    bounds = part.bounds
    scale = max(min(USUAL_SCALE, room.width() / bounds.width), SMALLEST_SCALE)
    width, height = room.width() / scale, room.height() / scale
    columns = max(1, math.ceil(bounds.width / width - 1e-9))
    for top, bottom in cut([_chain_spans(part), _box_spans(part), _row_spans(part)], height):
        for column in range(columns):
            seen = QRectF(bounds.x + column * width, top, width, bottom - top)
            inside = tuple(chain for chain in part.chains if _rect(chain).intersects(seen))
            if inside:
                yield BlocksSheet(part.title, inside, seen, scale)


def _chain_spans(part: Part) -> list[Span]:
    return [(_rect(chain).top(), _rect(chain).bottom()) for chain in part.chains]


def _box_spans(part: Part) -> list[Span]:
    """Where the blocks of the stacks lie, each with all that is in it."""
    return [
        (chain.y + top, chain.y + top + box.height)
        for chain in part.chains
        for box, top in zip(chain.boxes, chain.ys, strict=False)  # one more: the end
    ]


def _row_spans(part: Part) -> list[Span]:
    """Where the blocks lie that hold no others below each other."""
    placed = (one for chain in part.chains for one in boxes_of(chain, part.bounds))
    return [(one.y, one.y + one.box.height) for one in placed if not one.box.mouths]


def _rect(chain: Chain) -> QRectF:
    left = chain.x - chain.width if chain.is_mirrored else chain.x
    return QRectF(left, chain.y, chain.width, chain.height + TAB)


# Paints the sheets of a program on a printer: title above, date and number below.

HEAD, FOOT = 34.0, 24.0
"""How high the lines above and below a sheet are, in points."""

INK, PALE = QColor("black"), QColor("#666666")


def print_program(canvas: CanvasHost, printer: QPrinter, code: str, options: PrintOptions) -> int:
    """Print, ``code`` too if the options say so; how many sheets there are."""
    layout = printer.pageLayout()
    paper = layout.paintRect(QPageLayout.Unit.Point)
    room = QSizeF(paper.width(), paper.height() - HEAD - FOOT)
    sheets = block_sheets(canvas, options.what, room)
    if options.has_code:
        sheets += code_sheets(code, "Python", room)
    wanted = range(max(printer.fromPage(), 1), (printer.toPage() or len(sheets)) + 1)
    printer.setDocName(canvas.editor.project.name)
    scale = printer.resolution() / 72.0
    with QPainter(printer) as painter:
        painter.scale(scale, scale)
        whole = QRectF(0, 0, paper.width(), paper.height())
        printed = [(number, one) for number, one in enumerate(sheets, 1) if number in wanted]
        for number, sheet in printed:
            if number != printed[0][0]:
                printer.newPage()
            _paint(painter, sheet, canvas, whole, (number, len(sheets)))
    return len(sheets)


def _paint(
    painter: QPainter, sheet: Sheet, canvas: CanvasHost, paper: QRectF, place: tuple[int, int]
) -> None:
    title = sheet.title or page_title(canvas.editor.project, canvas.page_layout.page)
    start, end = _side(), _side(is_end=True)
    name = canvas.editor.project.name
    row = QRectF(0, 0, paper.width(), HEAD - 12)
    painter.setPen(INK)
    painter.setFont(on_paper(text_font(13, QFont.Weight.DemiBold), 13))
    painter.drawText(row, start | Qt.AlignmentFlag.AlignVCenter, name)
    painter.setFont(on_paper(text_font(11), 11))
    painter.drawText(row, end | Qt.AlignmentFlag.AlignVCenter, title)
    painter.setPen(QPen(PALE, 0.6))
    painter.drawLine(row.bottomLeft(), row.bottomRight())
    row = QRectF(0, paper.height() - FOOT + 8, paper.width(), FOOT - 8)
    date = QLocale().toString(QDate.currentDate(), QLocale.FormatType.LongFormat)
    painter.setPen(PALE)
    painter.setFont(on_paper(text_font(9), 9))
    painter.drawText(row, start | Qt.AlignmentFlag.AlignBottom, f"{date} · NEP Studio")
    words = tr("Page {number} of {count}", number=place[0], count=place[1])
    painter.drawText(row, end | Qt.AlignmentFlag.AlignBottom, words)
    painter.save()
    painter.translate(0, HEAD)
    if isinstance(sheet, BlocksSheet):
        _paint_blocks(painter, sheet, canvas)
    else:
        _paint_code(painter, sheet)
    painter.restore()


def _paint_blocks(painter: QPainter, sheet: BlocksSheet, canvas: CanvasHost) -> None:
    """Always in the light colours: dark ones would drink the ink."""
    language, measures = canvas.editor.language, canvas.look.measures
    font = _block_font(canvas, painter)
    blocks = BlockPainter(load_theme(LIGHT), language, measures, font)
    seen = sheet.seen
    painter.scale(sheet.scale, sheet.scale)
    painter.setClipRect(QRectF(0, 0, seen.width(), seen.height()))
    painter.translate(-seen.x(), -seen.y())
    rect = Rect(seen.x(), seen.y(), seen.width(), seen.height())
    for chain in sheet.chains:
        blocks.paint(painter, boxes_of(chain, rect), 1.0)


def _block_font(canvas: CanvasHost, painter: QPainter) -> QFont:
    """The font of the blocks: as many canvas units high on paper as it is on the screen."""
    font = QFont(canvas.look.block_font)
    units = QFontInfo(font).pixelSize()
    font.setPointSizeF(units * 72.0 / painter.device().logicalDpiY())
    font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    return font


def _paint_code(painter: QPainter, sheet: CodeSheet) -> None:
    font = on_paper(code_font(CODE_POINTS), CODE_POINTS)
    painter.setFont(font)
    painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as programs are everywhere
    metrics = QFontMetricsF(font)
    height, letter = metrics.lineSpacing(), metrics.horizontalAdvance("0")
    for row, (number, line) in enumerate(sheet.lines):
        y = row * height
        numbers = QRectF(0, y, 4 * letter, height)
        painter.setPen(PALE)
        painter.drawText(numbers, Qt.AlignmentFlag.AlignRight, number)
        painter.setPen(INK)
        text = QRectF(5 * letter, y, 10_000, height)
        painter.drawText(text, Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextSingleLine, line)


def _side(*, is_end: bool = False) -> Qt.AlignmentFlag:
    """Where reading begins, or ends; a painter does not turn it by itself everywhere."""
    is_right = is_end != is_right_to_left()
    side = Qt.AlignmentFlag.AlignRight if is_right else Qt.AlignmentFlag.AlignLeft
    return side | Qt.AlignmentFlag.AlignAbsolute


# The dialog that prints a program, with a preview that is always what will come out.


class ProgramPrintDialog(QDialog):
    """Asks what is printed, and on what paper; ``code`` is "" where there is no Python yet.

    ``done_well`` tells of a file that came out instead of paper.
    """

    done_well = Signal(str)

    def __init__(
        self, canvas: CanvasHost, code: str, parent: QWidget, printer: QPrinter | None = None
    ) -> None:
        super().__init__(parent)
        self._canvas, self._code = canvas, code
        self.setWindowTitle(tr("Print"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.printer = printer or QPrinter(QPrinter.PrinterMode.HighResolution)
        self.what = QComboBox()
        self.what.addItem(tr("All pages"), "pages")
        self.what.addItem(tr("This page"), "page")
        if canvas.selection.ids:
            self.what.addItem(tr("The selected blocks"), "selection")
        self.code = QCheckBox(tr("The Python, too"))
        self.code.setEnabled(bool(code))
        self.orientation = QComboBox()
        self.orientation.addItem(tr("Upright"), QPageLayout.Orientation.Portrait)
        self.orientation.addItem(tr("Across"), QPageLayout.Orientation.Landscape)
        self.preview = QPrintPreviewWidget(self.printer, self)
        self.preview.setAccessibleName(tr("What will be printed"))
        self.setup_button = QPushButton(tr("Page setup…"))
        self.print_button = QPushButton(tr("Print…"), default=True)
        self.close_button = QPushButton(tr("Close"))
        self._arrange(canvas.look.theme)
        self._connect()

    @property
    def options(self) -> PrintOptions:
        """What was chosen."""
        what = cast(What, self.what.currentData())
        return PrintOptions(what, has_code=self.code.isChecked())

    def print_to(self, printer: QPrinter) -> int:
        """Print what was chosen; how many sheets there are."""
        return print_program(self._canvas, printer, self._code, self.options)

    def _arrange(self, theme: Theme) -> None:
        line = self.fontMetrics().height()
        form = QFormLayout()
        form.addRow(tr("What"), self.what)
        form.addRow("", self.code)
        form.addRow(tr("Paper"), self.orientation)
        top = in_row(form, 1)
        for name, words, do in (
            ("zoom-out", tr("Zoom out"), self.preview.zoomOut),
            ("zoom-in", tr("Zoom in"), self.preview.zoomIn),
            ("maximize", tr("Show whole pages"), self.preview.fitInView),
        ):
            button = QToolButton()
            button.setIcon(icon(name, theme))
            button.setToolTip(words)
            button.setAccessibleName(words)
            button.clicked.connect(do)
            top.addWidget(button, 0, Qt.AlignmentFlag.AlignBottom)
        buttons = in_row(self.setup_button, 1, self.close_button, self.print_button)
        in_column(top, (self.preview, 1), buttons, of=self, margins=line, spacing=line // 2)
        fit_on_screen(self, 40, 36)

    def _connect(self) -> None:
        self.preview.paintRequested.connect(self.print_to)
        self.what.currentIndexChanged.connect(self.preview.updatePreview)
        self.code.toggled.connect(self.preview.updatePreview)
        self.orientation.currentIndexChanged.connect(self._on_turned)
        self.setup_button.clicked.connect(self._on_setup_clicked)
        self.print_button.clicked.connect(self._on_print_clicked)
        self.close_button.clicked.connect(self.reject)

    def _on_turned(self) -> None:
        self.preview.setOrientation(self.orientation.currentData())

    def _on_setup_clicked(self) -> None:
        dialog = QPageSetupDialog(self.printer, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.accepted.connect(self._on_set_up)
        dialog.open()

    def _on_set_up(self) -> None:
        orientation = self.printer.pageLayout().orientation()
        self.orientation.setCurrentIndex(self.orientation.findData(orientation))
        self.preview.updatePreview()

    def _on_print_clicked(self) -> None:
        dialog = QPrintDialog(self.printer, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setOption(QPrintDialog.PrintDialogOption.PrintPageRange)
        dialog.accepted.connect(self._on_print_accepted)
        QDialog.open(dialog)  # its own needs a receiver

    def _on_print_accepted(self) -> None:
        self.print_to(self.printer)
        if file := self.printer.outputFileName():
            self.done_well.emit(tr("Saved “{name}”.", name=Path(file).name))
        self.accept()
