"""Files of animations: poses in degrees, or keys in rad, and what is wrong with others."""

from __future__ import annotations

from pathlib import Path

import pytest
from nao_stage import BODY

from robots.body.animations import load_animation
from robots.body.keyframes import Track
from robots.errors import FilesUnusable

KEYS = """
title = "Wave"
description = "Waves."
kind = "animation"

[joints.RElbowRoll]
times = [0.9, 1.22]
keys = [0.5, 1.05]

[joints.RHand]
times = [0.9]
keys = [0.0]
"""
POSES = """
title = "Wave"
description = "Waves."
kind = "animation"

[[poses]]
at = 0.9
doing = "lifts both hands"
arms = { ShoulderRoll = 30, Hand = 1 }
head = { Yaw = -10 }

[[poses]]
at = 1.22
doing = "lowers the right one"
right_arm = { ShoulderRoll = -10 }
"""


def test_a_file_may_have_poses_in_degrees_with_both_arms_as_in_a_mirror(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(POSES)

    tracks = load_animation(path, BODY).keyframes.tracks

    assert tracks["LShoulderRoll"] == Track((0.9,), (0.5236,))
    assert tracks["RShoulderRoll"] == Track((0.9, 1.22), (-0.5236, -0.17453))
    assert tracks["HeadYaw"] == Track((0.9,), (-0.17453,))
    assert tracks["LHand"] == tracks["RHand"] == Track((0.9,), (1.0,))


@pytest.mark.parametrize(
    ("text", "old", "new", "place"),
    [
        (KEYS, "RElbowRoll", "RElbowJaw", "joints.RElbowJaw: the robot has no such joint"),
        (KEYS, "keys = [0.0]", "keys = []", "1 times for 0 keys"),
        (KEYS, "1.22]", "0.5]", "every time must be"),
        (KEYS, "1.05]", "inf]", "infinite"),
        (KEYS, 'kind = "animation"', 'kind = "film"', "Invalid enum value 'film'"),
        (KEYS, "kind =", 'starts_from = "Fly"\nkind =', "no posture Fly"),
        (KEYS, "RElbowRoll", "RKneePitch", "needs a posture"),
        (KEYS, 'title = "Wave"', "title = ", "Invalid value"),
        (KEYS + POSES[POSES.index("[[") :], "", "", "a file has either of them"),
        (POSES, "at = 1.22", "at = 0.5", "lowers the right one: it must be later than 0.9 s"),
        (POSES, "at = 1.22", "at = nan", "it must be later than 0.9 s"),
        (POSES, "ShoulderRoll = 30", "Trunk = 30", "joints.LTrunk: the robot has no such joint"),
        (POSES, "head =", "tail =", "unknown field `tail`"),
    ],
)
def test_a_wrong_file_is_told_by_name_and_place(
    text: str, old: str, new: str, place: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new, 1) if old else text)

    with pytest.raises(FilesUnusable) as told:
        load_animation(path, BODY)

    assert "mine.toml" in str(told.value.sentence) and place in str(told.value.sentence)
