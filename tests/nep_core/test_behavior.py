"""Behaviours: rules fire, repeat as they are told, run side by side, end and fail."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import human, tasks
from nep_core.program.behavior import Again, Behavior
from nep_core.program.human import human_state
from nep_core.program.tasks import Cancelled, stop_program, wait, wait_until
from nep_core.wire.messages import HUMAN_BEHAVIOR, PROGRAM_STATE, HumanBehavior, ProgramState
from nep_core.wire.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]


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


def test_an_error_in_a_rule_ends_the_program_with_that_error(
    person: Person, run: Callable[[Behavior], Running]
) -> None:
    behavior = Behavior()

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
