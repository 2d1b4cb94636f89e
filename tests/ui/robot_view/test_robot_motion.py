"""From told states to smooth movement, and which of them are seen at all."""

from __future__ import annotations

import math

import pytest

from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.figure import RobotFigure
from nep_studio.ui.robot_view.scene import RobotHere, between


def told(angle: float, **more: object) -> RobotState:
    return RobotState(robot="nao", joints={"HeadYaw": angle}, **more)


def test_a_robot_is_half_way_in_half_the_time(figure: RobotFigure) -> None:
    motion = RobotHere("nao", figure, told(0.0), 0.0)
    motion.go(told(0.0), 1.0)
    motion.go(told(1.0), 1.04)

    more = motion.step(1.06)

    assert more
    assert motion.shown.joints["HeadYaw"] == pytest.approx(0.5, abs=0.01)
    assert not motion.step(2.0)
    assert motion.shown.joints["HeadYaw"] == 1.0


def test_news_that_is_not_seen_moves_nothing(figure: RobotFigure) -> None:
    motion = RobotHere("nao", figure, told(0.5, battery=0.9), 0.0)

    is_seen = motion.go(told(0.5, battery=0.8, sensors={"sonar_left": 0.0}), 0.1)

    assert not is_seen
    assert motion.shown.battery == 0.8


@pytest.mark.parametrize(
    "change",
    [{"saying": "Hello"}, {"leds": {"ChestLeds": 255}}, {"sensors": {"head_front": 1.0}}],
)
def test_words_lights_and_touches_are_seen_at_once(
    figure: RobotFigure, change: dict[str, object]
) -> None:
    motion = RobotHere("nao", figure, told(0.5), 0.0)

    is_seen = motion.go(told(0.5, **change), 0.1)
    more = motion.step(0.1)

    assert is_seen
    assert not more
    assert motion.shown is motion.goal


def test_a_robot_turns_the_shorter_way_round() -> None:
    start, goal = told(0.0, base=(0, 0, math.radians(170))), told(0.0, base=(0, 0, -math.pi))

    half = between(start, goal, 0.5)

    assert half.base[2] == pytest.approx(math.radians(175))
