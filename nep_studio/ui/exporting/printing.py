"""Paints the sheets of a program on a printer: title above, date and number below."""

from __future__ import annotations

from PySide6.QtCore import QDate, QLocale, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QFont, QFontInfo, QFontMetricsF, QPageLayout, QPainter, QPen
from PySide6.QtPrintSupport import QPrinter

from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.page import boxes_of
from nep_studio.ui.pages_bar import page_title
from nep_studio.ui.theme import LIGHT, code_font, load_theme, text_font
from nep_studio.ui.words import is_right_to_left, tr

from .paper import (
    CODE_POINTS,
    BlocksSheet,
    CodeSheet,
    PrintOptions,
    Sheet,
    block_sheets,
    code_sheets,
    on_paper,
)

HEAD, FOOT = 34.0, 24.0
"""How high the lines above and below a sheet are, in points."""

INK, PALE = QColor("black"), QColor("#666666")


def print_program(canvas: Canvas, printer: QPrinter, code: str, options: PrintOptions) -> int:
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
        is_first = True
        for number, sheet in enumerate(sheets, start=1):
            if number not in wanted:
                continue
            if not is_first:
                printer.newPage()
            is_first = False
            whole = QRectF(0, 0, paper.width(), paper.height())
            _paint(painter, sheet, canvas, whole, (number, len(sheets)))
    return len(sheets)


def _paint(
    painter: QPainter, sheet: Sheet, canvas: Canvas, paper: QRectF, place: tuple[int, int]
) -> None:
    _paint_head(painter, _title(sheet, canvas), canvas.editor.project.name, paper)
    _paint_foot(painter, paper, place)
    painter.save()
    painter.translate(0, HEAD)
    if isinstance(sheet, BlocksSheet):
        _paint_blocks(painter, sheet, canvas)
    else:
        _paint_code(painter, sheet)
    painter.restore()


def _title(sheet: Sheet, canvas: Canvas) -> str:
    return sheet.title or page_title(canvas.editor.project, canvas.page)


def _paint_head(painter: QPainter, title: str, name: str, paper: QRectF) -> None:
    row = QRectF(0, 0, paper.width(), HEAD - 12)
    painter.setPen(INK)
    painter.setFont(on_paper(text_font(13, QFont.Weight.DemiBold), 13))
    painter.drawText(row, _start() | Qt.AlignmentFlag.AlignVCenter, name)
    painter.setFont(on_paper(text_font(11), 11))
    painter.drawText(row, _end() | Qt.AlignmentFlag.AlignVCenter, title)
    painter.setPen(QPen(PALE, 0.6))
    painter.drawLine(row.bottomLeft(), row.bottomRight())


def _paint_foot(painter: QPainter, paper: QRectF, place: tuple[int, int]) -> None:
    row = QRectF(0, paper.height() - FOOT + 8, paper.width(), FOOT - 8)
    date = QLocale().toString(QDate.currentDate(), QLocale.FormatType.LongFormat)
    painter.setPen(PALE)
    painter.setFont(on_paper(text_font(9), 9))
    painter.drawText(row, _start() | Qt.AlignmentFlag.AlignBottom, f"{date} · NEP Studio")
    words = tr("Page {number} of {count}", number=place[0], count=place[1])
    painter.drawText(row, _end() | Qt.AlignmentFlag.AlignBottom, words)


def _paint_blocks(painter: QPainter, sheet: BlocksSheet, canvas: Canvas) -> None:
    """Always in the light colours: dark ones would drink the ink."""
    language, measures = canvas.editor.language, canvas.measures
    font = _block_font(canvas, painter)
    blocks = BlockPainter(load_theme(LIGHT), language, measures, font)
    seen = sheet.seen
    painter.scale(sheet.scale, sheet.scale)
    painter.setClipRect(QRectF(0, 0, seen.width(), seen.height()))
    painter.translate(-seen.x(), -seen.y())
    rect = Rect(seen.x(), seen.y(), seen.width(), seen.height())
    for chain in sheet.chains:
        blocks.paint(painter, boxes_of(chain, rect), 1.0)


def _block_font(canvas: Canvas, painter: QPainter) -> QFont:
    """The font of the blocks: as many canvas units high on paper as it is on the screen."""
    font = QFont(canvas.block_font)
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


def _start() -> Qt.AlignmentFlag:
    """The side where reading begins; a painter does not turn it by itself everywhere."""
    start, end = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
    return (end if is_right_to_left() else start) | Qt.AlignmentFlag.AlignAbsolute


def _end() -> Qt.AlignmentFlag:
    start, end = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
    return (start if is_right_to_left() else end) | Qt.AlignmentFlag.AlignAbsolute
