"""A watch that is switched off, and robots that answer late or never."""

from __future__ import annotations

import os
import signal
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import closing, suppress

import pytest
from PySide6.QtCore import QTimer

from nep_studio.blocks.edits.content import SetField
from nep_studio.run.plan import PlannedNode
from tests.robots.naoqi.driver_stage import DriverStage, ServedNao
from tests.ui.faults.conftest import Scene

pytestmark = pytest.mark.long

FIRST = "Show me a karate chop!"
LATE = "“NAO” does not answer"
SAMPLES_HZ = 100
LONGEST_STOP_S = 10.0
"""Asking takes two seconds; the rest is for a busy computer."""


class Watch:
    """Sends samples by UDP, as the phones of the paper do, until it is switched off."""

    def __init__(self, port: int) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._port = port
        self._number = 0
        self._timer = QTimer(interval=1000 // SAMPLES_HZ)
        self._timer.timeout.connect(self._send)
        self._timer.start()

    def close(self) -> None:
        self._timer.stop()
        self._socket.close()

    def _send(self) -> None:
        self._number += 1
        time_ns = 10**15 + self._number * 10**9 // SAMPLES_HZ
        line = f"y;{time_ns};0.1;0.2;0.3\na;{time_ns};0;0;9.81\n"
        self._socket.sendto(line.encode(), ("127.0.0.1", self._port))


@pytest.fixture
def udp_port() -> int:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def frozen_robot(stage: Scene) -> Iterator[int]:
    """The robot's node of a run stands still in the middle of a sentence; its process."""
    stage.run()
    stage.until(lambda: FIRST in stage.said)
    pid = stage.pid("NAO")
    os.kill(pid, signal.SIGSTOP)
    yield pid
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGCONT)


def test_a_watch_that_is_switched_off_is_told_until_it_sends_again(
    stage: Scene, udp_port: int
) -> None:
    board = stage.runner.board.nodes
    stage.runner.start_node(PlannedNode("sensory/smartwatch", "phone", {"port": udp_port}))
    stage.until(lambda: "phone" in board and board["phone"].health == "ready")
    title = "“phone” has lost its connection"
    with closing(Watch(udp_port)):
        stage.until(lambda: board["phone"].event == "connected")

    stage.until(lambda: title in stage.shown)

    [alarm] = stage.alarms
    assert "sent nothing" in str(alarm.sentence)
    assert alarm.checklist
    with closing(Watch(udp_port)):
        stage.until(lambda: title not in stage.shown)


def test_a_robot_that_answers_late_is_told_and_nothing_is_lost(
    stage: Scene, frozen_robot: int
) -> None:
    stage.until(lambda: LATE in stage.shown)
    [alarm] = stage.alarms
    assert alarm.checklist

    os.kill(frozen_robot, signal.SIGCONT)

    stage.until(lambda: LATE not in stage.shown)
    stage.until(lambda: "Impressive!" in stage.said)
    assert stage.said[:2] == [FIRST, "Impressive!"]
    assert stage.runner.state == "running"
    assert len(stage.alarms) == 1


def test_stop_does_not_wait_for_a_robot_that_does_not_answer(
    stage: Scene, frozen_robot: int
) -> None:
    pressed_s = time.monotonic()

    stage.press("stop")
    stage.state_is("idle")

    assert time.monotonic() - pressed_s < LONGEST_STOP_S
    assert {alarm.title for alarm in stage.alarms} <= {LATE}
    stage.until(lambda: LATE not in stage.shown)
    with pytest.raises(ProcessLookupError):
        os.kill(frozen_robot, 0)


def test_a_robot_whose_address_takes_calls_but_never_answers_is_told(
    stage: Scene,
) -> None:
    """The button lets the one on the screen play its part."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        real = use_address(stage, f"127.0.0.1:{server.getsockname()[1]}")
        stage.runner.start_node(real)
        stage.until(lambda: "NAO does not answer" in stage.shown)

    stage.press_answer("NAO does not answer", "Use the robot on the screen")

    stage.until(lambda: stage.runner.board.nodes["NAO"].health == "ready")
    assert len(stage.alarms) == 1
    assert stage.alarms[0].checklist


@pytest.fixture
def driven_nao() -> Iterator[tuple[ServedNao, DriverStage]]:
    """A robot behind NAOqi, and another program that drives it."""
    nao = ServedNao(speed=10.0)
    other = DriverStage(nao.address)
    other.meet()
    is_over = threading.Event()

    def drive() -> None:
        while not is_over.is_set():
            other.step()

    driving = threading.Thread(target=drive)
    driving.start()
    yield nao, other
    is_over.set()
    driving.join()
    other.close()
    nao.close()


def test_a_robot_that_another_program_drives_is_taken_over_by_a_button(
    stage: Scene, driven_nao: tuple[ServedNao, DriverStage]
) -> None:
    nao, other = driven_nao
    stage.runner.start_node(use_address(stage, nao.address), is_wanted=True)
    stage.until(lambda: "NAO is driven by somebody else" in stage.shown)
    assert other.event == "connected"

    stage.press_answer("NAO is driven by somebody else", "Take it over")

    stage.until(lambda: other.driver.connection.fault.code == "taken_over")
    stage.until(lambda: stage.runner.board.nodes["NAO"].health == "ready")
    stage.until(lambda: "NAO is driven by somebody else" not in stage.shown)


def use_address(stage: Scene, address: str) -> PlannedNode:
    """Let the robot of the project be a real one at this address."""
    nao = next(one for one in stage.runner.planned() if one.name == "NAO")
    editor = stage.window.workbench.canvas.editor
    with editor.transaction("a real robot"):
        editor.apply(SetField(nao.block_id, "driver", "naoqi"))
        editor.apply(SetField(nao.block_id, "address", address))
    return next(one for one in stage.runner.planned() if one.name == "NAO")
