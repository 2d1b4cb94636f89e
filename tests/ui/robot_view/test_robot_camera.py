"""Cameras: from the room to pixels and back, and seeing all that there is."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.ui.robot_view.camera import Camera, Frame, Lens, fitted

cameras = st.builds(
    Camera,
    st.floats(-math.pi, math.pi),
    st.floats(0.1, 1.4),
    st.floats(0.5, 4.0),
    st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(0.0, 0.5)),
)


def test_from_the_front_the_robots_left_hand_is_on_the_right() -> None:
    lens = Lens(Camera(yaw=0.0), 640, 480)

    left = lens.project(np.array([0.0, 0.2, 0.27]))

    assert left[0] > 320
    assert left[1] == pytest.approx(240, abs=1)


@given(cameras, st.floats(0, 640), st.floats(0, 480))
def test_a_place_on_the_floor_is_under_the_pixel_that_shows_it(
    camera: Camera, x: float, y: float
) -> None:
    lens = Lens(camera, 640, 480)

    place = lens.floor_at(x, y)

    if place is not None and math.dist(place, camera.target[:2]) < 50:
        assert np.allclose(lens.project(np.array([*place, 0.0])), (x, y), atol=0.1)


@given(cameras)
def test_slopes_say_how_pixels_move(camera: Camera) -> None:
    lens, place = Lens(camera, 640, 480), np.array(camera.target)
    step = np.array([1e-5, -2e-5, 1.5e-5])

    moved = lens.project(place + step) - lens.project(place)

    assert np.allclose(lens.slopes(place) @ step, moved, atol=1e-5)


@given(cameras, st.integers(100, 1000), st.integers(100, 1000), st.integers(0, 30))
def test_a_fitted_camera_sees_all_places(camera: Camera, width: int, height: int, top: int) -> None:
    places = np.array([0.5, -0.5, 0.3]) + np.random.default_rng(3).uniform(-0.3, 0.3, (20, 3))

    pixels = Lens(fitted(camera, places, Frame(width, height, top), 0.1), width, height).project(
        places
    )

    assert (pixels > (-1, top - 1)).all()
    assert (pixels < (width + 1, height + 1)).all()


def test_a_camera_does_not_go_over_the_top_nor_far_below_the_floor() -> None:
    assert Camera().orbited(0, 10).pitch == pytest.approx(math.radians(88))
    assert Camera().orbited(0, -10).pitch == pytest.approx(math.radians(-12))


@given(cameras, st.floats(0, 640), st.floats(0, 480))
def test_a_dragged_place_stays_as_far_from_the_eye(camera: Camera, x: float, y: float) -> None:
    lens = Lens(camera, 640, 480)

    place = np.array(lens.plane_at(x, y, camera.target))

    assert float(lens.depths(place)) == pytest.approx(camera.distance, abs=1e-6)
    assert np.allclose(lens.project(place), (x, y), atol=1e-3)
