"""State machines as graphs: what is drawn, chosen, changed, and where the program is."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtGui import QAccessible, QGuiApplication, QImage
from PySide6.QtWidgets import QLineEdit
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_core.wire.messages import ProgramState
from nep_studio.blocks.files import to_bytes
from nep_studio.ui.canvas.fields.popup import Question
from nep_studio.ui.plugins.diagrams.panel import DiagramPage
from nep_studio.ui.plugins.diagrams.shapes import Measures, shapes_of
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import use_language
from tests.blocks.block_building import B
from tests.ui.panels.diagrams.conftest import GREET, VISIT


@pytest.fixture
def visit(draw) -> DiagramPage:
    return draw(*VISIT)


def labels(page: DiagramPage) -> dict[tuple[str, str], str]:
    return {(line.start, line.end): line.words for line in page.view.diagram.lines}


def arrow(page: DiagramPage, start: str, end: str) -> tuple[str, str]:
    lines = page.view.diagram.lines
    return "arrow", next(one.key for one in lines if (one.start, one.end) == (start, end))


def states(page: DiagramPage) -> list[str]:
    return [item.key for item in page.view.diagram.items if item.shape == "state"]


def click(page: DiagramPage, qtbot: QtBot, key: tuple[str, str]) -> None:
    place = page.view.place_of(key).toPoint()
    qtbot.mouseClick(page.view, Qt.MouseButton.LeftButton, pos=place)


def drag(page: DiagramPage, qtbot: QtBot, start: QPoint, end: QPoint) -> None:
    qtbot.mousePress(page.view, Qt.MouseButton.LeftButton, pos=start)
    qtbot.mouseMove(page.view, (start + end) / 2)
    qtbot.mouseMove(page.view, end)
    qtbot.mouseRelease(page.view, Qt.MouseButton.LeftButton, pos=end)


def asked(page: DiagramPage, qtbot: QtBot, name: str) -> Question:
    """Answers what the panel asks with a name; gives the question."""
    question = page.findChild(Question)
    line = question.findChild(QLineEdit)
    line.setText(name)
    qtbot.keyClick(line, Qt.Key.Key_Return)
    return question


def test_arrows_say_what_sets_them_off_in_the_words_of_the_blocks(visit: DiagramPage) -> None:
    assert labels(visit) == {
        ("waiting", "talking"): "when touched head",
        ("talking", "waiting"): "after 30 s",
        ("talking", "talking"): "when “ready” is told",
        ("", "resting"): "go to the state",
    }
    assert visit.view.words_of(("box", "waiting")) == (
        "waiting\nNAO says Hello with no gesture\nThe program begins here."
    )
    assert visit.view.words_of(arrow(visit, "", "resting")).startswith("arrow from any rule to")


def test_what_cannot_be_come_to_is_said(draw, qtbot: QtBot) -> None:
    page = draw(VISIT[0], [B("state.done", {"state": "lost", "target": "waiting"})])

    lost = page.view.item_of(("box", "lost"))

    assert lost is not None and not lost.is_reached
    assert "No arrow leads here" in page.view.words_of(("box", "lost"))


def test_a_click_on_a_box_or_an_arrow_shows_its_block_on_the_canvas(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    selection = window.workbench.canvas.selection

    click(visit, qtbot, ("box", "talking"))
    of_box = selection.cursor
    click(visit, qtbot, arrow(visit, "talking", "waiting"))

    blocks = window.workbench.canvas.editor.project.blocks
    assert blocks[of_box].type == "state.begins"
    assert blocks[selection.cursor].type == "state.after"
    assert visit.view.selected == arrow(visit, "talking", "waiting")


def test_a_click_on_the_line_of_an_arrow_is_one_on_the_arrow(visit: DiagramPage) -> None:
    key = arrow(visit, "waiting", "talking")
    path = visit.view.shapes.arrows[key[1]].path

    assert visit.view.item_at(path.pointAtPercent(0.8)) == key


def test_what_is_chosen_on_the_canvas_is_chosen_on_its_diagram(
    draw, window: MainWindow, qtbot: QtBot
) -> None:
    page = draw(*VISIT, *GREET)
    project = window.workbench.canvas.editor.project
    hello = next(b.id for b in project.blocks.values() if b.fields.get("text") == "Hello")
    wave = next(b.id for b in project.blocks.values() if b.type == "tree.step")

    window.workbench.canvas.selection.set([hello])
    of_state = page.view.selected
    window.workbench.canvas.selection.set([wave])

    assert of_state == ("box", "waiting")
    assert page.view.diagram.kind == "tree"
    assert page.view.selected == ("box", wave)
    assert page.choice.currentText() == "Tree: greet"


def test_the_arrow_keys_go_from_box_to_box_and_with_shift_to_arrows(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    view = visit.view

    qtbot.keyClick(view, Qt.Key.Key_Down)
    first = view.selected
    qtbot.keyClick(view, Qt.Key.Key_Down)
    second = view.selected
    qtbot.keyClick(view, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    third = view.selected
    qtbot.keyClick(view, Qt.Key.Key_Return)

    assert (first, second) == (("box", "waiting"), ("box", "talking"))
    assert third is not None and third[0] == "arrow"
    assert window.workbench.canvas.selection.cursor == third[1]


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_nothing_lies_on_something_else_from_either_side(
    visit: DiagramPage, is_mirrored: bool
) -> None:
    measures = Measures(visit.view.font())

    shapes = shapes_of(visit.view.diagram, measures, is_mirrored=is_mirrored)

    rects = list(shapes.rects.values())
    assert [(a, b) for a, b in itertools.combinations(rects, 2) if a.intersects(b)] == []
    [(dot, _, _)] = shapes.dots
    first = shapes.boxes["waiting"].rect
    assert (dot.x() > first.right()) if is_mirrored else (dot.x() < first.left())


def test_a_screen_reader_finds_all_boxes_and_arrows(visit: DiagramPage, qtbot: QtBot) -> None:
    found = QAccessible.queryAccessibleInterface(visit.view)
    visit.view.select(("box", "talking"))

    said = [found.child(n).text(QAccessible.Text.Name) for n in range(found.childCount())]
    chosen = found.focusChild()

    assert found.text(QAccessible.Text.Name) == "Diagram"
    assert "waiting, NAO says Hello with no gesture, The program begins here." in said
    assert "arrow from talking to waiting, after 30 s" in said
    assert len(said) == 8
    assert chosen.text(QAccessible.Text.Name) == "talking"
    middle = visit.view.mapToGlobal(visit.view.place_of(("box", "talking")).toPoint())
    assert chosen.rect().contains(middle)
    assert found.childAt(middle.x(), middle.y()).text(QAccessible.Text.Name) == "talking"


def test_drawing_an_arrow_from_box_to_box_makes_its_block(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    editor = window.workbench.canvas.editor
    before = to_bytes(editor.project)

    drag(
        visit,
        qtbot,
        visit.view.place_of(("box", "waiting")).toPoint(),
        visit.view.place_of(("box", "resting")).toPoint(),
    )

    assert labels(visit)["waiting", "resting"] == "when all is done"
    assert visit.view.selected == arrow(visit, "waiting", "resting")
    made = editor.project.blocks[window.workbench.canvas.selection.cursor]
    assert made.type == "state.done"
    assert editor.history.undo()
    assert to_bytes(editor.project) == before
    qtbot.waitUntil(lambda: ("waiting", "resting") not in labels(visit))


def test_an_arrow_that_ends_nowhere_or_where_it_began_is_none(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    start = visit.view.place_of(("box", "waiting")).toPoint()
    position = window.workbench.canvas.editor.history.position

    drag(visit, qtbot, start, QPoint(3, 3))
    drag(visit, qtbot, start, start + QPoint(8, 8))

    assert window.workbench.canvas.editor.history.position == position


def test_new_blocks_lie_on_no_others(visit: DiagramPage, window: MainWindow) -> None:
    visit.add_arrow("waiting", "resting")
    visit.add_state("dancing")

    found = window.workbench.canvas.page_layout.index.rects.values()
    rects = [QRectF(one.x, one.y, one.width, one.height) for one in found]
    new, others = rects[-2:], rects[:-2]
    assert not [one for one in new for other in others if one.intersects(other)]
    assert not new[0].intersects(new[1])


def test_the_button_arrow_to_offers_all_states(visit: DiagramPage, qtbot: QtBot) -> None:
    menu = visit.arrow_button.menu()

    menu.aboutToShow.emit()
    without = [action.text() for action in menu.actions()]
    visit.view.select(("box", "resting"))
    menu.aboutToShow.emit()
    offered = {action.text(): action for action in menu.actions()}
    offered["resting"].trigger()

    assert without == ["Choose a state first."]
    assert set(offered) == {"waiting", "talking", "resting"}
    assert labels(visit)["resting", "resting"] == "when all is done"


def test_a_new_state_is_asked_for_its_name(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    qtbot.mouseClick(visit.state_button, Qt.MouseButton.LeftButton)
    refused = asked(visit, qtbot, "talking")
    is_there_still = refused.isVisible()
    asked(visit, qtbot, "dancing")

    assert is_there_still
    assert "dancing" in states(visit)
    assert visit.view.selected == ("box", "dancing")
    selected = window.workbench.canvas.selection.cursor
    assert window.workbench.canvas.editor.project.blocks[selected].fields["state"] == "dancing"


def test_f2_renames_a_state_in_all_blocks(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    visit.view.select(("box", "talking"))

    qtbot.keyClick(visit.view, Qt.Key.Key_F2)
    asked(visit, qtbot, "listening")

    assert states(visit) == ["waiting", "listening", "resting"]
    assert labels(visit)["listening", "waiting"] == "after 30 s"
    assert visit.view.selected == ("box", "listening")
    assert window.workbench.canvas.editor.history.undo()
    qtbot.waitUntil(lambda: states(visit) == ["waiting", "talking", "resting"])


def test_delete_takes_an_arrow_away_with_its_block_and_undo_brings_it_back(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    visit.view.select(arrow(visit, "talking", "waiting"))

    qtbot.keyClick(visit.view, Qt.Key.Key_Delete)
    gone = labels(visit)
    window.workbench.canvas.editor.history.undo()

    assert ("talking", "waiting") not in gone
    qtbot.waitUntil(lambda: labels(visit).get(("talking", "waiting")) == "after 30 s")


def test_delete_takes_a_state_away_with_its_arrows(visit: DiagramPage, qtbot: QtBot) -> None:
    visit.view.select(("box", "talking"))

    qtbot.keyClick(visit.view, Qt.Key.Key_Delete)

    assert states(visit) == ["waiting", "resting"]
    assert list(labels(visit)) == [("", "resting")]


def test_the_menu_of_a_state_offers_what_can_be_done_with_it(visit: DiagramPage) -> None:
    def offered(key) -> list[str]:
        return [action.text() for action in visit.menu_of(key).actions()]

    assert offered(("box", "waiting")) == ["Show the block", "Arrow to", "Rename…", "Delete"]
    assert offered(arrow(visit, "talking", "waiting")) == ["Show the block", "Delete"]
    assert offered(("box", "")) == []
    assert offered(None) == ["New state…", "Copy as a picture"]


def test_what_is_changed_in_the_blocks_is_drawn(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    editor = window.workbench.canvas.editor

    editor.create("state.begins", editor.new_stack("behaviour", 900, 900))
    editor.create("state.done", editor.new_stack("behaviour", 900, 1200))

    qtbot.waitUntil(lambda: len(labels(visit)) == 4 and len(visit.view.diagram.lines) == 5)


def entered(state: str, machine: str = "") -> tuple[str, ProgramState]:
    told = ProgramState(program="x", event="state_entered", rule=state, machine=machine)
    return m.PROGRAM_STATE, told


def test_the_state_in_which_the_program_is_is_marked_until_it_ends(
    visit: DiagramPage, window: MainWindow
) -> None:
    runner = window.running.runner

    runner.arrived.emit([entered("waiting")])
    first = dict(visit.view.statuses)
    runner.arrived.emit([entered("talking"), entered("on", "lamp")])
    second = dict(visit.view.statuses)
    words = visit.view.words_of(("box", "talking"))
    runner.arrived.emit([(m.PROGRAM_STATE, ProgramState(program="x", event="finished"))])

    assert (first, second) == ({"waiting": "running"}, {"talking": "running"})
    assert words.endswith("The program is here now.")
    assert visit.view.statuses == {}


def test_nothing_is_drawn_anew_while_it_is_hidden(
    visit: DiagramPage, window: MainWindow, qtbot: QtBot
) -> None:
    window.workbench.panels.show(window.workbench.outline)
    qtbot.waitUntil(lambda: not visit.isVisible())
    diagram = visit.view.diagram

    window.running.runner.arrived.emit([entered("talking")])
    editor = window.workbench.canvas.editor
    editor.create("state.done", editor.new_stack("behaviour", 900, 1200))
    visit._open.changed.emit()
    hidden = (dict(visit.view.statuses), visit.view.diagram)
    window.host.show_panel(visit.parentWidget())

    assert hidden == ({}, diagram)
    qtbot.waitUntil(lambda: visit.view.statuses == {"talking": "running"})
    assert len(visit.view.diagram.lines) == 5


def test_without_states_and_trees_it_says_how_one_begins(
    draw, window: MainWindow, qtbot: QtBot
) -> None:
    page = draw()
    is_empty = page.empty.isVisible()

    qtbot.mouseClick(page.empty.state_button, Qt.MouseButton.LeftButton)
    asked(page, qtbot, "waiting")

    assert is_empty
    assert page.view.isVisible()
    assert page.view.item_of(("box", "waiting")).is_first


def test_a_first_tree_is_begun(draw, window: MainWindow, qtbot: QtBot) -> None:
    page = draw()

    qtbot.mouseClick(page.empty.tree_button, Qt.MouseButton.LeftButton)

    assert [item.shape for item in page.view.diagram.items] == ["root", "sign"]
    assert not page.arrow_button.isVisible()


def test_a_picture_is_saved_and_copied(
    visit: DiagramPage, window: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    visit.save_picture(tmp_path / "states.png")
    visit.save_picture(tmp_path / "states.svg")
    visit.save_picture(tmp_path / "nowhere" / "states.svg")
    qtbot.keyClick(visit.view, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)

    size = visit.view.shapes.bounds.size()
    assert QImage(str(tmp_path / "states.png")).width() > 2 * size.width()
    svg = (tmp_path / "states.svg").read_text(encoding="utf-8")
    [width] = re.findall(r'textLength="([\d.]+)"[^>]*>waiting<', svg)
    assert 0 < float(width) < visit.view.shapes.boxes["waiting"].rect.width()
    assert QGuiApplication.clipboard().image().width() > 2 * size.width()
    told = [one.message.title for one in window.host.services.messages.history]
    assert told[-4:] == [
        "Saved “states.png”.",
        "Saved “states.svg”.",
        "The file was not saved",
        "The picture is on the clipboard.",
    ]


def test_everything_is_told_in_the_language_of_the_window(
    visit: DiagramPage, window: MainWindow
) -> None:
    window.studio.choose_language("de")
    try:
        assert visit.choice.currentText() == "Zustände"
        assert labels(visit)["talking", "waiting"] == "nach 30 s"
    finally:
        use_language("en")
