"""A real robot, behind NAOqi, plays a motion of a project, and stops when its pilot is gone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from driver_stage import ANIMATIONS, BODY, DriverStage, ServedNao

from robots.body.actor import Actor
from robots.body.animations import with_own
from robots.body.driver import RobotState
from robots.body.pose import VirtualRobot
from robots.naoqi.discovery import FOLDER_VARIABLE
from robots.naoqi.driver.driver import NaoqiDriver

pytestmark = pytest.mark.long

LOOK_ASIDE = """title = "Look aside"
description = ""
kind = "animation"
[joints.HeadYaw]
times = [1.0, 3.0]
keys = [0.8, 0.8]
"""


@pytest.fixture
def robot() -> Iterator[ServedNao]:
    made = ServedNao(speed=5.0)
    yield made
    made.close()


@pytest.fixture
def stage(
    robot: ServedNao, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[DriverStage]:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    (tmp_path / "look_aside.toml").write_text(LOOK_ASIDE)
    animations, _ = with_own(ANIMATIONS, str(tmp_path), BODY)
    made = DriverStage(robot.address)
    made.driver.disconnect()
    made.driver = NaoqiDriver(VirtualRobot("NAO", BODY, animations), robot.address)
    made.actor = Actor("NAO", made.driver)
    made.driver.connect()
    made.meet()
    yield made
    made.close()


def test_it_plays_a_motion_that_only_the_project_has(robot: ServedNao, stage: DriverStage) -> None:
    stage.ask("p", "play", animation="look_aside")

    stage.until(lambda: robot.state().joints["HeadYaw"] > 0.7)

    assert stage.end_of("p").state == "done"


def test_a_walk_whose_pilot_is_gone_stops(robot: ServedNao, stage: DriverStage) -> None:
    stage.do("do", posture="posture_stand")
    stage.ask("w", "walk_freely", forward=1.0, unless_asked_s=1.0)
    stage.until(lambda: robot.state().base[0] > 0.02)

    assert stage.end_of("w").state == "cancelled"

    def rests() -> bool:
        state: RobotState = robot.state()
        return not state.moving

    stage.until(rests)
