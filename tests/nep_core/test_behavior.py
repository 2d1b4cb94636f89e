"""Behaviours: rules fire, repeat as they are told, run side by side, end and fail."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import human, tasks
from nep_core.program.behavior import Again, Behavior, one_of
from nep_core.program.human import human_state
from nep_core.program.tasks import (
    Cancelled,
    stop_program,
    stop_rule,
    together,
    wait,
    wait_until,
)
from nep_core.wire.messages import HUMAN_BEHAVIOR, PROGRAM_STATE, HumanBehavior, ProgramState
from nep_core.wire.pubsub import Publisher, Subscriber

pytestmark = pytest.mark.long

Join = Callable[[str], PeerNetwork]
WAIT_S = 20.0


class Person:
    """Someone whose gestures are recognised."""

    def __init__(self, network: PeerNetwork) -> None:
        self._states = Publisher(HUMAN_BEHAVIOR, network=network)

    def does(self, state: str) -> None:
        self._states.send(HumanBehavior(human_state=state))


class Running:
    """A behaviour that runs in a thread."""

    def __init__(self, behavior: Behavior, network: PeerNetwork) -> None:
        self.error: BaseException | None = None
        self.thread = threading.Thread(target=self._run, args=(behavior,))
        self.thread.start()
        self.states = Subscriber(PROGRAM_STATE, ProgramState, network=network)

    def _run(self, behavior: Behavior) -> None:
        try:
            behavior.run()
        except BaseException as error:
            self.error = error

    def stop(self) -> None:
        tasks.PROGRAM.cancel()
        self.thread.join(5)
        assert not self.thread.is_alive()


@pytest.fixture
def person(join: Join, network: PeerNetwork) -> Person:
    human.human_listener(network)
    return Person(join("gesture"))


@pytest.fixture
def run(network: PeerNetwork) -> Iterator[Callable[[Behavior], Running]]:
    running: list[Running] = []

    def start(behavior: Behavior) -> Running:
        started = threading.Event()
        behavior.when_started(started.set)
        running.append(Running(behavior, network))
        assert started.wait(5)
        return running[-1]

    yield start
    for behavior in running:
        behavior.stop()


def test_a_rule_fires_each_time_and_only_for_its_state(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    behavior.when("gesture_karate")(lambda: None)
    running = run(behavior)

    for _ in range(3):
        person.does("gesture_karate")
        events = [state.event for state in (running.states.receive(5) for _ in range(2)) if state]
        assert events == ["rule_started", "rule_finished"]
    person.does("gesture_katana")

    assert running.states.receive(0.1) is None


@pytest.mark.parametrize(("again", "runs"), [("ignore", 1), ("queue", 3), ("restart", 3)])
def test_a_rule_that_fires_while_it_runs(
    person: Person, run: Callable[[Behavior], Running], again: Again, runs: int
) -> None:
    behavior = Behavior()
    begun, go_on, finished = threading.Semaphore(0), threading.Event(), threading.Semaphore(0)
    seen = threading.Semaphore(0)

    @behavior.when("gesture_karate", again=again)
    def rule() -> None:
        begun.release()
        wait_until(go_on.is_set)
        finished.release()

    behavior.when("gesture_karate", again="queue")(seen.release)
    run(behavior)

    person.does("gesture_karate")
    assert begun.acquire(timeout=5)
    for _ in range(2):
        person.does("gesture_karate")
        if again == "restart":
            assert begun.acquire(timeout=5)
    for _ in range(3):
        assert seen.acquire(timeout=5)
    go_on.set()

    expected = 1 if again == "restart" else runs
    for _ in range(expected):
        assert finished.acquire(timeout=5)
    assert not finished.acquire(timeout=0.2)


def test_a_rule_that_is_started_again_runs_once_at_a_time(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    begun, at_once, most = threading.Semaphore(0), [0], [0]

    @behavior.when("gesture_karate", again="restart")
    def rule() -> None:
        at_once[0] += 1
        most[0] = max(most[0], at_once[0])
        begun.release()
        with contextlib.suppress(Cancelled):  # it ends well although it was cancelled
            wait(0.2)
        at_once[0] -= 1

    run(behavior)

    for _ in range(4):
        person.does("gesture_karate")
        assert begun.acquire(timeout=5)

    assert most[0] == 1


def test_what_the_person_does_before_the_rules_listen_is_not_lost(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    person.does("gesture_karate")
    wait_until(lambda: human_state() == "gesture_karate")
    behavior = Behavior()
    fired = threading.Event()
    behavior.when("gesture_karate")(fired.set)

    run(behavior)

    assert fired.wait(5)


def test_an_error_is_not_lost_when_its_thread_starts_late(
    network: PeerNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = threading.Thread.start

    def start_late(thread: threading.Thread) -> None:
        if thread.name.startswith("nep-start"):
            threading.Event().wait(0.1)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", start_late)
    behavior = Behavior()

    @behavior.when_started
    def fail() -> None:
        raise ValueError("at the start")

    with pytest.raises(ValueError, match="at the start"):
        behavior.run()


def test_two_rules_run_side_by_side(person: Person, run: Callable[[Behavior], Running]) -> None:
    behavior = Behavior()
    meet = threading.Barrier(3)
    behavior.when("a")(lambda: meet.wait(5))
    behavior.when("b")(lambda: meet.wait(5))
    run(behavior)

    person.does("a")
    person.does("b")

    meet.wait(5)


def test_an_error_in_a_rule_ends_the_program_where_that_is_wanted(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior(on_error="end")

    @behavior.when("gesture_karate")
    def rule() -> None:
        raise ZeroDivisionError("a rule divides by zero")

    running = run(behavior)
    person.does("gesture_karate")
    running.thread.join(5)

    assert isinstance(running.error, ZeroDivisionError)


def test_a_behavior_without_rules_ends_when_its_starts_are_done(network: PeerNetwork) -> None:
    behavior = Behavior()
    done: list[str] = []
    behavior.when_started(lambda: done.append("one"))
    behavior.when_started(lambda: done.append("two"))

    behavior.run()

    assert sorted(done) == ["one", "two"]


def test_stop_program_ends_everything_at_its_next_wait(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    ended = threading.Event()

    @behavior.when_started
    def sleeper() -> None:
        try:
            wait(60)
        except Cancelled:
            ended.set()
            raise

    behavior.when("gesture_karate")(stop_program)
    running = run(behavior)
    person.does("gesture_karate")
    running.thread.join(5)

    assert ended.is_set()
    assert running.error is None


def test_rules_are_told_on_the_program_state(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior("Karate")
    behavior.when("gesture_karate")(lambda: None)
    running = run(behavior)

    person.does("gesture_karate")

    first, second = running.states.receive(5), running.states.receive(5)
    assert first is not None and second is not None
    assert (first.program, first.event, first.rule) == ("Karate", "rule_started", "gesture_karate")
    assert second.event == "rule_finished"


def test_the_human_state_is_forgotten_after_a_while(
    person: Person, network: PeerNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    person.does("happy")
    wait_until(lambda: human_state() == "happy")

    monkeypatch.setattr(human, "REMEMBER_S", 0.0)

    assert human_state() == ""


# What rules do to each other: errors, starting again, queues, ending early.


def until(running: Running, event: str) -> ProgramState:
    """The next state of this event."""
    while (state := running.states.receive(WAIT_S)) is not None:
        if state.event == event:
            return state
    raise AssertionError(event)


def test_an_error_in_a_rule_is_told_and_the_others_go_on(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    rounds = threading.Semaphore(0)

    @behavior.when("gesture_karate")
    def rule() -> None:
        raise ZeroDivisionError("a rule divides by zero")

    behavior.when("wave")(rounds.release)
    running = run(behavior)
    person.does("gesture_karate")

    failed = until(running, "rule_failed")
    assert failed.rule == "gesture_karate"
    assert "divides by zero" in str(failed.fault.sentence)
    person.does("wave")
    assert rounds.acquire(timeout=WAIT_S)
    person.does("gesture_karate")
    assert until(running, "rule_failed").rule == "gesture_karate"
    running.stop()
    assert running.error is None


def test_a_program_without_rules_ends_with_the_error_of_its_start(network: PeerNetwork) -> None:
    behavior = Behavior()
    done = threading.Event()

    @behavior.when_started
    def fail() -> None:
        raise ValueError("at the start")

    behavior.when_started(lambda: (wait(0.2), done.set()))

    with pytest.raises(ValueError, match="at the start"):
        behavior.run()
    assert done.is_set()


def test_an_error_in_a_goal_ends_that_goal_and_others_follow(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    given_up, reached = threading.Event(), threading.Event()

    @behavior.goal("greet", when="seen_face")
    def greet() -> None:
        raise ValueError("no words")

    behavior.goal("wave", when="wave")(reached.set)
    behavior.when_goal("greet", "stopped")(given_up.set)
    running = run(behavior)
    person.does("seen_face")

    assert until(running, "rule_failed").rule == "greet"
    assert given_up.wait(WAIT_S)
    person.does("wave")
    assert reached.wait(WAIT_S)


def test_a_condition_that_fails_is_told_once(run: Callable[[Behavior], Running]) -> None:
    behavior = Behavior()
    behavior.when_true(lambda: [][0])(lambda: None)
    running = run(behavior)

    assert until(running, "rule_failed").event == "rule_failed"
    assert running.states.receive(0.3) is None


def test_a_rule_that_never_waits_is_started_again(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    begun, running_now = threading.Semaphore(0), [0]
    is_over = threading.Event()  # what stops a program ends its process, and here its thread not

    @behavior.when("gesture_karate", again="restart")
    def rule() -> None:
        begun.release()
        running_now[0] += 1
        try:
            number = 0
            while not is_over.is_set():
                number += 1
        finally:
            running_now[0] -= 1

    running = run(behavior)
    for _ in range(3):
        person.does("gesture_karate")
        assert begun.acquire(timeout=WAIT_S)

    assert running_now[0] == 1
    is_over.set()
    running.stop()


def test_a_rule_that_swallows_every_error_is_started_again_all_the_same(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    begun, is_over = threading.Semaphore(0), threading.Event()

    @behavior.when("gesture_karate", again="restart")
    def rule() -> None:
        begun.release()
        while not is_over.is_set():
            with contextlib.suppress(BaseException):
                while not is_over.is_set():
                    sum(range(100))

    run(behavior)
    person.does("gesture_karate")
    assert begun.acquire(timeout=WAIT_S)
    person.does("gesture_karate")
    assert begun.acquire(timeout=WAIT_S + tasks.GIVEN_UP_S)
    is_over.set()


def test_a_queue_keeps_what_comes_and_tells_what_it_cannot_keep(
    person: Person, run: Callable[[Behavior], Running], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.program.behavior.MOST_QUEUED", 100)
    behavior = Behavior()
    go_on, rounds, heard = threading.Event(), [0], threading.Semaphore(0)

    @behavior.when("gesture_karate", again="queue")
    def rule() -> None:
        rounds[0] += 1
        wait_until(go_on.is_set)

    behavior.when("last")(heard.release)
    running = run(behavior)
    for _ in range(131):
        person.does("gesture_karate")
    person.does("last")
    assert heard.acquire(timeout=WAIT_S)

    warning = until(running, "warning")
    assert warning.fault.code == "queue_full"
    counts = [warning.fault.sentence.values["count"]]
    go_on.set()
    wait_until(lambda: rounds[0] >= 101, WAIT_S)
    running.stop()
    while (state := running.states.receive(0.1)) is not None:
        counts += [state.fault.sentence.values["count"]] if state.event == "warning" else []
    assert (rounds[0], sum(map(int, counts))) == (101, 30)


def test_stopping_the_rule_in_its_parts_ends_all_of_it(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()
    diary: list[str] = []

    def own_block() -> None:
        stop_rule()

    @behavior.when("gesture_karate")
    def rule() -> None:
        diary.append("begins")
        try:
            together(lambda: one_of(own_block), lambda: wait(60))
        except Exception:
            diary.append("no pupil sees it")
        diary.append("goes on")

    running = run(behavior)
    for _ in range(2):
        person.does("gesture_karate")
        until(running, "rule_finished")

    assert diary == ["begins", "begins"]
    running.stop()
    assert running.error is None
