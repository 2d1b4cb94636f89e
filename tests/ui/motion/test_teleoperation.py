"""Driving a running robot by hand: it moves while a key is held, and stops when it is let go."""

from __future__ import annotations

import math
import os
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

from nep_core.wire import messages as m
from nep_studio.ui.plugins.motion import MotionKit
from nep_studio.ui.plugins.motion.drive import STILL, Drive, Gamepad, Sticks, Tilt, sum_of
from nep_studio.ui.plugins.motion.teleoperation import TeleoperationWindow
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B

pytestmark = pytest.mark.long

EARTH = 9.81
WAIT_MS = 30_000


def imu(x: float, y: float, z: float, seconds: float = 1.0) -> m.Imu:
    count = round(seconds * 50)
    return m.Imu(
        source="watch",
        rate_hz=50.0,
        t=[i / 50 for i in range(count)],
        acc=[(x, y, z)] * count,
    )


@pytest.fixture
def driving(
    window: MainWindow, open_program, kit: MotionKit, qtbot: QtBot
) -> Iterator[TeleoperationWindow]:
    """The window with a virtual NAO that runs."""
    open_program([B("event.started")])
    made = kit.drive()
    qtbot.waitExposed(made)
    qtbot.mouseClick(made.start_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(made.states), timeout=WAIT_MS)
    made.pad.setFocus()
    qtbot.waitUntil(made.pad.hasFocus)
    yield made
    if isValid(made):  # not closed with its main window
        made.close()


def base(driving: TeleoperationWindow) -> tuple[float, float, float]:
    return next(iter(driving.states.values())).base


def is_moving(driving: TeleoperationWindow) -> bool:
    return next(iter(driving.states.values())).moving


def test_it_walks_while_the_key_is_held_and_stops_when_it_is_let_go(
    driving: TeleoperationWindow, qtbot: QtBot
) -> None:
    qtbot.keyPress(driving.pad, Qt.Key.Key_Up)
    qtbot.waitUntil(lambda: base(driving)[0] > 0.02, timeout=WAIT_MS)

    qtbot.keyRelease(driving.pad, Qt.Key.Key_Up)

    qtbot.waitUntil(lambda: not is_moving(driving), timeout=WAIT_MS)


def test_losing_the_focus_stops_it(driving: TeleoperationWindow, qtbot: QtBot) -> None:
    qtbot.keyPress(driving.pad, Qt.Key.Key_Left)
    qtbot.waitUntil(lambda: base(driving)[2] > 0.05, timeout=WAIT_MS)

    driving.speed.setFocus()

    assert driving.pilot.drive == STILL
    qtbot.waitUntil(lambda: not is_moving(driving), timeout=WAIT_MS)


def test_the_head_turns_while_its_key_is_held(driving: TeleoperationWindow, qtbot: QtBot) -> None:
    qtbot.keyPress(driving.pad, Qt.Key.Key_A)

    qtbot.waitUntil(
        lambda: next(iter(driving.states.values())).joints["HeadYaw"] > 0.2, timeout=WAIT_MS
    )
    qtbot.keyRelease(driving.pad, Qt.Key.Key_A)


def test_a_robot_whose_pilot_is_gone_stops_by_itself(
    driving: TeleoperationWindow, qtbot: QtBot
) -> None:
    qtbot.keyPress(driving.pad, Qt.Key.Key_Up)
    qtbot.waitUntil(lambda: base(driving)[0] > 0.02, timeout=WAIT_MS)

    driving.pilot._again.stop()  # as if this program had frozen

    qtbot.waitUntil(lambda: not is_moving(driving), timeout=WAIT_MS)


def test_keys_held_together_add_up() -> None:
    assert sum_of([Drive(forward=1.0), Drive(turn=1.0), Drive(forward=0.5)]) == Drive(
        forward=1.0, turn=1.0
    )


def event(kind: int, number: int, value: int) -> bytes:
    return struct.pack("IhBB", 0, value, kind, number)


def test_the_sticks_of_a_gamepad_walk_and_look() -> None:
    sticks = Sticks()

    sticks.take(event(2, 1, -32767) + event(2, 3, 32767) + event(1, 4, 1) + b"torn")

    assert sticks.drive() == Drive(forward=1.0, left=1.0, turn=0.0, head_left=-1.0)
    sticks.take(event(0x82, 1, 2000) + event(2, 3, 0) + event(1, 4, 0))
    assert sticks.drive() == STILL


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="gamepads are read from files on Linux")
def test_a_gamepad_that_is_pulled_out_lets_go(tmp_path: Path, qtbot: QtBot) -> None:
    os.mkfifo(tmp_path / "js0")
    gamepad = Gamepad(folder=tmp_path)
    assert gamepad.open()
    cable = os.open(tmp_path / "js0", os.O_WRONLY)
    with qtbot.waitSignal(gamepad.changed) as told:
        os.write(cable, event(2, 1, -32767))
    assert told.args == [Drive(forward=1.0)]

    with qtbot.waitSignals([gamepad.changed, gamepad.lost]):
        os.close(cable)

    assert not gamepad.is_open


def test_a_tilted_watch_walks_and_a_level_one_does_not() -> None:
    tilt = Tilt()
    tilt.hear(imu(0.0, 0.0, EARTH))
    assert tilt.drive() == STILL

    angle = math.radians(50)
    tilt.hear(imu(0.0, EARTH * math.sin(angle), EARTH * math.cos(angle), 3.0))

    assert tilt.drive().forward == 1.0
    assert tilt.arm()["RShoulderPitch"] < 0.5


def test_how_the_watch_is_held_first_is_its_middle() -> None:
    tilt, angle = Tilt(), math.radians(30)

    tilt.hear(imu(EARTH * math.sin(angle), 0.0, EARTH * math.cos(angle), 3.0))

    assert tilt.is_settled
    assert tilt.drive() == STILL


def test_a_watch_that_falls_silent_stops_the_robot(
    driving: TeleoperationWindow, qtbot: QtBot
) -> None:
    driving.with_watch.setChecked(True)
    driving.tilt.hear(imu(0.0, 0.0, EARTH))
    angle = math.radians(50)
    driving.tilt.hear(imu(0.0, EARTH * math.sin(angle), EARTH * math.cos(angle), 3.0))

    driving._on_imu([])

    assert driving.pilot.drive.forward > 0
    qtbot.waitUntil(lambda: driving.pilot.drive == STILL)
    assert "not heard" in driving.told.text()


def test_another_window_in_front_stops_what_a_gamepad_drives(
    driving: TeleoperationWindow, window: MainWindow, qtbot: QtBot
) -> None:
    driving.gamepad.changed.emit(Drive(forward=1.0))
    assert driving.pilot.drive.forward > 0

    window.activateWindow()

    qtbot.waitUntil(lambda: driving.pilot.drive == STILL)
    driving.gamepad.changed.emit(Drive(forward=0.9))
    assert driving.pilot.drive == STILL
