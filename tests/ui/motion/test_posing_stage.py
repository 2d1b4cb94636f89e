"""Dragging feet, hips and head of the robot on the stage, also with both sides alike."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from nep_studio.blocks.own_animations import OwnAnimation
from nep_studio.ui.plugins.motion.motion_controller import MotionController
from nep_studio.ui.plugins.motion.stage import ROBOT, PosingStage
from nep_studio.ui.robot_view.view import RobotView, nao_folder
from nep_studio.ui.services import Studio
from robots.body.body import load_body
from tests.ui.window.conftest import home, studio

__all__ = ["home", "studio"]


@pytest.fixture
def stage(studio: Studio, qtbot: QtBot) -> PosingStage:
    desk = MotionController(load_body(nao_folder()))
    desk.open(OwnAnimation("New", {}, starts_from="StandInit"))
    view = RobotView(studio.look)
    qtbot.addWidget(view)
    view.resize(400, 400)
    return PosingStage(view, desk)


def place(stage: PosingStage, link: str) -> np.ndarray:
    """Where a link is in the room, in the pose that is shown."""
    pose = stage.controller.rehearsal.pose(stage.controller.cursor_s)
    return (stage._frame(pose) @ stage.skeleton.frames(pose)[link])[:3, 3]


def turn(stage: PosingStage, link: str) -> np.ndarray:
    pose = stage.controller.rehearsal.pose(stage.controller.cursor_s)
    return (stage._frame(pose) @ stage.skeleton.frames(pose)[link])[:3, :3]


def drag(stage: PosingStage, link: str, way: tuple[float, float, float], steps: int = 10) -> None:
    start = place(stage, link)
    stage.view.limb_pressed.emit(ROBOT, link, tuple(start))
    for step in range(1, steps + 1):
        there = start + np.array(way) * step / steps
        stage.view.limb_dragged.emit(ROBOT, link, tuple(float(x) for x in there))
    stage.view.limb_released.emit(ROBOT, link)


def test_a_foot_is_lifted_flat_while_the_other_one_stands(stage: PosingStage) -> None:
    drag(stage, "L_ankle", (0.03, 0.0, 0.06))

    left, right = place(stage, "L_ankle"), place(stage, "R_ankle")
    assert left[2] - right[2] == pytest.approx(0.06, abs=0.012)
    assert right[2] == pytest.approx(0.045, abs=0.01)
    assert turn(stage, "L_ankle")[2, 2] > 0.98


def test_the_hips_go_down_while_both_feet_stay(stage: PosingStage) -> None:
    before = place(stage, "torso")[2]

    drag(stage, "torso", (0.0, 0.0, -0.04))

    assert before - place(stage, "torso")[2] == pytest.approx(0.04, abs=0.008)
    for foot in ("L_ankle", "R_ankle"):
        assert turn(stage, foot)[2, 2] > 0.99
        assert place(stage, foot)[2] == pytest.approx(0.045, abs=0.006)


def test_the_head_looks_where_it_is_dragged(stage: PosingStage) -> None:
    start = place(stage, "Head") + np.array([0.06, 0.0, 0.06])
    stage.view.limb_pressed.emit(ROBOT, "Head", tuple(start))

    stage.view.limb_dragged.emit(ROBOT, "Head", tuple(start + np.array([-0.02, 0.05, 0.0])))

    assert stage.controller.motion.joints["HeadYaw"].keys[0] > 0.4


def test_with_both_sides_alike_the_other_hand_mirrors_the_drag(stage: PosingStage) -> None:
    stage.controller.is_mirrored = True

    drag(stage, "L_wrist", (0.05, 0.02, 0.12))

    left, right = place(stage, "L_wrist"), place(stage, "R_wrist")
    assert right == pytest.approx(left * [1, -1, 1], abs=1e-3)


def test_a_drag_without_a_press_does_nothing(stage: PosingStage) -> None:
    stage.view.limb_dragged.emit(ROBOT, "L_wrist", (0.2, 0.2, 0.4))

    assert stage.controller.motion.joints == {}
