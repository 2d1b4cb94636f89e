"""Another robot is another folder: Pepper, and one that is made here out of Pepper."""

from __future__ import annotations

import json
import math
import shutil
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nep_core.errors import NodeStartError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.robot import Robot
from nep_core.wire.messages import ROBOT_STATE
from nep_core.wire.pubsub import Subscriber
from nodes.resources import model_folder, model_of, resource_folder
from robots.body.actor import FINAL, Actor
from robots.body.animations import NO_GESTURE, load_animations
from robots.body.body import Body, load_body
from robots.body.driver import ActionRequest, ActionResult, RobotState, Thing
from robots.body.motion import keyframe_motion
from robots.body.pose import VirtualRobot
from robots.body.speech import CONTEXTUAL, RANDOM
from robots.body.virtual import VirtualDriver
from robots.errors import FilesUnusable
from tests.conftest import a_part_of
from tests.node_running import NodeRunner, until

ROBOTS = resource_folder() / "robots"
PEPPER = ROBOTS / "pepper"
BODY = load_body(PEPPER)
ANIMATIONS = load_animations(PEPPER / "animations", BODY)
LOOK_S = 0.04


class PepperOnStage:
    """One virtual Pepper on a fake clock."""

    def __init__(self, body: Body = BODY, folder: Path = PEPPER) -> None:
        shipped = ANIMATIONS if folder == PEPPER else load_animations(folder / "animations", body)
        self.robot = VirtualRobot("Pepper", body, shipped)
        self.driver = VirtualDriver(self.robot)
        self.actor = Actor("Pepper", self.driver)
        self.now_s = 0.0
        self.least_margin_m = math.inf

    def do(self, action: str, **args: Any) -> ActionResult:
        asked = ActionRequest(id=f"{self.now_s}", robots=["Pepper"], action=action, args=args)
        results = list(self.actor.request(asked))
        while not any(result.state in FINAL for result in results):
            self.now_s += LOOK_S
            results += self.actor.step(self.now_s)
            self.least_margin_m = min(self.least_margin_m, self.robot.stance.margin_m)
            assert self.now_s < 120.0, "it never ends"
        return results[-1]


@pytest.mark.parametrize("name", BODY.postures)
def test_pepper_can_have_each_posture_and_stands_in_it(name: str) -> None:
    angles = BODY.posture_angles(name)
    stage = PepperOnStage()

    result = stage.do("do", posture=name)

    assert np.allclose(BODY.clamped(angles)[0], angles)
    assert result.state == "done" and stage.robot.posture == name
    assert stage.least_margin_m > 0.03 and not stage.robot.fallen


@pytest.mark.parametrize("name", a_part_of(ANIMATIONS.names()))
def test_pepper_plays_each_of_its_animations_as_written_and_keeps_its_balance(name: str) -> None:
    stage = PepperOnStage()
    start = BODY.posture_angles("Stand")

    result = stage.do("play", animation=name)

    assert keyframe_motion(BODY, start, ANIMATIONS.get(name).keyframes).notes == ()
    assert (result.state, result.description) == ("done", "")
    assert stage.least_margin_m > 0.03


def test_pepper_offers_what_it_has() -> None:
    choices = tomllib.loads((PEPPER / "robot.toml").read_text())["choices"]

    assert set(choices["animations"]) == set(ANIMATIONS.names("animation"))
    assert set(choices["animals"]) == set(ANIMATIONS.names("animal"))
    told = {NO_GESTURE, CONTEXTUAL, RANDOM}
    assert set(choices["say_gestures"]) - told == set(ANIMATIONS.names("gesture"))


def test_pepper_rolls_to_where_it_should_without_steps() -> None:
    stage = PepperOnStage()
    before = stage.robot.angles.copy()

    result = stage.do("walk", forward_m=0.5, left_m=0.2, turn_deg=90)

    assert result.state == "done"
    assert stage.driver.state().base == pytest.approx((0.5, 0.2, math.pi / 2), abs=1e-3)
    assert np.array_equal(stage.robot.angles, before)


def test_pepper_does_not_roll_while_it_crouches() -> None:
    stage = PepperOnStage()
    stage.do("do", posture="posture_crouch")

    result = stage.do("walk", forward_m=0.5)

    assert result.state == "failed" and "Pepper crouches" in result.description


def test_pepper_looks_and_points_from_its_own_neck_and_shoulders() -> None:
    stage = PepperOnStage()
    neck_up_m = 0.82 + 0.1699

    stage.do("look_at", x_m=2.0, y_m=0.0, z_m=neck_up_m, frame="world")
    stage.do("point_at", x_m=3.0, y_m=0.14974, z_m=0.82 + 0.08682, frame="world", arm="left")

    angle = dict(zip(BODY.names, stage.robot.angles, strict=True))
    lean = stage.robot.stance.pose[4]
    assert angle["HeadPitch"] + lean == pytest.approx(0.0, abs=0.02)
    assert angle["LShoulderPitch"] + lean == pytest.approx(0.0, abs=0.02)
    assert angle["LShoulderRoll"] == pytest.approx(0.0088, abs=0.01)


