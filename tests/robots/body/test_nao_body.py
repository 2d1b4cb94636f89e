from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from nao_skeleton import frames, point
from nao_stage import BODY

from robots.body.body import load_body, posture_name, posture_path
from robots.body.keyframes import mirror_angle
from robots.body.limbs import MOVING, Limb
from robots.errors import ActionFailed, FilesUnusable


def test_it_has_the_26_joints_of_nao_with_their_limits() -> None:
    assert len(BODY.names) == 26
    assert (BODY.min < BODY.max).all() and (BODY.max_speed > 0).all()
    assert BODY.max[BODY.index["LKneePitch"]] == pytest.approx(2.1125)


def test_the_right_side_has_the_limits_of_the_left_one_but_for_its_ankle() -> None:
    low, high = (
        dict(zip(BODY.names, BODY.min, strict=True)),
        dict(zip(BODY.names, BODY.max, strict=True)),
    )
    for left in (name for name in BODY.names if name.startswith("L")):
        name, right = left[1:], f"R{left[1:]}"
        limits = [low[left], high[left]]
        mirrored = sorted(mirror_angle(name, angle) for angle in limits)
        if right != "RAnklePitch":
            assert [low[right], high[right]] == pytest.approx(mirrored), right
    assert (low["RAnklePitch"], high["RAnklePitch"]) == pytest.approx((-1.1863, 0.932))


def test_every_joint_belongs_to_one_moving_limb() -> None:
    columns = [column for limb in MOVING for column in BODY.columns({limb})]

    assert sorted(columns) == list(range(26))
    assert BODY.limbs_of(["LHand", "LHipRoll"]) == {Limb.LEFT_ARM, Limb.LEGS}


@pytest.mark.parametrize("name", BODY.postures)
def test_every_posture_is_within_the_limits(name: str) -> None:
    _, clamped = BODY.clamped(BODY.posture_angles(name))

    assert clamped == []


def test_an_angle_beyond_a_limit_is_clamped_and_named() -> None:
    angles = BODY.posture_angles("Stand")
    angles[BODY.index["LElbowRoll"]] = 1.0

    allowed, clamped = BODY.clamped(angles)

    assert clamped == ["LElbowRoll"]
    assert allowed[BODY.index["LElbowRoll"]] == pytest.approx(-0.0349)


def test_both_hips_are_turned_by_one_motor() -> None:
    angles = BODY.posture_angles("StandZero")
    angles[BODY.index["LHipYawPitch"]] = -0.5

    allowed, clamped = BODY.clamped(angles)

    assert allowed[BODY.index["RHipYawPitch"]] == -0.5
    assert clamped == ["RHipYawPitch"]


@pytest.mark.parametrize(
    ("yaw_deg", "lowest_deg", "highest_deg"),
    [(0, -38.5, 29.5), (-43.3, -31.4, 21.2), (75, -21.75, 14.35), (119.5, -25.7, 18.9)],
)
def test_the_shell_lets_a_turned_head_nod_less(
    yaw_deg: float, lowest_deg: float, highest_deg: float
) -> None:
    low, high = BODY.pitch_limits(np.radians(yaw_deg))

    assert np.degrees([low, high]) == pytest.approx([lowest_deg, highest_deg])


@pytest.mark.parametrize("name", ["Stand", "StandInit", "StandZero"])
def test_both_feet_are_flat_and_level_in_standing_postures(name: str) -> None:
    angles = BODY.posture_angles(name)
    left, right = frames(angles)["L_ankle"][0], frames(angles)["R_ankle"][0]

    assert point(angles, "left_sole")[2] == pytest.approx(point(angles, "right_sole")[2], abs=1e-3)
    assert left[:, 2] == pytest.approx(right[:, 2], abs=5e-3)


def test_every_posture_can_be_reached_from_every_other_by_neighbours() -> None:
    for start in BODY.postures:
        for goal in BODY.postures:
            path = posture_path(BODY, start, goal)

            assert path[-1] == goal
            for here, there in zip([start, *path], path, strict=False):
                assert here == there or there in BODY.postures[here].next


def test_it_gets_up_from_its_back_by_way_of_sitting_and_crouching() -> None:
    path = posture_path(BODY, "LyingBack", "Stand")

    assert path == ["SitRelax", "Sit", "Crouch", "StandInit", "Stand"]


@pytest.mark.parametrize(
    "word", ["posture_stand_init", "posture_standInit", "StandInit", "stand init"]
)
def test_a_posture_is_known_by_the_spellings_of_programs(word: str) -> None:
    assert posture_name(BODY, word) == "StandInit"


def test_an_unknown_posture_is_answered_with_those_there_are() -> None:
    with pytest.raises(ActionFailed, match=r'"posture_fly".*posture_stand_init.*posture_rest'):
        posture_name(BODY, "posture_fly")


def test_a_body_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    (tmp_path / "body.json").write_text('{"joints": [')

    with pytest.raises(FilesUnusable, match=r"body\.json"):
        load_body(tmp_path)
