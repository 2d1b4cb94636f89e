"""Motions and the rest of the program: blocks, robots that run, texts of Choregraphe."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.blocks.own_animations import OwnAnimation, own_animations
from nep_studio.ui.canvas.editing.menu import MenuPlace
from nep_studio.ui.canvas.layout.page import Hit
from nep_studio.ui.message_cards import QuestionDialog
from nep_studio.ui.plugins.motion import MotionKit, editing
from nep_studio.ui.plugins.motion.importing import ImportDialog
from nep_studio.ui.plugins.motion.page import MotionPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.running.window_use import WAIT_MS, block_of

NODS = """
names = list()
times = list()
keys = list()

names.append("HeadPitch")
times.append([0.8, 1.6])
keys.append([0.3, 0.0])
"""


def entries(kit: MotionKit, window: MainWindow, block: str) -> dict[str, object]:
    canvas = window.workbench.canvas
    place = MenuPlace(Hit(block, placed=None), QPointF())
    return {entry.id: entry.run for entry in kit.section(canvas, place)}


def test_the_menu_of_a_block_makes_a_motion_that_it_plays(
    window: MainWindow, open_program, kit: MotionKit, motion: MotionPage
) -> None:
    open_program([B("event.started"), B("robot.play")])
    block = block_of(window, "robot.play")
    assert "change_motion" not in entries(kit, window, block)

    entries(kit, window, block)["new_motion"]()
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    assert motion.project.save()

    project = window.files.document.project
    assert project.blocks[block].fields["animation"] == "my_motion"
    entries(kit, window, block)["change_motion"]()
    assert motion.controller.name == "my_motion"
    assert window.files.document.editor.history.undo()
    assert own_animations(project) == {}


def test_other_blocks_have_no_such_menu(
    window: MainWindow, open_program, kit: MotionKit, motion: MotionPage
) -> None:
    open_program([B("event.started"), B("control.wait")])

    assert entries(kit, window, block_of(window, "control.wait")) == {}


def test_a_motion_that_is_deleted_says_how_many_blocks_play_it(
    window: MainWindow, open_program, kit: MotionKit, motion: MotionPage, qtbot: QtBot
) -> None:
    open_program([B("event.started"), B("robot.play")])
    entries(kit, window, block_of(window, "robot.play"))["new_motion"]()
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    motion.project.save()

    motion.actions_by_name["delete_motion"].trigger()

    [question] = motion.findChildren(QuestionDialog)
    assert "1 block plays it" in question.message.sentence
    delete = next(button for button in question.buttons if button.text() == "Delete")
    qtbot.mouseClick(delete, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: own_animations(window.files.document.project) == {})


def test_a_text_of_choregraphe_becomes_a_motion(motion: MotionPage, qtbot: QtBot) -> None:
    motion.actions_by_name["import_motion"].trigger()
    [dialog] = motion.findChildren(ImportDialog)
    assert not dialog.use_button.isEnabled()

    dialog.text.setPlainText("this is no motion")
    assert "no joint names" in dialog.reason.text()
    dialog.text.setPlainText(NODS)
    qtbot.mouseClick(dialog.use_button, Qt.MouseButton.LeftButton)

    assert editing.key_times(motion.controller.motion) == [0.8, 1.6]
    assert motion.controller.is_modified


def test_a_file_that_cannot_be_read_is_told(motion: MotionPage, tmp_path: Path) -> None:
    dialog = ImportDialog(motion.controller.body, motion)
    (tmp_path / "odd.py").write_bytes(b"\xff\xfe\xff")

    dialog.read_file(tmp_path / "missing.py")
    assert "missing.py cannot be read" in dialog.reason.text()
    dialog.read_file(tmp_path / "odd.py")

    assert "odd.py cannot be read" in dialog.reason.text()
    assert not dialog.use_button.isEnabled()


def test_the_pose_of_a_robot_that_was_moved_by_hand_becomes_a_key(
    window: MainWindow, open_program, motion: MotionPage, qtbot: QtBot
) -> None:
    open_program([B("event.started")])
    robots, menu = motion.robots, QMenu()
    qtbot.addWidget(menu)
    robots.fill(menu, window.studio.language)
    next(a for a in menu.actions() if a.text().startswith("Start")).trigger()
    qtbot.waitUntil(lambda: "NAO" in robots.states, timeout=WAIT_MS)

    robots.let_go("NAO", "arms", is_on=False)
    qtbot.waitUntil(
        lambda: robots.states["NAO"].settings["locked_left_arm"] is False, timeout=WAIT_MS
    )
    robots.take("NAO")
    joints = robots.states["NAO"].joints
    touch = m.SenseRequest(robot="NAO", sense="head_middle", value=1.0)
    window.running.runner.send(m.SENSE_REQUEST, touch)
    qtbot.waitUntil(lambda: len(editing.key_times(motion.controller.motion)) == 2, timeout=WAIT_MS)

    assert editing.key_times(motion.controller.motion) == [1.0, 2.0]
    pose = editing.pose_at(motion.controller.motion, 1.0)
    assert pose == pytest.approx(joints, abs=1e-3)


def test_a_robot_plays_a_motion_that_is_not_kept(
    window: MainWindow, open_program, motion: MotionPage, qtbot: QtBot
) -> None:
    open_program([B("event.started")])
    robots = motion.robots
    window.running.runner.start_node(window.running.runner.planned()[0])
    qtbot.waitUntil(lambda: "NAO" in robots.states, timeout=WAIT_MS)
    motion.controller.set_joints({"HeadYaw": math.radians(40)}, "pose")

    robots.play("NAO")

    qtbot.waitUntil(lambda: robots.states["NAO"].joints["HeadYaw"] > 0.6, timeout=WAIT_MS)


def test_a_new_motion_asks_for_the_changes_of_the_old_one(motion: MotionPage) -> None:
    motion.controller.open(OwnAnimation("Old", {}), is_kept=True)
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")

    motion.actions_by_name["new_motion"].trigger()

    [question] = motion.findChildren(QuestionDialog)
    question.reject()
    assert motion.controller.motion.title == "Old"
