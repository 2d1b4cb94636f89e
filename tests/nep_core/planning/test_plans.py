"""Plans in a running program: steps that fail, sensors that disagree, and what is told of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import nep_core
from nep_core.errors import FactNotSo, PlanError, ValueRefused
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import facts, plans, tasks
from nep_core.program.facts import FACTS
from nep_core.wire.messages import PlannedStep, ProgramState
from tests.nep_core.goal_playing import WAIT_S, Join, Scene

HOUSE = '''
from nep_core import fact, makes_true, makes_untrue, needs, now_true, reach, the_plan

log = []
broken = set()


def go(a, b):
    needs("at", "NAO", a)
    needs("door", a, b)
    log.append(f"{a} to {b}")
    if (a, b) in broken:
        raise ValueError("the door is locked")
    makes_untrue("at", "NAO", a)
    makes_true("at", "NAO", b)


def greet(who, room):
    needs("at", "NAO", room)
    needs("in", who, room)
    log.append(f"hello {who}")
    makes_true("greeted", who)


def count_steps(n):
    makes_true("steps", n + 1)


def tidy():
    """Changes no facts."""
    log.append("tidy")


def house():
    now_true("at", "NAO", "hall")
    for a, b in [("hall", "kitchen"), ("hall", "garden"), ("garden", "kitchen")]:
        now_true("door", a, b)
    now_true("in", "Anna", "kitchen")
'''

Program = dict[str, Any]


@pytest.fixture(autouse=True)
def no_facts() -> Iterator[None]:
    tasks.PROGRAM.cancelled.clear()
    FACTS.clear()
    yield
    FACTS.clear()
    plans.tell_by(plans.tell_nobody)


@pytest.fixture
def program(tmp_path: Path) -> Callable[[str], Program]:
    """Runs the lines of a program from a file, and gives its names."""

    def run(more: str = "") -> Program:
        path = tmp_path / "program.py"
        path.write_text(HOUSE + more, encoding="utf-8")
        names: Program = {"__name__": "program"}
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
        names["house"]()
        return names

    return run


GREET = '\n\ndef main():\n    reach(fact("greeted", "Anna"))\n'
SHOW = '\n\ndef main():\n    return the_plan(fact("greeted", "Anna"))\n'


def test_a_plan_is_found_and_followed(program) -> None:
    house = program(GREET)

    house["main"]()

    assert house["log"] == ["hall to kitchen", "hello Anna"]
    assert facts.is_true("greeted", "Anna")
    assert facts.is_true("at", "NAO", "kitchen")
    assert not facts.is_true("at", "NAO", "hall")


def test_a_plan_is_shown_before_it_is_followed(program) -> None:
    house = program(SHOW)

    assert house["main"]() == ["go hall kitchen", "greet Anna kitchen"]
    assert house["log"] == []


def test_after_a_step_that_fails_another_way_is_planned(program) -> None:
    house = program(GREET)
    house["broken"].add(("hall", "kitchen"))

    house["main"]()

    assert house["log"] == [
        *("hall to kitchen", "hall to garden", "garden to kitchen", "hello Anna"),
    ]


def test_a_step_that_fails_is_tried_again_where_there_is_no_other_way(program) -> None:
    house = program(GREET)
    facts.no_longer_true("door", "hall", "garden")
    house["broken"].add(("hall", "kitchen"))

    with pytest.raises(PlanError) as refused:
        house["main"]()

    assert house["log"] == ["hall to kitchen"] * plans.MOST_PLANS
    assert "“go hall kitchen”: the door is locked" in str(refused.value)
    assert isinstance(refused.value.__cause__, ValueError)


def test_what_a_sensor_tells_after_a_step_decides(program, monkeypatch) -> None:
    monkeypatch.setattr(facts, "SETTLE_S", 0.05)
    house = program(GREET)
    tries = []

    def is_heard() -> bool:  # she hears the second greeting only
        return house["log"].count("hello Anna") >= 2

    facts.true_while(is_heard, "greeted", "Anna")
    tries.append(house["main"]())

    assert house["log"] == ["hall to kitchen", "hello Anna", "hello Anna"]


def test_a_step_is_not_begun_when_its_needs_have_gone_meanwhile(program) -> None:
    house = program(GREET)
    states: list[str] = []

    def tell(event: str, goal: str, plan: list[PlannedStep], step: int, fault: object) -> None:
        states.append(event)
        if event == "plan_step" and step == 2 and states.count("plan_made") == 1:
            facts.no_longer_true("at", "NAO", "kitchen")  # somebody carries the robot back
            facts.now_true("at", "NAO", "hall")

    plans.tell_by(tell)
    house["main"]()

    assert house["log"] == ["hall to kitchen", "hall to kitchen", "hello Anna"]
    assert states.count("plan_made") == 2


def test_no_plan_is_an_error_that_names_what_is_missing(program) -> None:
    house = program('\n\ndef main():\n    reach(fact("at", "NAO", "cellar"))\n')

    with pytest.raises(PlanError, match="needs “door … cellar”, which nothing makes true"):
        house["main"]()

    assert house["log"] == []


def test_rules_and_functions_whose_facts_nobody_knows_before_are_no_tasks(program) -> None:
    more = """

