"""What a program knows of its robots and of people: sensors, questions, memory, choices."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time

import pytest

from nep_core import errors
from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import human
from nep_core.program import robot as robot_states
from nep_core.program.behavior import in_turn, one_of
from nep_core.program.human import (
    heard_answer,
    heard_word,
    human_listener,
    is_remembered,
    remember,
    times_seen,
    until_state,
    was_seen,
)
from nep_core.program.robot import robot_listener
from nep_core.program.tasks import together, wait, wait_until
from nep_core.wire.states import NOT_UNDERSTOOD as UNCLEAR
from tests.conftest import PROJECT
from tests.nep_core.outside import Outside, seen


def test_sensors_are_told_in_units_that_people_use(outside: Outside) -> None:
    outside.robot_is(sensors={"sonar_left": 0.25, "foot_left": 2.6}, battery=0.5)

    robot = outside.robot

    assert robot.sensor("sonar_left") == 25.0
    assert robot.sensor("foot_left") == 2.6
    assert robot.sensor("battery") == 50.0


def test_what_a_robot_does_and_sees_can_be_asked(outside: Outside) -> None:
    outside.robot_is(
        posture="SitRelax",
        saying="Hello",
        sensors={"head_rear": 1.0},
        sees={"face": (1.5, 1.5, 0.4), "face_anna_b": (1.5, 1.5, 0.4), "mark_64": (1, 0, 0)},
        settings={"volume": 40.0, "language": "de", "awake": True},
    )
    robot = outside.robot

    assert robot.is_in("posture_sit_relax") and not robot.is_in("posture_sit")
    assert robot.is_doing("speaking") and robot.is_doing("awake") and not robot.is_doing("moving")
    assert robot.is_touched("head") and not robot.is_touched("head_front")
    assert robot.sees("face", "Anna B.") and robot.sees("mark", 64) and not robot.sees("ball")
    assert robot.seen_name("face") == "anna b" and robot.seen_name("mark") == "64"
    assert robot.place_of("face", "left") == 45.0 and robot.place_of("ball") == -1
    assert robot.person_is("far") and not robot.person_is("close")
    assert (robot.volume(), robot.language()) == (40.0, "de")


def test_a_robot_that_tells_nothing_about_itself_does_not_answer(
    outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robot_states, "FIRST_STATE_S", 0.1)

    with pytest.raises(errors.RobotNotAnswering):
        outside.robot.sensor("battery")


def test_a_state_is_read_that_is_newer_than_what_was_done(outside: Outside) -> None:
    outside.robot_is(settings={"volume": 10.0})
    assert outside.robot.volume() == 10.0
    later = threading.Timer(0.2, lambda: outside.robot_is(settings={"volume": 80.0}))

    outside.robot.set_volume(80)
    later.start()

    assert outside.robot.volume() == 80.0


def test_a_state_is_read_that_is_newer_than_what_the_robot_told_of_the_person(
    outside: Outside,
) -> None:
    outside.robot_is(sees={})
    assert not outside.robot.sees("face")
    later = threading.Timer(0.2, lambda: outside.robot_is(sees={"face": (1.0, 0.0, 0.0)}))

    outside.does("seen_face_now", source="NAO")
    seen("seen_face_now")
    later.start()

    assert outside.robot.place_of("face") == 100.0


def once_it_listens(outside: Outside, *states: str, source: str = "") -> None:
    """Let the person do something as soon as the robot listens for an answer."""

    def answer() -> None:
        wait_until(lambda: "listen" in [action for action, _ in outside.nao.asked])
        outside.does(*states, source=source)

    threading.Thread(target=answer).start()


def test_a_question_is_answered_by_a_word_that_counts(outside: Outside) -> None:
    once_it_listens(outside, "gesture_karate", "heard_of_course")

    word = outside.robot.ask("Do you like it?", ["No", "Of course!"], 5)

    assert word == heard_answer() == "Of course!"
    assert outside.nao.words() == ["Do you like it?"]


@pytest.mark.parametrize("source", ["", "NAO", "an ear of somebody's own"])
@pytest.mark.parametrize(("state", "told"), [("heard_of_course", "of course"), (UNCLEAR, "")])
def test_another_answer_ends_the_question_at_once(
    outside: Outside, state: str, told: str, source: str
) -> None:
    outside.robot_is()
    once_it_listens(outside, "gesture_karate", state, source=source)
    begun_s = time.monotonic()

    word = outside.robot.ask("Do you like it?", ["Yes", "No"], 60)

    assert word == heard_answer() == told
    assert time.monotonic() - begun_s < 20


def test_a_noise_and_what_others_hear_or_are_told_are_no_other_answer(outside: Outside) -> None:
    outside.robot_is(name="NAO2")
    wait_until(lambda: robot_listener(outside.network).heard_of("NAO2") is not None)
    human_listener(outside.network).of_rules = frozenset({"heard_help"})
    once_it_listens(outside, "heard_sound", "heard_help")
    once_it_listens(outside, "heard_maybe", UNCLEAR, source="NAO2")

    assert outside.robot.ask("Do you like it?", ["Yes", "No"], 0.5) == heard_answer() == ""


def test_a_robot_does_not_answer_itself_while_it_talks(outside: Outside) -> None:
    outside.robot_is(saying="What a nice day")
    robots = robot_listener(outside.network)
    wait_until(lambda: getattr(robots.heard_of("NAO"), "saying", "") != "")
    once_it_listens(outside, "heard_a_nice_day", UNCLEAR, source="NAO")

    assert outside.robot.ask("Do you like it?", ["Yes", "No"], 0.5) == ""


def test_an_answer_to_another_robot_that_asks_is_not_taken_away(outside: Outside) -> None:
    outside.robot_is(name="NAO2", listening=["Yes"])
    wait_until(lambda: robot_listener(outside.network).heard_of("NAO2") is not None)
    once_it_listens(outside, "heard_yes", source="NAO2")

    assert outside.robot.ask("Do you like it?", ["Yes", "No"], 0.5) == ""


def test_a_question_for_any_word_waits_for_one_that_is_understood(outside: Outside) -> None:
    once_it_listens(outside, UNCLEAR, "heard_sound", "heard_anna")

    assert outside.robot.ask("Who are you?", seconds=5) == heard_answer() == "anna"


def test_the_answer_is_that_to_the_last_question_of_each_part(outside: Outside) -> None:
    once_it_listens(outside, "heard_yes")
    outside.robot.ask("Do you like it?", ["Yes", "No"], 5)
    found = []

    together(lambda: found.append(heard_answer()), lambda: outside.robot.ask("Hm?", ["Yes"], 0.1))
    found.append(heard_answer())
    outside.robot.ask("Really?", ["Yes"], 0.1)
    found.append(heard_answer())

    assert found == ["Yes", "Yes", ""]


def test_a_question_without_words_takes_any_answer(outside: Outside) -> None:
    def answer() -> None:
        wait_until(lambda: "listen" in [action for action, _ in outside.nao.asked])
        outside.does("heard_good_morning", "heard_sound")

    threading.Thread(target=answer).start()

    assert outside.robot.ask("Hello?", seconds=5) == "good morning"
    seen("heard_sound")
    assert heard_word() == "good morning"


def test_a_question_without_an_answer_ends_in_time(outside: Outside) -> None:
    outside.does("heard_yes")  # before it was asked
    seen("heard_yes")

    assert outside.robot.ask("Really?", ["yes"], seconds=0.2) == ""
    assert outside.robot.wait_for_word("yes", seconds=0.1) == ""


def test_states_are_remembered_with_time_and_number(
    outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    outside.does("touched_head", "touched_head")
    seen("touched_head", 2)

    assert was_seen("touched_head", 60) and not was_seen("touched_hand", 60)
    assert times_seen("touched_head") == 2 and times_seen("touched_hand") == 0
    wait(0.05)
    assert not was_seen("touched_head", 0.01)


def test_something_is_remembered_as_long_as_asked(outside: Outside) -> None:
    remember("friend", 60)
    remember("stranger", 0)

    assert is_remembered("friend") and not is_remembered("stranger")
    assert not is_remembered("nobody")


def test_the_oldest_states_are_forgotten(outside: Outside, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(human, "MOST_STATES", 3)

    outside.does("a", "b", "a", "c", "d")
    seen("d")

    assert [times_seen(state) for state in "abcd"] == [2, 0, 1, 1]


def test_repeating_ends_when_the_state_comes(outside: Outside) -> None:
    outside.does("touched_head")  # before it began
    seen("touched_head")
    turns = []

    for turn in until_state("touched_head", 50):
        turns.append(turn)
        if turn == 3:
            outside.does("touched_head")
            seen("touched_head", 2)

    assert turns == [1, 2, 3]
    assert list(until_state("never", 4)) == [1, 2, 3, 4]


def test_one_of_several_is_done_by_chance_and_each_in_turn() -> None:
    done: list[str] = []
    for _ in range(200):
        one_of(lambda: done.append("a"), lambda: done.append("b"))
    by_chance = set(done)
    done.clear()

    for _ in range(5):
        in_turn(lambda: done.append("a"), lambda: done.append("b"))
        in_turn(lambda: done.append("1"), lambda: done.append("2"), lambda: done.append("3"))

    assert by_chance == {"a", "b"}
    assert "".join(done) == "a1b2a3b1a2"


SET_BACK = """
import time

offset_s, real = [0.0], time.time
time.time = lambda: real() + offset_s[0]

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.zmq_networks import PeerNetwork
from tests.nep_core.outside import Outside

program, world = PeerNetwork("program"), PeerNetwork("world")
outside = Outside(program, world)


def asked_ms():
    outside.robot.say("hello")
    outside.robot_is(sensors={"sonar_left": 1.0})
    begun_s = time.monotonic()
    assert outside.robot.sensor("sonar_left") == 100.0
    return 1000 * (time.monotonic() - begun_s)


asked_ms()
before = sorted(asked_ms() for _ in range(5))[2]
offset_s[0] = -3600.0
after = sorted(asked_ms() for _ in range(5))[2]
print(before, after)
program.close()
world.close()
"""


def test_a_clock_that_is_set_back_makes_no_sensor_slower(network: PeerNetwork) -> None:
    environment = {**os.environ, MASTER_VARIABLE: network.master, "PYTHONPATH": str(PROJECT)}

    run = subprocess.run(
        [sys.executable, "-c", SET_BACK], capture_output=True, text=True, env=environment
    )

    assert run.returncode == 0, run.stderr
    _before_ms, after_ms = map(float, run.stdout.split())
    assert after_ms < 500.0
