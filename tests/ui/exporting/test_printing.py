"""A program on paper: whole blocks on each sheet, all of them, in colours that can be read."""

from __future__ import annotations

import gc
import re
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QMarginsF, QSizeF, Qt
from PySide6.QtGui import QPageLayout, QPageSize
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QLineEdit
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import load
from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.exporting.print_dialog import (
    SMALLEST_SCALE,
    USUAL_SCALE,
    BlocksSheet,
    CodeSheet,
    ProgramPrintDialog,
    block_sheets,
    code_sheets,
    cut,
)
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

A4 = QSizeF(500, 700)
SPANS = st.lists(
    st.tuples(st.integers(0, 300), st.integers(1, 80)).map(lambda s: (float(s[0]), float(sum(s)))),
    min_size=1,
    max_size=12,
)


@given(SPANS, st.integers(5, 120).map(float))
def test_what_is_cut_is_all_there_once_and_fits(spans: list, height: float) -> None:
    pieces = cut([spans], height)

    assert all(0 < bottom - top <= height for top, bottom in pieces)
    assert all(before[1] <= after[0] for before, after in pairwise(pieces))
    for top, bottom in spans:
        shown = sum(max(0.0, min(bottom, b) - max(top, a)) for a, b in pieces)
        assert shown == bottom - top


@given(st.lists(st.integers(1, 60), min_size=1, max_size=15))
def test_things_below_each_other_that_fit_are_never_cut(heights: list[int]) -> None:
    ends = [float(sum(heights[: n + 1])) for n in range(len(heights))]
    spans = [(end - height, end) for end, height in zip(ends, heights, strict=True)]

    pieces = cut([spans], 60.0)

    for top, bottom in spans:
        assert any(a <= top and bottom <= b for a, b in pieces)


def test_what_is_too_high_is_cut_between_its_parts() -> None:
    pieces = cut([[(0, 100)], [(0, 30), (30, 70), (70, 100)]], 60)

    assert pieces == [(0, 30), (30, 70), (70, 100)]


@pytest.fixture
def printer(tmp_path: Path) -> QPrinter:
    made = QPrinter(QPrinter.PrinterMode.HighResolution)
    made.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
    made.setOutputFileName(str(tmp_path / "program.pdf"))
    size = QPageSize(QPageSize.PageSizeId.A4)
    made.setPageLayout(
        QPageLayout(size, QPageLayout.Orientation.Portrait, QMarginsF(40, 40, 40, 40))
    )
    return made


def pages_in(pdf: Path) -> int:
    return len(re.findall(rb"/Type\s*/Page\b(?!s)", pdf.read_bytes()))


@pytest.fixture
def canvas(studio: Studio, qtbot: QtBot) -> Canvas:
    made = Canvas(Editor(Project(), studio.language), studio.look.theme)
    qtbot.addWidget(made)
    return made


@pytest.mark.parametrize("path", sorted(paths.examples().glob("*.nep")), ids=lambda p: p.stem)
def test_every_block_of_an_example_is_on_a_sheet(
    studio: Studio, canvas: Canvas, path: Path
) -> None:
    canvas.set_editor(Editor(load(path, studio.language), studio.language))

    sheets = [one for one in block_sheets(canvas, "pages", A4) if isinstance(one, BlocksSheet)]

    shown = {box.block for sheet in sheets for chain in sheet.chains for box in chain.boxes}
    tops = {stack.body[0] for stacks in canvas.editor.project.pages.values() for stack in stacks}
    assert tops <= shown
    for sheet in sheets:
        assert SMALLEST_SCALE <= sheet.scale <= USUAL_SCALE
        assert sheet.seen.height() * sheet.scale <= A4.height() + 1e-6


def test_it_prints_as_many_pages_as_it_says(
    karate: MainWindow, printer: QPrinter, tmp_path: Path, qtbot: QtBot
) -> None:
    dialog = ProgramPrintDialog(karate.workbench.canvas, "x = 1\n" * 200, karate, printer)
    dialog.code.setChecked(True)

    count = dialog.print_to(printer)

    assert count >= 4
    assert pages_in(tmp_path / "program.pdf") == count
    dialog.close()


def test_a_range_of_pages_is_printed_alone(
    karate: MainWindow, printer: QPrinter, tmp_path: Path
) -> None:
    dialog = ProgramPrintDialog(karate.workbench.canvas, "x = 1\n" * 200, karate, printer)
    dialog.code.setChecked(True)
    printer.setFromTo(2, 3)

    dialog.print_to(printer)

    assert pages_in(tmp_path / "program.pdf") == 2
    dialog.close()


def test_the_print_button_asks_for_a_printer_and_prints(
    karate: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    dialog = ProgramPrintDialog(karate.workbench.canvas, "x = 1\n", karate)
    dialog.open()
    qtbot.mouseClick(dialog.print_button, Qt.MouseButton.LeftButton)
    gc.collect()  # what only Python held would be gone now
    [asked] = dialog.findChildren(QPrintDialog)
    qtbot.keyClick(asked, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not dialog.findChildren(QPrintDialog))
    qtbot.mouseClick(dialog.print_button, Qt.MouseButton.LeftButton)
    [asked] = dialog.findChildren(QPrintDialog)
    asked.findChild(QLineEdit, "filename").setText(str(tmp_path / "program.pdf"))

    asked.accept()

    qtbot.waitUntil(lambda: not karate.findChildren(ProgramPrintDialog))
    assert pages_in(tmp_path / "program.pdf") >= 1


def test_long_lines_of_python_go_on_below_and_none_is_lost() -> None:
    code = "a = 1\n" + "b = '" + "x" * 400 + "'\n" + "c = 3\n"

    sheets = code_sheets(code, "Python", A4)

    lines = [line for sheet in sheets if isinstance(sheet, CodeSheet) for line in sheet.lines]
    assert "".join(text for _, text in lines) == code.replace("\n", "")
    assert [number for number, _ in lines if number] == ["1", "2", "3"]


def test_without_a_printer_a_named_file_is_made_and_told(
    karate: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    karate.actions_by_name["print"].trigger()
    [dialog] = karate.findChildren(ProgramPrintDialog)
    qtbot.mouseClick(dialog.print_button, Qt.MouseButton.LeftButton)
    [asked] = dialog.findChildren(QPrintDialog)
    file_name = asked.findChild(QLineEdit, "filename")
    offered = Path(file_name.text())
    file_name.setText(str(tmp_path / offered.name))

    asked.accept()

    assert offered.suffix == ".pdf" and offered.stem == karate.files.document.title
    assert pages_in(tmp_path / offered.name) >= 1
    assert karate.message_area.cards[-1].message.title == f"Saved “{offered.name}”."


def test_the_action_shows_what_will_be_printed(karate: MainWindow, qtbot: QtBot) -> None:
    karate.actions_by_name["print"].trigger()
    [dialog] = karate.findChildren(ProgramPrintDialog)

    before = dialog.preview.pageCount()
    qtbot.mouseClick(dialog.code, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.preview.pageCount() > before)
    dialog.orientation.setCurrentIndex(1)

    assert dialog.printer.pageLayout().orientation() == QPageLayout.Orientation.Landscape
    dialog.close()
