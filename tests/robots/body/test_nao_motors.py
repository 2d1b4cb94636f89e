"""Single motors: set angles, reached angles, keys given inline, stiffness, pace, silence."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nao_stage import BODY, Stage

FREE_JOINTS = ["HeadYaw", "HeadPitch", "LShoulderPitch", "LElbowRoll", "RWristYaw", "LHand"]


def angle(stage: Stage, joint: str) -> float:
    return float(stage.robot.angles[BODY.index[joint]])


def test_set_angles_is_done_at_once_and_the_joint_gets_there_later() -> None:
    stage = Stage()

    stage.ask("1", "set_angles", angles={"HeadYaw": 1.0}, speed=0.2)

    assert stage.told == ["1 done"]
    stage.finish()
    assert angle(stage, "HeadYaw") == pytest.approx(1.0, abs=1e-6)
    assert stage.relative_speeds.max() <= 0.2 + 1e-9


def test_new_angles_on_the_way_need_no_halt() -> None:
    stage = Stage()
    stage.ask("1", "set_angles", angles={"HeadYaw": 1.5}, speed=0.3)
    stage.pass_time(0.5)

    stage.ask("2", "set_angles", angles={"HeadYaw": 2.0}, speed=0.3)
    stage.pass_time(0.3)

    way = [float(angles[0]) for angles in stage.angles[-30:]]
    slowest = min(late - early for early, late in pairwise(way))
    assert slowest > 0.0


@settings(max_examples=15, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(FREE_JOINTS),
            st.floats(-4.0, 4.0),
            st.floats(0.01, 1.0),
            st.integers(0, 30),
        ),
        min_size=1,
        max_size=6,
    )
)
def test_whatever_angles_are_set_joints_keep_to_limits_and_speeds_and_arrive(
    asked: list[tuple[str, float, float, int]],
) -> None:
    stage = Stage()

    for number, (joint, goal, speed, ticks) in enumerate(asked):
        stage.ask(str(number), "set_angles", angles={joint: goal}, speed=speed)
        stage.pass_time(ticks * 0.01)
    stage.finish()

    assert stage.relative_speeds.max() <= 1.0 + 1e-6
    assert BODY.clamped(np.array(stage.angles))[1] == []
    assert not stage.actor.schedule.running


def test_angles_that_are_set_wait_for_their_limb() -> None:
    stage = Stage()
    stage.ask("1", "look", yaw_deg=30.0)

    stage.ask("2", "set_angles", angles={"HeadYaw": -0.5, "RHand": 1.0})
    stage.pass_time(0.2)

    assert angle(stage, "RHand") > 0.2
    assert angle(stage, "HeadYaw") > 0.0
    stage.finish()
    assert angle(stage, "HeadYaw") == pytest.approx(-0.5, abs=1e-3)


def test_a_stop_forgets_where_joints_were_going() -> None:
    stage = Stage()
    stage.ask("1", "set_angles", angles={"HeadYaw": 2.0}, speed=0.1)
    stage.pass_time(0.2)

    stage.ask("2", "stop")
    stage.finish()
    stage.ask("3", "set_angles", angles={"HeadPitch": 0.2})
    stage.finish()

    assert angle(stage, "HeadYaw") < 1.0
    assert angle(stage, "HeadPitch") == pytest.approx(0.2, abs=1e-3)


def test_reached_angles_arrive_together() -> None:
    stage = Stage()

    result = stage.do("reach_angles", angles={"HeadYaw": 1.0, "HeadPitch": 0.05}, speed=0.3)

    assert result.state == "done"
    assert (angle(stage, "HeadYaw"), angle(stage, "HeadPitch")) == pytest.approx((1.0, 0.05))
    assert stage.relative_speeds.max() <= 0.3 + 1e-6


def test_keys_are_reached_at_their_times() -> None:
    stage = Stage()

    stage.ask("1", "move_through", tracks={"HeadYaw": {"times": [1.0, 2.0], "keys": [0.8, 0.2]}})
    stage.pass_time(1.0)
    first = angle(stage, "HeadYaw")
    stage.pass_time(1.0)

    assert (first, angle(stage, "HeadYaw")) == pytest.approx((0.8, 0.2), abs=0.01)


def test_keys_that_are_too_fast_are_played_slower_and_it_says_so() -> None:
    stage = Stage()

    result = stage.do("move_through", tracks={"HeadYaw": {"times": [0.1], "keys": [2.0]}})

    assert "times slower: its joints cannot move faster" in result.description
    assert angle(stage, "HeadYaw") == pytest.approx(2.0)


def test_joints_with_one_motor_move_together() -> None:
    stage = Stage("StandInit")

    stage.do("reach_angles", angles={"LHipYawPitch": -0.1}, speed=0.2)

    assert angle(stage, "RHipYawPitch") == angle(stage, "LHipYawPitch") == pytest.approx(-0.1)


def test_a_part_is_released_when_none_of_its_joints_is_held() -> None:
    stage = Stage()

    stage.do("set_stiffness", joints={"HeadYaw": 0.0})
    one = stage.robot.released
    stage.do("set_stiffness", joints={"HeadPitch": 0.0})

    assert (one, stage.robot.released) == (frozenset(), frozenset({"head"}))


def test_one_firm_joint_makes_its_part_held_again() -> None:
    stage = Stage()
    stage.do("stiffness", part="head", on=False)

    stage.do("set_stiffness", joints={"HeadYaw": 1.0})
    stage.do("reach_angles", angles={"HeadYaw": 0.4, "HeadPitch": 0.2})

    assert stage.robot.released == frozenset()
    assert angle(stage, "HeadYaw") == pytest.approx(0.4)
    assert angle(stage, "HeadPitch") == pytest.approx(-0.17, abs=0.05)  # loose


def test_locking_a_part_forgets_its_loose_joints() -> None:
    stage = Stage()
    stage.do("set_stiffness", joints={"HeadYaw": 0.0})

    stage.do("stiffness", part="head", on=True)
    stage.do("reach_angles", angles={"HeadYaw": 0.4})

    assert angle(stage, "HeadYaw") == pytest.approx(0.4)


@pytest.mark.parametrize("pace", [0.5, 2.0])
def test_a_posture_at_another_pace_takes_another_time_and_is_the_same(pace: float) -> None:
    usual, changed = Stage(), Stage()
    usual.do("do", posture="Crouch")

    changed.do("do", posture="Crouch", pace=pace)

    assert changed.now_s == pytest.approx(usual.now_s / pace, rel=0.05)
    assert changed.robot.angles == pytest.approx(usual.robot.angles, abs=1e-6)
    assert not changed.robot.fallen


def test_silence_keeps_the_voice_for_its_time() -> None:
    stage = Stage()
    stage.ask("1", "silence", seconds=1.0)

    stage.ask("2", "say", text="Hello")
    stage.pass_time(0.9)
    before = stage.robot.saying
    stage.pass_time(0.3)

    assert (before, stage.robot.saying) == ("", "Hello")


@pytest.mark.parametrize(
    ("action", "args"),
    [
        ("set_angles", {"angles": {"Nose": 1.0}}),
        ("reach_angles", {"angles": {"Nose": 1.0}}),
        ("move_through", {"tracks": {"Nose": {"times": [1.0], "keys": [1.0]}}}),
        ("set_stiffness", {"joints": {"Nose": 1.0}}),
    ],
)
def test_a_joint_that_there_is_not_is_refused(action: str, args: dict[str, object]) -> None:
    stage = Stage()

    result = stage.do(action, **args)

    assert result.state == "failed"
    assert 'There is no joint "Nose"' in result.description
