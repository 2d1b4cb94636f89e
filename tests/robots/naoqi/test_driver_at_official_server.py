"""Our driver and a robot that is played by the official package, in a process of its own."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from driver_stage import DriverStage
from naoqi_lamp import needs_oracle

pytestmark = [needs_oracle, pytest.mark.long]


class OfficialNao:
    def __init__(self) -> None:
        command = [sys.executable, str(Path(__file__).with_name("naoqi_oracle_nao.py"))]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.port = int(self.process.stdout.readline())

    def state(self, line: str = "state") -> dict[str, Any]:
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())


@pytest.fixture
def robot() -> Iterator[OfficialNao]:
    made = OfficialNao()
    yield made
    made.process.kill()
    made.process.communicate()


@pytest.fixture
def stage(robot: OfficialNao) -> Iterator[DriverStage]:
    made = DriverStage(f"127.0.0.1:{robot.port}")
    made.meet()
    yield made
    made.close()


def test_it_speaks_moves_walks_and_shines(robot: OfficialNao, stage: DriverStage) -> None:
    ends = [
        stage.do("say", text="Hello there", speed=120),
        stage.do("do", posture="posture_sit"),
        stage.do("do", posture="posture_stand"),
        stage.do("play", animation="wave"),
        stage.do("look", yaw_deg=30, pitch_deg=10),
        stage.do("walk", forward_m=0.2, turn_deg=20),
        stage.do("leds", group="FaceLeds", colour="#ff8800", seconds=0.1),
    ]
    state = robot.state()

    assert [end.state for end in ends] == ["done"] * len(ends), ends
    assert state["said"] == ["\\rspd=120\\ Hello there"]
    assert state["posture"] == "Stand"
    assert state["base"] == pytest.approx([0.2, 0.0, math.radians(20)], abs=1e-4)
    assert state["leds"] == {"FaceLeds": 0xFF8800}
    told = stage.driver.state()
    assert told.joints["HeadYaw"] == pytest.approx(math.radians(30), abs=0.01)
    assert told.battery == 0.5


def test_what_it_feels_comes_as_human_states(robot: OfficialNao, stage: DriverStage) -> None:
    robot.state("touch 1.0")
    stage.until(lambda: "touched_head" in stage.noticed)
    robot.state("touch 0.0")

    stage.until(lambda: stage.driver.state().sensors["head_middle"] == 0.0)
    assert stage.noticed == ["touched_head_middle", "touched_head"]


def test_stop_reaches_motion_posture_and_speech(robot: OfficialNao, stage: DriverStage) -> None:
    stage.ask("say", "say", text="All this takes a long time to say. " * 5)
    stage.until(lambda: robot.state()["saying"])

    stage.ask("stop", "stop")
    passed_s = stage.until(lambda: not robot.state()["saying"])

    stage.until(lambda: set(robot.state()["stopped"]) >= {"stopMove", "killAll", "posture"})
    assert passed_s < 1.0  # 0.2 s on a quiet computer
    assert "say cancelled" in stage.told


def test_what_this_robot_does_not_have_is_told(stage: DriverStage) -> None:
    refused = stage.do("volume", percent=20)

    assert refused.state == "failed"
    assert "no ALAudioDevice.setOutputVolume" in refused.description


def test_a_killed_robot_is_told_at_once(robot: OfficialNao, stage: DriverStage) -> None:
    stage.ask("walk", "walk", forward_m=1)

    robot.process.kill()
    passed_s = stage.until(lambda: stage.event == "disconnected")

    assert passed_s < 3.0
    assert stage.end_of("walk").state == "failed"
