"""Making a motion with the mouse and the keys, and keeping it in the project."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QTabBar
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.own_animations import own_animations
from nep_studio.ui.message_cards import QuestionDialog
from nep_studio.ui.plugins.motion import editing
from nep_studio.ui.plugins.motion.page import MotionPage
from nep_studio.ui.plugins.motion.stage import ROBOT
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.running.window_use import block_of, has_run, press

pytestmark = pytest.mark.long


def place_of(motion: MotionPage, link: str) -> QPointF:
    """Where the middle of a link's part is in the view."""
    motion.view.room.step(np.inf)
    robot = next(r for r in motion.view.room.scene().robots if r.name == ROBOT)
    numbers = [i for i, part in enumerate(robot.placed.parts) if part.link == link]
    for middle in robot.placed.middles()[numbers]:
        x, y = motion.view.lens.project(middle)
        found = motion.view.found_at(QPointF(float(x), float(y)))
        if found.part is not None and found.part.link == link:
            return QPointF(float(x), float(y))
    pytest.fail(f"{link} is not seen")


def test_a_dragged_hand_goes_with_the_mouse_and_makes_a_key(motion: MotionPage, drag) -> None:
    start = place_of(motion, "R_wrist")

    drag(motion.view, start, start + QPointF(-10, -60))

    assert editing.key_times(motion.controller.motion) == [1.0]
    assert motion.controller.motion.joints.keys() >= {"RShoulderPitch", "RElbowRoll"}
    motion.stage.refresh()
    end = place_of(motion, "R_wrist")
    assert end.y() < start.y() - 30
    assert motion.controller.undo_label


def test_one_drag_is_one_step_back(motion: MotionPage, drag) -> None:
    start = place_of(motion, "R_wrist")
    drag(motion.view, start, start + QPointF(-10, -60))

    motion.controller.undo()

    assert motion.controller.motion.joints == {}


def test_a_slider_turns_its_joint(motion: MotionPage, qtbot: QtBot) -> None:
    row = motion.joints.rows["HeadYaw"]

    row.slider.setFocus()
    for _ in range(3):
        qtbot.keyClick(row.slider, Qt.Key.Key_PageUp)

    assert motion.controller.motion.joints["HeadYaw"].keys[0] > 0.02
    assert row.box.value() == pytest.approx(row.slider.value() / 10)


def test_keys_are_added_and_moved_on_the_timeline(motion: MotionPage, drag, qtbot: QtBot) -> None:
    motion.controller.set_joints({"RShoulderPitch": -0.5}, "pose")
    timeline = motion.timeline
    qtbot.mouseClick(timeline, Qt.MouseButton.LeftButton, pos=timeline.row(0).center().toPoint())
    shown = motion.controller.cursor_s
    qtbot.keyClick(timeline, Qt.Key.Key_K)
    assert editing.key_times(motion.controller.motion) == [1.0, pytest.approx(shown)]

    drag(timeline, timeline.place_of(1.0), timeline.place_of(1.5))

    assert editing.key_times(motion.controller.motion)[0] == pytest.approx(1.5, abs=0.051)
    assert motion.controller.chosen == pytest.approx((1.5,), abs=0.051)


def test_with_shift_all_later_keys_go_along(motion: MotionPage, drag) -> None:
    motion.controller.set_joints({"RShoulderPitch": -0.5}, "pose")
    motion.controller.show(2.0)
    motion.controller.add_key("key")
    timeline = motion.timeline

    shift = Qt.KeyboardModifier.ShiftModifier
    drag(timeline, timeline.place_of(1.0), timeline.place_of(1.5), modifier=shift)

    first, second = editing.key_times(motion.controller.motion)
    assert second - first == pytest.approx(1.0)
    assert first == pytest.approx(1.5, abs=0.051)


def test_space_plays_it_to_its_end(motion: MotionPage, qtbot: QtBot) -> None:
    motion.controller.set_joints({"RShoulderPitch": -0.5}, "pose")
    motion.controller.show(0.0)
    motion.player.speed = 4.0

    motion.timeline.setFocus()
    qtbot.keyClick(motion.timeline, Qt.Key.Key_Space)

    assert motion.player.is_playing
    qtbot.waitUntil(lambda: not motion.player.is_playing)
    assert motion.controller.cursor_s == motion.controller.motion.duration_s


def test_posing_pauses_the_play(motion: MotionPage, drag, qtbot: QtBot) -> None:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    motion.controller.show(0.0)
    motion.player.play()
    start = place_of(motion, "R_wrist")

    drag(motion.view, start, start + QPointF(0, -20))

    assert not motion.player.is_playing


def test_too_fast_is_told_and_gets_its_time(motion: MotionPage, qtbot: QtBot) -> None:
    motion.controller.set_joints({"RShoulderPitch": -1.9}, "pose")
    motion.controller.move_chosen(-0.9, "move")
    qtbot.waitUntil(lambda: any(fault.kind == "fast" for fault in motion.faults.now))
    assert "Too fast" in motion.notes.words.text()

    qtbot.mouseClick(motion.notes.give_time, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: motion.faults.is_sure)

    assert motion.faults.now == []
    assert "can do this" in motion.notes.words.text()


