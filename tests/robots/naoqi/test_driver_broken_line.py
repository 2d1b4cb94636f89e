"""What happens when the line to a robot that was met brings rubbish in the middle of a motion."""

from __future__ import annotations

import contextlib
import socket
import struct
import threading
from collections.abc import Iterator

import pytest
from driver_stage import DriverStage, ServedNao

from robots.naoqi.discovery import FOLDER_VARIABLE

pytestmark = pytest.mark.long

TOLD_S = 3.0
MAGIC = 0x42ADDE42
RUBBISH = b"\x00\xffnothing that NAOqi says" * 20
HALF_A_FRAME = struct.pack("<IIIHBB", MAGIC, 1, 4000, 0, 2, 0)
A_GIGABYTE = struct.pack("<IIIHBBIII", MAGIC, 7, 1 << 30, 0, 2, 0, 1, 1, 8)


class Line:
    """Passes bytes on between the driver and the robot, and more than these when it is told to."""

    def __init__(self, robot: ServedNao) -> None:
        self.robot = robot
        self._server = socket.create_server(("127.0.0.1", 0))
        self._ends: list[tuple[socket.socket, socket.socket]] = []
        self.port = self._server.getsockname()[1]
        self.is_broken = False
        threading.Thread(target=self._accept, daemon=True).start()

    def say(self, words: bytes) -> None:
        """Let the driver hear something, and the robot no more."""
        self.is_broken = True
        self._ends[-1][0].sendall(words)

    def close(self) -> None:
        with contextlib.suppress(OSError):  # a thread waits there: closing alone would not end it
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        for ends in self._ends:
            for end in ends:
                end.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError), self._server:
            while True:
                driver, _ = self._server.accept()
                robot = socket.create_connection(("127.0.0.1", self.robot.port))
                self._ends.append((driver, robot))
                self.is_broken = False
                for one, other in ((driver, robot), (robot, driver)):
                    threading.Thread(target=self._pass_on, args=(one, other), daemon=True).start()

    def _pass_on(self, one: socket.socket, other: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while words := one.recv(65536):
                if not self.is_broken:
                    other.sendall(words)
            other.shutdown(socket.SHUT_RDWR)


@pytest.fixture
def line(tmp_path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Line]:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    robot = ServedNao(speed=1.0)
    made = Line(robot)
    yield made
    made.close()
    robot.close()


@pytest.mark.parametrize("words", [RUBBISH, HALF_A_FRAME, A_GIGABYTE])
def test_rubbish_in_the_middle_of_a_motion_is_told_and_the_robot_is_met_again(
    line: Line, words: bytes
) -> None:
    stage = DriverStage(f"127.0.0.1:{line.port}")
    stage.meet()
    stage.ask("walk", "walk", forward_m=2)
    stage.until(lambda: "walk started" in stage.told)

    line.say(words)
    passed_s = stage.until(lambda: "walk failed" in stage.told)

    assert passed_s < TOLD_S
    assert stage.event == "disconnected"
    assert str(stage.driver.connection.fault).startswith(("The connection", "NAO does not answer"))
    stage.meet()
    assert stage.do("say", text="Here I am again").state == "done"
    stage.until(lambda: not line.robot.state().moving)
    assert line.robot.state().base[0] < 1.0  # nobody lets it walk on alone
    stage.close()
