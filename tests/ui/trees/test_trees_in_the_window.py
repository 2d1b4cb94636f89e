"""Behaviour trees in the window: files in and out, and how the parts of a running tree end."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_core.wire.messages import ProgramState
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.plugins.trees import export_file, import_file
from nep_studio.ui.running.stage import Marks
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

GREET = """<root BTCPP_format="4"><BehaviorTree ID="Greet"><Sequence>
<AlwaysSuccess/><Wave/></Sequence></BehaviorTree></root>"""


def cards(window: MainWindow) -> list[tuple[str, tuple[str, ...]]]:
    return [(card.message.title, card.message.checklist) for card in window.message_area.cards]


@pytest.fixture
def greet(tmp_path: Path) -> Path:
    path = tmp_path / "greet.xml"
    path.write_text(GREET, encoding="utf-8")
    return path


def test_a_file_becomes_blocks_and_is_written_again(
    karate: MainWindow, greet: Path, tmp_path: Path
) -> None:
    assert import_file(karate.host, greet)
    assert export_file(karate.host, tmp_path / "out.xml")

    assert cards(karate)[-1] == ("Exported “out.xml”.", ())
    assert '<Action ID="Wave"/>' in (tmp_path / "out.xml").read_text(encoding="utf-8")


def test_what_is_not_taken_over_is_told_in_the_window(karate: MainWindow, greet: Path) -> None:
    greet.write_text(GREET.replace("<Wave/>", '<Wave _onHalted="x := 1"/>'), encoding="utf-8")

    assert import_file(karate.host, greet)

    told = ("Imported “greet.xml”.", ("“_onHalted” of “Wave” is not taken over.",))
    assert cards(karate)[-1] == told


def test_bad_files_and_places_are_told(karate: MainWindow, greet: Path, tmp_path: Path) -> None:
    greet.write_text("<root>", encoding="utf-8")

    assert not import_file(karate.host, greet)
    assert not import_file(karate.host, tmp_path / "nothing.xml")
    assert not export_file(karate.host, tmp_path / "out.xml")

    titles = [title for title, _ in cards(karate)]
    assert "These behaviour trees cannot be read" in titles
    assert "The file could not be read" in titles
    assert not (tmp_path / "out.xml").exists()


def test_the_file_menu_offers_both(karate: MainWindow) -> None:
    shown = [action.text() for action in karate.host.menus["file"].actions()]

    assert {"Import a behaviour tree…", "Export the behaviour trees…"} <= set(shown)


def test_the_parts_of_a_running_tree_are_marked_as_they_are_told(
    karate: MainWindow, greet: Path
) -> None:
    import_file(karate.host, greet)
    editor = karate.workbench.canvas.editor
    code = generate_program(editor.project, editor.language)
    lines = code.text.split("\n")
    row = lines.index("    with Sequence():") + 1
    marks = Marks(code)

    def tell(**nodes: str) -> None:
        told = {line.removeprefix("line"): status for line, status in nodes.items()}
        marks.take(ProgramState(program="x", event="tree", rule="Greet", nodes=told))

    tell(**{f"line{row}": "running", f"line{row + 1}": "succeeded", "linex": "failed"})
    sequence, check = code.block_at(row), code.block_at(row + 1)
    assert marks.nodes == {sequence: "running", check: "succeeded"}
    tell(**{f"line{row + 1}": "idle"})
    assert marks.nodes == {sequence: "running"}
    tell(**{f"line{row}": "strange"})
    assert not marks.nodes
    tell(**{f"line{row}": "running", f"line{row + 1}": "failed"})
    marks.take(ProgramState(program="x", event="finished"))
    assert marks.nodes == {check: "failed"}
    marks.take(ProgramState(program="x", event="started"))
    assert not marks.nodes


def test_the_word_of_a_part_stands_beside_its_block(karate: MainWindow, greet: Path) -> None:
    import_file(karate.host, greet)
    canvas = karate.workbench.canvas
    code = generate_program(canvas.editor.project, canvas.editor.language)
    row = code.text.split("\n").index("    with Sequence():") + 1
    overlay = next(one for one in canvas.layers.overlays if hasattr(one, "breakpoints"))
    overlay.marks = Marks(code)
    before = canvas.grab().toImage()
    overlay.marks.take(
        ProgramState(program="x", event="tree", rule="Greet", nodes={str(row): "failed"})
    )
    canvas.area.viewport().update()

    assert canvas.grab().toImage() != before
    assert overlay._chip(canvas, str(code.block_at(row))) == "failed"