def test_a_motion_that_would_fall_is_told(motion: MotionPage, qtbot: QtBot) -> None:
    motion.controller.set_joints({"LHipPitch": -1.3, "LKneePitch": 1.9}, "pose")
    motion.controller.show(2.5)
    motion.controller.add_key("hold")

    qtbot.waitUntil(lambda: motion.faults.is_sure)

    assert [fault.kind for fault in motion.faults.now] == ["fall"]
    assert "fall" in motion.notes.words.text()


def test_a_closed_tab_throws_nothing_away(
    window: MainWindow, motion: MotionPage, qtbot: QtBot
) -> None:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    tabs = window.workbench.pages_bar.tabs
    close = tabs.tabButton(tabs.currentIndex(), QTabBar.ButtonPosition.RightSide)

    qtbot.mouseClick(close, Qt.MouseButton.LeftButton)

    assert window.workbench.canvas.isVisible() and not motion.isVisible()
    window.actions_by_name["make_motion"].trigger()
    assert motion.isVisible() and motion.controller.motion.joints


def test_undo_of_the_window_takes_a_pose_back_while_the_motion_is_shown(
    window: MainWindow, motion: MotionPage, qtbot: QtBot
) -> None:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    undo = window.actions_by_name["undo"]
    assert "pose" in undo.text()

    qtbot.keyClick(motion.timeline, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)

    assert not motion.controller.motion.joints
    assert not undo.isEnabled()


def test_keys_on_the_page_leave_the_blocks_alone(
    window: MainWindow, motion: MotionPage, qtbot: QtBot
) -> None:
    window.workbench.canvas.show_page("behaviour")
    editor = window.files.document.editor
    block = editor.create("event.started", editor.new_stack("behaviour", 40, 40))
    window.workbench.canvas.selection.set([block])
    window.actions_by_name["make_motion"].trigger()
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    motion.controller.choose((0.0,))

    qtbot.keyClick(motion.timeline, Qt.Key.Key_Delete)

    assert block in editor.project.blocks


def test_a_shipped_motion_is_a_start_and_is_kept_as_one_of_the_project(
    motion: MotionPage,
) -> None:
    motion.project.open("wave")
    motion.controller.change("title", title="Wave twice")

    motion.actions_by_name["save_motion"].trigger()

    assert motion.controller.name == "wave_twice"
    assert not motion.controller.is_modified
    assert "Wave twice" in [action.text() for action in motion.project.open_menu().actions()]


def test_the_motions_of_the_robot_are_offered_by_what_they_are_used_for(
    motion: MotionPage,
) -> None:
    menu = motion.project.open_menu()

    offered = {
        a.text(): [one.text() for one in a.menu().actions()] for a in menu.actions() if a.menu()
    }

    assert offered.keys() == {"be played", "imitate an animal", "speak with gestures"}
    assert "elephant" in offered["imitate an animal"]
    assert "elephant" not in offered["be played"]


def test_another_title_renames_it_in_the_blocks_too(motion: MotionPage, window: MainWindow) -> None:
    motion.project.open("wave")
    motion.controller.change("title", title="Hop")
    assert motion.project.save()
    motion.controller.change("title", title="Jump")

    assert motion.project.save()

    assert own_animations(window.files.document.project).keys() == {"jump"}


def test_a_kept_motion_is_played_by_a_block_in_a_run(
    window: MainWindow, open_program, motion: MotionPage, drag, qtbot: QtBot
) -> None:
    seen = open_program([B("event.started"), B("robot.play")])
    start = place_of(motion, "R_wrist")
    drag(motion.view, start, start + QPointF(-10, -60))
    assert motion.project.save()
    editor = window.files.document.editor
    editor.apply(SetField(block_of(window, "robot.play"), "animation", motion.controller.name))

    press(window, qtbot, "run")
    has_run(window, qtbot, seen)

    results = [one for one in seen.messages if getattr(one, "state", "") == "done"]
    requests = [one for one in seen.messages if getattr(one, "action", "") == "play"]
    assert {one.args["animation"] for one in requests} == {"my_motion"}
    assert requests[0].id in [one.id for one in results]


def test_the_program_is_not_closed_over_a_motion_that_is_not_kept(
    window: MainWindow, motion: MotionPage, qtbot: QtBot
) -> None:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")

    window.close()

    assert window.isVisible()
    [question] = motion.findChildren(QuestionDialog)
    throw = next(button for button in question.buttons if "Throw" in button.text())
    qtbot.mouseClick(throw, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.isVisible())


def test_a_motion_is_new_to_another_project(window: MainWindow, motion: MotionPage) -> None:
    motion.controller.set_joints({"HeadYaw": 0.5}, "pose")
    assert motion.project.save()

    window.files.document.editor.history.seal()
    window.files.document_changed.emit(window.files.document)

    assert motion.controller.name == ""
