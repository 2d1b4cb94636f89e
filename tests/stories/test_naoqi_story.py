"""As a user: ``nep-studio naoqi`` in a terminal, and programs made for a real NAO that find it."""

from __future__ import annotations

import contextlib
import importlib.util
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QApplication

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import ROBOT_STATE, RobotState
from nep_core.wire.pubsub import Subscriber
from nep_studio.ui.robot_view.camera import Camera
from nep_studio.ui.robot_view.view import RoomPicture
from nep_studio.ui.theme.look import Look
from robots.naoqi.client.session import Session
from robots.naoqi.wire.errors import LoginRefused, NoConnection
from robots.naoqi.wire.line import Login
from tests.node_running import until

pytestmark = pytest.mark.long

GREETER = Path(__file__).parent.parent / "robots" / "naoqi" / "greeter.py"
WAIT_S = 30.0


class Terminal:
    """``nep-studio naoqi`` and all that it prints."""

    def __init__(self, *words: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "nep_studio", "naoqi", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.text = ""

    def wait_for(self, words: str) -> str:
        """All that was printed up to some words; fails when it ends without them."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.text += line
            if words in line:
                return self.text
        pytest.fail(self.text + self.process.communicate()[1])

    def finish(self) -> tuple[int, str, str]:
        """Wait for its end; exit code, output, errors."""
        output, errors = self.process.communicate(timeout=WAIT_S)
        return self.process.returncode, self.text + output, errors

    def interrupt(self) -> tuple[int, str, str]:
        """Press Ctrl-C; exit code, output, errors."""
        self.process.send_signal(signal.SIGINT)
        return self.finish()


@contextlib.contextmanager
def terminal(*words: object) -> Iterator[Terminal]:
    """A terminal in which the program is ended, if it still runs."""
    one = Terminal(*map(str, words))
    try:
        yield one
    finally:
        if one.process.poll() is None:
            one.interrupt()
        for stream in (one.process.stdout, one.process.stderr):
            if stream:
                stream.close()


def test_it_says_where_the_robot_is_and_switches_it_off_at_ctrl_c(
    network: PeerNetwork, free_port: int
) -> None:
    with terminal("--port", free_port, "--speed", 10) as shell:
        told = shell.wait_for(f"Ctrl-C switches NAO-{free_port} off.")
        session = Session(("127.0.0.1", free_port))
        session.connect()
        name = session.service("ALSystem").call("robotName")
        session.close()

        code, output, errors = shell.interrupt()

    assert f"tcp://127.0.0.1:{free_port}" in told
    assert f"--qi-url=tcp://127.0.0.1:{free_port}" in told
    assert name == f"NAO-{free_port}"
    assert (code, errors) == (0, "")
    assert output.endswith(f"NAO-{free_port} is off.\n")
    with pytest.raises(NoConnection):
        Session(("127.0.0.1", free_port)).connect()


@pytest.mark.skipif(importlib.util.find_spec("qi") is None, reason="qi is not there")
def test_a_program_made_for_a_real_nao_moves_the_robot_that_the_network_sees(
    network: PeerNetwork, free_port: int, qapp: QApplication
) -> None:
    states = Subscriber(ROBOT_STATE, RobotState, network=network)
    with terminal("--port", free_port, "--speed", 4) as shell:
        shell.wait_for("Ctrl-C switches")
        program = subprocess.Popen(
            [sys.executable, str(GREETER), f"--qi-url=tcp://127.0.0.1:{free_port}"],
            stdout=subprocess.PIPE,
            text=True,
        )

        before = until(states, lambda state: state.robot)[-1]
        lit = until(states, lambda state: state.leds["LeftFaceLeds"] == 0xFF00FF)[-1]
        waving = until(states, lambda state: state.saying == "a robot")[-1]
        walked = until(states, lambda state: state.base[0] > 0.04)[-1]
        program.kill()
        program.communicate()

    assert walked.robot == f"NAO-{free_port}"
    seen = [picture(qapp, state) for state in (before, lit, waving, walked)]
    for earlier, later in pairwise(seen):
        assert (np.abs(earlier - later).max(axis=2) > 30).mean() > 0.004
    red, green, blue = (seen[1] - seen[0]).transpose(2, 0, 1)
    assert ((red > 40) & (green < 0) & (blue > 0)).sum() > 20  # its eyes, in magenta


def picture(qapp: QApplication, state: RobotState) -> NDArray[np.int_]:
    """What the stage paints of a state: red, green and blue of all pixels."""
    room = RoomPicture(Look(qapp, "light"), drawing="painter")
    room.show_robot(state.robot, state)
    room.look_through(Camera(target=(0.0, 0.0, 0.3)))
    image = room.grab_picture(QSize(320, 320))
    bits = np.frombuffer(image.constBits(), np.uint8).reshape(320, 320, 4)
    room.deleteLater()
    return bits[:, :, 2::-1].astype(int)


def test_a_port_that_is_taken_is_told_with_what_to_do(network: PeerNetwork) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]

        with terminal("--port", port) as shell:
            code, output, errors = shell.finish()

    assert (code, output) == (1, "")
    assert f"Port {port} of this computer is used by another program." in errors
    assert f"[ ] Or take another port: nep-studio naoqi --port {port + 1}" in errors
    assert "Traceback" not in errors


def test_a_robot_with_a_login_lets_in_who_knows_it(network: PeerNetwork, free_port: int) -> None:
    with terminal("--port", free_port, "--login", "nao:secret", "--robot", "Anna") as shell:
        told = shell.wait_for("Ctrl-C switches Anna off.")
        right = Session(("127.0.0.1", free_port), login=Login("nao", "secret"))
        right.connect()
        name = right.service("ALSystem").call("robotName")
        right.close()

        with pytest.raises(LoginRefused):
            Session(("127.0.0.1", free_port), login=Login("nao", "guess")).connect()

    assert name == "Anna"
    assert "as user nao" in told
    assert "secret" not in told


def test_without_a_network_it_starts_one_of_its_own(
    monkeypatch: pytest.MonkeyPatch, free_port: int
) -> None:
    monkeypatch.setenv("NEP_MASTER", f"tcp://127.0.0.1:{free_port + 1}")

    with terminal("--port", free_port) as shell:
        shell.wait_for("Ctrl-C switches")
        code, _, errors = shell.interrupt()

    assert (code, errors) == (0, "")


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--port", "99999"], "is not a port"),
        (["--speed", "0"], "is not a number from 0.1 to 50"),
        (["--login", "nao"], "write user:password"),
        (["--robot", ""], "A node has no name."),
    ],
)
def test_a_word_that_makes_no_sense_is_told(words: list[str], told: str) -> None:
    with terminal(*words) as shell:
        code, _, errors = shell.finish()

    assert code in (1, 2)
    assert told in errors
    assert "Traceback" not in errors
