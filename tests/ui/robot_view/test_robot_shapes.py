"""Rounded shapes: how far they reach, and what the file of a robot says about them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import NodeStartError
from nep_core.wire.messages import RobotState
from nep_studio import paths
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.parts import Blob, Solids, all_parts, facing, read_view, rotation
from nep_studio.ui.robot_view.view import nao_folder

sizes = st.tuples(*[st.floats(0.01, 1.0)] * 3)
powers = st.tuples(st.floats(1.5, 12.0), st.floats(1.5, 12.0))
places = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
directions = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda way: math.hypot(*way) > 0.1)


def surface_points(blob: Blob) -> np.ndarray:
    """Points on the surface of a superellipsoid, from its equation."""
    turns, tilts = np.meshgrid(np.linspace(0, 2 * np.pi, 24), np.linspace(-1.5, 1.5, 13))
    ways = [np.cos(tilts) * np.cos(turns), np.cos(tilts) * np.sin(turns), np.sin(tilts)]
    unit = np.stack(ways, axis=-1).reshape(-1, 3)
    across, along = blob.powers
    x, y, z = np.abs(unit).T
    reach = ((x**across + y**across) ** (along / across) + z**along) ** (1 / along)
    return np.array(blob.at) + unit / reach[:, None] * blob.size


@given(st.lists(st.builds(Blob, places, sizes, powers), min_size=1, max_size=3), directions)
def test_no_point_of_a_shape_is_farther_than_its_farthest(
    blobs: list[Blob], way: tuple[float, float, float]
) -> None:
    direction = np.array(way) / math.hypot(*way)

    farthest = Solids.of([blobs]).farthest(direction[None, None])[0, 0]

    reached = max(float((surface_points(blob) @ direction).max()) for blob in blobs)
    assert farthest @ direction >= reached - 1e-6


@given(st.lists(st.builds(Blob, places, sizes, powers), min_size=1, max_size=3), directions)
def test_a_shape_stays_within_its_box(blobs: list[Blob], way: tuple[float, float, float]) -> None:
    solids = Solids.of([blobs])

    farthest = solids.farthest(np.array(way)[None, None])[0, 0]

    assert (np.abs(farthest - solids.middle[0]) <= solids.extent[0] + 1e-9).all()


def test_shapes_joined_reach_as_far_as_each_of_them() -> None:
    one = Solids.of([[Blob(size=(1, 2, 3))], [Blob((1, 0, 0), (1, 1, 1), (4, 4))]])
    other = Solids.of([[Blob(size=(2, 2, 2)), Blob((0, 0, 3), (1, 1, 1))]])
    ways = np.random.default_rng(1).normal(size=(3, 5, 3))

    joined = Solids.joined([one, other]).farthest(ways)

    assert np.allclose(joined[:2], one.farthest(ways[:2]))
    assert np.allclose(joined[2:], other.farthest(ways[2:]))


@given(directions)
def test_a_part_that_faces_somewhere_has_its_axis_there(way: tuple[float, float, float]) -> None:
    turn = facing(np.array(way))

    assert np.allclose(turn[:, 2], np.array(way) / math.hypot(*way))
    assert np.allclose(turn.T @ turn, np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_a_rotation_about_the_vertical_takes_ahead_to_the_left() -> None:
    turned = rotation(np.array([0.0, 0.0, 1.0]), math.pi / 2) @ np.array([1.0, 0.0, 0.0])

    assert np.allclose(turned, [0.0, 1.0, 0.0])


def test_naos_left_and_right_are_alike() -> None:
    parts = {one.part.name: one for one in all_parts(read_view(nao_folder() / "view.toml"))}

    left, right = parts["forearm_left"], parts["forearm_right"]
    assert (left.part.link, right.part.link) == ("LForeArm", "RForeArm")
    assert np.allclose(np.array(left.at) * (1, -1, 1), right.at)
    assert parts["bumper_right"].part.sensor == "bumper_right"
    assert parts["eye_led_right_3"].part.light == "FaceLedRight3"


ROBOTS = sorted(path.parent for path in (paths.resources() / "robots").glob("*/view.toml"))


@pytest.mark.parametrize("folder", ROBOTS, ids=lambda folder: folder.name)
def test_every_robot_of_the_program_can_be_seen(folder: Path) -> None:
    figure = load_figure(folder)
    posture = next(iter(figure.body.postures))
    angles = figure.body.posture_angles(posture).tolist()
    joints = dict(zip(figure.body.names, angles, strict=True))

    placed = figure.pose(RobotState(robot="r", joints=joints, posture=posture))

    assert figure.head in placed.links
    assert {"head_front", "head_middle", "head_rear"} <= set(figure.sensors)
    assert np.isfinite(placed.corners()).all()


def test_a_part_on_a_link_that_the_body_does_not_have_is_told_of(tmp_path: Path) -> None:
    for name in ("body.json", "view.toml"):
        text = (nao_folder() / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text.replace('link = "Neck"', 'link = "Tail"'), "utf-8")

    with pytest.raises(NodeStartError, match="has no link Tail for its part neck"):
        load_figure(tmp_path)


def test_nao_has_all_its_lights_and_sensors() -> None:
    figure = load_figure(nao_folder())

    lights = [part.light for part in figure.parts if part.light]
    assert len([one for one in lights if one.startswith("FaceLed")]) == 16
    assert len([one for one in lights if one.startswith("Brain")]) == 12
    assert len([one for one in lights if "EarLed" in one]) == 20
    assert set(figure.sensors) == {
        *("head_front", "head_middle", "head_rear", "chest_button"),
        *("hand_left", "hand_right", "bumper_left", "bumper_right"),
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("not toml [", "cannot be read"),
        ('colours = {}\n[[part]]\nname="a"\nlink="b"\ncolour="c"\nshape="ball"', "no colour c"),
        ('colours = {c="#fff"}\n[[part]]\nname="a"\nlink="b"\ncolour="c"\nshape="egg"', "egg"),
    ],
)
def test_a_file_that_makes_no_robot_is_told_of_in_words(
    tmp_path: Path, text: str, words: str
) -> None:
    path = tmp_path / "view.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(NodeStartError) as told:
        read_view(path)

    assert words in f"{told.value} {told.value.details}"
