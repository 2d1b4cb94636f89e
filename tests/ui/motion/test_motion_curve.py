"""The curve of one joint: its keys are moved without those of the other joints."""

from __future__ import annotations

import math

import pytest
from PySide6.QtCore import QPointF, Qt
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.motion import editing
from nep_studio.ui.plugins.motion.curve import CurveView
from nep_studio.ui.plugins.motion.page import MotionPage


@pytest.fixture
def curve(motion: MotionPage, qtbot: QtBot) -> CurveView:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    motion.actions_by_name["show_curve"].trigger()
    qtbot.waitUntil(lambda: motion.curve.curve.isVisible())
    motion.curve.show_joint("HeadYaw")
    return motion.curve.curve


def test_a_key_is_dragged_in_time_and_angle_alone(
    motion: MotionPage, curve: CurveView, drag
) -> None:
    start, end = curve.place_of(1.0, 0.5), curve.place_of(1.5, -0.4)

    drag(curve, start, end)

    head = motion.controller.motion.joints["HeadYaw"]
    assert head.times == pytest.approx((1.5,), abs=0.051)
    assert head.keys == pytest.approx((-0.4,), abs=0.1)
    assert motion.controller.motion.joints["HeadPitch"].times == (1.0,)
    motion.controller.undo()
    assert motion.controller.motion.joints["HeadYaw"].times == (1.0,)


def test_a_double_click_sets_a_key_of_this_joint(
    motion: MotionPage, curve: CurveView, qtbot: QtBot
) -> None:
    place = curve.place_of(2.0, -0.5).toPoint()

    qtbot.mouseDClick(curve, Qt.MouseButton.LeftButton, pos=place)

    assert len(motion.controller.motion.joints["HeadYaw"].times) == 2
    assert motion.controller.motion.joints["HeadPitch"].times == (1.0,)


def test_keys_turn_it_and_take_it_away(motion: MotionPage, curve: CurveView, qtbot: QtBot) -> None:
    motion.controller.show(0.0)
    curve.setFocus()

    qtbot.keyClick(curve, Qt.Key.Key_PageDown)
    qtbot.keyClick(curve, Qt.Key.Key_Up)

    turned = motion.controller.motion.joints["HeadYaw"].keys[0]
    assert turned == pytest.approx(0.5 + math.radians(1), abs=1e-3)
    qtbot.keyClick(curve, Qt.Key.Key_Delete)
    assert "HeadYaw" not in motion.controller.motion.joints
    assert editing.key_times(motion.controller.motion) == [1.0]


def test_a_key_does_not_push_another_one_of_its_joint_away(
    motion: MotionPage, curve: CurveView, drag
) -> None:
    motion.controller.set_key("HeadYaw", 2.0, 0.0, "key")

    drag(curve, curve.place_of(1.0, 0.5), curve.place_of(2.0, 0.5) + QPointF(0, 1))

    assert len(motion.controller.motion.joints["HeadYaw"].times) == 2
