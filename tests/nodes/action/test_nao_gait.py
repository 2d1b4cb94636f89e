from __future__ import annotations

import math

import numpy as np
import pytest
from nao_skeleton import frames, point, rotation
from nao_stage import BODY, TICK_S, Stage

from nodes.action.naobody.gait import plan_walk

STANDING = BODY.posture_angles("StandInit")
# Flat feet make the torso lean: its pitch is the opposite of the sum of a leg's pitch joints.
LEAN = rotation([0, 1, 0], 0.1)


def feet_in_room(angles: np.ndarray, base: np.ndarray) -> dict[str, np.ndarray]:
    """Where the soles are (x, y, m), and how high above the lower one, for one tick."""
    turn = rotation([0, 0, 1], base[2]) @ LEAN
    soles = {side: turn @ point(angles, f"{side}_sole") for side in ("left", "right")}
    lowest = min(sole[2] for sole in soles.values())
    return {side: sole + np.array([*base[:2], -lowest]) for side, sole in soles.items()}


@pytest.mark.parametrize(
    ("forward_m", "left_m", "turn"),
    [(0.4, 0, 0), (-0.25, 0, 0), (0, 0.2, 0), (0, 0, 1.5), (0.3, -0.1, -0.4), (0.001, 0, 0)],
)
def test_a_walk_ends_exactly_where_it_should_with_joined_feet(
    forward_m: float, left_m: float, turn: float
) -> None:
    walk = plan_walk(BODY, STANDING, forward_m, left_m, turn)

    assert walk.base[-1] == pytest.approx([forward_m, left_m, turn], abs=1e-9)
    assert walk.legs.angles[-1] == pytest.approx(STANDING[list(walk.legs.columns)], abs=1e-6)
    assert len(walk.base) == len(walk.legs.angles)


def test_standing_feet_stay_where_they_are_and_swinging_feet_are_lifted() -> None:
    walk = plan_walk(BODY, STANDING, 0.4, 0.0, 0.0)
    angles = np.repeat(STANDING[None], len(walk.base), axis=0)
    angles[:, walk.legs.columns] = walk.legs.angles

    feet = [feet_in_room(row, base) for row, base in zip(angles, walk.base, strict=True)]

    for side in ("left", "right"):
        track = np.array([foot[side] for foot in feet])
        height, speed = track[1:, 2], np.linalg.norm(np.diff(track[:, :2], axis=0), axis=1) / TICK_S
        assert height.max() == pytest.approx(0.02, abs=0.002)
        assert speed[height < 1e-4].max() < 0.02
        assert speed.max() > 0.2


def test_feet_stay_level_with_the_floor() -> None:
    walk = plan_walk(BODY, STANDING, 0.2, 0.1, 0.5)
    angles = STANDING.copy()

    for row in walk.legs.angles[::5]:
        angles[list(walk.legs.columns)] = row
        links = frames(angles)
        for ankle in ("L_ankle", "R_ankle"):
            assert (LEAN @ links[ankle][0])[2, 2] > math.cos(0.02)


def test_it_walks_and_turns_as_fast_as_nao() -> None:
    forward, turn = Stage("StandInit"), Stage("StandInit")

    forward_s = seconds(forward, "walk", forward_m=1.0)
    turn_s = seconds(turn, "turn", degrees=180)

    assert 1.0 / forward_s == pytest.approx(0.0916, abs=0.005)
    assert math.pi / turn_s == pytest.approx(0.44, abs=0.05)


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


def test_a_walk_of_nothing_is_done_at_once() -> None:
    assert Stage().do("walk").state == "done"
