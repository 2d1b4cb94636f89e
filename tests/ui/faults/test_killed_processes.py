"""Each process of a run is killed in turn: it is told once, in a sentence, and the show goes on."""

from __future__ import annotations

import signal

import pytest

from nep_core.wire import messages as m
from tests.ui.faults.conftest import Scene

pytestmark = pytest.mark.long

FIRST, ANSWER = "Show me a karate chop!", "Impressive!"
AGAIN = "The program ended unexpectedly and begins again"
NO_NETWORK = "The network ended unexpectedly"


def test_nodes_killed_in_turn_are_each_told_once_and_the_program_goes_on(stage: Scene) -> None:
    stage.run()
    stage.until(lambda: FIRST in stage.said)
    sentence = stage.results("started")[-1]
    assert sentence not in stage.results("done")
    log = stage.runner.log_file("karate")
    before = log.read_bytes()

    for name in ("NAO", "karate", "watch"):  # the robot in the middle of its sentence
        pid = stage.kill(name)
        stage.until(stage.is_back(name, pid))
    stage.until(lambda: ANSWER in stage.said)

    titles = [alarm.title for alarm in stage.alarms]
    assert titles == [
        f"“{name}” ended unexpectedly and is started again" for name in ("NAO", "karate", "watch")
    ]
    assert all("was killed" in str(one.sentence) and one.checklist for one in stage.alarms)
    assert not set(titles) & set(stage.shown)
    assert sentence in stage.results("done")
    assert stage.said[:2] == [FIRST, ANSWER]
    assert log.read_bytes().startswith(before)
    assert b"--- started again at" in log.read_bytes()


def test_a_killed_program_begins_again_and_its_counts_with_it(stage: Scene) -> None:
    stage.run()
    stage.until(lambda: FIRST in stage.said)
    marks = stage.window.running.stage.marks
    stage.runner.send(m.HUMAN_BEHAVIOR, m.HumanBehavior(human_state="gesture_karate"))
    stage.until(lambda: marks.counts.total() == 1)

    stage.kill("program")
    stage.until(lambda: stage.said.count(FIRST) == 2)

    [alarm] = stage.alarms
    assert alarm.title == AGAIN
    assert alarm.checklist
    assert stage.runner.state == "running"
    assert marks.counts.total() == 0
    stage.until(lambda: stage.results("cancelled"))  # what the one before it had asked for


def test_the_button_of_a_killed_program_stops_it(stage: Scene) -> None:
    stage.run()
    stage.until(lambda: FIRST in stage.said)
    stage.kill("program")
    stage.until(lambda: AGAIN in stage.shown)

    stage.press_answer(AGAIN, "Stop")

    stage.state_is("idle")
    assert [alarm.title for alarm in stage.alarms] == [AGAIN]


def test_a_killed_master_comes_back_and_nobody_misses_anything(stage: Scene) -> None:
    stage.run()
    stage.until(lambda: FIRST in stage.said)

    stage.signal_master(signal.SIGKILL)
    stage.until(lambda: "The network is open again" in stage.shown)
    stage.until(lambda: ANSWER in stage.said)

    [alarm] = stage.alarms
    assert alarm.title == "The network ended unexpectedly and is opened again"
    assert alarm.checklist
    assert "master" not in stage.runner.board.nodes


def test_a_master_that_is_gone_is_started_by_its_button_or_by_run(stage: Scene) -> None:
    stage.runner.open_network()
    stage.until(lambda: stage.runner.is_connected)
    stage.signal_master(signal.SIGTERM)
    stage.until(lambda: NO_NETWORK in stage.shown)

    stage.press_answer(NO_NETWORK, "Start it again")
    stage.until(lambda: stage.local.has_master)
    stage.signal_master(signal.SIGTERM)
    stage.until(lambda: NO_NETWORK in stage.shown)
    stage.run()

    stage.until(lambda: FIRST in stage.said)
    assert NO_NETWORK not in stage.shown
    assert [alarm.title for alarm in stage.alarms] == [NO_NETWORK] * 2


def test_the_end_of_a_run_is_told_in_one_message(stage: Scene) -> None:
    """The nodes that end with it say nothing of their own."""
    stage.run()
    stage.until(lambda: FIRST in stage.said)

    stage.runner.send(m.PROGRAM_CONTROL, m.ProgramControl(command="stop"))
    stage.state_is("idle")
    stage.until(lambda: "The program has ended." in stage.shown)
    stage.until(lambda: stage.runner.board.nodes["NAO"].health == "stopped")

    told = [one.title for one in stage.told if not one.title.startswith("The program runs")]
    assert told == ["The program has ended."]
