"""The window runs the open project: real nodes, a real program, and what is seen of it."""

from __future__ import annotations

import time
from collections.abc import Callable

import psutil
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QPushButton
from pytestqt.qtbot import QtBot

from nep_core import messages as m
from nep_studio import paths
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import SetField
from nep_studio.ui.documents import Document
from nep_studio.ui.main_window import MainWindow
from nep_studio.ui.running.needs import NeedsDialog
from tests.blocks.block_building import B, build

WAIT_MS = 30_000
LONG_WAIT = B("control.wait", {"seconds": 600})
WAIT_A_LITTLE = B("control.wait", {"seconds": 0.05})


class Seen:
    """The states that the program went through, and what it told."""

    def __init__(self, window: MainWindow) -> None:
        self.states: list[str] = []
        self.messages: list[object] = []
        self.glowing: list[frozenset[str]] = []
        runner, stage = window.running.runner, window.running.stage
        runner.state_changed.connect(self.states.append)
        runner.arrived.connect(lambda batch: self.messages.extend(one for _, one in batch))
        runner.arrived.connect(lambda _: self.glowing.append(stage.marks.glowing))

    def said(self) -> list[str]:
        requests = [one for one in self.messages if isinstance(one, m.ActionRequest)]
        return [one.args["text"] for one in requests if one.action == "say"]


@pytest.fixture
def open_program(window: MainWindow, qtbot: QtBot) -> Callable[..., Seen]:
    """Opens a program of these stacks in the window."""

    def show(*stacks: list[B], **more) -> Seen:
        editor: Editor = build(window.studio.language, *stacks, **more)
        build(window.studio.language, [B("robots.robot")], page="robots", editor=editor)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
        return Seen(window)

    return show


def blocks_of(window: MainWindow, block_type: str) -> list[str]:
    blocks = window.workbench.canvas.editor.project.blocks.values()
    return [block.id for block in blocks if block.type == block_type]


def block_of(window: MainWindow, block_type: str) -> str:
    return blocks_of(window, block_type)[0]


def press(window: MainWindow, qtbot: QtBot, name: str) -> None:
    """Press a button of the toolbar."""
    button = window.toolbar.widgetForAction(window.actions_by_name[name])
    assert button.isEnabled(), name
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def state_is(window: MainWindow, qtbot: QtBot, state: str) -> None:
    qtbot.waitUntil(lambda: window.running.runner.state == state, timeout=WAIT_MS)


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
    open_program([B("event.started"), broken], variables=("result",))
    block = block_of(window, "variable.set")

    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    state_is(window, qtbot, "idle")

    problem = window.workbench.canvas.problems.problems[block]
    assert "zero" in problem.sentence
    assert any("zero" in card.message.sentence for card in window.message_area.cards)


def test_a_breakpoint_pauses_there_and_a_step_goes_to_the_next_block(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program(
        [
            B("event.started"),
            *(B("control.wait", {"seconds": seconds}) for seconds in (0.01, 0.02, 0.03)),
        ]
    )
    second, third = blocks_of(window, "control.wait")[1:]
    window.running.breakpoints.toggle([second])

    press(window, qtbot, "run")
    state_is(window, qtbot, "paused")
    paused = window.running.stage.marks
    assert set(paused.paused.values()) == {second}

    press(window, qtbot, "step")
    qtbot.waitUntil(lambda: set(paused.paused.values()) == {third}, timeout=WAIT_MS)
    press(window, qtbot, "run")
    state_is(window, qtbot, "idle")


def test_the_counts_of_rules_and_the_values_of_variables_are_on_the_blocks(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program(
        [
            B("event.human_state", {"state": "waved"}),
            B("variable.change", {"variable": "v1", "amount": 1}),
        ],
        variables=("how many",),
    )
    runner, rule = window.running.runner, block_of(window, "event.human_state")
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    marks = window.running.stage.marks

    assert runner.send(m.HUMAN_BEHAVIOR, m.HumanBehavior(human_state="waved"))

    qtbot.waitUntil(lambda: marks.counts[rule] == 1, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: marks.values.get("how_many") == "1", timeout=WAIT_MS)


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


def test_a_node_is_started_and_stopped_by_hand_without_a_program(
    window: MainWindow, karate: MainWindow, qtbot: QtBot
) -> None:
    runner = window.running.runner
    node = next(one for one in runner.planned() if one.name == "karate")

    runner.start_node(node)
    qtbot.waitUntil(lambda: _health(window, "karate") == "ready", timeout=WAIT_MS)
    runner.stop_node("karate")
    qtbot.waitUntil(lambda: _health(window, "karate") == "stopped", timeout=WAIT_MS)

    assert runner.state == "idle"


def _health(window: MainWindow, name: str) -> str:
    status = window.running.runner.board.nodes.get(name)
    return status.health if status is not None else ""


def test_a_frozen_node_is_noticed(window: MainWindow, karate: MainWindow, qtbot: QtBot) -> None:
    runner = window.running.runner
    runner.start_node(next(one for one in runner.planned() if one.name == "karate"))
    qtbot.waitUntil(lambda: _health(window, "karate") == "ready", timeout=WAIT_MS)
    process = psutil.Process(runner.board.nodes["karate"].pid)

    process.suspend()
    try:
        qtbot.waitUntil(lambda: _health(window, "karate") == "frozen", timeout=WAIT_MS)
    finally:
        process.resume()

    qtbot.waitUntil(lambda: _health(window, "karate") == "ready", timeout=WAIT_MS)


def test_a_tap_hears_a_topic_also_after_stop_and_run(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    runner = window.running.runner
    heard: list[float] = []
    tap = runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=window)
    tap.arrived.connect(lambda batch: heard.extend(one.time_s for one in batch))
    open_program([B("event.started"), B("control.wait", {"seconds": 600})])

    for _ in range(2):
        heard.clear()
        press(window, qtbot, "run")
        qtbot.waitUntil(lambda: bool(heard), timeout=WAIT_MS)
        assert abs(heard[0] - time.time()) < 60
        state_is(window, qtbot, "running")
        press(window, qtbot, "stop")
        state_is(window, qtbot, "idle")
    tap.close()


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


def test_pause_and_go_on_by_the_buttons(window: MainWindow, open_program, qtbot: QtBot) -> None:
    open_program(
        [
            B("event.started"),
            B(
                "control.forever",
                bodies={"do": [B("variable.change", {"variable": "v1"}), WAIT_A_LITTLE]},
            ),
        ],
        variables=("turns",),
    )
    press(window, qtbot, "run")
    qtbot.waitUntil(
        lambda: int(window.running.stage.marks.values.get("turns", "0")) > 2, timeout=WAIT_MS
    )

    press(window, qtbot, "pause")
    qtbot.waitUntil(lambda: bool(window.running.stage.marks.paused), timeout=WAIT_MS)
    assert window.running.runner.state == "paused"
    held = window.running.stage.marks.values["turns"]

    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: window.running.stage.marks.values["turns"] != held, timeout=WAIT_MS)
    assert window.running.runner.state == "running"


def test_what_a_sensor_gave_last_is_beside_its_statement(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    sensor = B("robot_senses.sensor")
    open_program(
        [B("event.started"), B("variable.set", {"variable": "v1"}, {"value": sensor}), LONG_WAIT],
        variables=("charge",),
    )

    press(window, qtbot, "run")

    statement = block_of(window, "variable.set")
    stage = window.running.stage
    qtbot.waitUntil(lambda: statement in stage.marks.results, timeout=WAIT_MS)
    assert list(stage.marks.results[statement]) == [block_of(window, "robot_senses.sensor")]
