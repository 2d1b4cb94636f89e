"""A robot that says yes to everything and does nothing, as one does that somebody holds."""

from __future__ import annotations

from typing import Any

from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.service import method

SERVICES = ("ALMotion", "ALRobotPosture", "ALLeds", "ALTextToSpeech", "ALMemory")


class HeldNao:
    """All its services in one."""

    posture = "Crouch"
    awake = True

    def __init__(self) -> None:
        self.stopped: list[str] = []

    @method("getAngles::[f](mb)")
    def angles(self, names: Any, sensors: bool) -> list[float]:
        return [0.0] * len(names)

    @method("angleInterpolationWithSpeed::v(mmf)")
    def go(self, names: Any, angles: Any, speed: float) -> None:
        return

    @method("robotIsWakeUp::b()")
    def is_awake(self) -> bool:
        return self.awake

    @method("getRobotPosition::[f](b)")
    def place(self, sensors: bool) -> list[float]:
        return [0.0, 0.0, 0.0]

    @method("moveTo::b(fff)")
    def move_to(self, x: float, y: float, theta: float) -> bool:
        return True

    @method("goToPosture::b(sf)")
    def posture_go(self, name: str, speed: float) -> bool:
        return True

    @method("getPosture::s()")
    def where(self) -> str:
        return "Unknown"

    @method("fadeRGB::v(sif)")
    def fade(self, name: str, colour: int, seconds: float) -> None:
        raise CallFailed("These lights are broken.")

    @method("setIntensity::v(sf)")
    def shine(self, name: str, level: float) -> Any:
        return Promise().future  # which nobody keeps

    @method("stopAll::v()")
    def be_silent(self) -> None:
        self.stopped.append("stopAll")

    @method("moveIsActive::b()")
    def walks(self) -> bool:
        return False

    @method("killAll::v()")
    def kill_all(self) -> None:
        self.stopped.append("killAll")

    @method("stopMove::v()")
    def stop_move(self) -> None:
        self.stopped.append("stopMove")

    @method("say::v(s)")
    def say(self, text: str) -> None:
        return

    @method("getListData::m(m)")
    def values(self, keys: list[str]) -> list[Any]:
        return [80.0 if "RKneePitch/Temperature" in key else None for key in keys]
