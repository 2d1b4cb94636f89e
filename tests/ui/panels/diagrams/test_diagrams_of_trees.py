"""Behaviour trees as trees: what is drawn, folded, and how the parts are while they run."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_core.wire.messages import ProgramState
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.plugins.diagrams.panel import DiagramPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.panels.diagrams.conftest import GREET, check


@pytest.fixture
def greet(draw) -> DiagramPage:
    return draw(*GREET)


def part(page: DiagramPage, shape: str, sign: str = "") -> str:
    items = page.view.diagram.items
    return next(item.key for item in items if item.shape == shape and sign in ("", item.sign))


def test_a_tree_is_drawn_with_the_signs_of_the_field(greet: DiagramPage) -> None:
    items = greet.view.diagram.items

    assert [(item.shape, item.sign, item.title) for item in items] == [
        ("root", "", "greet"),
        ("sign", "fallback", ""),
        ("sign", "sequence", ""),
        ("ellipse", "", "1 = 2"),
        ("ellipse", "", "3 = 2"),
        ("diamond", "rotate-cw", ""),
        ("leaf", "", "wave"),
        ("leaf", "list-tree", "rest"),
    ]
    assert items[5].small == "try again until it succeeds, at most 3 times"
    assert items[6].small == "NAO says Hi with no gesture"


def test_parts_stand_as_they_are_ticked_with_the_root_on_top(greet: DiagramPage) -> None:
    rects = greet.view.shapes.boxes
    items = greet.view.diagram.items
    x = {item.key: rects[item.key].rect.center().x() for item in items}

    sequence, retry, rest = items[2].key, items[5].key, items[7].key
    assert x[sequence] < x[retry] < x[rest]
    assert min(rects.values(), key=lambda box: box.rect.top()).item.shape == "root"


def test_a_part_is_folded_away_and_shown_again(greet: DiagramPage, qtbot: QtBot) -> None:
    sequence = part(greet, "sign", "sequence")
    greet.view.select(("box", sequence))

    qtbot.keyClick(greet.view, Qt.Key.Key_Space)
    folded = [item.key for item in greet.view.diagram.items]
    item = greet.view.item_of(("box", sequence))
    words = greet.view.words_of(("box", sequence))
    place = greet.view.place_of(("box", sequence)).toPoint()
    qtbot.mouseDClick(greet.view, Qt.MouseButton.LeftButton, pos=place)

    assert len(folded) == 6
    assert item is not None and item.hidden == 2
    assert words == "do all one after the other (2 parts are folded away)"
    assert len(greet.view.diagram.items) == 8
    assert greet.view.selected == ("box", sequence)


def test_parts_that_are_switched_off_are_not_drawn(greet: DiagramPage, window: MainWindow) -> None:
    project = window.workbench.canvas.editor.project

    project.blocks[part(greet, "diamond")].disabled = True
    greet.refresh()

    assert "diamond" not in {item.shape for item in greet.view.diagram.items}
    assert len(greet.view.diagram.items) == 6


def test_a_click_shows_the_part_on_the_canvas(
    greet: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    step = part(greet, "leaf")

    greet.view.open(("box", step))

    assert window.workbench.canvas.selection.cursor == step


def test_two_trees_are_two_diagrams_to_choose_from(draw, qtbot: QtBot) -> None:
    page = draw(*GREET, [B("tree.tree", {"name": "rest"}), check(2)])

    page.choice.setCurrentIndex(1)
    page.choice.activated.emit(1)

    assert [page.choice.itemText(n) for n in range(2)] == ["Tree: greet", "Tree: rest"]
    assert [item.title for item in page.view.diagram.items] == ["rest", "2 = 2"]


def test_parts_show_how_they_are_while_they_run(greet: DiagramPage, window: MainWindow) -> None:
    editor, stage = window.workbench.canvas.editor, window.running.stage
    code = generate_program(editor.project, editor.language)
    stage.begin(code)
    sequence, retry = part(greet, "sign", "sequence"), part(greet, "diamond")
    lines = {block: str(code.lines_of(block)[0]) for block in (sequence, retry)}

    def tell(**statuses: str) -> None:
        nodes = {lines[{"s": sequence, "r": retry}[name]]: how for name, how in statuses.items()}
        told = ProgramState(program="x", event="tree", rule="greet", nodes=nodes)
        window.running.runner.arrived.emit([(m.PROGRAM_STATE, told)])

    tell(s="running")
    first = dict(greet.view.statuses)
    tell(s="failed", r="running")
    second = dict(greet.view.statuses)
    words = greet.view.words_of(("box", sequence))
    tell(s="idle")

    assert first == {sequence: "running"}
    assert second == {sequence: "failed", retry: "running"}
    assert words.endswith("failed")
    assert greet.view.statuses == {retry: "running"}


def test_a_wide_tree_begins_with_its_root_in_sight(draw, window: MainWindow) -> None:
    wide = B("tree.sequence", bodies={"do": [check(number) for number in range(60)]})

    page = draw([B("tree.tree", {"name": "wide"}), wide])

    root = page.view.place_of(("box", part(page, "root")))
    assert page.view.rect().contains(root.toPoint())
