"""Another robot, Pepper, offered by the same services: what it lacks is told in words."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from naoqi_theatre import NAO, NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed


@pytest.fixture
def pepper() -> Iterator[NaoqiTheatre]:
    theatre = NaoqiTheatre(speed=10, folder=NAO.parent / "pepper")
    yield theatre
    theatre.close()


def test_it_says_that_it_is_a_pepper(pepper: NaoqiTheatre) -> None:
    assert pepper.call("ALRobotModel", "getRobotType") == "Pepper"
    assert pepper.call("ALRobotModel", "hasLegs") is False
    chains = pepper.call("ALMotion", "getBodyNames", "Chains")
    assert chains == ["Head", "LArm", "Leg", "RArm"]


def test_it_moves_speaks_and_takes_postures(pepper: NaoqiTheatre) -> None:
    pepper.call("ALMotion", "angleInterpolation", ["HeadYaw", "HipPitch"], [0.3, -0.1], 1.0, True)
    bent = (pepper.joint("HeadYaw"), pepper.joint("HipPitch"))
    pepper.call("ALAnimatedSpeech", "say", "Hello, I am Pepper")

    pepper.call("ALRobotPosture", "goToPosture", "Crouch", 0.8)

    assert bent == pytest.approx((0.3, -0.1), abs=1e-3)
    assert pepper.call("ALRobotPosture", "getPosture") == "Crouch"
    assert "Sit" not in pepper.call("ALRobotPosture", "getPostureList")


def test_it_rolls_where_it_is_told(pepper: NaoqiTheatre) -> None:
    pepper.call("ALMotion", "moveTo", 0.3, 0.1, 0.5)

    place = pepper.call("ALMotion", "getRobotPosition", True)
    assert place == pytest.approx([0.3, 0.1, 0.5], abs=0.02)


def test_a_leg_that_it_does_not_have_is_told(pepper: NaoqiTheatre) -> None:
    with pytest.raises(CallFailed) as refused:
        pepper.call("ALMotion", "getAngles", "LLeg", True)

    assert "no joint, chain or group “LLeg”" in str(refused.value.sentence)
