"""Words are as large as their blocks, however many dots an inch has where they are drawn."""

from __future__ import annotations

import re
import zlib
from pathlib import Path

import pytest
from PySide6.QtPrintSupport import QPrinter

from nep_studio.ui.plugins.exporting.picture import PictureOptions, pdf_of
from nep_studio.ui.plugins.exporting.print_dialog import ProgramPrintDialog
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

USUAL_UNITS = 14.0
"""How high the font of blocks is, in canvas units."""


def word_sizes(pdf: bytes) -> set[float]:
    """The sizes of the words in a PDF, in points: the font's with all scales that are in force."""
    sizes = set()
    for stream in re.findall(rb"stream\r?\n(.*?)endstream", pdf, re.DOTALL):
        try:
            drawn = zlib.decompress(stream).decode("latin1")
        except zlib.error:
            continue
        if " Tf" in drawn:
            sizes |= _sizes(drawn)
    return sizes


def _sizes(drawn: str) -> set[float]:
    sizes, scales, scale = set(), [], 1.0
    for word in re.finditer(r"\bq\b|\bQ\b|([-\d.]+) \S+ \S+ \S+ \S+ \S+ cm|(\S+) Tf", drawn):
        if word[0] == "q":
            scales.append(scale)
        elif word[0] == "Q":
            scale = scales.pop()
        elif word[1]:
            scale *= abs(float(word[1]))
        else:
            sizes.add(round(float(word[2]) * scale, 2))
    return sizes


def test_words_of_a_pdf_picture_are_as_large_as_their_blocks(karate: MainWindow) -> None:
    sizes = word_sizes(pdf_of(karate.workbench.canvas, PictureOptions()))

    assert max(sizes) == pytest.approx(USUAL_UNITS * 0.75, rel=0.05)


def test_words_that_are_printed_are_as_large_as_their_blocks(
    karate: MainWindow, tmp_path: Path
) -> None:
    printer = QPrinter(QPrinter.PrinterMode.HighResolution)
    printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
    printer.setOutputFileName(str(tmp_path / "program.pdf"))
    dialog = ProgramPrintDialog(karate.workbench.canvas, "", karate, printer)

    dialog.print_to(printer)

    sizes = word_sizes((tmp_path / "program.pdf").read_bytes())
    blocks = [size for size in sizes if size not in (13.0, 11.0, 9.0)]  # title, page, foot
    assert blocks
    assert max(blocks) <= USUAL_UNITS * 0.75 + 0.1
    assert min(blocks) >= 4
    dialog.close()
