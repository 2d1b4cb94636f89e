from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from nao_stage import BODY, TICK_S, Stage

from robots.body.gait import GRAVITY_M_S2, Walk, plan_walk
from robots.body.kinematics import Skeleton, turned
from robots.body.settling import hull, inside_by

STANDING = BODY.posture_angles("StandInit")
SKELETON = Skeleton(BODY)
WAYS = [(0.4, 0, 0), (-0.25, 0, 0), (0, 0.2, 0), (0, 0, 1.5), (0.3, -0.1, -0.4), (0.001, 0, 0)]


class Footprints:
    """Where the soles and the mass of a walking robot are in the room, at every tick."""

    def __init__(self, walk: Walk) -> None:
        self.angles = np.repeat(STANDING[None], len(walk.base), axis=0)
        self.angles[:, walk.legs.columns] = walk.legs.angles
        frames = SKELETON.transforms(self.angles)
        turns = np.array([turned(yaw) @ walk.lean for yaw in walk.torso[:, 2]])
        places = np.column_stack([walk.torso[:, :2], np.zeros(len(walk.torso))])
        self.soles = {}
        for link in SKELETON.soles:
            sole = np.einsum("tij,tpj->tpi", turns, SKELETON.sole(frames, link))
            self.soles[link] = sole + places[:, None]
        floor = min(sole[..., 2].min() for sole in self.soles.values())
        for sole in self.soles.values():
            sole[..., 2] -= floor
        self.mass = np.einsum("tij,tj->ti", turns, SKELETON.mass_centre(frames)) + places
        self.mass[:, 2] -= floor

    def zero_moment_point(self) -> np.ndarray:
        """Where the floor has to carry the robot (ticks, 2), as if its mass were one point."""
        speed = np.gradient(self.mass[:, :2], TICK_S, axis=0)
        acceleration = np.gradient(speed, TICK_S, axis=0)
        return self.mass[:, :2] - self.mass[:, 2:] / GRAVITY_M_S2 * acceleration


@pytest.mark.parametrize(("forward_m", "left_m", "turn"), WAYS)
def test_a_walk_ends_exactly_where_it_should_with_joined_feet(
    forward_m: float, left_m: float, turn: float
) -> None:
    walk = plan_walk(BODY, STANDING, forward_m, left_m, turn)

    assert walk.base[-1] == pytest.approx([forward_m, left_m, turn], abs=1e-9)
    assert walk.legs.angles[-1] == pytest.approx(STANDING[list(walk.legs.columns)], abs=1e-6)
    assert len(walk.base) == len(walk.legs.angles) == len(walk.torso)


@pytest.mark.parametrize(("forward_m", "left_m", "turn"), WAYS)
def test_standing_feet_stay_where_they_are_and_swinging_feet_are_lifted(
    forward_m: float, left_m: float, turn: float
) -> None:
    steps = Footprints(plan_walk(BODY, STANDING, forward_m, left_m, turn))

    for sole in steps.soles.values():
        height = sole[..., 2].max(axis=1)
        stands = (height[1:] < 1e-4) & (height[:-1] < 1e-4)
        slid_m = np.linalg.norm(np.diff(sole[..., :2], axis=0), axis=2).max(axis=1)
        assert height.max() == pytest.approx(0.02, abs=0.002)
        assert slid_m[stands].max() < 0.002 * TICK_S
        assert np.ptp(sole[..., 2], axis=1).max() < 1e-3  # level with the floor


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(-2.0, 2.0))
@example(0.359375, -0.265625, 1.0)  # with slower steps its leg would be stretched
def test_every_walk_keeps_its_balance_its_limits_and_its_speed(
    forward_m: float, left_m: float, turn: float
) -> None:
    steps = Footprints(plan_walk(BODY, STANDING, forward_m, left_m, turn))

    for tick, point in enumerate(steps.zero_moment_point()):
        soles = [sole[tick] for sole in steps.soles.values() if sole[tick, :, 2].min() < 1.2e-3]
        assert inside_by(hull(np.vstack(soles)[:, :2]), tuple(point)) > 0.01
    speeds = np.abs(np.diff(steps.angles, axis=0)) / TICK_S / BODY.max_speed
    assert speeds.max() < 1.0
    assert BODY.clamped(steps.angles)[1] == []


@pytest.mark.parametrize(("forward_m", "left_m", "turn"), WAYS)
def test_a_walk_may_be_cut_off_once_both_feet_are_down_for_good(
    forward_m: float, left_m: float, turn: float
) -> None:
    walk = plan_walk(BODY, STANDING, forward_m, left_m, turn)
    steps, landed = Footprints(walk), math.ceil(walk.landed_s / TICK_S)

    speed = np.gradient(steps.mass[:, :2], TICK_S, axis=0)
    # Where a mass on stiff legs comes to rest, that has to be over the soles (capture point)
    reached = steps.mass[:, :2] + speed * np.sqrt(steps.mass[:, 2:] / GRAVITY_M_S2)
    for tick in range(landed, len(walk.base)):
        soles = np.vstack([sole[tick] for sole in steps.soles.values()])
        assert soles[:, 2].max() < 1e-3
        assert inside_by(hull(soles[:, :2]), tuple(reached[tick])) > 0.03
    assert 0.5 < TICK_S * (len(walk.base) - landed) < 0.65
    assert walk.base[landed] == pytest.approx(walk.base[-1], abs=1e-3)


