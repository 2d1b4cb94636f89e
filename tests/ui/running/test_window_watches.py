"""The window watches a running program and its nodes: pauses, steps, values, taps."""

from __future__ import annotations

import time

import psutil
import pytest
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.running.window_use import (
    LONG_WAIT,
    WAIT_A_LITTLE,
    WAIT_MS,
    block_of,
    blocks_of,
    health,
    press,
    state_is,
)

pytestmark = pytest.mark.long


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
    qtbot.waitUntil(lambda: marks.values.get("program.how_many") == "1", timeout=WAIT_MS)


def test_a_node_is_started_and_stopped_by_hand_without_a_program(
    window: MainWindow, karate: MainWindow, qtbot: QtBot
) -> None:
    runner = window.running.runner
    node = next(one for one in runner.planned() if one.name == "karate")

    runner.start_node(node)
    qtbot.waitUntil(lambda: health(window, "karate") == "ready", timeout=WAIT_MS)
    runner.stop_node("karate")
    qtbot.waitUntil(lambda: health(window, "karate") == "stopped", timeout=WAIT_MS)

    assert runner.state == "idle"


def test_a_frozen_node_is_noticed(window: MainWindow, karate: MainWindow, qtbot: QtBot) -> None:
    runner = window.running.runner
    runner.start_node(next(one for one in runner.planned() if one.name == "karate"))
    qtbot.waitUntil(lambda: health(window, "karate") == "ready", timeout=WAIT_MS)
    process = psutil.Process(runner.board.nodes["karate"].pid)

    process.suspend()
    try:
        qtbot.waitUntil(lambda: health(window, "karate") == "frozen", timeout=WAIT_MS)
    finally:
        process.resume()

    qtbot.waitUntil(lambda: health(window, "karate") == "ready", timeout=WAIT_MS)


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
        lambda: int(window.running.stage.marks.values.get("program.turns", "0")) > 2,
        timeout=WAIT_MS,
    )

    press(window, qtbot, "pause")
    qtbot.waitUntil(lambda: bool(window.running.stage.marks.paused), timeout=WAIT_MS)
    assert window.running.runner.state == "paused"
    held = window.running.stage.marks.values["program.turns"]

    press(window, qtbot, "run")
    qtbot.waitUntil(
        lambda: window.running.stage.marks.values["program.turns"] != held, timeout=WAIT_MS
    )
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
