from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from nao_capsules import ALLOWED_M, balance_m, depths
from nao_skeleton import NAO, point
from nao_stage import ANIMATIONS, BODY, Stage

from robots.body.animations import NO_GESTURE, Animation, load_animation
from robots.body.body import Angles
from robots.body.limbs import Limb
from robots.body.motion import TICK_S, keyframe_motion
from robots.body.speech import CONTEXTUAL, RANDOM

WAVE = (NAO / "animations" / "wave.toml").read_text()


@cache
def played(name: str, posture: str = "Stand") -> Angles:
    """Every joint's angle at every tick, from the posture that the animation starts from."""
    animation = ANIMATIONS.get(name)
    start = BODY.posture_angles(animation.starts_from or posture)
    motion = keyframe_motion(BODY, start, animation.keyframes)
    angles = np.repeat(start[None], len(motion.angles), axis=0)
    angles[:, motion.columns] = motion.angles
    return angles


def heights(name: str, part: str) -> Angles:
    return point(played(name), part)[:, 2]


def assert_possible_as_written(animation: Animation) -> None:
    start = BODY.posture_angles(animation.starts_from or "Stand")
    assert keyframe_motion(BODY, start, animation.keyframes).notes == ()


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_every_animation_is_within_limits_and_speeds_as_written(name: str) -> None:
    assert_possible_as_written(ANIMATIONS.get(name))


@pytest.mark.parametrize(
    ("old", "new"), [("at = 1.22", "at = 0.98"), ("ShoulderPitch = -65.9", "ShoulderPitch = -125")]
)
def test_a_planted_animation_that_is_too_fast_or_too_wide_is_found(
    old: str, new: str, tmp_path: Path
) -> None:
    path = tmp_path / "planted.toml"
    path.write_text(WAVE.replace(old, new))

    with pytest.raises(AssertionError):
        assert_possible_as_written(load_animation(path, BODY))


def test_all_that_the_robot_profile_offers_is_there_and_all_that_is_there_is_offered() -> None:
    choices = tomllib.loads((NAO / "robot.toml").read_text())["choices"]

    assert set(choices["animations"]) == set(ANIMATIONS.names("animation"))
    assert set(choices["animals"]) == set(ANIMATIONS.names("animal"))
    told = {NO_GESTURE, CONTEXTUAL, RANDOM}
    assert set(choices["say_gestures"]) - told == set(ANIMATIONS.names("gesture"))


def test_there_are_many_animations() -> None:
    assert len(ANIMATIONS.names()) >= 45
    assert len(ANIMATIONS.names("animal")) >= 14
    assert len(ANIMATIONS.names("gesture")) >= 20


@pytest.mark.parametrize("name", ["katana", "batting", "hand_up", "karate", "strech_up"])
def test_the_five_gestures_that_people_make_can_be_shown_by_the_robot(name: str) -> None:
    assert ANIMATIONS.get(name, "animation").title


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_every_animation_is_written_as_poses_that_say_what_they_are(name: str) -> None:
    file = tomllib.loads((NAO / "animations" / f"{name}.toml").read_text())

    assert len(file["poses"]) >= 3
    assert all(pose["doing"] for pose in file["poses"])


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_arms_pass_through_nothing(name: str) -> None:
    deep = {part: m for part, m in depths(played(name)[::2]).items() if m > 0}

    assert all(m <= ALLOWED_M for m in deep.values()), deep


def test_a_planted_hand_in_the_belly_is_found() -> None:
    angles = BODY.posture_angles("StandZero")
    angles[BODY.index["LShoulderPitch"]] = 1.6
    angles[BODY.index["LElbowRoll"]] = -1.5
    angles[BODY.index["LShoulderRoll"]] = -0.2

    assert depths(angles[None])["L arm in torso"] > ALLOWED_M


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_nao_keeps_its_balance(name: str) -> None:
    start = ANIMATIONS.get(name).starts_from
    postures = [start] if start else ["Stand", "StandInit"]

    assert all(balance_m(played(name, posture)[::4]) >= 0.01 for posture in postures)


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_nao_plays_each_animation_to_its_end_without_falling(name: str) -> None:
    stage = Stage()

    result = stage.live_fast("play", animation=name)

    assert (result.state, result.description) == ("done", "")
    assert not stage.robot.fallen and np.abs(stage.robot.base).max() < 0.02


