"""The camera: where the person looks, and how large."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF

from nep_studio.ui.canvas.layout.index import LARGEST, SMALLEST, Camera

pixels = st.floats(0, 2000)
scales = st.floats(SMALLEST, LARGEST)


@given(pixels, pixels, scales, scales)
def test_what_is_under_the_pointer_stays_there_when_zooming(x, y, before, after) -> None:
    camera = Camera(100.0, -40.0, before)
    pointer = QPointF(x, y)
    place = camera.to_page(pointer)

    camera.zoom_at(pointer, after)

    again = camera.to_view(place.x(), place.y())
    assert again.x() == pytest.approx(x, abs=1e-6)
    assert again.y() == pytest.approx(y, abs=1e-6)


@pytest.mark.parametrize(("asked", "given_scale"), [(0.0001, SMALLEST), (90.0, LARGEST)])
def test_zooming_ends_at_its_limits(asked: float, given_scale: float) -> None:
    camera = Camera()

    camera.zoom_at(QPointF(0, 0), asked)

    assert camera.scale == given_scale


@given(st.floats(-1e5, 1e5), scales, st.sampled_from([1.0, 1.25, 1.5, 2.0]))
def test_an_aligned_corner_is_on_a_whole_pixel_of_the_screen(x, scale, ratio) -> None:
    camera = Camera(x, x, scale)

    camera.align(ratio)

    on_screen = camera.x * scale * ratio
    assert on_screen == pytest.approx(round(on_screen), abs=1e-3)
