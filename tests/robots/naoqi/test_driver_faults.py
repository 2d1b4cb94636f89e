"""Robots that end, freeze, refuse, or are something else: each is told, and met again later."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import struct
import threading
from collections.abc import Callable, Iterator

import pytest
from driver_stage import DriverStage, ServedNao

from robots.body.actions import Turn
from robots.errors import ActionFailed
from robots.naoqi.discovery import FOLDER_VARIABLE, PASSWORD_VARIABLE, SavedLogin, save_login
from robots.naoqi.server.server import Server
from robots.naoqi.wire.service import method

pytestmark = pytest.mark.long

TOLD_S = 6.0
"""Half of that on a quiet computer."""
MAGIC = 0x42ADDE42

Answer = Callable[[socket.socket], None]


@pytest.fixture(autouse=True)
def no_saved_login(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    monkeypatch.delenv(PASSWORD_VARIABLE, raising=False)


@pytest.fixture
def stages() -> Iterator[Callable[[str], DriverStage]]:
    with contextlib.ExitStack() as stack:

        def make(address: str) -> DriverStage:
            stage = DriverStage(address)
            stack.callback(stage.close)
            return stage

        yield make


@pytest.fixture
def robots() -> Iterator[Callable[..., ServedNao]]:
    with contextlib.ExitStack() as stack:

        def make(**how: object) -> ServedNao:
            robot = ServedNao(**how)
            stack.callback(robot.close)
            return robot

        yield make


@pytest.fixture
def strangers() -> Iterator[Callable[[Answer], str]]:
    """Makes programs that are no robots; gives their address."""
    with contextlib.ExitStack() as stack:

        def make(answer: Answer) -> str:
            server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
            threading.Thread(target=serve, args=(server, answer), daemon=True).start()
            return f"127.0.0.1:{server.getsockname()[1]}"

        yield make


def serve(server: socket.socket, answer: Answer) -> None:
    kept = []
    with contextlib.suppress(OSError):
        while True:
            one, _ = server.accept()
            kept.append(one)
            one.recv(4096)
            answer(one)


def sentence(stage: DriverStage) -> str:
    return str(stage.driver.connection.fault)


def checklist(stage: DriverStage) -> list[str]:
    return [str(step) for step in stage.driver.connection.fault.checklist]


def test_a_robot_that_does_not_answer_is_told_with_a_checklist_and_fails_every_action(
    stages, free_port: int
) -> None:
    stage = stages(f"127.0.0.1:{free_port}")
    before = stage.driver.connection

    passed_s = stage.until(lambda: stage.event == "connection_failed")

    assert before.event == "connecting"
    assert str(before.fault) == f"Looking for NAO at 127.0.0.1:{free_port}."
    assert passed_s < TOLD_S
    assert sentence(stage).startswith("NAO does not answer")
    assert len(checklist(stage)) == 4
    assert all(checklist(stage))
    with pytest.raises(ActionFailed) as told:
        stage.driver.limbs(Turn(90.0))
    assert str(told.value.sentence) == sentence(stage)
    assert stage.driver.state() is None


def test_a_robot_that_is_switched_on_later_is_met(stages, robots, free_port: int) -> None:
    stage = stages(f"127.0.0.1:{free_port}")
    stage.until(lambda: stage.event == "connection_failed")

    robots(port=free_port)
    stage.meet()

    assert stage.do("turn", degrees=30).state == "done"


def test_a_server_that_is_killed_in_the_middle_of_a_motion_is_told_and_met_again(
    stages, robots
) -> None:
    robot = robots(speed=1.0)
    stage = stages(robot.address)
    stage.meet()
    stage.ask("walk", "walk", forward_m=3)
    stage.until(lambda: "walk started" in stage.told)

    robot.process.kill()
    passed_s = stage.until(lambda: "walk failed" in stage.told)

    assert passed_s < TOLD_S
    assert stage.event == "disconnected"
    assert stage.end_of("walk").description == sentence(stage)
    assert "The connection to NAO" in sentence(stage)
    robots(port=robot.port)
    stage.meet()
    assert stage.do("look", yaw_deg=20).state == "done"


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="there is no SIGSTOP here")
def test_a_frozen_robot_is_told_and_met_again_when_it_goes_on(stages, robots) -> None:
    robot = robots(speed=1.0)
    stage = stages(robot.address)
    stage.meet()
    stage.ask("walk", "walk", forward_m=3)
    stage.until(lambda: "walk started" in stage.told)

    os.kill(robot.process.pid, signal.SIGSTOP)
    try:
        passed_s = stage.until(lambda: "walk failed" in stage.told)

        assert passed_s < TOLD_S
        assert "does not answer any more" in sentence(stage)
    finally:
        os.kill(robot.process.pid, signal.SIGCONT)
    stage.meet()
    assert stage.do("say", text="I am back").state == "done"


def test_a_wrong_password_is_told_and_the_right_one_opens_the_door(stages, robots) -> None:
    robot = robots(password="right")
    save_login(robot.address, SavedLogin("nao", "wrong"))
    stage = stages(robot.address)

    passed_s = stage.until(lambda: stage.event == "connection_failed")

    assert passed_s < TOLD_S
    assert "does not let this program in" in sentence(stage)
    save_login(robot.address, SavedLogin("nao", "right"))
    stage.meet()


def test_a_robot_that_asks_for_a_password_says_so_when_there_is_none(stages, robots) -> None:
    stage = stages(robots(password="right").address)

    stage.until(lambda: stage.event == "connection_failed")

    assert "does not let this program in" in sentence(stage)


def garbage(one: socket.socket) -> None:
    one.sendall(b"HTTP/1.1 400 Bad Request\r\nServer: nothing of NAOqi's\r\n\r\n" * 10)


def half_a_frame(one: socket.socket) -> None:
    one.sendall(struct.pack("<IIIHBB", MAGIC, 1, 40, 0, 2, 0))


def a_gigabyte(one: socket.socket) -> None:
    one.sendall(struct.pack("<IIIHBBIII", MAGIC, 1, 1 << 30, 0, 2, 0, 0, 0, 8) + b"x" * 64)


def nothing(one: socket.socket) -> None:
    return


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (garbage, "is not a NAOqi robot"),
        (a_gigabyte, "is not a NAOqi robot"),
        (half_a_frame, "does not answer"),
        (nothing, "does not answer"),
        (socket.socket.close, "is not a NAOqi robot"),
    ],
)
def test_what_does_not_speak_as_a_robot_does_is_told_in_time(
    stages, strangers, answer: Answer, words: str
) -> None:
    stage = stages(strangers(answer))

    passed_s = stage.until(lambda: stage.event == "connection_failed")

    assert passed_s < TOLD_S
    assert words in sentence(stage)
    assert len(checklist(stage)) >= 2


class Lamp:
    """A service that no NAO has."""

    @method("shine::v()")
    def shine(self) -> None:
        return


def test_a_robot_without_the_services_of_a_nao_is_told_by_what_is_missing(stages) -> None:
    server = Server({"Lamp": Lamp()}, port=0)
    stage = stages(f"127.0.0.1:{server.start()}")

    passed_s = stage.until(lambda: stage.event == "connection_failed")
    server.stop()

    assert passed_s < TOLD_S
    assert "ALMotion" in sentence(stage)


def test_a_joint_that_is_asked_to_go_too_far_goes_as_far_as_it_can(stages, robots) -> None:
    robot = robots()
    stage = stages(robot.address)
    stage.meet()

    result = stage.do("move_joint", joint="HeadYaw", degrees=300)

    assert (result.state, result.description) == ("done", "moved as far as it goes: 120 degrees")
    assert robot.state().joints["HeadYaw"] == pytest.approx(2.086, abs=0.02)


def test_an_action_that_the_robot_cannot_do_says_the_reason(stages, robots) -> None:
    stage = stages(robots().address)
    stage.meet()

    refused = stage.do("learn_face", name="Anna")
    unknown = stage.do("move_joint", joint="Tail", degrees=3)

    assert refused.state == "failed" and "sees nobody" in refused.description
    assert unknown.state == "failed" and 'no joint "Tail"' in unknown.description


def test_stop_reaches_the_robot_at_once_while_it_walks_and_speaks(stages, robots) -> None:
    robot = robots(speed=1.0)
    stage = stages(robot.address)
    stage.meet()
    stage.ask("walk", "walk", forward_m=3)
    stage.ask("say", "say", text="I could go on like this for a very long time " * 5)
    stage.until(lambda: {"walk started", "say started"} <= set(stage.told))
    stage.until(lambda: robot.state().saying and robot.state().base[0] > 0.02)

    stage.ask("stop", "stop")
    passed_s = stage.until(lambda: not robot.state().saying)
    place = robot.state().base[0]

    assert passed_s < 1.0  # 0.2 s on a quiet computer
    assert {"walk cancelled", "say cancelled", "stop done"} <= set(stage.told)
    stage.until(lambda: not robot.state().moving)
    assert robot.state().base[0] - place < 0.2


def test_stop_ends_only_what_was_meant(stages, robots) -> None:
    robot = robots(speed=1.0)
    stage = stages(robot.address)
    stage.meet()
    stage.ask("walk", "walk", forward_m=3)
    stage.ask("say", "say", text="I could go on like this for a very long time " * 5)
    stage.until(lambda: robot.state().saying and robot.state().moving)

    stage.ask("stop", "stop", request="walk")
    stage.until(lambda: not robot.state().moving)

    assert "walk cancelled" in stage.told and "say cancelled" not in stage.told
    assert robot.state().saying
