"""Rules that fire by a robot, a word, a condition, or because nothing happens."""

from __future__ import annotations

import threading
import time

import pytest

from nep_core.errors import RobotError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.actions import action_client
from nep_core.program.behavior import Behavior
from nep_core.program.tasks import current_task, wait, wait_until
from nep_core.wire.states import state_of_word
from tests.nep_core.outside import Outside, seen

pytestmark = pytest.mark.long


class Running:
    """A behaviour that runs in a thread until the end of the test."""

    def __init__(self, behavior: Behavior) -> None:
        started = threading.Event()
        behavior.when_started(started.set)
        self._thread = threading.Thread(target=behavior.run)
        self._thread.start()
        assert started.wait(5)

    def end(self) -> None:
        tasks.PROGRAM.cancel()
        self._thread.join(5)
        assert not self._thread.is_alive()


def test_a_rule_for_one_robot_does_not_fire_for_another(
    outside: Outside, network: PeerNetwork
) -> None:
    behavior, fired = Behavior(network=network), threading.Semaphore(0)
    behavior.when("touched_head", source="NAO")(fired.release)
    running = Running(behavior)

    outside.does("touched_head", source="NAO2")
    seen("touched_head")
    by_other = fired.acquire(timeout=0.2)
    outside.does("touched_head", source="NAO")

    assert not by_other and fired.acquire(timeout=5)
    running.end()


def test_rules_for_words_and_faces_fire(outside: Outside, network: PeerNetwork) -> None:
    behavior, fired = Behavior(network=network), threading.Semaphore(0)
    behavior.when_heard("Good morning!")(fired.release)
    behavior.when_noticed("face", "Anna")(fired.release)
    behavior.when_noticed("mark", 64)(fired.release)
    behavior.when_noticed("sound")(fired.release)
    running = Running(behavior)

    outside.does("heard_good_morning", "seen_face_anna", "seen_mark_64", "heard_sound")

    assert all(fired.acquire(timeout=5) for _ in range(4))
    running.end()


def test_a_rule_fires_each_time_that_its_condition_becomes_true(
    outside: Outside, network: PeerNetwork
) -> None:
    behavior, fired, looked = Behavior(network=network), threading.Semaphore(0), [0]
    near = [True]

    def is_near() -> bool:
        looked[0] += 1
        return near[0]

    behavior.when_true(is_near)(fired.release)
    running = Running(behavior)

    assert fired.acquire(timeout=5)
    assert not fired.acquire(timeout=0.2)  # still near
    near[0] = False
    before = looked[0]
    wait_until(lambda: looked[0] > before + 1)
    near[0] = True
    assert fired.acquire(timeout=5)
    running.end()


def test_a_rule_for_idleness_fires_again_and_again_until_something_happens(
    outside: Outside, network: PeerNetwork
) -> None:
    behavior, fired = Behavior(network=network), threading.Semaphore(0)
    behavior.when_idle(0.3)(fired.release)
    running = Running(behavior)

    assert fired.acquire(timeout=5) and fired.acquire(timeout=5)
    for _ in range(6):
        outside.does("waves")
        wait(0.1)
    while fired.acquire(blocking=False):
        pass
    outside.does("waves")
    assert not fired.acquire(timeout=0.15)
    assert fired.acquire(timeout=5)
    running.end()


def test_a_walk_without_an_end_ends_with_the_program(
    outside: Outside, network: PeerNetwork
) -> None:
    behavior = Behavior(network=network)
    behavior.when_started(lambda: outside.robot.start_walking(50))

    behavior.run()

    wait_until(lambda: "stop" in [action for action, _ in outside.nao.asked])
    assert [action for action, _ in outside.nao.asked] == ["walk_freely", "stop"]


@pytest.mark.parametrize(
    ("answers", "number", "questions"),
    [
        (["7"], 7, 1),
        (["Seven"], 7, 1),
        (["seven apples", "", "zwölf"], 12, 3),
        (["2.5"], 2.5, 1),
        (["-5"], -5, 1),
        (["\u2212 0,5"], -0.5, 1),
        (["minus five"], -5, 1),
        (["1/2", "5-3", "10:30"], None, 3),
        (["1,000", "20 30", "1000"], 1000, 3),
        (["apples", "pears", "plums"], None, 3),
    ],
)
def test_a_wrong_answer_to_a_question_for_a_number_is_asked_again(
    outside: Outside, answers: list[str], number: float | None, questions: int
) -> None:
    left = list(answers)
    is_over = threading.Event()

    def answer() -> None:
        """Say the next answer each time that the robot listens."""
        heard = 0
        while not is_over.wait(0.02):
            listens = [action for action, _ in outside.nao.asked].count("listen")
            if listens > heard and left:
                heard = listens
                if word := left.pop(0):
                    outside.does(state_of_word(word))

    person = threading.Thread(target=answer)
    person.start()
    try:
        if number is None:
            with pytest.raises(RobotError, match="has heard no number"):
                outside.robot.ask_number("How many?", seconds=4)
        else:
            assert outside.robot.ask_number("How many?", seconds=4) == number
    finally:
        is_over.set()
        person.join()

    assert outside.nao.words() == ["How many?"] * questions


def test_a_walk_is_asked_for_again_until_it_ends_and_not_when_nobody_answers(
    outside: Outside, network: PeerNetwork
) -> None:
    outside.nao.end = None
    asked = outside.nao.times_asked
    outside.robot.start_walking(50)
    wait_until(lambda: max(asked.values(), default=0) > 3, 10)
    assert max(asked.values()) > 3

    outside.nao.end = "cancelled"  # as when the robot's own stop button was pressed
    wait(1.5)
    before = dict(asked)
    wait(1.0)

    assert asked == before
    current_task().end_undone()


def test_a_program_that_stood_still_begins_its_walk_anew(
    outside: Outside, network: PeerNetwork
) -> None:
    outside.nao.end = None
    asked = outside.nao.times_asked
    outside.robot.start_walking(50)
    wait_until(lambda: max(asked.values(), default=0) > 2, 10)
    assert [args.get("was_known", False) for _, args in outside.nao.asked] == [False]

    with action_client(network)._renewing:  # nothing is sent meanwhile, as in a busy program
        time.sleep(1.5)

    wait_until(lambda: len(outside.nao.asked) > 1, 10)
    assert [args.get("was_known", False) for _, args in outside.nao.asked] == [False, False]
    current_task().end_undone()
    wait_until(lambda: outside.nao.asked[-1][0] == "stop", 10)
    assert outside.nao.asked[-1][1]["request"] in asked
