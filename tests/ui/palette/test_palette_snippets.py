"""Snippets: blocks kept in files, used in any project."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import load
from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.editing.menu import menu_for
from nep_studio.ui.workbench.palette.palette import Palette
from nep_studio.ui.workbench.snippets import Snippets, read_snippet, write_out

LEFT = Qt.MouseButton.LeftButton


def keep(palette: Palette, name: str, block_type: str = "control.together") -> None:
    project = palette.canvas.editor.project
    block = next(block.id for block in project.blocks.values() if block.type == block_type)
    palette.canvas.selection.set([block])
    palette.snippet_menu.keep(name)


def kept(palette: Palette) -> list[str]:
    return [entry.text for entry in palette.shelf.entries if entry.snippet]


def entry_named(palette: Palette, name: str):
    return next(e for e in palette.shelf.entries if e.snippet and e.text == name)


def test_selected_blocks_are_kept_by_a_name_in_a_file(palette, qtbot):
    project = palette.canvas.editor.project
    palette.canvas.selection.set([next(iter(project.blocks))])
    palette.use(next(e for e in palette.shelf.entries if e.action == "keep"))
    question = palette.snippet_menu.asking.question

    qtbot.keyClicks(question.name, "my start")
    qtbot.keyClick(question, Qt.Key.Key_Return)

    assert kept(palette) == ["my start"]
    assert [path.name for path in palette.snippets.folder.iterdir()] == ["my-start.nepsnippet"]


def test_without_a_selection_the_palette_says_what_to_do(palette, qtbot):
    palette.canvas.selection.clear()

    with qtbot.waitSignal(palette.canvas.news.refused) as told:
        palette.snippet_menu.ask_to_keep()

    assert "Select" in told.args[0]


def test_the_menu_of_a_block_offers_to_keep_it(palette):
    canvas = palette.canvas
    hit = canvas.sight.hit(
        canvas.sight.view_rect_of(next(iter(canvas.editor.project.blocks))).center()
    )

    menu = menu_for(canvas, hit, canvas.sight.to_page(QPoint(0, 0)), canvas.menu_sections)

    assert "keep" in [action.objectName() for action in menu.actions()]
    menu.deleteLater()


def test_a_snippet_is_used_in_another_project_with_its_variables(palette):
    keep(palette, "both")
    language = palette.canvas.editor.language
    palette.canvas.set_editor(Editor(Project("Other"), language))
    palette.refresh()

    palette.use(entry_named(palette, "both"))

    project = palette.canvas.editor.project
    assert [variable.name for variable in project.variables] == ["times"]
    assert "control.together" in [block.type for block in project.blocks.values()]


def test_a_snippet_is_dragged_onto_the_canvas(palette):
    keep(palette, "both")
    before = len(palette.canvas.editor.project.blocks)
    shelf, viewport = palette.shelf, palette.shelf.viewport()
    number = list(shelf.entries).index(entry_named(palette, "both"))
    shelf._go_to(number)
    start = shelf.rect_of(number).topLeft() + QPoint(20, 40)
    end = viewport.mapFromGlobal(palette.canvas.viewport().mapToGlobal(QPoint(450, 400)))

    QTest.mousePress(viewport, LEFT, pos=start)
    QTest.mouseMove(viewport, start + (end - start) / 2)
    QTest.mouseMove(viewport, end)
    QTest.mouseRelease(viewport, LEFT, pos=end)

    assert len(palette.canvas.editor.project.blocks) > before + 3


def test_a_snippet_is_renamed_and_deleted_after_a_question(palette, qtbot):
    keep(palette, "old")
    snippet = entry_named(palette, "old").snippet
    palette.snippet_menu.ask_to_rename(snippet)
    question = palette.snippet_menu.asking.question
    question.name.setText("new")
    qtbot.keyClick(question, Qt.Key.Key_Return)
    renamed = kept(palette)

    palette.snippet_menu.ask_to_delete(entry_named(palette, "new").snippet)
    qtbot.mouseClick(palette.snippet_menu.asking.question.yes, LEFT)

    assert renamed == ["new"]
    assert kept(palette) == []
    assert list(palette.snippets.folder.iterdir()) == []


def test_the_menu_of_a_snippet_opens_on_it(palette):
    keep(palette, "both")

    palette.snippet_menu.open(entry_named(palette, "both"), QPoint(10, 10))

    labels = [action.text() for action in palette.snippet_menu.menu.actions() if action.text()]
    assert labels == ["Insert", "Rename…", "Export…", "Delete…"]
    palette.snippet_menu.menu.close()


def test_two_snippets_may_have_the_same_name(palette):
    keep(palette, "same")
    keep(palette, "same", "robot.do")

    assert kept(palette) == ["same", "same"]
    assert len(list(palette.snippets.folder.iterdir())) == 2


def test_an_exported_snippet_is_a_project_and_can_be_taken_in(palette, tmp_path):
    keep(palette, "both")
    snippet = entry_named(palette, "both").snippet
    outside = tmp_path / "outside.nep"

    write_out(snippet, outside)
    palette.snippet_menu.take_in(outside)

    language = palette.canvas.editor.language
    assert len(load(outside, language).blocks) == len(snippet.clip)
    assert kept(palette) == ["both", "both"]


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe\x00", b"print('hello')", b"[" * 5000])
def test_a_damaged_snippet_is_left_out_and_left_alone(palette, content):
    keep(palette, "good")
    bad = palette.snippets.folder / "bad.nepsnippet"
    bad.write_bytes(content)

    palette.fill()

    assert kept(palette) == ["good"]
    assert bad.read_bytes() == content
    with pytest.raises(EditRefused):
        read_snippet(bad, palette.canvas.editor.language)


@pytest.mark.parametrize("name", ["", "   ", "x" * 61])
def test_a_name_that_is_none_is_refused(palette, name):
    with pytest.raises(EditRefused):
        keep(palette, name)


@pytest.mark.parametrize("name", ["../up", "a/b\\c", "CON:", "…", "日本語"])
def test_any_name_makes_a_file_inside_the_folder(palette, name):
    keep(palette, name)

    [path] = palette.snippets.folder.iterdir()
    assert path.parent == palette.snippets.folder
    assert kept(palette) == [name]


def test_snippets_have_a_folder_of_their_own(tmp_path, monkeypatch):
    monkeypatch.setenv("NEP_STUDIO_FOLDER", str(tmp_path))

    assert Snippets().folder == Path(tmp_path) / "snippets"
