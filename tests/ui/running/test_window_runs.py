"""The window runs the open project: real nodes, a real program, and what is seen of it."""

from __future__ import annotations

import psutil
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.edits.content import SetField
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.running.needs import NeedsDialog
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.running.window_use import (
    LONG_WAIT,
    WAIT_MS,
    Seen,
    block_of,
    blocks_of,
    has_run,
    press,
    state_is,
)

pytestmark = pytest.mark.long


def test_run_plays_the_program_and_the_running_block_glows(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    seen = open_program([B("event.started"), B("robot.say", {"text": "Good morning."})])

    greeting = block_of(window, "robot.say")

    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    qtbot.waitUntil(lambda: frozenset({greeting}) in seen.glowing, timeout=WAIT_MS)
    state_is(window, qtbot, "idle")

    assert seen.said() == ["Good morning."]
    assert seen.states == ["starting", "running", "idle"]
    assert window.running.stage.marks.glowing == frozenset()


def test_stop_ends_the_program_and_all_that_was_started_for_it(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    seen = open_program([B("event.started"), B("control.wait", {"seconds": 600})])
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    nodes = window.running.runner.local.launcher.nodes
    processes = [psutil.Process(node.pid) for node in nodes.values()]

    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")

    assert seen.states[-2:] == ["stopping", "idle"]
    assert not any(process.is_running() for process in processes)


def test_stop_while_it_starts_gives_the_start_up(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    seen = open_program([B("event.started"), B("robot.say", {"text": "Never."})])
    press(window, qtbot, "run")
    state_is(window, qtbot, "starting")

    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")

    assert "running" not in seen.states
    assert seen.said() == []


def test_a_program_without_a_beginning_shows_what_is_needed_and_gets_one(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program([B("robot.say", {"text": "Hello."})])

    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: bool(window.findChildren(NeedsDialog)))
    dialog = window.findChildren(NeedsDialog)[0]
    assert not dialog.run_button.isEnabled()
    add = next(b for b in dialog.findChildren(QPushButton) if "when the program" in b.text())
    qtbot.mouseClick(add, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: dialog.run_button.isEnabled())
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    state_is(window, qtbot, "running")


def test_an_error_marks_its_block_and_is_told_with_what_to_do(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    divide = B("math.arithmetic", {"operation": "divide", "a": 1, "b": 0})
    broken = B("variable.set", {"variable": "v1"}, {"value": divide})
    seen = open_program([B("event.started"), broken], variables=("result",))
    block = block_of(window, "variable.set")

    press(window, qtbot, "run")
    has_run(window, qtbot, seen)

    problem = window.workbench.canvas.problems.problems[block]
    assert "zero" in str(problem.sentence)
    assert any("zero" in card.message.sentence for card in window.message_area.cards)


def test_what_went_wrong_is_told_no_more_once_the_program_runs_again(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    divide = B("math.arithmetic", {"operation": "divide", "a": 1, "b": 0})
    broken = B("variable.set", {"variable": "v1"}, {"value": divide})
    seen = open_program([B("event.started"), broken], variables=("result",))
    press(window, qtbot, "run")
    has_run(window, qtbot, seen)
    told = window.messages.history[-1].message

    press(window, qtbot, "run")
    state_is(window, qtbot, "starting")

    assert all(card.message is not told for card in window.message_area.cards)
    state_is(window, qtbot, "idle")


def test_closing_the_window_while_a_program_runs_leaves_nothing_behind(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program([B("event.started"), B("control.wait", {"seconds": 600})])
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    children = psutil.Process().children(recursive=True)
    window._may_close = True

    window.close()

    gone, alive = psutil.wait_procs(children, timeout=10)
    assert [process.cmdline() for process in alive] == []
    assert gone


def test_another_project_stops_the_one_that_runs(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program([B("event.started"), B("control.wait", {"seconds": 600})])
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    document = window.files.document

    open_program([B("event.started")])

    state_is(window, qtbot, "idle")
    document.close()


def test_what_is_needed_can_be_looked_at_before_running(
    window: MainWindow, karate: MainWindow, qtbot: QtBot
) -> None:
    window.actions_by_name["needs"].trigger()
    dialogs = [d for d in window.findChildren(QDialog) if isinstance(d, NeedsDialog)]

    assert [need.state for need in dialogs[0].needs] == ["automatic"] * len(dialogs[0].needs)
    assert dialogs[0].run_button.isEnabled()


def test_run_again_plays_the_program_with_its_changes(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    seen = open_program(
        [B("event.started"), B("robot.say", {"text": "One."}), B("control.wait", {"seconds": 600})]
    )
    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: seen.said() == ["One."], timeout=WAIT_MS)
    editor = window.workbench.canvas.editor
    editor.apply(SetField(block_of(window, "robot.say"), "text", "Two."))
    assert window.running.is_stale

    press(window, qtbot, "run")

    qtbot.waitUntil(lambda: "Two." in seen.said(), timeout=WAIT_MS)
    assert not window.running.is_stale


def test_an_example_is_tried_with_one_press(window: MainWindow, qtbot: QtBot) -> None:
    seen = Seen(window)

    window.running.try_example(paths.examples() / "karate_greeting.nep")

    qtbot.waitUntil(lambda: bool(seen.said()), timeout=WAIT_MS)
    assert window.files.document.title


def test_the_canvas_follows_the_block_that_runs_unless_a_person_wants_to_stay(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    short = [B("control.wait", {"seconds": 0.01}) for _ in range(50)]
    open_program([B("event.started"), *short, B("robot.say", {"text": "Down."}), LONG_WAIT])
    canvas = window.workbench.canvas
    deep = canvas.page_layout.placed(blocks_of(window, "control.wait")[-1])

    press(window, qtbot, "run")

    qtbot.waitUntil(
        lambda: canvas.sight.visible_page_rect().holds(deep.x + 4, deep.y + 4), timeout=WAIT_MS
    )
    window.actions_by_name["follow_running"].trigger()
    assert not window.settings.follows_running
    assert not canvas.following.is_on
    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")


def test_in_a_new_project_the_robot_stands_where_it_begins(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program([B("event.started"), B("robot.do", {"posture": "posture_sit"}), LONG_WAIT])
    panel = window.findChild(RobotsPanel)
    window.workbench.panels.show(panel)
    press(window, qtbot, "run")

    def posture() -> str:
        return panel.stage.view.room.robots["NAO"].shown.posture

    qtbot.waitUntil(lambda: posture() == "Sit", timeout=WAIT_MS)

    window.files.new()
    state_is(window, qtbot, "idle")

    qtbot.waitUntil(lambda: posture() == "Stand", timeout=WAIT_MS)
    qtbot.waitUntil(lambda: "Not started" in words_in(panel.cards["NAO"]), timeout=WAIT_MS)
    assert len(panel.stage.view.room.robots["NAO"].path) <= 1, "only where it stands now"


def words_in(card: QWidget) -> list[str]:
    return [label.text() for label in card.findChildren(QLabel)]
