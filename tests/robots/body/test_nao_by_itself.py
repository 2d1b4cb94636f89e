"""What a virtual NAO does by itself: it breathes, its battery drains, sensors follow its body."""

from __future__ import annotations

import math

import numpy as np
import pytest
from nao_stage import BODY, Stage

from robots.body import body


def sensors(stage: Stage) -> dict[str, float]:
    state = stage.driver.state()
    assert state is not None
    return state.sensors


def test_breathing_moves_arms_and_knees_and_keeps_the_feet_where_they_are() -> None:
    stage = Stage("StandInit")
    feet, angles = stage.robot.stance.feet_base(), stage.robot.angles.copy()
    stage.do("breathing", on=True)

    stage.pass_time(4.5)
    moved = np.ptp(np.array(stage.angles), axis=0)

    assert stage.driver.moving
    for joint in ("LShoulderPitch", "RElbowRoll", "LKneePitch"):
        assert 0.01 < moved[BODY.index[joint]] < 0.1
    assert stage.robot.stance.feet_base() == pytest.approx(feet, abs=2e-3)
    assert not stage.robot.fallen
    stage.do("breathing", on=False)
    stage.pass_time(2.0)
    assert stage.robot.angles == pytest.approx(angles, abs=1e-6) and not stage.driver.moving


def test_breathing_leaves_limbs_alone_that_are_used() -> None:
    stage = Stage("StandInit")
    stage.do("breathing", on=True)

    result = stage.do("walk", forward_m=0.3)

    assert result.state == "done"
    assert stage.robot.base == pytest.approx([0.3, 0.0, 0.0], abs=1e-9)
    assert (stage.relative_speeds <= 1.001).all()


def test_a_battery_drains_in_an_hour_and_a_half() -> None:
    stage = Stage()

    stage.driver.step(45 * 60.0)

    state = stage.driver.state()
    assert state is not None and state.battery == pytest.approx(0.5, abs=0.01)


def test_the_inertial_unit_feels_how_the_torso_leans() -> None:
    upright, back = sensors(Stage("StandZero")), sensors(Stage("LyingBack"))

    assert (upright["angle_x"], upright["angle_y"]) == pytest.approx((0, 0), abs=0.01)
    assert upright["acc_z"] == pytest.approx(-9.81, abs=0.01)
    assert back["angle_y"] == pytest.approx(-math.pi / 2, abs=0.05)


def test_a_gyroscope_turns_with_the_body() -> None:
    stage = Stage("StandInit")
    stage.ask("1", "turn", degrees=90)
    turning = []

    while stage.driver.is_busy or stage.actor.schedule.waiting:
        stage.pass_time(0.02)
        turning.append(sensors(stage)["gyro_z"])

    assert np.sum(turning) * 0.02 == pytest.approx(math.pi / 2, abs=0.1)


def test_eight_corners_of_the_feet_feel_all_of_the_weight() -> None:
    felt = sensors(Stage("StandInit"))
    corners = [f"{row}_{side}" for row in ("front", "rear") for side in ("left", "right")]

    for foot in ("foot_left", "foot_right"):
        assert sum(felt[f"{foot}_{corner}"] for corner in corners) == pytest.approx(
            felt[foot], abs=0.01
        )
    assert felt["foot_left"] + felt["foot_right"] == pytest.approx(5.305, abs=0.01)


def test_who_sits_feels_less_weight_on_its_feet() -> None:
    felt = sensors(Stage("Sit"))

    assert 0.0 < felt["foot_left"] + felt["foot_right"] < 3.0


def test_one_lamp_can_be_lit_by_itself() -> None:
    stage = Stage()

    stage.do("leds", group="FaceLedLeft3", colour="#ff0000")
    single = stage.driver.state()
    stage.do("leds", group="FaceLeds", colour="#00ff00")
    whole = stage.driver.state()

    assert single is not None and whole is not None
    assert single.leds["FaceLedLeft3"] == 0xFF0000 and single.leds["LeftFaceLeds"] == 0xFFFFFF
    assert "FaceLedLeft3" not in whole.leds and whole.leds["LeftFaceLeds"] == 0x00FF00


def test_colours_go_round_the_eyes_lamp_by_lamp() -> None:
    stage = Stage()
    stage.ask("1", "rotate_eyes", seconds=1.0)
    stage.pass_time(0.1)
    first = dict(stage.robot.leds)

    stage.pass_time(0.2)
    second = dict(stage.robot.leds)
    stage.finish()

    lamps = body.LAMPS["LeftFaceLeds"]
    assert {first[lamp] for lamp in lamps} == {0x00FF00, 0xFFFF00, 0xFF0000}
    assert [first[lamp] for lamp in lamps] != [second[lamp] for lamp in lamps]
    assert stage.robot.leds == body.AT_START


@pytest.mark.parametrize("group", [*body.GROUPS, "Brain7", "LeftEarLed10", "FaceLedRight0"])
def test_every_group_and_lamp_can_be_lit(group: str) -> None:
    stage = Stage()

    assert stage.do("leds", group=group, colour="#123456", seconds=0.2).state == "done"
    assert all(body.shining(stage.robot.leds, light) == 0x123456 for light in body.lights(group))
