"""Behaviour trees that run: steps in parts of their own, values, halts, pauses, what is told."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from nep_core.errors import NepError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks, tree
from nep_core.program.behavior import Behavior
from nep_core.program.tasks import CLOCK, Cancelled, Part, stop_rule, wait
from nep_core.program.tree import (
    Check,
    CoolDown,
    Delay,
    Fallback,
    Input,
    Output,
    Parallel,
    Plan,
    Repeat,
    Retry,
    Sequence,
    Step,
    SubTree,
    TimeLimit,
    WhileTrue,
    do_tree,
    fail_step,
    set_tree_value,
    tree_value,
)
from nep_core.wire.messages import PROGRAM_STATE, ProgramState
from nep_core.wire.pubsub import Subscriber

WAIT_S = 5.0


class Scene:
    """Trees, what their steps wrote, the errors of steps, and what was told of the nodes."""

    def __init__(self) -> None:
        self.written: list[str] = []
        self.errors: list[BaseException] = []
        self.told: list[dict[int, str]] = []

    def tree(self, name: str, function: Callable[[], object]) -> None:
        tree.plant(Plan(name, function, self.told.append, self.errors.append))

    def step(self, name: str, seconds: float = 0.0, fails: int = 0) -> None:
        """A step that writes its name, and fails so many times first."""
        left = [fails]

        @Step(name)
        def step() -> None:
            self.written.append(name)
            try:
                wait(seconds)
            except Cancelled:
                self.written.append(f"{name} halted")
                raise
            if left[0]:
                left[0] -= 1
                fail_step()


@pytest.fixture
def scene() -> Iterator[Scene]:
    tasks.PROGRAM.cancelled.clear()
    yield Scene()
    tree._plans.clear()


def test_steps_are_done_in_order_and_the_next_begins_at_once(scene: Scene) -> None:
    def plan() -> None:
        with Sequence():
            for number in range(20):
                scene.step(str(number))

    scene.tree("count", plan)
    begun_s = time.monotonic()

    assert do_tree("count")
    assert scene.written == [str(number) for number in range(20)]
    assert time.monotonic() - begun_s < 20 * tree.PERIOD_S, "it waits for a step to end, not more"


def test_a_fallback_tries_the_next_when_a_step_says_that_it_failed(scene: Scene) -> None:
    def plan() -> None:
        with Fallback():
            scene.step("a", fails=1)
            scene.step("b")
            scene.step("c")

    scene.tree("try", plan)

    assert do_tree("try")
    assert scene.written == ["a", "b"]


def test_an_error_fails_the_step_and_is_told(scene: Scene) -> None:
    def plan() -> None:
        with Fallback():

            @Step("divide")
            def divide() -> None:
                _ = 1 / 0

            scene.step("instead")

    scene.tree("errors", plan)

    assert do_tree("errors")
    assert [type(error) for error in scene.errors] == [ZeroDivisionError]
    assert scene.written == ["instead"]


def test_a_guard_halts_its_step_when_it_becomes_false(scene: Scene) -> None:
    is_true = threading.Event()
    is_true.set()

    def plan() -> None:
        with WhileTrue(is_true.is_set):
            scene.step("walk", 60)

    scene.tree("guard", plan)
    threading.Timer(0.2, is_true.clear).start()

    assert not do_tree("guard")
    assert scene.written == ["walk", "walk halted"]


def test_a_time_limit_halts_and_a_pause_does_not_count(scene: Scene) -> None:
    def plan() -> None:
        with TimeLimit(0.3):
            scene.step("slow", 60)

    scene.tree("limit", plan)
    begun_s = time.monotonic()
    CLOCK.pause()
    threading.Timer(0.4, CLOCK.resume).start()

    assert not do_tree("limit")
    assert scene.written == ["slow", "slow halted"]
    assert time.monotonic() - begun_s >= 0.65


def test_a_paused_program_looks_at_no_tree(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    may_go_on, is_held = threading.Event(), threading.Event()

    def hold() -> None:
        is_held.set()
        may_go_on.wait(WAIT_S)

    monkeypatch.setattr(CLOCK, "hold", hold)
    scene.tree("held", lambda: scene.step("go"))
    part = Part(lambda: do_tree("held"), "rule", tasks.PROGRAM).start()

    assert is_held.wait(WAIT_S)
    assert not scene.written
    may_go_on.set()
    part.join(WAIT_S)
    assert scene.written == ["go"]


def test_retry_and_repeat_count(scene: Scene) -> None:
    def plan() -> None:
        with Sequence():
            with Retry(3):
                scene.step("try", fails=2)
            with Repeat(2):
                scene.step("again")
                scene.step("and more")
            with Repeat(0):
                scene.step("never")
            with Retry(0):
                scene.step("never")

    scene.tree("counts", plan)

    assert not do_tree("counts")
    assert scene.written == ["try"] * 3 + ["again", "and more"] * 2


def test_retry_without_a_limit_goes_on_until_it_succeeds(scene: Scene) -> None:
    def plan() -> None:
        with Retry():
            scene.step("try", fails=12)

    scene.tree("for ever", plan)

    assert do_tree("for ever")
    assert len(scene.written) == 13


def test_a_sequence_that_keeps_its_place_begins_with_the_one_that_failed(scene: Scene) -> None:
    def plan() -> None:
        with Retry(2), Sequence(keeps_place=True):
            scene.step("once")
            scene.step("twice", fails=1)

    scene.tree("keeps", plan)

    assert do_tree("keeps")
    assert scene.written == ["once", "twice", "twice"]


def test_cooling_down_fails_and_a_delay_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [0.0]
    monkeypatch.setattr(CLOCK, "now_s", lambda: now_s[0])
    trunk = tree.Trunk("time", lambda _nodes: None, lambda _error: None)
    token = tree._growing.set(trunk)
    with CoolDown(5) as cooled:
        Check(lambda: True)
    with Delay(5) as delayed:
        Check(lambda: True)
    tree._growing.reset(token)

    assert [cooled.tick(), cooled.tick(), delayed.tick()] == ["succeeded", "failed", "running"]
    now_s[0] = 5.0
    assert [cooled.tick(), delayed.tick(), delayed.tick()] == ["succeeded", "succeeded", "running"]


def test_parallel_is_done_when_enough_are_and_halts_the_others(scene: Scene) -> None:
    def plan() -> None:
        with Parallel(2):
            scene.step("a")
            scene.step("b", 0.1)
            scene.step("c", 60)

    scene.tree("enough", plan)

    assert do_tree("enough")
    assert sorted(scene.written) == ["a", "b", "c", "c halted"]


def test_values_go_into_a_tree_and_out_and_are_its_own(scene: Scene) -> None:
    def go() -> None:
        @Step("go")
        def step() -> None:
            scene.written.append(f"to {tree_value('place')}")
            set_tree_value("seen", tree_value("place") + "!")
            set_tree_value("secret", 1)

    def plan() -> None:
        set_tree_value("goal", "kitchen")
        with SubTree("go"):
            Input("place", lambda: tree_value("goal"))
            Output("seen", "found")

        @Step("tell")
        def tell() -> None:
            scene.written.append(tree_value("found"))
            tree_value("secret")

    scene.tree("go", go)
    scene.tree("main", plan)

    assert not do_tree("main")
    assert scene.written == ["to kitchen", "kitchen!"]
    assert "“secret”" in str(scene.errors[0])


def test_a_tree_in_itself_is_refused(scene: Scene) -> None:
    scene.tree("round", lambda: SubTree("round"))

    with pytest.raises(NepError, match="too deep"):
        do_tree("round")


def test_what_is_not_there_is_told(scene: Scene) -> None:
    with pytest.raises(NepError, match="There is no behaviour tree “nothing”"):
        do_tree("nothing")
    with pytest.raises(NepError, match="outside of a tree"):
        Sequence()
    scene.tree("inputs", lambda: Input("a", lambda: 1))
    with pytest.raises(NepError, match="inside another one"):
        do_tree("inputs")


def test_a_cancelled_rule_halts_its_tree(scene: Scene) -> None:
    scene.tree("long", lambda: scene.step("long", 60))
    part = Part(lambda: do_tree("long"), "rule", tasks.PROGRAM).start()
    while not scene.written:
        part.join(0.01)

    part.task.cancel()
    part.join(WAIT_S)

    assert not part.is_running
    assert scene.written == ["long", "long halted"]


def test_stop_this_rule_in_a_step_ends_the_rule(scene: Scene) -> None:
    scene.tree("stop", lambda: Step("stop")(stop_rule))
    ran = []
    part = Part(lambda: ran.append(do_tree("stop")), "rule", tasks.PROGRAM).start()
    part.join(WAIT_S)

    assert not part.is_running
    assert not ran


def test_the_status_of_each_line_is_told_as_it_changes(scene: Scene) -> None:
    def plan() -> None:
        with Sequence():
            Check(lambda: True)
            Check(lambda: False)

    scene.tree("told", plan)
    first = plan.__code__.co_firstlineno

    do_tree("told")

    lines = {line - first: status for told in scene.told for line, status in told.items()}
    assert lines == {1: "failed", 2: "succeeded", 3: "failed"}


def test_trees_run_with_the_program_or_when_they_are_asked(network: PeerNetwork) -> None:
    tasks.PROGRAM.cancelled.clear()
    behavior, written = Behavior("Trees", network=network), []
    states = Subscriber(PROGRAM_STATE, ProgramState, network=network)

    @behavior.tree("asked")
    def asked() -> None:
        Step("asked")(lambda: written.append("asked"))

    @behavior.tree("start", runs="at_start")
    def start() -> None:
        with Sequence():
            SubTree("asked")
            Step("start")(lambda: written.append("start"))

    behavior.run()

    assert written == ["asked", "start"]
    last: dict[str, str] = {}
    while (state := states.receive(0.2)) is not None:
        if state.event == "tree":
            assert state.rule == "start"
            last |= state.nodes
    assert list(last.values()) == ["succeeded"] * 4


def test_a_tree_that_always_runs_remembers_what_cools_down(network: PeerNetwork) -> None:
    tasks.PROGRAM.cancelled.clear()
    behavior, written = Behavior("Trees", network=network), []

    @behavior.tree("always", runs="always")
    def always() -> None:
        with Fallback():
            with CoolDown(60):
                Step("once")(lambda: written.append("once"))
            Step("often")(lambda: written.append("often"))

    running = threading.Thread(target=behavior.run)
    running.start()
    deadline_s = time.monotonic() + WAIT_S
    while len(written) < 4 and time.monotonic() < deadline_s:
        time.sleep(0.01)
    tasks.PROGRAM.cancel()
    running.join(WAIT_S)

    assert written[:4] == ["once", "often", "often", "often"]
    assert written.count("once") == 1


def test_what_is_as_it_was_at_the_look_before_is_told_once(network: PeerNetwork) -> None:
    tasks.PROGRAM.cancelled.clear()
    behavior, looks = Behavior("Trees", network=network), []
    states = Subscriber(PROGRAM_STATE, ProgramState, network=network)

    def is_there() -> bool:
        looks.append("asked")
        return len(looks) > 5

    @behavior.tree("always", runs="always")
    def always() -> None:
        Check(is_there)
        Step("greet")(tasks.PROGRAM.cancel)

    with contextlib.suppress(tasks.Cancelled):
        behavior.run()

    told = []
    while (state := states.receive(0.2)) is not None:
        told += [status for status in state.nodes.values() if state.event == "tree"]
    assert told.count("failed") == 1
    assert len(looks) > 5
