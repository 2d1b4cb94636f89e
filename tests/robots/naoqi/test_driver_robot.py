"""What our driver says and does of a robot behind NAOqi: states, words, warnings, true results."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from driver_stage import DriverStage, ServedNao

from robots.naoqi.discovery import FOLDER_VARIABLE

pytestmark = pytest.mark.long


@pytest.fixture(autouse=True)
def no_saved_login(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture
def robot() -> Iterator[ServedNao]:
    made = ServedNao(speed=20.0)
    yield made
    made.close()


@pytest.fixture
def stage(robot: ServedNao) -> Iterator[DriverStage]:
    made = DriverStage(robot.address)
    made.meet()
    yield made
    made.close()


def test_its_state_is_that_of_the_robot(robot: ServedNao, stage: DriverStage) -> None:
    stage.do("do", posture="posture_sit")
    stage.do("leds", group="FaceLeds", colour="#00ff00")
    robot.sense("sonar_left", 0.3)
    robot.sense("battery", 0.4)

    def is_there() -> bool:
        told = stage.driver.state()
        return told is not None and told.battery < 0.45 and told.sensors["sonar_left"] < 0.35

    stage.until(is_there)
    told, real = stage.driver.state(), robot.state()

    assert told is not None and told.posture == real.posture == "Sit"
    assert told.joints == pytest.approx(real.joints, abs=0.01)
    assert told.leds == real.leds
    assert told.settings == real.settings
    assert told.sensors["acc_z"] == pytest.approx(real.sensors["acc_z"], abs=0.1)
    assert told.torso == pytest.approx(real.torso, abs=0.05)


def test_touches_come_once_and_the_sensor_is_told(robot: ServedNao, stage: DriverStage) -> None:
    robot.sense("hand_left")
    stage.until(lambda: len(stage.noticed) == 2)
    robot.sense("hand_left", 0.0)
    stage.until(lambda: stage.driver.state().sensors["hand_left"] == 0.0)
    robot.sense("hand_left")
    stage.until(lambda: len(stage.noticed) == 4)

    assert stage.noticed == ["touched_hand_left", "touched_hand"] * 2


def test_a_face_is_noticed_where_it_is_and_forgotten(robot: ServedNao, stage: DriverStage) -> None:
    robot.sense("face", name="Anna", place=(1.5, 0.5, 0.6))
    stage.until(lambda: "person_middle" in stage.noticed)

    seen = stage.driver.state().sees["face_anna"]
    robot.sense("face", 0.0, name="Anna")
    stage.until(lambda: not stage.driver.state().sees)

    assert stage.noticed == ["seen_face_anna", "seen_face", "person_middle"]
    assert math.dist(seen, (1.5, 0.5, 0.6)) < 0.15


def test_marks_balls_and_sounds_are_noticed(robot: ServedNao, stage: DriverStage) -> None:
    robot.sense("mark", name="64", place=(1.0, 0.0, 0.4))
    robot.sense("ball", place=(0.6, 0.1, 0.3))
    robot.sense("sound", place=(1.0, 1.0, 0.5))

    stage.until(lambda: {"seen_mark_64", "seen_ball", "heard_sound"} <= set(stage.noticed))

    assert set(stage.driver.state().sees) == {"mark", "mark_64", "ball", "sound"}


def test_words_that_rules_wait_for_are_heard_all_the_time(
    robot: ServedNao, stage: DriverStage
) -> None:
    stage.driver.expect(["Good morning", "stop it"])
    stage.until(lambda: set(robot.state().listening) == {"Good morning", "stop it"})

    robot.sense("word", name="elephant")
    robot.sense("word", name="Good morning")

    stage.until(lambda: stage.noticed)
    assert stage.noticed == ["heard_good_morning"]


def test_a_question_adds_its_words_for_a_while(robot: ServedNao, stage: DriverStage) -> None:
    stage.driver.expect(["hello"])
    stage.ask("1", "listen", words=["yes", "no"], seconds=60)
    stage.until(lambda: set(robot.state().listening) == {"hello", "yes", "no"})
    stage.until(lambda: stage.driver.state().listening == ["yes", "no"])

    stage.ask("2", "stop", request="1")
    stage.until(lambda: robot.state().listening == ["hello"])

    assert stage.driver.state().listening == []


def test_an_answer_that_is_none_of_the_words_is_noticed(
    robot: ServedNao, stage: DriverStage
) -> None:
    stage.ask("1", "listen", words=["yes", "no"], seconds=60)
    stage.until(lambda: stage.driver.state().listening == ["yes", "no"])
    stage.until(lambda: robot.state().listening == ["yes", "no"])

    robot.sense("word", name="elephant")

    stage.until(lambda: stage.noticed == ["not_understood"])


def test_words_are_listened_for_again_after_the_robot_was_gone(stage: DriverStage, robot) -> None:
    stage.driver.expect(["hello"])
    stage.until(lambda: robot.state().listening == ["hello"])
    robot.close()
    stage.until(lambda: stage.event == "disconnected")

    again = ServedNao(port=robot.port)
    try:
        stage.until(lambda: again.state().listening == ["hello"])
    finally:
        again.close()


@pytest.mark.parametrize(
    ("sense", "words"),
    [(("battery", 0.08), "battery is nearly empty: 8 %")],
)
def test_a_nearly_empty_battery_is_warned_of_until_it_is_charged(
    robot: ServedNao, stage: DriverStage, sense: tuple[str, float], words: str
) -> None:
    robot.sense(*sense)
    stage.until(lambda: stage.event == "warning")

    told = stage.driver.connection.fault
    robot.sense("battery", 0.9)
    stage.until(lambda: stage.event == "connected")

    assert words in str(told)
    assert str(told.checklist[0]).startswith("Plug NAO in")


def test_a_robot_that_sleeps_says_how_it_is_woken(robot: ServedNao, stage: DriverStage) -> None:
    stage.do("rest")
    stage.until(lambda: stage.event == "warning")

    told = stage.driver.connection.fault
    refused = stage.do("look", yaw_deg=20)
    spoken = stage.do("say", text="I can still speak")
    woken = stage.do("wake_up")

    assert "asleep" in str(told) and any("wakes up" in str(step) for step in told.checklist)
    assert refused.state == "failed" and "head is released" in refused.description
    assert [spoken.state, woken.state] == ["done", "done"]
    stage.until(lambda: stage.event == "connected")


def test_a_text_in_a_language_that_it_does_not_speak_is_said_as_it_can(
    robot: ServedNao, stage: DriverStage
) -> None:
    ends = [stage.do("say", text="Hallo", usual_language=code) for code in ("de", "xx")]
    refused = stage.do("say", text="Hallo", language="xx")

    assert [end.state for end in ends] == ["done", "done"]
    assert refused.state == "failed"


def test_joints_follow_angles_that_change_on_the_way(robot: ServedNao, stage: DriverStage) -> None:
    for yaw in (0.2, 0.4, 0.6):
        stage.ask(f"{yaw}", "set_angles", angles={"HeadYaw": yaw, "LShoulderPitch": 1.0})

    stage.until(lambda: not stage.driver.moving)

    joints = robot.state().joints
    assert joints["HeadYaw"] == pytest.approx(0.6, abs=0.03)
    assert joints["LShoulderPitch"] == pytest.approx(1.0, abs=0.03)


def test_different_limbs_act_at_the_same_time(robot: ServedNao, stage: DriverStage) -> None:
    stage.ask("walk", "walk", forward_m=0.5)
    stage.ask("look", "look", yaw_deg=40)
    stage.ask("say", "say", text="I walk and look and talk")
    stage.until(lambda: {"walk started", "look started", "say started"} <= set(stage.told))

    ends = [stage.end_of(name).state for name in ("walk", "look", "say")]

    assert ends == ["done", "done", "done"]
    assert robot.state().base[0] == pytest.approx(0.5, abs=0.02)
