"""What is more important takes the limbs that it needs, and only those, at once."""

from __future__ import annotations

import math

import pytest

from robots.body.actions import Turn, Walk
from robots.body.actor import DISPLACED, KEPT_S, rest_of_way
from robots.body.limbs import Limb
from robots.body.schedule import Command, Schedule
from tests.robots.body.nao_stage import Stage

LOW, NORMAL, HIGH = -1, 0, 1


def command(id: str, *limbs: Limb, priority: int = NORMAL) -> Command:
    return Command(id, Turn(0.0), frozenset(limbs), priority)


def running(*commands: Command) -> Schedule:
    schedule = Schedule()
    for one in commands:
        schedule.add(one)
    schedule.start_ready()
    return schedule


def test_a_more_important_command_displaces_what_is_in_its_way_alone() -> None:
    schedule = running(command("dance", Limb.LEFT_ARM, Limb.LEGS), command("talk", Limb.VOICE))

    urgent = command("point", Limb.LEFT_ARM, priority=HIGH)
    schedule.add(urgent)

    assert schedule.displaced() == {"dance": urgent}


def test_equals_and_less_important_ones_wait() -> None:
    schedule = running(command("dance", Limb.LEGS))

    schedule.add(command("walk", Limb.LEGS))
    schedule.add(command("turn", Limb.LEGS, priority=LOW))

    assert schedule.displaced() == {}


def test_nothing_makes_way_for_what_has_to_wait_all_the_same() -> None:
    schedule = running(
        command("look", Limb.HEAD, priority=LOW), command("alarm", Limb.VOICE, priority=HIGH)
    )

    schedule.add(command("tell", Limb.HEAD, Limb.VOICE))
    before = schedule.displaced()
    schedule.end("alarm")

    assert before == {}
    assert list(schedule.displaced()) == ["look"]


def test_ears_are_never_taken_away() -> None:
    schedule = running(command("listen", Limb.EARS, priority=LOW))

    schedule.add(command("other", Limb.EARS, priority=HIGH))

    assert schedule.displaced() == {}


def test_a_limb_is_kept_for_the_next_step_of_what_is_more_important() -> None:
    schedule = Schedule(keep_s=0.4)
    schedule.add(command("alarm", Limb.VOICE, priority=HIGH))
    schedule.start_ready()
    schedule.add(command("story", Limb.VOICE))
    schedule.end("alarm")

    schedule.now_s = 0.3
    too_early = schedule.start_ready()
    schedule.now_s = 0.5

    assert too_early == []
    assert [one.id for one in schedule.start_ready()] == ["story"]


def test_what_is_as_important_need_not_wait_for_a_kept_limb() -> None:
    schedule = Schedule(keep_s=0.4)
    schedule.add(command("alarm", Limb.VOICE, priority=HIGH))
    schedule.start_ready()
    schedule.end("alarm")

    schedule.add(command("help", Limb.VOICE, priority=HIGH))

    assert [one.id for one in schedule.start_ready()] == ["help"]


def test_a_robot_stops_a_dance_at_once_for_what_is_more_important() -> None:
    stage = Stage()
    stage.ask("dance", "play", animation="dance")
    stage.pass_time(2.0)

    stage.ask("point", "point_at", HIGH, x_m=1.0, y_m=0.5, z_m=1.0)
    stage.pass_time(0.05)

    (cancelled,) = [one for one in stage.results if (one.id, one.state) == ("dance", "cancelled")]
    assert cancelled.fault.code == DISPLACED
    assert stage.told[-1] == "point started"


def test_who_took_a_limb_is_told_by_name() -> None:
    stage = Stage()
    stage.ask("story", "say", text="A very long story about a robot", gesture="no_gesture")
    stage.pass_time(0.2)

    stage.ask("alarm", "say", HIGH, text="Fire", by="help")
    stage.pass_time(0.05)

    told = next(one for one in stage.results if (one.id, one.state) == ("story", "cancelled"))
    assert told.fault.values["by"] == "help"
    assert "help" in str(told.fault)


def test_a_walk_that_makes_way_tells_the_rest_of_it() -> None:
    stage = Stage()
    stage.ask("walk", "walk", forward_m=1.0)
    stage.pass_time(4.0)
    gone_m = float(stage.robot.base[0])

    stage.ask("sit", "do", HIGH, posture="posture_sit")
    stage.pass_time(0.05)

    told = next(one for one in stage.results if (one.id, one.state) == ("walk", "cancelled"))
    assert 0.1 < gone_m < 0.9
    assert told.fault.values["rest_forward_m"] == pytest.approx(1.0 - gone_m, abs=0.05)


def test_a_free_walk_does_not_make_way_for_what_is_less_important() -> None:
    stage = Stage()
    stage.ask("walk", "walk_freely", HIGH, forward=0.5)
    stage.pass_time(0.5)

    stage.ask("turn", "turn", degrees=30.0)
    stage.pass_time(0.5)

    assert "walk done" not in stage.told
    assert "turn started" not in stage.told


def test_limbs_are_free_at_once_after_all_was_stopped() -> None:
    stage = Stage()
    stage.ask("alarm", "say", HIGH, text="Fire in the house")
    stage.pass_time(0.1)
    stage.ask("stop", "stop")

    stage.ask("story", "say", text="Once")
    stage.pass_time(KEPT_S / 4)

    assert "story started" in stage.told


@pytest.mark.parametrize(
    ("action", "here", "rest"),
    [
        (Turn(90.0), (0.0, 0.0, math.radians(30)), {"degrees": 60.0}),
        (Turn(-170.0), (0.0, 0.0, math.radians(-20)), {"degrees": -150.0}),
        (Turn(720.0), (0.0, 0.0, 0.3), {}),
        (Walk(1.0), (0.4, 0.0, 0.0), {"forward_m": 0.6, "left_m": 0.0, "turn_deg": 0.0}),
        (
            Walk(1.0, 0.0, 90.0),
            (0.5, 0.0, math.radians(90)),
            {"forward_m": 0.0, "left_m": -0.5, "turn_deg": 0.0},
        ),
    ],
)
def test_the_rest_of_a_way_is_seen_from_where_the_robot_is_now(
    action: Turn | Walk, here: tuple[float, float, float], rest: dict[str, float]
) -> None:
    assert dict(rest_of_way(action, (0.0, 0.0, 0.0), here)) == pytest.approx(rest, abs=0.05)
