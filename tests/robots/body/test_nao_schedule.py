from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robots.body.actions import Turn
from robots.body.limbs import Limb
from robots.body.schedule import Command, Schedule

NOTHING = Turn(0.0)


def command(id: str, *limbs: Limb, priority: int = 0) -> Command:
    return Command(id, NOTHING, frozenset(limbs), priority)


def started(schedule: Schedule) -> list[str]:
    return [command.id for command in schedule.start_ready()]


def test_commands_on_different_limbs_run_together() -> None:
    schedule = Schedule()
    schedule.add(command("talk", Limb.VOICE))
    schedule.add(command("walk", Limb.LEGS))

    assert started(schedule) == ["talk", "walk"]


def test_a_command_on_a_limb_in_use_waits_until_it_is_free() -> None:
    schedule = Schedule()
    schedule.add(command("first", Limb.HEAD))
    schedule.add(command("second", Limb.HEAD))

    assert started(schedule) == ["first"]
    assert started(schedule) == []
    schedule.end("first")
    assert started(schedule) == ["second"]


def test_a_higher_priority_goes_first_and_equals_go_by_time() -> None:
    schedule = Schedule()
    for id, priority in (("now", 0), ("a", 0), ("b", 0), ("urgent", 5)):
        schedule.add(command(id, Limb.LEGS, priority=priority))
    order = []

    while schedule.waiting:
        order += started(schedule)
        schedule.end(order[-1])

    assert order == ["urgent", "now", "a", "b"]


def test_a_command_that_waits_for_two_limbs_is_not_overtaken() -> None:
    schedule = Schedule()
    schedule.add(command("left", Limb.LEFT_ARM))
    schedule.add(command("both", Limb.LEFT_ARM, Limb.RIGHT_ARM))
    schedule.add(command("right", Limb.RIGHT_ARM))

    assert started(schedule) == ["left"]


limbs = st.sets(st.sampled_from(list(Limb)), min_size=1)
steps = st.lists(
    st.one_of(
        st.tuples(st.just("add"), limbs, st.integers(-2, 2)),
        st.tuples(st.just("end"), st.integers(0, 20), st.none()),
    ),
    max_size=40,
)


@given(steps)
def test_no_limb_ever_does_two_things_and_every_command_has_its_turn(steps: list) -> None:
    schedule = Schedule()
    added, ran = [], []

    def start() -> None:
        ran.extend(started(schedule))
        taken = [limb for one in schedule.running for limb in one.limbs]
        assert len(taken) == len(set(taken))

    for kind, what, priority in steps:
        if kind == "add":
            added.append(str(len(added)))
            schedule.add(command(added[-1], *what, priority=priority))
        elif schedule.running:
            schedule.end(schedule.running[what % len(schedule.running)].id)
        start()
    while schedule.running:
        schedule.end(schedule.running[0].id)
        start()

    assert sorted(ran) == sorted(added)
