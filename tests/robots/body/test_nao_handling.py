"""Hands push a virtual robot over, and put it somewhere else."""

from __future__ import annotations

import math

import pytest

from nodes.resources import resource_folder
from robots.body.animations import load_animations
from robots.body.body import load_body
from robots.body.driver import SenseRequest
from robots.body.pose import VirtualRobot
from robots.body.virtual import VirtualDriver


@pytest.fixture
def driver() -> VirtualDriver:
    folder = resource_folder() / "robots" / "nao"
    body = load_body(folder)
    made = VirtualDriver(VirtualRobot("NAO", body, load_animations(folder / "animations", body)))
    made.connect()
    return made


def test_a_robot_that_is_put_somewhere_is_there_and_stays(driver: VirtualDriver) -> None:
    driver.sense(SenseRequest(robot="NAO", sense="place", place=(1.0, -0.5, math.pi / 2)))

    driver.step(1.0)
    state = driver.state()

    assert state.base == pytest.approx((1.0, -0.5, math.pi / 2), abs=0.02)
    assert state.torso is not None
    assert state.torso[:2] == pytest.approx((1.0, -0.5), abs=0.06)
    assert not state.fallen


@pytest.mark.parametrize("degrees", [0, 90, 180, -90])
def test_a_robot_that_is_pushed_falls_and_tells_it(driver: VirtualDriver, degrees: int) -> None:
    angle = math.radians(degrees)
    place = (math.cos(angle), math.sin(angle), 0.3)

    driver.sense(SenseRequest(robot="NAO", sense="push", place=place))
    driver.step(8.0)

    state = driver.state()
    assert state.fallen
    assert state.posture in ("LyingBelly", "LyingBack")
    assert "robot_fell" in driver.noticed()
    if degrees in (0, 180):
        assert state.posture == ("LyingBelly" if degrees == 0 else "LyingBack")


def test_a_place_that_is_none_changes_nothing(driver: VirtualDriver) -> None:
    before = driver.state().base

    for sense in ("place", "push"):
        driver.sense(SenseRequest(robot="NAO", sense=sense, place=(math.nan, math.inf, 0.0)))
    driver.step(1.0)

    assert driver.state().base == before
    assert not driver.state().fallen
