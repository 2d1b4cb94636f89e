"""A virtual NAO that loses its balance falls, says so, and gets up again."""

from __future__ import annotations

import numpy as np
import pytest
from nao_stage import BODY, Stage

from robots.body.body import part_of

pytestmark = pytest.mark.long


@pytest.mark.parametrize(
    ("joint", "angle", "posture"),
    [("AnklePitch", 0.9, "LyingBack"), ("AnklePitch", -0.9, "LyingBelly"), ("KneePitch", 2, None)],
)
def test_legs_that_are_moved_too_far_let_it_fall(
    joint: str, angle: float, posture: str | None
) -> None:
    stage = Stage("StandZero")

    result = stage.do("reach_angles", angles={f"{side}{joint}": angle for side in "LR"}, speed=0.3)

    assert result.state == "failed" and fell(stage)
    assert "lost its balance and fell" in result.description
    assert "posture_stand" in result.description
    assert stage.robot.family == "lying" and stage.robot.posture in (posture or stage.robot.posture)
    assert abs(stage.robot.stance.turn[2, 2]) < 0.2


def test_a_knee_that_a_program_bends_lets_it_fall() -> None:
    stage = Stage()

    result = stage.do("move_joint", joint="LKneePitch", degrees=90)

    assert result.state == "failed" and "fell" in result.description
    assert stage.robot.fallen and stage.robot.family == "lying"


def fell(stage: Stage) -> bool:
    state = stage.driver.state()
    return state is not None and state.fallen and state.sensors["fallen"] == 1.0


def fallen_stage() -> Stage:
    stage = Stage("StandZero")
    stage.ask("1", "reach_angles", angles={"LAnklePitch": 0.9, "RAnklePitch": 0.9}, speed=0.3)
    stage.finish()
    assert fell(stage)
    return stage


def test_a_fall_takes_its_time_and_joints_keep_their_speed() -> None:
    stage = Stage("StandZero")
    stage.ask("1", "reach_angles", angles={"LAnklePitch": 0.9, "RAnklePitch": 0.9}, speed=0.3)
    heights = []

    while stage.driver.is_busy or stage.actor.schedule.waiting:
        stage.pass_time(0.02)
        heights.append(stage.robot.stance.place[2])

    steps = np.abs(np.diff(heights))
    assert steps.max() < 0.06
    assert (stage.relative_speeds <= 1.001).all()
    assert stage.robot.stance.places[:, 2].min() == pytest.approx(0.0, abs=1e-9)


def test_a_fall_is_told_once_as_something_that_happened() -> None:
    stage = fallen_stage()

    assert stage.driver.noticed().count("robot_fell") == 1
    assert stage.driver.noticed() == []


@pytest.mark.parametrize("args", [("wake_up", {}), ("do", {"posture": "posture_stand"})])
def test_a_fallen_robot_gets_up(args: tuple[str, dict[str, str]]) -> None:
    stage = fallen_stage()
    action, more = args

    result = stage.do(action, **more)

    assert result.state == "done" and not stage.robot.fallen
    assert stage.robot.posture == "Stand"
    assert stage.robot.stance.turn[2, 2] > 0.99


def test_a_fallen_robot_does_not_walk() -> None:
    result = fallen_stage().do("walk", forward_m=0.3)

    assert result.state == "failed" and "NAO lies" in result.description


def test_released_legs_let_it_sink_down_and_it_can_get_up() -> None:
    stage = Stage()
    stage.ask("1", "walk", forward_m=1.0)
    stage.pass_time(1.5)

    legs = [name for name in BODY.names if part_of(BODY, name) in ("left_leg", "right_leg")]
    stage.do("set_stiffness", joints=dict.fromkeys(legs, 0.0))
    sunk = stage.robot.posture, stage.robot.stance.place[2]

    walk = next(result for result in stage.results if result.id == "1" and result.description)
    assert walk.state == "failed" and "sank down" in walk.description
    assert sunk[0] == "Crouch" and sunk[1] < 0.26 and not stage.robot.fallen
    assert stage.do("wake_up").state == "done" and stage.robot.posture == "Stand"


def test_released_arms_hang_down() -> None:
    stage = Stage("StandZero")

    stage.do("stiffness", part="arms", on=False)
    stage.pass_time(4.0)

    frames = stage.robot.stance.skeleton.frames(stage.robot.angles)
    for side in "LR":
        assert frames[f"{side}_wrist"][2, 3] < frames[f"{side}Shoulder"][2, 3] - 0.15
    assert (stage.relative_speeds <= 0.21).all() and not stage.driver.moving


def test_arms_and_head_may_do_what_they_like() -> None:
    stage = Stage()

    for joint in ("HeadYaw", "LShoulderPitch", "RShoulderRoll", "LElbowYaw"):
        for degrees in (-120, 120):
            assert stage.do("move_joint", joint=joint, degrees=degrees).state == "done"

    assert not stage.robot.fallen


def test_feet_stay_where_they_are_while_arms_move() -> None:
    stage = Stage()
    before = stage.robot.stance.feet_base()

    stage.do("play", animation="wave")

    assert stage.robot.stance.feet_base() == pytest.approx(before, abs=1e-3)


def test_its_mass_is_over_its_feet_in_every_standing_posture() -> None:
    margins = {name: Stage(name).robot.stance.margin_m for name in ("Stand", "StandInit", "Crouch")}

    assert all(margin > 0.02 for margin in margins.values()), margins
    assert len(BODY.postures) == 9
