"""Where NAO's links, its mass and its soles are, and how its body comes to rest on the floor."""

from __future__ import annotations

import math

import nao_skeleton
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nao_stage import BODY

from robots.body.kinematics import Skeleton, rotation
from robots.body.settling import hull, inside_by, nearest_in_hull, tilt_for, tipped

SKELETON = Skeleton(BODY)
ANGLES = st.builds(
    lambda parts: BODY.clamped(BODY.min + np.array(parts) * (BODY.max - BODY.min))[0],
    st.lists(st.floats(0, 1), min_size=26, max_size=26),
)


@settings(max_examples=30, deadline=None)
@given(ANGLES)
def test_links_are_where_a_plain_calculation_says(angles: np.ndarray) -> None:
    found, plain = SKELETON.frames(angles), nao_skeleton.frames(angles)

    for link, (turn, place) in plain.items():
        assert found[link][:3, :3] == pytest.approx(turn, abs=1e-5)
        assert found[link][:3, 3] == pytest.approx(place, abs=1e-5)


def test_many_poses_at_once_are_the_same_as_one_by_one() -> None:
    poses = np.array([BODY.posture_angles(name) for name in BODY.postures])

    together = SKELETON.transforms(poses)

    for pose, frames in zip(poses, together, strict=True):
        assert frames == pytest.approx(SKELETON.transforms(pose))


def test_it_weighs_what_nao_weighs_and_its_mass_is_in_its_belly() -> None:
    centre = SKELETON.centre_of_mass(BODY.posture_angles("StandZero"))

    assert SKELETON.mass_kg == pytest.approx(5.305, abs=0.001)
    assert abs(centre[1]) < 0.001
    assert -0.08 < centre[2] < 0.0


@pytest.mark.parametrize(
    ("posture", "height_m", "pitch_deg"),
    [
        ("Stand", 0.331, 0),
        ("StandInit", 0.320, 6),
        ("StandZero", 0.333, 0),
        ("Crouch", 0.230, -3),
        ("Sit", 0.137, -18),
        ("SitRelax", 0.147, -9),
        ("LyingBelly", 0.060, 81),
        ("LyingBack", 0.067, -89),
    ],
)
def test_each_posture_rests_on_the_floor_as_it_should(
    posture: str, height_m: float, pitch_deg: float
) -> None:
    down = BODY.postures[posture].down

    _, _, z, _, pitch, _ = SKELETON.torso_over_floor(BODY.posture_angles(posture), down=down)

    assert z == pytest.approx(height_m, abs=0.003)
    assert math.degrees(pitch) == pytest.approx(pitch_deg, abs=1.5)


@pytest.mark.parametrize("posture", ["Stand", "StandInit", "StandZero", "Crouch"])
def test_standing_feet_are_flat_on_the_floor(posture: str) -> None:
    angles = BODY.posture_angles(posture)
    x, y, z, *turns = SKELETON.torso_over_floor(angles, base=(0.3, -0.2, 0.5))
    frames, turn = SKELETON.transforms(angles), rotation(*turns)

    soles = [SKELETON.sole(frames, link) @ turn.T + (x, y, z) for link in SKELETON.soles]

    assert max(sole[:, 2].max() for sole in soles) < 0.002
    middle = turn @ SKELETON.feet_middle(frames) + (x, y, z)
    assert middle[:2] == pytest.approx((0.3, -0.2), abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(ANGLES, st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda way: math.hypot(*way) > 0.1))
def test_every_pose_rests_steadily_with_its_mass_above_its_support(
    angles: np.ndarray, down: tuple[float, float, float]
) -> None:
    turn = SKELETON.resting_turn(angles, down)
    frames = SKELETON.transforms(angles)

    places = (SKELETON.outline(frames) - SKELETON.mass_centre(frames)) @ turn.T

    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)
    low = places[places[:, 2] < places[:, 2].min() + 1e-3]
    assert math.hypot(*nearest_in_hull(low[:, :2])) < 1e-4


def test_a_box_on_its_edge_falls_onto_its_side() -> None:
    box = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-3, 3)], dtype=float)

    kept = tipped(box, rotation(0, 0.2, 0), math.inf)[0]
    fallen = tipped(box, rotation(0, 0.5, 0), math.inf)[0]

    assert kept[2, 2] == pytest.approx(1.0)
    assert abs(fallen[2, 2]) < 1e-6


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=12))
def test_a_convex_hull_has_every_point_inside(points: list[tuple[float, float]]) -> None:
    corners = hull(np.array(points))

    if len(corners) > 2:
        assert all(inside_by(corners, point) > -1e-9 for point in points)


@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda way: math.hypot(*way) > 0.01))
def test_a_direction_is_turned_downwards(down: tuple[float, float, float]) -> None:
    turned = tilt_for(np.array(down)) @ down

    assert turned / np.linalg.norm(turned) == pytest.approx([0, 0, -1], abs=1e-6)