def test_pepper_sees_a_ball_from_its_own_head_and_a_wall_from_its_base() -> None:
    stage = PepperOnStage()
    ball = Thing(id="b", kind="ball", place=(1.0, 0.0, 1.0), size=(0.1, 0.1, 0.1))
    wall = Thing(id="w", kind="wall", place=(0.9, 0.0, 0.0), size=(2.0, 0.1, 0.5))
    stage.robot.things = (ball, wall)

    stage.do("do", posture="posture_stand")

    state = stage.driver.state()
    assert state.sees["ball"] == pytest.approx((1.0, 0.0, 1.05), abs=0.01)
    assert state.sensors["sonar_left"] == pytest.approx(0.85 - 0.07, abs=0.02)


def test_a_nao_with_longer_thighs_walks_with_its_own_legs(tmp_path: Path) -> None:
    made = tmp_path / "tall"
    shutil.copytree(ROBOTS / "nao", made)
    body = json.loads((made / "body.json").read_text())
    for joint in body["joints"]:
        if joint["name"] in ("LKneePitch", "RKneePitch"):
            joint["origin_m"] = [0.0, 0.0, -0.11]
    (made / "body.json").write_text(json.dumps(body))
    stage = PepperOnStage(load_body(made), made)

    result = stage.do("walk", forward_m=0.2)

    assert (result.state, stage.robot.fallen) == ("done", False)
    assert stage.driver.state().base[0] == pytest.approx(0.2, abs=1e-3)
    assert stage.least_margin_m > -0.01


def test_pepper_says_which_postures_it_has() -> None:
    result = PepperOnStage().do("do", posture="posture_sit")

    assert "posture_crouch" in result.description and "lying" not in result.description


def test_an_unknown_model_is_told_with_those_that_there_are() -> None:
    with pytest.raises(NodeStartError, match='no robot model "zora"') as told:
        model_folder("zora")

    assert "nao, pepper" in str(told.value.checklist[0])


def test_a_model_is_named_by_its_folder(tmp_path: Path) -> None:
    assert model_of(model_folder("nao")) == ""
    assert model_of(model_folder("pepper")) == "pepper"
    shutil.copy(PEPPER / "body.json", tmp_path)
    assert model_of(model_folder(str(tmp_path))) == str(tmp_path.resolve())


def test_a_robot_is_called_as_its_profile_says_and_without_one_as_its_folder(
    folder: Path,
) -> None:
    called = load_body(folder).title
    (folder / "robot.toml").unlink()

    assert (called, load_body(folder).title) == ("Sitter", "sitter")
    assert (load_body(PEPPER).title, load_body(ROBOTS / "nao").title) == ("Pepper", "NAO")


def test_a_profile_without_a_title_is_told(folder: Path) -> None:
    (folder / "robot.toml").write_text('name = "sitter"')

    with pytest.raises(FilesUnusable, match=r"robot\.toml, cannot be read"):
        load_body(folder)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A robot of one's own: Pepper without wrists, which can sit, with one nod of its own."""
    made = tmp_path / "sitter"
    shutil.copytree(PEPPER, made)
    body = json.loads((made / "body.json").read_text())
    names = [joint["name"] for joint in body["joints"]]
    gone = {"LWristYaw", "RWristYaw"}
    body["joints"] = [
        _without_wrist(joint) for joint in body["joints"] if joint["name"] not in gone
    ]
    for posture in body["postures"].values():
        posture["angles"] = [
            angle for name, angle in zip(names, posture["angles"], strict=True) if name not in gone
        ]
    body["postures"]["Sit"] = {**body["postures"]["Crouch"], "family": "sitting", "next": ["Stand"]}
    body["postures"]["Stand"]["next"].append("Sit")
    (made / "body.json").write_text(json.dumps(body))
    profile = made / "robot.toml"
    profile.write_text(profile.read_text().replace('title = "Pepper"', 'title = "Sitter"'))
    for path in (made / "animations").glob("*.toml"):
        path.unlink()
    (made / "animations" / "deep_nod.toml").write_text(NOD)
    return made


NOD = """
title = "Deep nod"
description = "Nods deeply."
kind = "animation"

[[poses]]
at = 0.8
doing = "nods"
head = { Pitch = 30 }
"""


def _without_wrist(joint: dict[str, Any]) -> dict[str, Any]:
    return (
        joint | {"parent": joint["parent"].replace("_wrist", "ForeArm")}
        if "parent" in joint
        else joint
    )


@pytest.fixture
def runner(network: PeerNetwork) -> Iterator[NodeRunner]:
    made = NodeRunner(network)
    yield made
    made.close()


def test_a_robot_made_as_a_folder_acts_without_any_code(
    runner: NodeRunner, folder: Path, network: PeerNetwork
) -> None:
    states = Subscriber(ROBOT_STATE, RobotState, network=network)
    runner.start_node("action/nao", "sitter", robot="Sitter", model=str(folder), speed=20)
    ready = runner.state("ready")
    robot = Robot("Sitter")

    robot.play("deep_nod")
    robot.walk(0.3)
    robot.point_at(2, 1, 1)
    robot.do("posture_sit")

    last = until(states, lambda state: state.posture == "Sit")[-1]
    assert ready.description == "virtual Sitter, standing"
    assert last.model == str(folder.resolve())
    assert last.base[0] == pytest.approx(0.3, abs=1e-3)
    assert "LWristYaw" not in last.joints and len(last.joints) == 15


def test_a_node_with_an_unknown_model_ends_with_a_sentence(runner: NodeRunner) -> None:
    node = runner.start_node("action/nao", "zora", model="zora")

    _, words = node.communicate(timeout=20)

    assert node.returncode == 1
    assert words.startswith('There is no robot model "zora".')
