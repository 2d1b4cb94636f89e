"""What is not right yet is found while a person works, shown at its block, and put right."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks, MoveBlocks
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.places import InStack
from nep_studio.blocks.slices import Sliced
from nep_studio.run.installation import problem_steps
from nep_studio.ui.edits import edits_of
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.checklist.person import CTRL, Key, Person


@pytest.fixture
def robotless(karate: MainWindow, qtbot: QtBot) -> MainWindow:
    """The karate example, whose robot has been deleted from its page."""
    editor = karate.files.document.editor
    qtbot.waitUntil(lambda: karate.workbench.checks._check is None)
    for stack in list(editor.project.pages["robots"]):
        editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    qtbot.waitUntil(lambda: bool(karate.workbench.checks.problems))
    return karate


def test_a_problem_is_found_without_asking(robotless: MainWindow) -> None:
    [problem] = robotless.workbench.checks.problems

    assert problem.kind == "robot_missing"
    assert robotless.workbench.canvas.problems.problems[problem.block] == problem
    assert robotless.actions_by_name["check"].iconText() == "1 problem"


def test_check_lists_the_problems_with_sentence_and_checklist(
    robotless: MainWindow, qtbot: QtBot
) -> None:
    button = robotless.toolbar.widgetForAction(robotless.actions_by_name["check"])

    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: len(robotless.workbench.problems.rows) == 1)
    assert robotless.workbench.problems.isVisible()
    assert "NAO is not on the Robots page" in robotless.workbench.problems.rows[0].accessibleName()


def test_a_click_on_a_problem_shows_its_block(robotless: MainWindow, qtbot: QtBot) -> None:
    robotless.workbench.canvas.show_page("nodes")
    robotless.show_problems()
    [row] = robotless.workbench.problems.rows

    qtbot.mouseClick(row, Qt.MouseButton.LeftButton)

    assert robotless.workbench.canvas.page == "behaviour"
    assert robotless.workbench.canvas.selection.ids == (row.problem.block,)


def test_the_fix_button_puts_it_right_and_undo_takes_it_back(
    robotless: MainWindow, qtbot: QtBot
) -> None:
    robotless.show_problems()
    [row] = robotless.workbench.problems.rows

    qtbot.mouseClick(row.fix_button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: robotless.workbench.checks.problems == [])
    assert robotless.actions_by_name["undo"].text() == "Undo “Add NAO”"
    robotless.actions_by_name["undo"].trigger()
    qtbot.waitUntil(lambda: len(robotless.workbench.checks.problems) == 1)


def test_a_fix_on_another_page_stays_on_this_one_and_says_what_it_did(
    robotless: MainWindow, qtbot: QtBot
) -> None:
    robotless.show_problems()
    [row] = robotless.workbench.problems.rows

    qtbot.mouseClick(row.fix_button, Qt.MouseButton.LeftButton)

    assert robotless.workbench.canvas.page == "behaviour"
    [card] = robotless.message_area.cards
    assert card.message.title == "Done on the page Robots: Add NAO"
    qtbot.mouseClick(card.buttons[0], Qt.MouseButton.LeftButton)
    assert robotless.files.document.project.pages["robots"] == []
    assert robotless.message_area.cards == []


def test_a_fix_on_this_page_shows_the_block(karate: MainWindow, qtbot: QtBot) -> None:
    editor = karate.files.document.editor
    forever = editor.create("control.forever", editor.new_stack("behaviour", 40, 2000))
    hat = editor.create("event.started", editor.new_stack("behaviour", 40, 1900))
    editor.apply(MoveBlocks(forever, 1, InStack(editor.project.stack_of(hat).id, 1)))
    qtbot.waitUntil(lambda: bool(karate.workbench.checks.problems))
    karate.show_problems()
    [row] = [row for row in karate.workbench.problems.rows if row.fix_button]

    qtbot.mouseClick(row.fix_button, Qt.MouseButton.LeftButton)

    [made] = karate.workbench.canvas.selection.ids
    assert editor.project.parents[made].owner == forever
    assert karate.message_area.cards[-1].message.title == "Done: Add a pause"


def test_the_badge_opens_a_bubble_with_the_fix(robotless: MainWindow, qtbot: QtBot) -> None:
    [problem] = robotless.workbench.checks.problems
    robotless.workbench.canvas.news.problem_opened.emit(problem.block)
    bubble = robotless.workbench.bubble

    qtbot.mouseClick(bubble.buttons[0], Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: robotless.workbench.checks.problems == [])


def test_a_program_without_problems_says_so(karate: MainWindow, qtbot: QtBot) -> None:
    karate.show_problems()

    assert karate.workbench.problems.rows == []
    assert karate.actions_by_name["check"].iconText() == "Check"


def test_what_was_checked_is_in_order_until_it_is_changed(karate: MainWindow, qtbot: QtBot) -> None:
    checks = karate.workbench.checks
    qtbot.waitUntil(lambda: checks.is_in_order)

    karate.files.document.editor.apply(RenameProject("Typed"))

    assert not checks.is_in_order
    qtbot.waitUntil(lambda: checks.is_in_order)


def test_typing_does_not_wait_for_a_check(karate: MainWindow, qtbot: QtBot) -> None:
    checks = karate.workbench.checks
    edits = edits_of(karate.files.document.editor)
    qtbot.waitUntil(lambda: edits.is_settled and checks._check is None)

    karate.files.document.editor.apply(RenameProject("Typed"))

    assert checks._check is None
    assert not edits.is_settled


def test_a_huge_program_is_checked_in_many_slices(karate: MainWindow) -> None:
    editor = karate.files.document.editor
    with editor.transaction("many"):
        for number in range(400):
            editor.create("control.wait", editor.new_stack("behaviour", 900, 60 * number))

    folder = karate.files.document.folder
    check = Sliced(problem_steps(editor.project, editor.language, folder))
    slices = 1
    while not check.run(0.0):
        slices += 1

    assert slices > 400
    assert len(check.result) >= 1


# A new project, and what is told while somebody is making the first blocks of it.


@pytest.fixture
def beginner(window: MainWindow, qtbot: QtBot) -> Person:
    """Somebody before the empty page of a new project."""
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    return Person(window, qtbot)


def kinds(person: Person) -> list[str]:
    return [problem.kind for problem in person.window.workbench.checks.problems]


def is_checked(person: Person) -> None:
    """Wait until what was done is checked."""
    checks, edits = person.window.workbench.checks, edits_of(person.editor)
    person.qtbot.waitUntil(lambda: edits.is_settled and checks._check is None and checks._are_true)


def test_a_new_project_has_a_robot_that_no_undo_takes_away(beginner: Person) -> None:
    beginner.key(Key.Key_Z, CTRL)

    [robot] = beginner.project.blocks.values()
    assert (robot.type, robot.fields["name"], robot.fields["driver"]) == (
        "robots.robot",
        "NAO",
        "virtual",
    )
    assert not beginner.window.files.document.is_modified
    assert not beginner.window.actions_by_name["undo"].isEnabled()


@pytest.mark.parametrize("made", ["robot.say", "event.gesture", "control.if", "control.forever"])
def test_nothing_is_wrong_with_a_block_that_was_just_dropped(beginner: Person, made: str) -> None:
    beginner.from_palette(made, QPoint(120, 120))

    is_checked(beginner)
    assert kinds(beginner) == []
    assert beginner.canvas.problems.problems == {}
    assert beginner.window.actions_by_name["check"].iconText() == "Check"


def test_what_a_block_lacks_is_told_once_it_is_left_alone(beginner: Person, qtbot: QtBot) -> None:
    beginner.from_palette("control.if", QPoint(120, 120))
    is_checked(beginner)

    beginner.click(QPoint(400, 300))

    qtbot.waitUntil(lambda: "empty_slot" in kinds(beginner))


def test_a_block_is_not_left_alone_by_what_is_put_into_it(beginner: Person, qtbot: QtBot) -> None:
    beginner.from_palette("control.if", QPoint(120, 120))
    mouth = beginner.mouth(beginner.block("control.if").id, "do")
    beginner.from_palette("robot.say", mouth, is_corner=True)
    is_checked(beginner)
    inner = beginner.block("robot.say")
    assert beginner.project.parents[inner.id].slot == "do"
    assert kinds(beginner) == []

    beginner.from_palette("event.started", QPoint(120, 330))

    qtbot.waitUntil(lambda: "empty_slot" in kinds(beginner))


def test_run_tells_all_at_once(beginner: Person, qtbot: QtBot) -> None:
    beginner.from_palette("control.if", QPoint(120, 120))
    is_checked(beginner)
    window = beginner.window
    run = window.toolbar.widgetForAction(window.actions_by_name["run"])

    qtbot.mouseClick(run, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: {"empty_slot", "no_rule"} <= set(kinds(beginner)))


def test_a_block_of_the_palette_is_for_a_robot_that_is_there(beginner: Person) -> None:
    [robot] = beginner.project.blocks
    beginner.editor.apply(SetField(robot, "name", "Robby"))

    beginner.from_palette("robot.say", QPoint(120, 120))

    assert beginner.block("robot.say").fields["robot"] == "Robby"
