"""What the virtual NAO senses and says about it; its lights, voice and other settings."""

from __future__ import annotations

import math

import msgspec
import pytest
from nao_stage import Stage

from robots.body.driver import RobotState, SenseRequest, Thing

pytestmark = pytest.mark.long


def sense(stage: Stage, what: str, value: float = 1.0, **more: object) -> list[str]:
    request = SenseRequest(robot="NAO", sense=what, value=value, **more)
    return stage.actor.sense(request)


def state(stage: Stage) -> RobotState:
    found = stage.driver.state()
    assert found is not None
    return found


def test_a_touch_is_felt_and_told_once() -> None:
    stage = Stage()

    first, second = sense(stage, "head_front"), sense(stage, "head_front")

    assert first == ["touched_head_front", "touched_head"]
    assert second == []
    assert state(stage).sensors["head_front"] == 1.0


def test_a_touch_that_ends_can_come_again() -> None:
    stage = Stage()
    sense(stage, "bumper_left")

    ended, again = sense(stage, "bumper_left", 0.0), sense(stage, "bumper_left")

    assert ended == [] and again == ["touched_bumper_left", "touched_bumper"]


def test_a_face_with_a_name_is_seen_with_its_distance() -> None:
    stage = Stage()

    states = sense(stage, "face", name="Anna B.", place=(0.8, 0.0, 0.4))

    assert states == ["seen_face_anna_b", "seen_face", "person_close"]
    assert state(stage).sees["face_anna_b"] == pytest.approx((0.8, 0.0, 0.4))
    assert sense(stage, "face", 0.0, name="Anna B.") == []
    assert state(stage).sees == {}


def test_a_word_that_is_said_is_heard() -> None:
    assert sense(Stage(), "word", name="Good morning!") == ["heard_good_morning"]


def test_what_it_sees_moves_to_its_side_when_it_turns() -> None:
    stage = Stage()
    sense(stage, "ball", place=(1.0, 0.0, 0.1))

    stage.do("turn", degrees=90)

    assert state(stage).sees["ball"] == pytest.approx((0.0, -1.0, 0.1), abs=0.02)


def test_sensors_of_a_quiet_standing_nao() -> None:
    sensors = state(Stage()).sensors

    assert sensors["sonar_left"] == 2.55
    assert sensors["acc_z"] == pytest.approx(-9.81)
    assert sensors["foot_left"] + sensors["foot_right"] == pytest.approx(5.305, abs=0.01)
    assert sensors["foot_left"] == pytest.approx(sensors["foot_right"], abs=0.01)
    assert sensors["current_LKneePitch"] > 0.0


def test_it_feels_how_it_lies_and_that_its_feet_carry_nothing() -> None:
    sensors = state(Stage("LyingBack")).sensors

    assert sensors["acc_x"] == pytest.approx(-9.81, abs=0.05)
    assert sensors["foot_left"] < 1.0


def test_a_walk_shifts_its_weight_and_takes_current() -> None:
    stage = Stage()
    weights, currents, turning = [], [], []
    stage.ask("walk", "walk", forward_m=0.2, turn_deg=60)

    for _ in range(300):
        stage.pass_time(0.01)
        sensors = state(stage).sensors
        weights.append(sensors["foot_left"])
        currents.append(sensors["current_LKneePitch"])
        turning.append(sensors["gyro_z"])

    assert max(weights) > 3.0 and min(weights) < 2.3
    assert max(currents) > 2 * min(currents)
    assert max(turning) > 0.1


def test_a_sensor_measures_what_it_is_told() -> None:
    stage = Stage()

    sense(stage, "sonar_left", 0.25)
    sense(stage, "battery", 0.4)

    assert state(stage).sensors["sonar_left"] == 0.25
    assert state(stage).battery == 0.4
    assert "battery" not in state(stage).sensors


@pytest.mark.parametrize(
    ("action", "args", "setting", "value"),
    [
        ("volume", {"percent": 30}, "volume", 30.0),
        ("language", {"language": "de"}, "language", "de"),
        ("awareness", {"on": True}, "awareness", True),
        ("breathing", {"on": True}, "breathing", True),
        ("stiffness", {"part": "left_arm", "on": False}, "locked_left_arm", False),
    ],
)
def test_a_setting_shows_in_its_state(
    action: str, args: dict[str, object], setting: str, value: object
) -> None:
    stage = Stage()

    stage.do(action, **args)

    assert state(stage).settings[setting] == value


def test_it_speaks_twice_as_fast() -> None:
    usual, fast = Stage(), Stage()
    text = "This sentence takes a few seconds to say."
    usual.ask("1", "say", text=text)
    fast.ask("1", "say", text=text, speed=200)

    assert fast.finish() == pytest.approx(usual.finish() / 2, abs=0.05)


def test_it_listens_while_it_moves_and_says_for_what() -> None:
    stage = Stage()
    stage.ask("1", "listen", words=["yes", "no"], seconds=2)
    stage.ask("2", "look", yaw_deg=20)
    stage.pass_time(0.2)
    during = state(stage)

    stage.finish()

    assert during.listening == ["yes", "no"] and during.moving
    assert state(stage).listening == []


def test_lights_are_dimmed_switched_off_and_reset() -> None:
    stage = Stage()
    stage.do("leds", group="ChestLeds", colour="#ff8000")
    stage.do("intensity", group="ChestLeds", percent=50)
    half = state(stage).leds["ChestLeds"]
    stage.do("intensity", group="AllLeds", percent=0)
    dark = set(state(stage).leds.values())

    stage.do("reset_leds", group="AllLeds")

    assert half == 0x804000 and dark == {0}
    assert state(stage).leds["LeftEarLeds"] == 0x0000FF


@pytest.mark.parametrize("action", ["random_eyes", "rotate_eyes"])
def test_the_eyes_play_with_colours_and_are_as_before(action: str) -> None:
    stage = Stage()
    stage.ask("1", action, seconds=2)
    colours = set()

    for _ in range(190):
        stage.pass_time(0.01)
        colours.add(state(stage).leds["LeftFaceLeds"])
    stage.finish()

    assert len(colours) >= 3
    assert state(stage).leds["LeftFaceLeds"] == 0xFFFFFF


ODD = (math.nan, math.inf, -math.inf)


def test_what_no_sensor_can_measure_is_not_felt_and_the_robot_still_tells_how_it_is() -> None:
    """A number that JSON has not would come as null: nobody could read the robot's state again."""
    stage = Stage()
    for odd in ODD:
        for what in ("battery", "head_front", "face", "ball", "place", "push"):
            sense(stage, what, odd)
            sense(stage, what, place=(odd, odd, odd))
        stage.driver.surroundings([Thing(id="t", kind="ball", place=(odd, 0.3, odd), heading=odd)])
        stage.pass_time(0.5)

    told = msgspec.json.decode(msgspec.json.encode(state(stage)), type=RobotState)

    assert told.battery <= 1.0
    assert told.sensors["head_front"] in (0.0, 1.0)


def test_what_is_told_to_be_felt_and_seen_under_ever_new_names_is_bounded() -> None:
    stage = Stage()
    for number in range(2000):
        sense(stage, f"sensor_{number}")
        sense(stage, "face", name=f"name {number}")

    assert len(msgspec.json.encode(state(stage))) < 100_000
    assert state(stage).sees["face_name_1999"]
