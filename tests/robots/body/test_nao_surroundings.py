"""What a virtual NAO notices of people, balls, walls and marks around it."""

from __future__ import annotations

import math

import pytest
from nao_stage import Stage

from robots.body.driver import RobotState, Thing

ANNA = Thing(id="a", kind="person", place=(1.5, 0.0, 0.0), heading=math.pi, name="Anna")
WALL = Thing(id="w", kind="wall", place=(0.8, 0.0, 0.0), heading=math.pi, size=(2.0, 0.1, 2.0))
BALL = Thing(id="b", kind="ball", place=(0.7, 0.1, 0.0), size=(0.1, 0.1, 0.1))
MARK = Thing(
    id="m", kind="mark", place=(1.2, -0.2, 0.3), heading=math.pi, size=(0.2, 0.01, 0.2), name="64"
)


def stage_with(*things: Thing, posture: str = "StandInit") -> Stage:
    stage = Stage(posture)
    stage.driver.surroundings(things)
    stage.pass_time(0.3)
    return stage


def state(stage: Stage) -> RobotState:
    found = stage.driver.state()
    assert found is not None
    return found


def child(**changes: object) -> Thing:
    """A person whose face is as high as the robot's."""
    known: dict[str, object] = {"place": (1.0, 0.0, 0.0), "heading": math.pi, "name": "Anna"}
    return Thing(id="a", kind="person", size=(0.3, 0.2, 0.6), **(known | changes))


def test_a_face_in_view_is_seen_by_its_name_with_its_distance() -> None:
    stage = stage_with(child())

    assert stage.driver.noticed() == ["seen_face_anna", "seen_face", "person_middle"]
    assert state(stage).sees["face_anna"][:2] == pytest.approx((1.0, 0.0), abs=0.01)


def test_what_stays_in_view_is_told_once() -> None:
    stage = stage_with(child())
    stage.driver.noticed()

    stage.pass_time(3.0)

    assert stage.driver.noticed() == []


@pytest.mark.parametrize(
    "changes",
    [
        {"place": (-1.0, 0.0, 0.0)},
        {"place": (6.0, 0.0, 0.0)},
        {"place": (0.5, 1.5, 0.0)},
        {"heading": 0.0},
    ],
    ids=["behind it", "too far", "beside it", "turned away"],
)
def test_a_face_that_cannot_be_seen_is_not_noticed(changes: dict[str, object]) -> None:
    stage = stage_with(child(**changes))

    assert stage.driver.noticed() == [] and state(stage).sees == {}


def test_a_wall_hides_the_person_behind_it() -> None:
    stage = stage_with(child(place=(1.5, 0.0, 0.0)), WALL)

    assert stage.driver.noticed() == []


def test_a_person_who_comes_nearer_is_told_again() -> None:
    stage = stage_with(child(place=(2.5, 0.0, 0.0)))
    far = stage.driver.noticed()

    stage.driver.surroundings([child(place=(0.9, 0.0, 0.0))])
    stage.pass_time(0.3)

    assert far[-1] == "person_far"
    assert stage.driver.noticed() == ["person_close"]


def test_who_goes_away_is_forgotten_and_can_come_again() -> None:
    stage = stage_with(child())
    stage.driver.noticed()

    stage.driver.surroundings([])
    stage.pass_time(1.5)
    gone = state(stage).sees
    stage.driver.surroundings([child()])
    stage.pass_time(0.3)

    assert gone == {}
    assert "seen_face_anna" in stage.driver.noticed()


def test_a_ball_and_a_mark_with_its_number_are_seen() -> None:
    stage = stage_with(BALL, MARK)

    assert set(stage.driver.noticed()) == {"seen_ball", "seen_mark", "seen_mark_64"}


def test_turning_the_head_brings_a_face_into_view() -> None:
    stage = stage_with(child(place=(0.2, 1.0, 0.0), heading=-math.pi / 2))
    before = stage.driver.noticed()

    stage.do("look", yaw_deg=75)
    stage.pass_time(0.3)

    assert before == [] and "seen_face_anna" in stage.driver.noticed()


def test_the_head_turns_to_a_face_when_it_is_aware_of_people() -> None:
    stage = stage_with(child(place=(1.0, 0.4, 0.0), heading=-2.7))
    stage.do("awareness", on=True)

    stage.pass_time(3.0)

    yaw = math.degrees(stage.robot.angles[stage.robot.body.head[0]])
    assert yaw == pytest.approx(math.degrees(math.atan2(0.4, 1.0)), abs=2.5)
    assert (stage.relative_speeds <= 1.001).all()


def test_the_head_follows_a_face_that_walks() -> None:
    stage = stage_with(child())
    stage.do("track", thing="face")

    for step in range(10):
        stage.driver.surroundings([child(place=(1.0, 0.08 * step, 0.0))])
        stage.pass_time(0.5)

    yaw = stage.robot.angles[stage.robot.body.head[0]]
    assert yaw == pytest.approx(math.atan2(0.72, 1.0), abs=0.06)


def test_sonars_measure_the_way_to_a_wall() -> None:
    sensors = state(stage_with(WALL)).sensors

    assert sensors["sonar_left"] == pytest.approx(0.75, abs=0.04)
    assert sensors["sonar_right"] == pytest.approx(0.75, abs=0.04)


def test_a_person_on_the_left_is_near_for_the_left_sonar_only() -> None:
    on_the_left = Thing(id="p", kind="person", place=(0.8, 0.6, 0.0), size=(0.3, 0.3, 1.7))

    sensors = state(stage_with(on_the_left)).sensors

    assert sensors["sonar_left"] < 1.0 and sensors["sonar_right"] == 2.55


def test_a_ball_on_the_floor_is_too_low_for_the_sonars_from_near() -> None:
    near = Thing(id="b", kind="ball", place=(0.4, 0.0, 0.0), size=(0.1, 0.1, 0.1))

    assert state(stage_with(near)).sensors["sonar_left"] == 2.55


def test_nothing_around_it_is_as_far_as_the_sonars_reach() -> None:
    assert state(stage_with()).sensors["sonar_right"] == 2.55


def test_it_stops_with_a_sentence_when_it_walks_into_a_wall() -> None:
    stage = stage_with(WALL)

    result = stage.do("walk", forward_m=1.5)

    assert result.state == "failed"
    assert "walked into a wall after 0." in result.description
    assert 0.4 < stage.robot.base[0] < 0.8 and not stage.robot.fallen
    sensors = state(stage).sensors
    assert max(sensors["bumper_left"], sensors["bumper_right"]) == 1.0
    told = stage.driver.noticed()
    assert "touched_bumper" in told


def test_it_can_walk_away_from_the_wall_that_it_touches() -> None:
    stage = stage_with(WALL)
    stage.do("walk", forward_m=1.5)

    back = stage.do("walk", forward_m=-0.3)

    assert back.state == "done"
    sensors = state(stage).sensors
    assert sensors["bumper_left"] == sensors["bumper_right"] == 0.0


def test_it_walks_past_what_is_not_in_its_way() -> None:
    aside = Thing(id="p", kind="person", place=(0.5, 0.8, 0.0), size=(0.3, 0.3, 1.7))

    assert stage_with(aside).do("walk", forward_m=0.8).state == "done"


def test_a_lying_robot_does_not_measure_with_its_sonars() -> None:
    stage = stage_with(WALL, posture="LyingBack")

    assert state(stage).sensors["sonar_left"] == 2.55
