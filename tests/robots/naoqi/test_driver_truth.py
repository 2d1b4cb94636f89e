"""Done is what the robot has really done; and robots that ask who we are."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from driver_held_nao import SERVICES, HeldNao
from driver_stage import DriverStage, ServedNao
from naoqi_lamp import CERTIFICATE, KEY

from robots.body.driver import RobotState
from robots.naoqi.discovery import FOLDER_VARIABLE, SavedLogin, save_login
from robots.naoqi.probe import probe
from robots.naoqi.server.server import Server
from robots.naoqi.wire.line import Login, TlsFiles

pytestmark = pytest.mark.long


@pytest.fixture(autouse=True)
def no_saved_login(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture
def nao() -> HeldNao:
    return HeldNao()


@pytest.fixture
def held(nao: HeldNao) -> Iterator[DriverStage]:
    server = Server({name: nao for name in SERVICES}, port=0)
    stage = DriverStage(f"127.0.0.1:{server.start()}")
    stage.until(lambda: stage.driver.state() is not None)
    yield stage
    stage.close()
    server.stop()


def test_done_is_said_only_when_the_robot_has_done_it(held: DriverStage) -> None:
    head = held.do("look", yaw_deg=40)
    posture = held.do("do", posture="posture_stand")
    walk = held.do("walk", forward_m=0.5)
    lights = held.do("leds", group="FaceLeds", colour="#ff0000")

    assert [head.state, posture.state, walk.state, lights.state] == ["failed"] * 4
    assert "HeadYaw did not get where it was sent" in head.description
    assert "did not get into the posture Stand" in posture.description
    assert "got only 0.00 m of 0.50 m" in walk.description
    assert "These lights are broken." in lights.description


def test_a_call_that_never_ends_is_given_up_with_a_sentence(held: DriverStage) -> None:
    held.ask("dim", "intensity", group="EarLeds", percent=10)

    passed_s = held.until(lambda: "dim failed" in held.told)

    assert passed_s < 6.0
    assert "did not end in time what it was asked" in held.end_of("dim").description


def test_stop_reaches_motion_posture_and_speech_while_a_call_hangs(
    held: DriverStage, nao: HeldNao
) -> None:
    held.ask("dim", "intensity", group="EarLeds", percent=10)

    held.ask("stop", "stop")
    passed_s = held.until(lambda: {"stopAll", "killAll"} <= set(nao.stopped))

    assert passed_s < 1.0  # 0.2 s on a quiet computer
    assert nao.stopped.count("stopMove") == 2  # of motion, and of posture
    assert held.told[-2:] == ["dim cancelled", "stop done"]


def test_a_hot_motor_is_warned_of(held: DriverStage) -> None:
    held.until(lambda: held.event == "warning")

    told = held.driver.connection.fault
    assert "RKneePitch has 80 °C" in str(told)
    assert any("rest" in str(step) for step in told.checklist)


def test_the_state_of_a_robot_that_was_never_met_is_not_known() -> None:
    stage = DriverStage("127.0.0.1:1")

    state: RobotState | None = stage.driver.state()

    assert state is None
    stage.close()


def test_another_model_is_driven_by_the_same_code() -> None:
    pepper = ServedNao(model="pepper")
    stage = DriverStage(pepper.address, "pepper")
    try:
        stage.meet()
        ends = [
            stage.do("say", text="Hello, I am on wheels"),
            stage.do("play", animation="wave"),
            stage.do("walk", forward_m=0.3, turn_deg=90),
            stage.do("look", yaw_deg=30),
            stage.do("stiffness", part="body", on=True),
            stage.do("rest"),
            stage.do("wake_up"),
        ]
        state = pepper.state()
    finally:
        stage.close()
        pepper.close()

    assert [end.state for end in ends] == ["done"] * len(ends), ends
    assert state.base == pytest.approx((0.3, 0.0, 1.5708), abs=0.02)
    assert stage.driver.state() is None  # given up


@pytest.fixture
def encrypted() -> Iterator[str]:
    """A robot that speaks only TLS and asks for a password; its address."""
    files = TlsFiles(CERTIFICATE, KEY)
    services = {name: HeldNao() for name in SERVICES}
    server = Server(services, port=0, login=Login("nao", "secret"), tls_files=files)
    yield f"127.0.0.1:{server.start()}"
    server.stop()


def test_a_robot_with_tls_and_login_is_met_and_its_certificate_is_remembered(
    encrypted: str,
) -> None:
    *_, last = probe(encrypted, Login("nao", "secret"))
    assert last.about is not None and len(last.about.fingerprint) == 95

    save_login(encrypted, SavedLogin("nao", "secret", last.about.fingerprint))
    stage = DriverStage(encrypted)
    stage.until(lambda: stage.driver.state() is not None)

    assert stage.do("say", text="Hello").state == "done"
    stage.close()


def test_another_robot_at_a_trusted_address_is_told(encrypted: str) -> None:
    save_login(encrypted, SavedLogin("nao", "secret", "00:11"))
    stage = DriverStage(encrypted)

    stage.until(lambda: stage.event == "connection_failed")

    assert "not the robot that was trusted before" in str(stage.driver.connection.fault)
    stage.close()


def test_a_robot_with_tls_says_that_it_asks_for_a_login(encrypted: str) -> None:
    stage = DriverStage(encrypted)

    stage.until(lambda: stage.event == "connection_failed")

    assert "password" in str(stage.driver.connection.fault)
    stage.close()