def test_the_torso_sways_over_the_standing_foot() -> None:
    steps = Footprints(plan_walk(BODY, STANDING, 0.3, 0.0, 0.0))

    right_stands = steps.soles["L_ankle"][..., 2].max(axis=1) > 0.015
    left_stands = steps.soles["R_ankle"][..., 2].max(axis=1) > 0.015

    assert steps.mass[right_stands, 1].max() < 0.0 < steps.mass[left_stands, 1].min()


def test_it_walks_and_turns_as_fast_as_nao() -> None:
    short, long = (seconds(Stage("StandInit"), "walk", forward_m=way) for way in (0.4, 1.2))
    small, large = (seconds(Stage("StandInit"), "turn", degrees=angle) for angle in (60, 180))

    assert 0.8 / (long - short) == pytest.approx(0.095, abs=0.001)
    assert math.radians(120) / (large - small) == pytest.approx(0.476, abs=0.03)


def seconds(stage: Stage, action: str, **args: float) -> float:
    stage.ask("1", action, **args)
    return stage.finish()


def test_odometry_adds_up_over_walks_and_turns() -> None:
    stage = Stage()

    stage.do("walk", forward_m=0.3)
    stage.do("turn", degrees=90)
    stage.do("walk", forward_m=0.2, left_m=0.1)

    assert stage.robot.base == pytest.approx([0.2, 0.2, math.pi / 2], abs=1e-12)
    assert (stage.relative_speeds <= 1.001).all()
    assert stage.robot.stance.feet_base() == pytest.approx(stage.robot.base, abs=1e-4)


def test_the_feet_on_the_floor_are_where_its_odometry_says_they_are() -> None:
    stage = Stage()
    stage.ask("1", "walk", forward_m=0.3, turn_deg=50)

    while stage.driver.is_busy or stage.actor.schedule.waiting:
        stage.pass_time(0.02)
        feet = stage.robot.stance.feet_base()
        assert feet[:2] == pytest.approx(stage.robot.base[:2], abs=0.003)
        assert feet[2] == pytest.approx(stage.robot.base[2], abs=0.02)


@pytest.mark.parametrize("after_s", [0.3, 0.8, 1.1, 1.35, 1.6, 2.5])
def test_a_walk_that_is_stopped_ends_its_step_and_stands(after_s: float) -> None:
    stage = Stage("StandInit")
    stage.ask("1", "walk", forward_m=1.0)
    stage.pass_time(after_s)

    stage.results += stage.actor.stop()
    seconds = stage.finish()
    stage.pass_time(0.5)  # the arms have swung with the steps

    assert seconds < 1.5 and not stage.robot.fallen
    assert (stage.relative_speeds <= 1.001).all()
    assert stage.robot.stance.feet_base() == pytest.approx(stage.robot.base, abs=2e-3)
    assert stage.robot.angles == pytest.approx(STANDING, abs=1e-3)


@pytest.mark.parametrize(
    ("posture", "verb"),
    [("Sit", "sits"), ("LyingBack", "lies"), ("Crouch", "crouches"), ("Rest", "rests")],
)
def test_it_does_not_walk_unless_it_stands_and_says_what_to_do(posture: str, verb: str) -> None:
    stage = Stage(posture)

    result = stage.do("walk", forward_m=0.3)

    assert result.state == "failed"
    assert f"NAO {verb}: it must stand before it can walk" in result.description
    assert "posture_stand" in result.description
    assert stage.robot.base.tolist() == [0, 0, 0]


def test_free_arms_swing_against_the_legs_and_hang_as_before_after_the_walk() -> None:
    stage = Stage("StandInit")

    stage.do("walk", forward_m=0.3)
    stage.pass_time(0.5)

    shoulders = np.array(stage.angles)[:, [BODY.index[f"{side}ShoulderPitch"] for side in "LR"]]
    swung = shoulders - shoulders[0]
    assert (np.ptp(swung, axis=0) > 0.1).all()
    assert swung[:, 0] == pytest.approx(-swung[:, 1], abs=1e-6)
    assert swung[-1] == pytest.approx([0.0, 0.0], abs=1e-6)


def test_an_arm_that_does_something_else_does_not_swing() -> None:
    stage = Stage("StandInit")
    stage.ask("1", "walk", forward_m=0.3)
    stage.pass_time(1.0)

    result = stage.do("hand", side="left", open=True)

    assert result.state == "done"
    assert (stage.relative_speeds <= 1.001).all()


def test_a_walk_of_nothing_is_done_at_once() -> None:
    assert Stage().do("walk").state == "done"
