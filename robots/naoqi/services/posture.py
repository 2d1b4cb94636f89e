"""ALRobotPosture: the named postures."""

from __future__ import annotations

from typing import Any

import numpy as np

from robots.body.body import Body
from robots.body.limbs import Limb
from robots.body.pose import VirtualRobot
from robots.naoqi.wire.service import method

from .arguments import one_of, within
from .module import Module

UNKNOWN = "Unknown"
FAMILIES = {"standing": "Standing", "sitting": "Sitting", "crouching": "Crouching"}
NEAR_RAD = 0.35
"""No arm or leg joint may be further from a posture than this for the robot to be in it."""
FREE = ("WristYaw", "Hand")
"""What is left out then."""
USUAL_SPEED = 0.5
"""The speed by NAOqi's measure at which this program's robots take postures by themselves."""
SLOWEST_PACE = 0.1
NOT_NAOQIS = ("Rest",)


def posture_names(body: Body) -> list[str]:
    """Return the postures of a robot that NAOqi names."""
    return sorted(name for name in body.postures if name not in NOT_NAOQIS)


def posture_of(robot: VirtualRobot) -> str:
    """Return the posture that a robot's joints show, by NAOqi's name, or “Unknown”."""
    body = robot.body
    columns = [
        column
        for column, joint in enumerate(body.joints)
        if joint.limb is not Limb.HEAD and not joint.name.endswith(FREE)
    ]
    ways = {
        name: float(np.max(np.abs(body.posture_angles(name) - robot.angles)[columns]))
        for name in posture_names(body)
    }
    nearest = min(ways, key=lambda name: (ways[name], name != robot.posture))
    if ways.get(robot.posture, NEAR_RAD) < NEAR_RAD:
        return robot.posture
    return nearest if ways[nearest] < NEAR_RAD else UNKNOWN


def family_of(robot: VirtualRobot) -> str:
    """Return the family of a robot's posture, by NAOqi's name."""
    if robot.posture.startswith("Lying"):
        return robot.posture
    return FAMILIES.get(robot.family, "Crouching")


class ALRobotPosture(Module):
    """Goes to postures, and tells which one it is in."""

    @method("goToPosture::b(sf)", "applyPosture::b(sf)")
    def go_to_posture(self, name: str, speed: float) -> Any:
        """Go to a posture, through others where it must; wait for the end."""
        pace = within(speed, 0.0, 1.0, "The speed") / USUAL_SPEED
        known = posture_names(self._robot.robot.body)
        one_of(name, known, "There is no posture “{name}”. Possible: {known}.")
        return self._do("do", True, stopped=False, posture=name, pace=max(pace, SLOWEST_PACE))

    @method("setMaxTryNumber::v(i)")
    def set_max_try_number(self, tries: int) -> None:
        """Remember how often it may try; this robot arrives at the first try."""
        self._kept["tries"] = tries

    @method("stopMove::v()")
    def stop_move(self) -> None:
        """Stop going to a posture."""
        self._robot.stop(lambda command: type(command.action).__name__ in ("Do", "WakeUp", "Rest"))

    @method("getPosture::s()")
    def posture(self) -> str:
        """Return the posture that it is in, or “Unknown”."""
        with self._robot.lock:
            return posture_of(self._robot.robot)

    posture_list = method("getPostureList::[s]()")(
        lambda self: posture_names(self._robot.robot.body)
    )

    @method("getPostureFamily::s()")
    def posture_family(self) -> str:
        """Return the family of the posture that it is in."""
        with self._robot.lock:
            return family_of(self._robot.robot)

    posture_family_list = method("getPostureFamilyList::[s]()")(
        lambda self: ["Standing", "Crouching", "Sitting", "LyingBelly", "LyingBack"]
    )