def test_a_planted_pose_that_falls_is_found() -> None:
    angles = BODY.posture_angles("StandInit")
    angles[[BODY.index["LAnklePitch"], BODY.index["RAnklePitch"]]] -= 0.4

    assert balance_m(angles[None]) < 0.01


@pytest.mark.parametrize("name", ANIMATIONS.names("gesture"))
def test_gestures_for_speaking_leave_the_legs_alone(name: str) -> None:
    assert Limb.LEGS not in ANIMATIONS.get(name).limbs


@pytest.mark.parametrize("name", ANIMATIONS.names("animal"))
def test_every_animal_makes_its_sound(name: str) -> None:
    stage = Stage()

    stage.ask("1", "imitate", animal=name)
    said = set()
    while not said & {ANIMATIONS.get(name).says} and stage.now_s < 10:
        stage.pass_time(0.1)
        said.add(stage.robot.saying)

    assert said == {"", ANIMATIONS.get(name).says}


@pytest.mark.parametrize("name", ["hand_up", "wave", "greet"])
def test_a_raised_hand_is_above_the_head(name: str) -> None:
    assert (heights(name, "right_hand") - heights(name, "head_top")).max() > 0.03
    assert heights(name, "left_hand").max() < 0.05


def test_stretching_and_cheering_raise_both_hands() -> None:
    for name in ("strech_up", "cheer"):
        for hand in ("left_hand", "right_hand"):
            assert (heights(name, hand) - heights(name, "head_top")).max() > 0.05


def test_karate_punches_forward_with_both_hands_and_strikes_down_from_above_the_head() -> None:
    angles = played("karate")
    left, right = point(angles, "left_hand"), point(angles, "right_hand")

    for hand in (left, right):
        punch = hand[hand[:, 0].argmax()]
        assert punch[0] > 0.2 and abs(punch[2] - 0.1) < 0.04
    top = right[:, 2].argmax()
    assert right[top, 2] > point(angles[top], "head_top")[2] - 0.02
    strike = right[top : top + round(0.6 / TICK_S)]
    assert strike[-1, 2] - strike[0, 2] < -0.2
    assert strike[-1, 0] > 0.12


def test_katana_is_held_with_both_hands_from_above_the_head_down() -> None:
    angles = played("katana")
    left, right = point(angles, "left_hand"), point(angles, "right_hand")

    held = np.linalg.norm(left - right, axis=1)[round(0.8 / TICK_S) : round(3.9 / TICK_S)]
    assert held.max() < 0.13
    assert left[:, 2].max() > 0.25 and left[:, 2].min() < 0.05


def test_batting_swings_both_hands_from_right_to_left() -> None:
    angles = played("batting")
    right = point(angles, "right_hand")[:, 1]

    assert right[: round(1.5 / TICK_S)].min() < -0.06
    assert right[round(1.7 / TICK_S) :].max() > -0.01


def test_bow_leans_the_body_forward_and_keeps_the_feet_flat() -> None:
    angles = played("bow")
    pitches = [BODY.index[f"L{joint}Pitch"] for joint in ("Hip", "Knee", "Ankle")]
    lean = -angles[:, pitches].sum(axis=1)

    assert np.degrees(lean.max()) > 35
    assert lean[-1] == pytest.approx(0.1, abs=0.02)


@pytest.mark.parametrize(
    "name", [name for name in ANIMATIONS.names() if ANIMATIONS.get(name).starts_from]
)
def test_both_legs_bend_alike_so_that_both_feet_stay_on_the_floor(name: str) -> None:
    left, right = heights(name, "left_sole"), heights(name, "right_sole")

    # A swaying body tilts in its own frame: by the distance of the feet times the sway.
    assert np.abs(left - right).max() < 0.012


def test_clapping_hands_meet() -> None:
    angles = played("clap")
    gaps = np.linalg.norm(point(angles, "left_hand") - point(angles, "right_hand"), axis=1)

    assert gaps.min() < 0.04 and gaps[round(0.8 / TICK_S) :].max() > 0.15


def test_the_elephant_lifts_its_trunk_and_the_crow_spreads_its_wings() -> None:
    trunk = heights("elephant", "right_hand")
    left = point(played("crow"), "left_hand")

    assert trunk.max() - trunk.min() > 0.3
    assert left[:, 1].max() > 0.27


def test_the_frog_squats_and_jumps() -> None:
    sole = heights("frog", "left_sole")

    assert sole.min() < -0.32 and sole.max() > -0.26
