"""What is done to a motion on its timeline, and what a robot would make of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.own_animations import JointKeys, OwnAnimation, why_not_animation
from nep_studio.ui.plugins.motion import editing
from nep_studio.ui.plugins.motion.rehearsal import Rehearsal, given_time
from nodes.resources import resource_folder
from robots.body.body import Body, load_body

NODS = OwnAnimation(
    "Nods",
    {"HeadPitch": JointKeys((0.5, 1.0, 2.0), (0.3, -0.2, 0.0)), "LHand": JointKeys((1.0,), (1.0,))},
)
EMPTY = OwnAnimation("New", {})


@pytest.fixture(scope="module")
def body() -> Body:
    return load_body(resource_folder() / "robots" / "nao")


def test_the_times_of_all_joints_are_the_key_times() -> None:
    assert editing.key_times(NODS) == [0.5, 1.0, 2.0]
    assert editing.pose_at(NODS, 1.0) == {"HeadPitch": -0.2, "LHand": 1.0}


def test_a_pose_is_set_at_a_time_and_changed_there() -> None:
    motion = editing.with_pose(EMPTY, 0.503, {"HeadYaw": 0.5})
    motion = editing.with_pose(motion, 0.5, {"HeadYaw": 0.7})

    assert motion.joints == {"HeadYaw": JointKeys((0.5,), (0.7,))}


def test_a_pose_between_bezier_keys_goes_on_smoothly() -> None:
    flat = (0.0, 0.0, 0.0, 0.0)
    motion = OwnAnimation("A", {"HeadYaw": JointKeys((1.0, 2.0), (0.0, 1.0), (flat, flat))})

    motion = editing.with_pose(motion, 1.5, {"HeadYaw": 0.5})

    before_s, before, after_s, after = motion.joints["HeadYaw"].handles[1]
    assert before_s < 0 < after_s
    assert before / before_s == pytest.approx(after / after_s) == pytest.approx(1.0)


def test_a_moved_key_takes_the_place_of_one_that_was_there() -> None:
    motion = editing.moved(NODS, {0.5: 2.0})

    assert motion.joints["HeadPitch"] == JointKeys((1.0, 2.0), (-0.2, 0.3))


def test_a_joint_that_has_no_key_left_is_not_moved_any_more() -> None:
    motion = editing.without_times(NODS, [1.0])

    assert motion.joints.keys() == {"HeadPitch"}


def test_copies_come_later_with_all_that_was_at_their_times() -> None:
    motion = editing.copied(NODS, [1.0], 3.0)

    assert editing.pose_at(motion, 4.0) == {"HeadPitch": -0.2, "LHand": 1.0}


def test_time_is_put_in_and_taken_out_after_a_key() -> None:
    longer = editing.shifted_after(NODS, 0.5, 1.0)
    shorter = editing.shifted_after(NODS, 0.5, -9.0)

    assert editing.key_times(longer) == [0.5, 2.0, 3.0]
    assert editing.key_times(shorter) == [0.5, 0.51, 1.51]


def test_backwards_and_mirrored_twice_is_the_motion_itself() -> None:
    motion = editing.mirrored(editing.mirrored(editing.backwards(editing.backwards(NODS))))

    assert editing.key_times(motion) == pytest.approx(editing.key_times(NODS))
    assert motion.joints["HeadPitch"].keys == NODS.joints["HeadPitch"].keys


def test_the_mirror_image_moves_the_other_hand() -> None:
    assert "RHand" in editing.mirrored(NODS).joints


times = st.floats(0, 30)
changes = st.one_of(
    st.tuples(st.just("pose"), times),
    st.tuples(st.just("move"), times),
    st.tuples(st.just("delete"), times),
    st.tuples(st.just("copy"), times),
    st.tuples(st.just("shift"), st.floats(-20, 20)),
    st.tuples(st.just("stretch"), st.floats(0.1, 4)),
    st.tuples(st.just("back"), times),
)


def changed(motion: OwnAnimation, change: tuple[str, float]) -> OwnAnimation:
    what, number = change
    known = editing.key_times(motion)
    some = known[int(number * 7) % len(known) :: 2] if known else []
    match what:
        case "pose":
            return editing.with_pose(motion, number, {"HeadPitch": 0.1, "RHand": 0.5})
        case "move":
            return editing.moved(motion, {time: time + number - 5 for time in some})
        case "delete":
            return editing.without_times(motion, some[:1])
        case "copy":
            return editing.copied(motion, some[:3], number)
        case "shift":
            return editing.shifted_after(motion, abs(number), number)
        case "stretch":
            return editing.stretched(motion, number)
    return editing.backwards(motion)


@given(st.lists(changes, max_size=12))
def test_whatever_is_done_to_it_a_motion_can_be_kept(steps: list[tuple[str, float]]) -> None:
    motion = NODS

    for step in steps:
        motion = changed(motion, step)
        assert not motion.joints or why_not_animation("nods", motion) is None, step


def test_the_rehearsal_passes_through_the_keys(body: Body) -> None:
    rehearsal = Rehearsal(body, NODS)

    for time, angle in zip((0.5, 1.0, 2.0), (0.3, -0.2, 0.0), strict=True):
        assert rehearsal.pose(time)[body.index["HeadPitch"]] == pytest.approx(angle, abs=1e-3)
    assert np.allclose(rehearsal.pose(0.0), body.posture_angles("Stand"))


def test_what_is_too_fast_is_told_and_gets_the_time_it_needs(body: Body) -> None:
    hurried = OwnAnimation("A", {"HeadYaw": JointKeys((0.1, 0.2, 1.5), (1.5, -1.5, 0.0))})
    rehearsal = Rehearsal(body, hurried)

    calm = given_time(rehearsal)

    assert [(one.joint, one.to_s) for one in rehearsal.too_fast()] == [
        ("HeadYaw", 0.1),
        ("HeadYaw", 0.2),
    ]
    assert rehearsal.again(calm).too_fast() == []
    _, second, third = editing.key_times(calm)
    assert third - second == pytest.approx(1.3)
    assert calm.duration_s < 2.6


def test_a_shipped_pace_is_not_called_too_fast(body: Body) -> None:
    assert Rehearsal(body, NODS).too_fast() == []


def test_a_changed_joint_alone_is_worked_out_again(body: Body) -> None:
    rehearsal = Rehearsal(body, NODS)

    again = rehearsal.again(editing.with_pose(NODS, 1.0, {"LHand": 0.5}))

    assert again.pose(1.0)[body.index["LHand"]] == pytest.approx(0.5, abs=1e-3)
    assert again.pose(0.5)[body.index["HeadPitch"]] == pytest.approx(0.3, abs=1e-3)
