"""No animation carries a robot's weight beyond its soles: by zero-moment points, and in MuJoCo."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from nao_skeleton import NAO
from nao_stage import ANIMATIONS, BODY, Stage
from nao_zmp import margins_m, on_wheels, whole_play, zero_moment_points

from robots.body.animations import Animation, load_animation, load_animations
from robots.body.body import load_body

PEPPER = on_wheels(load_body(NAO.parent / "pepper"), "Tibia")
PEPPERS = load_animations(NAO.parent / "pepper" / "animations", PEPPER.body)
LEAST_M = 0.01
"""The floor carries it so far inside of its soles at least: motors are not exact."""
MENDED = ("katana", "dog", "sneeze")
GAINS, FRICTIONS = (60.0, 150.0, 400.0), (0.5, 1.2)


THROWING = (
    (
        "HipPitch = -20.1, KneePitch = 47, AnklePitch = -28",
        "HipPitch = -26.2, KneePitch = 47, AnklePitch = -21.9",
    ),
    (
        "HipPitch = -19.6, KneePitch = 47, AnklePitch = -28.5",
        "HipPitch = -26.2, KneePitch = 47, AnklePitch = -21.9",
    ),
    (
        "HipPitch = -56, KneePitch = 70.9, AnklePitch = -26.3",
        "HipPitch = -44, KneePitch = 70.9, AnklePitch = -38.3",
    ),
    ("at = 2.2\n", "at = 2.07\n"),
)
"""The katana as it was, by what it is now: its cut threw the robot over."""


@pytest.fixture
def throwing(tmp_path: Path) -> Animation:
    text = (NAO / "animations" / "katana.toml").read_text()
    for new, old in THROWING:
        assert new in text
        text = text.replace(new, old)
    path = tmp_path / "planted.toml"
    path.write_text(text)
    return load_animation(path, BODY)


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_the_floor_carries_nao_inside_of_its_soles(name: str) -> None:
    animation = ANIMATIONS.get(name)
    postures = [animation.starts_from] if animation.starts_from else ["Stand", "StandInit"]

    least_m = min(margins_m(whole_play(animation, posture)).min() for posture in postures)

    assert least_m >= LEAST_M, f"{name}: {least_m * 1000:.1f} mm"


def test_what_is_checked_is_what_the_robot_plays() -> None:
    stage = Stage("StandInit")
    stage.ask("1", "play", animation="katana")
    stage.finish()

    least_m = margins_m(np.array(stage.angles)).min()

    assert least_m == pytest.approx(margins_m(whole_play(ANIMATIONS.get("katana"))).min(), abs=1e-6)


def test_a_planted_cut_that_throws_it_over_is_found(throwing: Animation) -> None:
    assert margins_m(whole_play(throwing)).min() < -0.05


@pytest.mark.parametrize("name", PEPPERS.names())
def test_the_floor_carries_pepper_inside_of_its_wheels(name: str) -> None:
    angles = whole_play(PEPPERS.get(name), "Stand", PEPPER)

    least_m = margins_m(angles, PEPPER).min()

    assert least_m >= LEAST_M, f"{name}: {least_m * 1000:.1f} mm"


@pytest.mark.parametrize("name", [*MENDED, "wave"])
def test_mujoco_finds_the_same_zero_moment_points(name: str) -> None:
    nao_mujoco = pytest.importorskip("nao_mujoco", exc_type=ImportError)
    angles = whole_play(ANIMATIONS.get(name))

    away_m = np.abs(nao_mujoco.carried_at(angles) - zero_moment_points(angles)).max()

    assert away_m < 0.001


@pytest.mark.parametrize("name", [*MENDED, "cheer", "batting", "dance"])
def test_the_mended_ones_stand_in_mujoco(name: str) -> None:
    nao_mujoco = pytest.importorskip("nao_mujoco", exc_type=ImportError)
    ground = nao_mujoco.Ground(150.0, 0.8)

    assert not nao_mujoco.played(whole_play(ANIMATIONS.get(name)), ground).has_fallen


def test_the_planted_cut_falls_in_mujoco(throwing: Animation) -> None:
    nao_mujoco = pytest.importorskip("nao_mujoco", exc_type=ImportError)

    outcome = nao_mujoco.played(whole_play(throwing), nao_mujoco.Ground(150.0, 0.8))

    assert outcome.has_fallen


@pytest.mark.mujoco
@pytest.mark.parametrize(("gain", "friction"), [*product(GAINS, FRICTIONS)])
@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_every_animation_stands_in_mujoco(name: str, gain: float, friction: float) -> None:
    nao_mujoco = pytest.importorskip("nao_mujoco", exc_type=ImportError)
    ground = nao_mujoco.Ground(gain, friction)

    outcome = nao_mujoco.played(whole_play(ANIMATIONS.get(name)), ground)

    assert not outcome.has_fallen and np.degrees(outcome.tilt_rad) < 10.0
