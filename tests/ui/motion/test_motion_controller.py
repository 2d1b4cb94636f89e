"""The motion on the desk: posing, keys, and every step back."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nep_studio.blocks.own_animations import OwnAnimation, why_not_animation
from nep_studio.ui.plugins.motion import editing
from nep_studio.ui.plugins.motion.motion_controller import MotionController
from nodes.resources import resource_folder
from robots.body.body import load_body

pytestmark = pytest.mark.long

BODY = load_body(resource_folder() / "robots" / "nao")
RIGHT_ARM = {"RShoulderPitch", "RShoulderRoll", "RElbowYaw", "RElbowRoll", "RWristYaw", "RHand"}


@pytest.fixture
def desk() -> MotionController:
    desk = MotionController(BODY)
    desk.open(OwnAnimation("New", {}))
    return desk


def test_posing_an_arm_at_the_beginning_makes_the_first_key_of_that_arm(
    desk: MotionController,
) -> None:
    desk.set_joints({"RShoulderPitch": -0.5}, "pose")

    assert editing.key_times(desk.motion) == [1.0]
    assert desk.motion.joints.keys() == RIGHT_ARM
    assert (desk.cursor_s, desk.chosen) == (1.0, (1.0,))


def test_a_drag_is_one_step_and_the_next_one_another(desk: MotionController) -> None:
    for angle in (-0.1, -0.2, -0.3):
        desk.set_joints({"RShoulderPitch": angle}, "pose", merge="drag")
    desk.seal()
    desk.set_joints({"RShoulderPitch": -0.9}, "pose", merge="drag")

    desk.undo()

    assert desk.motion.joints["RShoulderPitch"].keys == (-0.3,)
    desk.undo()
    assert desk.motion.joints == {}
    assert not desk.is_modified
    desk.redo()
    desk.redo()
    assert desk.motion.joints["RShoulderPitch"].keys == (-0.9,)


def test_with_both_sides_alike_the_other_arm_does_as_in_a_mirror(desk: MotionController) -> None:
    desk.is_mirrored = True

    desk.set_joints({"LShoulderRoll": 0.8}, "pose")

    assert desk.motion.joints["RShoulderRoll"].keys == (-0.8,)


def test_legs_that_move_start_from_a_standing_posture(desk: MotionController) -> None:
    desk.set_joints({"LKneePitch": 0.9}, "pose")

    assert desk.motion.starts_from == "StandInit"
    desk.set_start("", "start")
    assert desk.motion.starts_from == "StandInit"


def test_angles_are_kept_within_the_limits(desk: MotionController) -> None:
    desk.set_joints({"HeadYaw": 9.0}, "pose")

    assert desk.motion.joints["HeadYaw"].keys[0] <= BODY.max[BODY.index["HeadYaw"]]


def test_a_key_of_what_moves_is_kept_where_the_moment_is(desk: MotionController) -> None:
    desk.set_joints({"RShoulderPitch": -0.5}, "pose")
    desk.show(2.0)

    desk.add_key("key")

    assert editing.key_times(desk.motion) == [1.0, 2.0]
    assert editing.pose_at(desk.motion, 2.0)["RShoulderPitch"] == pytest.approx(-0.5)


def test_chosen_keys_are_moved_copied_and_deleted(desk: MotionController) -> None:
    desk.set_joints({"RShoulderPitch": -0.5}, "pose")

    desk.move_chosen(0.5, "move")
    desk.copy_chosen(1.0, "copy")

    assert editing.key_times(desk.motion) == [1.5, 2.5]
    assert desk.chosen == (2.5,)
    desk.delete_chosen("delete")
    assert editing.key_times(desk.motion) == [1.5]


def test_what_is_saved_is_not_modified_any_more(desk: MotionController) -> None:
    desk.set_joints({"RShoulderPitch": -0.5}, "pose")
    assert desk.is_modified

    desk.saved("new")

    assert not desk.is_modified


steps = st.lists(
    st.tuples(
        st.sampled_from(["pose", "legs", "add", "move", "copy", "delete", "shift", "time", "show"]),
        st.floats(-3, 6),
    ),
    max_size=15,
)


@settings(deadline=None, max_examples=40)
@given(steps)
def test_every_step_can_be_taken_back_and_done_again(taken: list[tuple[str, float]]) -> None:
    desk = MotionController(BODY)
    desk.open(OwnAnimation("New", {}))
    begun = desk.motion

    for what, number in taken:
        step(desk, what, number)
        motion = desk.motion
        assert not motion.joints or why_not_animation("new", motion) is None

    done = desk.motion
    while desk.undo_label:
        desk.undo()
    assert desk.motion == begun
    while desk.redo_label:
        desk.redo()
    assert desk.motion == done


def step(desk: MotionController, what: str, number: float) -> None:
    match what:
        case "pose":
            desk.set_joints({"RShoulderPitch": number, "LHand": 0.5}, "pose")
        case "legs":
            desk.set_joints({"LKneePitch": number}, "legs")
        case "add":
            desk.add_key("add")
        case "move":
            desk.move_chosen(number, "move")
        case "copy":
            desk.copy_chosen(number, "copy")
        case "delete":
            desk.delete_chosen("delete")
        case "shift":
            desk.shift_after(abs(number), number, "shift")
        case "time":
            desk.give_time("time")
        case "show":
            desk.show(number)
