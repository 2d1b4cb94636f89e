"""Inverse kinematics: hands, feet and head come to where they are dragged, within the limits."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.resources import resource_folder
from robots.body.body import load_body
from robots.body.inverse import Goal, Reach, mirrored_pose, turn_between
from robots.body.kinematics import Skeleton, rotation

BODY = load_body(resource_folder() / "robots" / "nao")
REACH = Reach(Skeleton(BODY))
STAND = BODY.posture_angles("Stand")
ENDS = {
    "L_wrist": (0.06, 0.0, 0.0),
    "R_wrist": (0.06, 0.0, 0.0),
    "L_ankle": (0.0, 0.0, -0.045),
    "R_ankle": (0.0, 0.0, -0.045),
    "Head": (0.06, 0.0, 0.06),
}
links = st.sampled_from(sorted(ENDS))
parts = st.lists(st.floats(0.0, 1.0), min_size=26, max_size=26)


def pose(shares: list[float]) -> np.ndarray:
    return BODY.clamped(BODY.min + np.array(shares) * (BODY.max - BODY.min))[0]


def is_allowed(angles: np.ndarray) -> bool:
    return BODY.clamped(angles)[1] == []


@given(links, parts)
def test_a_place_that_can_be_reached_is_reached_nearly_always(link: str, shares) -> None:
    start = pose([0.5] * 26)
    moving = REACH.columns(link)
    inside = start.copy()
    inside[moving] = (0.75 * start + 0.25 * pose(shares))[moving]
    inside = BODY.clamped(inside)[0]
    place = REACH.place(inside, link, ENDS[link])

    found = REACH.reached(start, Goal(link, ENDS[link], place), steps=60)

    assert np.linalg.norm(REACH.place(found, link, ENDS[link]) - place) < 0.003
    assert is_allowed(found)


@given(links, st.tuples(*[st.floats(-1.0, 1.0)] * 3), parts)
def test_whatever_is_asked_the_angles_are_allowed_and_nothing_else_moves(
    link: str, place: tuple[float, float, float], shares
) -> None:
    start = pose(shares)

    found = REACH.reached(start, Goal(link, ENDS[link], np.array(place)))

    others = [i for i in range(26) if i not in REACH.columns(link)]
    assert is_allowed(found)
    assert np.allclose(found[others], start[others], atol=1e-9)


@given(links, st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_it_never_goes_further_away_than_it_was(link: str, place) -> None:
    target = np.array(place)

    found = REACH.reached(STAND, Goal(link, ENDS[link], target))

    before = np.linalg.norm(REACH.place(STAND, link, ENDS[link]) - target)
    assert np.linalg.norm(REACH.place(found, link, ENDS[link]) - target) <= before + 1e-9


def test_an_arm_that_cannot_reach_is_stretched_towards_the_place() -> None:
    far = np.array([1.0, 0.3, 0.3])

    found = REACH.reached(STAND, Goal("L_wrist", ENDS["L_wrist"], far), steps=60)

    shoulder = np.array([0.0, 0.098, 0.1])
    hand = REACH.place(found, "L_wrist", ENDS["L_wrist"])
    way, wanted = hand - shoulder, far - shoulder
    assert np.linalg.norm(way) > 0.2
    assert way @ wanted / np.linalg.norm(way) / np.linalg.norm(wanted) > 0.98


def test_both_feet_stay_flat_on_their_places_while_the_hips_go_down() -> None:
    start = BODY.posture_angles("StandInit")
    frames = REACH.skeleton.frames(start)
    down = np.array([0.0, 0.0, 0.02])
    goals = [
        Goal(foot, (0.0, 0.0, 0.0), frames[foot][:3, 3] + down, frames[foot][:3, :3])
        for foot in ("L_ankle", "R_ankle")
    ]

    found = REACH.reached(start, *goals, steps=40)

    after = REACH.skeleton.frames(found)
    for goal in goals:
        assert np.linalg.norm(after[goal.link][:3, 3] - goal.place) < 0.002
        assert np.linalg.norm(turn_between(after[goal.link][:3, :3], goal.turn)) < 0.02
    assert found[BODY.index["LKneePitch"]] > start[BODY.index["LKneePitch"]]


@given(st.tuples(*[st.floats(-1.5, 1.5)] * 3))
def test_the_turn_between_two_rotations_is_the_one_that_was_made(turns) -> None:
    made = rotation(turns[0], 0.0, 0.0)

    assert turn_between(np.eye(3), made) == pytest.approx([turns[0], 0.0, 0.0], abs=1e-6)


def test_a_mirrored_arm_is_where_the_mirror_shows_it() -> None:
    lifted = REACH.reached(STAND, Goal("L_wrist", ENDS["L_wrist"], np.array([0.1, 0.2, 0.2])))
    left = {name: float(lifted[i]) for name, i in BODY.index.items() if name.startswith("L")}
    both = lifted.copy()
    for name, angle in mirrored_pose(left).items():
        both[BODY.index[name]] = angle

    x, y, z = REACH.place(both, "L_wrist", ENDS["L_wrist"])

    assert REACH.place(both, "R_wrist", ENDS["R_wrist"]) == pytest.approx([x, -y, z], abs=1e-6)


def test_a_drag_step_is_quick() -> None:
    places = [np.array([0.14 + 0.001 * i, 0.15, 0.03 + 0.002 * i]) for i in range(40)]
    angles, spent = STAND, []

    for place in places:
        begun = time.thread_time()
        angles = REACH.reached(angles, Goal("L_wrist", ENDS["L_wrist"], place))
        spent.append(time.thread_time() - begun)

    assert sorted(spent)[len(spent) // 2] < 0.006  # half a millisecond on a quiet computer
