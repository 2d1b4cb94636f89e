"""From every posture to every other one: on the floor, within limits, in a calm time."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from nao_skeleton import POINTS, point, rotation
from nao_stage import BODY, Stage

from robots.body.driver import RobotState
from robots.body.stance import Stance
from tests.conftest import a_part_of

pytestmark = pytest.mark.long

NAMES = [name for name in BODY.postures if name != "Rest"]


def ask_for(posture: str) -> str:
    return "posture" + "".join(f"_{c.lower()}" if c.isupper() else c for c in posture)


@pytest.mark.parametrize(("start", "goal"), a_part_of(permutations(NAMES, 2)))
def test_a_posture_is_reached_from_any_other_without_going_through_the_floor(
    start: str, goal: str
) -> None:
    stage = Stage(start)
    stance = stage.robot.stance
    stage.ask("1", "do", posture=ask_for(goal))
    speeds, ways, states = [], [], []

    while stage.driver.is_busy or stage.actor.schedule.waiting:
        place, turn = stance.place.copy(), stance.turn.copy()
        stage.pass_time(0.05)
        states.append(stage.driver.state())
        speeds.append(np.linalg.norm(stance.place - place) / 0.05)
        ways.append(np.arccos(np.clip((np.trace(turn.T @ stance.turn) - 1) / 2, -1, 1)) / 0.05)

    assert lowest_m(states) > -0.01
    assert stage.told[-1] == "1 done" and stage.robot.posture == goal
    assert stage.robot.angles == pytest.approx(BODY.posture_angles(goal), abs=1e-3)
    assert (stage.relative_speeds <= 0.3).all()
    assert 0.5 < stage.now_s < 16
    assert BODY.clamped(np.array(stage.angles[::10]))[1] == []
    assert max(speeds) < 0.6 and max(ways) < 3.5  # nothing jumps: m/s, rad/s
    assert not stage.robot.fallen
    assert rests(stance)


def lowest_m(states: list[RobotState]) -> float:
    """How high the lowest of hands, soles and head ever is, by what was told and plain sums."""
    _, _, z, roll, pitch, yaw = np.array([state.torso for state in states]).T
    turn = rotation([0, 0, 1], yaw) @ rotation([0, 1, 0], pitch) @ rotation([1, 0, 0], roll)
    angles = np.array([[state.joints[name] for name in BODY.names] for state in states])
    points = [point(angles, name) for name in POINTS]
    return min(float((np.einsum("nj,nj->n", turn[:, 2], place) + z).min()) for place in points)


def rests(stance: Stance) -> bool:
    """Whether it stays as it is when it is let alone."""
    turn = stance.turn.copy()
    for _ in range(50):
        stance.follow(stance._angles + 1e-9, 0.01)
    return bool(turn[2] @ stance.turn[2] > 0.999)


@pytest.mark.parametrize("after_s", [1.0, 3.9, 6.3])
@pytest.mark.parametrize(
    ("start", "goal"),
    [("Stand", "LyingBelly"), ("LyingBelly", "Stand"), ("LyingBack", "Stand"), ("Stand", "Sit")],
)
def test_it_gets_up_from_wherever_it_was_stopped(start: str, goal: str, after_s: float) -> None:
    stage = Stage(start)
    stage.ask("1", "do", posture=ask_for(goal))
    stage.pass_time(after_s)
    stage.results += stage.actor.stop()
    stage.finish()

    result = stage.do("do", posture="posture_stand")

    assert result.state == "done" and not stage.robot.fallen
    assert stage.robot.angles == pytest.approx(BODY.posture_angles("Stand"), abs=1e-3)
    assert stage.robot.stance.turn[2, 2] > 0.99
    assert (stage.relative_speeds <= 1.001).all()


def test_a_way_that_was_stopped_is_gone_back_over_its_key_poses() -> None:
    stage = Stage("Crouch")
    stage.ask("1", "do", posture="posture_lying_belly")
    stage.pass_time(3.0)
    stage.results += stage.actor.stop()
    stage.finish()
    passed = len(stage.robot.passed)

    stage.do("do", posture="posture_crouch")

    assert passed >= 2
    assert stage.robot.passed == () and stage.robot.posture == "Crouch"
    assert stage.robot.angles == pytest.approx(BODY.posture_angles("Crouch"), abs=1e-3)


def test_a_robot_that_has_got_up_is_where_its_feet_are() -> None:
    stage = Stage("LyingBelly")

    stage.do("do", posture="posture_stand")
    stage.do("walk", forward_m=0.2)

    assert stage.robot.stance.feet_base() == pytest.approx(stage.robot.base, abs=1e-3)


def test_getting_up_from_the_belly_goes_over_hands_and_knees() -> None:
    stage = Stage("LyingBelly")
    stage.ask("1", "do", posture="posture_stand")
    touched: list[set[str]] = []

    while stage.driver.is_busy or stage.actor.schedule.waiting:
        stage.pass_time(0.1)
        stance = stage.robot.stance
        links = stance.skeleton.point_links[stance.touching]
        touched.append({stance.skeleton.links[link] for link in links})

    on_hands = [links for links in touched if {"L_wrist", "R_wrist"} <= links]
    assert len(on_hands) > 10
    assert any({"L_ankle", "R_ankle"} <= links for links in on_hands)
    assert touched[-1] == {"L_ankle", "R_ankle"}
