"""The virtual NAO's hands, single joints, locks, sleep, walk without an end, gaze and pointing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nao_skeleton import frames
from nao_stage import BODY, Stage

from robots.body.driver import SenseRequest
from robots.body.inverse import arm_angles

pytestmark = pytest.mark.long


def angle_deg(stage: Stage, joint: str) -> float:
    return math.degrees(stage.robot.angles[BODY.index[joint]])


@pytest.mark.parametrize(("side", "moved"), [("left", "L"), ("right", "R"), ("both", "LR")])
def test_hands_open_and_close(side: str, moved: str) -> None:
    stage = Stage()
    stage.do("hand", side="both", open=False)

    stage.do("hand", side=side, open=True)

    hands = {letter: stage.robot.angles[BODY.index[f"{letter}Hand"]] for letter in "LR"}
    assert hands == {letter: pytest.approx(float(letter in moved), abs=1e-6) for letter in "LR"}


def test_a_joint_moves_to_an_angle_and_by_one() -> None:
    stage = Stage()
    stage.do("move_joint", joint="HeadYaw", degrees=30)

    stage.do("move_joint", joint="HeadYaw", degrees=-10, relative=True)

    assert angle_deg(stage, "HeadYaw") == pytest.approx(20)


@given(joint=st.sampled_from(BODY.names), degrees=st.floats(-360, 360), relative=st.booleans())
def test_no_joint_ever_leaves_its_limits_or_its_speed(
    joint: str, degrees: float, relative: bool
) -> None:
    stage = Stage()

    result = stage.do("move_joint", joint=joint, degrees=degrees, relative=relative)

    assert result.state == ("failed" if stage.robot.fallen else "done")
    assert np.allclose(stage.robot.angles, BODY.clamped(stage.robot.angles)[0])
    assert (stage.relative_speeds <= (0.51 if stage.robot.fallen else 0.31)).all()


def test_both_hips_turn_with_their_one_motor() -> None:
    stage = Stage()

    stage.do("move_joint", joint="RHipYawPitch", degrees=-20)

    assert angle_deg(stage, "LHipYawPitch") == angle_deg(stage, "RHipYawPitch")
    assert angle_deg(stage, "LHipYawPitch") == pytest.approx(-20)


def test_a_joint_that_cannot_go_so_far_says_how_far_it_went() -> None:
    stage = Stage()

    result = stage.do("move_joint", joint="LElbowRoll", degrees=90)

    assert result.description == "moved as far as it goes: -2 degrees"


def test_a_released_arm_does_not_move_until_it_is_locked() -> None:
    stage = Stage()
    stage.do("stiffness", part="left_arm", on=False)

    refused = stage.do("hand", side="left", open=True)
    free = stage.do("hand", side="right", open=True)
    stage.do("stiffness", part="arms", on=True)
    allowed = stage.do("hand", side="left", open=True)

    assert refused.state == "failed"
    assert "left arm is released" in refused.description
    assert (free.state, allowed.state) == ("done", "done")


def test_a_resting_nao_is_loose_and_wakes_up_standing() -> None:
    stage = Stage()
    stage.do("rest")
    resting = stage.driver.state()

    stage.do("wake_up")

    assert resting.posture == "Rest"
    assert resting.settings["awake"] is False and resting.settings["locked_head"] is False
    assert stage.robot.posture == "Stand" and stage.driver.state().settings["awake"] is True


def test_a_walk_without_an_end_goes_on_until_the_legs_are_asked_for_something_else() -> None:
    stage = Stage()
    stage.ask("walk", "walk_freely", forward=1.0)
    stage.pass_time(20)
    way_m = stage.robot.base[0]

    stage.ask("turn", "turn", degrees=90)
    stage.finish()

    assert 1.0 < way_m < 2.0
    assert [told for told in stage.told if told.startswith("walk")][-1] == "walk done"
    assert stage.robot.base[2] == pytest.approx(math.pi / 2, abs=0.01)


def test_a_slower_walk_is_slower() -> None:
    ways = []
    for forward in (1.0, 0.5):
        stage = Stage()
        stage.ask("walk", "walk_freely", forward=forward)
        stage.pass_time(20)
        ways.append(stage.robot.base[0])

    assert ways[1] == pytest.approx(ways[0] / 2, rel=0.15)


def test_stop_moving_lets_it_go_on_speaking() -> None:
    stage = Stage()
    stage.ask("walk", "walk_freely", forward=1.0)
    stage.ask("say", "say", text="I go on speaking, whatever my legs do now.")
    stage.pass_time(1)

    stage.ask("stop", "stop_moving")
    stage.finish()

    assert "walk cancelled" in stage.told and "say done" in stage.told


def seen_by_torso(stage: Stage, place: tuple[float, float, float]) -> np.ndarray:
    """A place on the floor in the frame of the torso, which may lean."""
    stance = stage.robot.stance
    return stance.turn.T @ (np.array(place) - stance.place)


@pytest.mark.parametrize("place", [(1, 0, 0.5), (1, 1, 0.3), (0.5, -0.4, 0.6), (2, 0.2, 0.1)])
def test_it_looks_at_a_place(place: tuple[float, float, float]) -> None:
    stage = Stage()

    stage.do("look_at", x_m=place[0], y_m=place[1], z_m=place[2])

    turn, neck = frames(stage.robot.angles)["Head"]
    to_place = seen_by_torso(stage, place) - neck
    assert turn @ [1, 0, 0] == pytest.approx(to_place / np.linalg.norm(to_place), abs=1e-3)


def test_a_place_in_the_world_stays_where_it_is_when_the_robot_turns() -> None:
    stage = Stage()
    stage.do("turn", degrees=90)

    stage.do("look_at", x_m=0, y_m=2, z_m=0.45, frame="world")

    assert angle_deg(stage, "HeadYaw") == pytest.approx(0, abs=0.5)


@pytest.mark.parametrize(
    ("place", "side"),
    [((1, 0.5, 0.5), "left"), ((1, -0.5, 0.2), "right"), ((0.4, 0.6, 0.9), "left")],
)
def test_it_points_at_a_place_with_the_arm_that_is_nearer(
    place: tuple[float, float, float], side: str
) -> None:
    stage = Stage()

    result = stage.do("point_at", x_m=place[0], y_m=place[1], z_m=place[2])

    letter = side[0].upper()
    turn, shoulder = frames(stage.robot.angles)[f"{letter}Bicep"]
    to_place = seen_by_torso(stage, place) - shoulder
    assert result.description == ""
    assert turn @ [1, 0, 0] == pytest.approx(to_place / np.linalg.norm(to_place), abs=1e-3)
    assert stage.robot.angles[BODY.index[f"{letter}Hand"]] == pytest.approx(1.0)


@given(st.tuples(*[st.floats(-2, 2)] * 3), st.sampled_from(["left", "right"]))
def test_angles_of_an_arm_are_numbers_for_every_place(
    place: tuple[float, float, float], side: str
) -> None:
    assert all(math.isfinite(angle) for angle in arm_angles(place, side, BODY))


def test_without_a_face_it_says_that_it_sees_none() -> None:
    stage = Stage()

    result = stage.do("look_at_seen", thing="face")

    assert result.state == "failed"
    assert result.description.startswith("NAO does not see a face.")


def test_the_head_follows_a_face_that_it_tracks() -> None:
    stage = Stage()
    stage.actor.sense(SenseRequest(robot="NAO", sense="face", place=(1.0, 0.0, 0.5)))
    stage.do("track", thing="face")

    stage.actor.sense(SenseRequest(robot="NAO", sense="face", place=(1.0, 1.0, 0.5)))
    stage.finish()
    followed = angle_deg(stage, "HeadYaw")
    stage.do("track", thing="face", using="off")
    stage.actor.sense(SenseRequest(robot="NAO", sense="face", place=(1.0, -1.0, 0.5)))
    stage.finish()

    assert followed == pytest.approx(45, abs=0.5)
    assert angle_deg(stage, "HeadYaw") == pytest.approx(followed)


def test_tracking_with_the_body_turns_it_to_the_sound() -> None:
    stage = Stage()
    stage.actor.sense(SenseRequest(robot="NAO", sense="sound", place=(0.0, 2.0, 0.5)))

    stage.do("track", thing="sound", using="body")

    assert stage.robot.base[2] == pytest.approx(math.pi / 2, abs=0.02)
    assert angle_deg(stage, "HeadYaw") == pytest.approx(0, abs=1)


def test_what_is_no_text_is_refused_in_plain_words() -> None:
    stage = Stage()

    stage.ask("1", "track", thing={"x": 1})
    stage.ask("2", "track", thing=["face"])

    said = [result.description for result in stage.results]
    assert "thing should be text, not a group of values" in said[0]
    assert "thing should be text, not a list" in said[1]