class behavior:
    when = staticmethod(lambda state: lambda function: function)


@behavior.when("clap")
def when_clap():
    makes_true("clapped")


def perhaps(a):
    if a:
        makes_true("clapped")


def main():
    reach(fact("clapped"))
"""
    house = program(more)

    known = plans._functions(house)

    assert {task.name for task in known} == {"go", "greet"}  # not count_steps: n + 1 is open
    with pytest.raises(PlanError, match="Nothing makes “clapped” true"):
        house["main"]()


def test_values_of_the_program_stand_in_what_a_task_needs(program) -> None:
    more = """

home = "garden"


def rest():
    needs("at", "NAO", home)
    makes_true("rested", 1, True)


def main():
    reach(fact("rested", 1.0, True))
"""
    house = program(more)

    house["main"]()

    assert house["log"] == ["hall to garden"]
    assert not facts.is_true("rested", True, True)


def test_a_program_is_read_as_it_was_when_it_began(program, tmp_path: Path) -> None:
    house = program(SHOW)
    house["main"]()

    (tmp_path / "program.py").write_text("something else = 1", encoding="utf-8")

    assert house["main"]() == ["go hall kitchen", "greet Anna kitchen"]


def test_facts_without_a_name_or_with_lists_in_them_are_refused() -> None:
    for wrong in ([" "], [3], ["at", [1]], ["at", None], ["at", *range(21)]):
        with pytest.raises(ValueRefused):
            facts.now_true(*wrong)
    with pytest.raises(ValueRefused):
        nep_core.reach()
    with pytest.raises(ValueRefused):
        nep_core.reach("at")


def test_facts_without_end_are_refused(monkeypatch) -> None:
    monkeypatch.setattr(facts, "MOST_FACTS", 5)

    with pytest.raises(ValueRefused):
        for number in range(6):
            facts.now_true("n", number)


def test_what_is_needed_and_not_true_is_an_error(program) -> None:
    house = program()

    with pytest.raises(FactNotSo, match="“at NAO garden” is needed here, but is not true"):
        house["go"]("garden", "kitchen")


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def next_told(scene: Scene, event: str) -> ProgramState:
    for _ in range(50):
        state = scene.told.receive(WAIT_S)
        assert state is not None, event
        if state.event == event:
            return state
    raise AssertionError(event)


def test_a_behaviour_tells_of_its_plan_and_of_the_step_that_runs(scene: Scene, program) -> None:
    house = program(GREET)
    house["broken"].add(("hall", "kitchen"))
    scene.behavior.when("visitor")(house["main"])
    scene.begin()

    scene.does("visitor")
    first, step = next_told(scene, "plan_made"), next_told(scene, "plan_step")
    failed, again = next_told(scene, "plan_step_failed"), next_told(scene, "plan_made")
    done = next_told(scene, "plan_done")

    go = PlannedStep("go", ["NAO"])
    assert (first.rule, [one.task for one in first.plan]) == ("greeted Anna", ["go", "greet"])
    assert first.plan[0] == PlannedStep("go", ["hall", "kitchen"]) != go
    assert (step.step, failed.step) == (1, 1)
    assert "the door is locked" in str(failed.fault.sentence)
    assert len(again.plan) == 3
    assert done.rule == "greeted Anna"


def test_an_error_in_a_plan_is_that_of_the_rule(scene: Scene, program) -> None:
    house = program('\n\ndef main():\n    reach(fact("moon"))\n')
    scene.behavior.when("visitor")(house["main"])
    scene.begin()

    scene.does("visitor")

    told = next_told(scene, "rule_failed")
    assert str(told.fault.sentence) == "Nothing makes “moon” true."
