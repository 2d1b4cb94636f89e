"""A real robot as tasks see it: its services, and what was last heard of its body."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nep_core.errors import ActionFailed
from nodes.action.naobody.body import Angles
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.parts import PLAIN_NAMES, parts_of_limbs
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naoqi.driver.calls import ANSWER_S, Calling, Calls
from nodes.action.naoqi.driver.watched import parts_of

NEAR_RAD = 0.14
"""So far (8 degrees) a joint may be from where it was sent: motors give way a little."""
HANDS_NEAR = 0.35
"""The same for hands, which count 0 to 1 and are soft."""
LARGEST_RAD = 10.0
"""No joint of a robot turns so far."""
SETTLING_S = 0.6
"""So long joints may still move after NAOqi says that they are there."""
LIFE_S = 8.0
UPRIGHT = (0.0, 0.0, -1.0)


@dataclass
class RealRobot:
    """``known`` is a picture of the robot, kept true by what it is asked again and again.

    ``torso``: as in RobotState. ``life_is_off``: its own life was switched off already, so that
    only programs move it.
    """

    known: VirtualRobot
    calls: Calls
    sensors: dict[str, float] = field(default_factory=dict)
    battery: float = 1.0
    torso: tuple[float, float, float, float, float, float] | None = None
    has_fallen: bool = False
    life_is_off: bool = False

    @property
    def name(self) -> str:
        """The robot's name."""
        return self.known.name

    @property
    def parts(self) -> dict[str, list[str]]:
        """The joints of each part of the body that can be locked and released."""
        return parts_of(self.known.body)

    def call(
        self, service: str, method: str, *args: Any, limit_s: float = ANSWER_S, uses: object = ()
    ) -> Calling:
        """Call a service and wait for its answer (see Calls)."""
        return self.calls.call(service, method, *args, limit_s=limit_s, uses=uses)

    def names(self, limbs: Collection[Limb]) -> list[str]:
        """The joints of some limbs."""
        return [self.known.body.names[column] for column in self.known.body.columns(limbs)]

    def check_locked(self, limbs: frozenset[Limb]) -> None:
        """Raise ActionFailed when the motors of a limb are off."""
        if loose := sorted(parts_of_limbs(limbs) & self.known.released):
            raise ActionFailed(
                f"{self.name}'s {PLAIN_NAMES[loose[0]]} is released and cannot move. "
                "Lock it first, or let the robot wake up."
            )

    def take_over(self) -> Calling:
        """Switch the robot's own life off once, so that nothing else moves it."""
        if self.life_is_off:
            return
        self.life_is_off = True
        if not self.calls.has("ALAutonomousLife", "setState"):
            return
        state = yield from self.call("ALAutonomousLife", "getState")
        if state == "disabled":
            return
        was_awake = not self.known.released
        yield from self.call("ALAutonomousLife", "setState", "disabled", limit_s=LIFE_S)
        if was_awake and self.calls.has("ALMotion", "wakeUp"):
            awake = yield from self.call("ALMotion", "robotIsWakeUp")
            if not awake:  # many robots sit down when their own life ends
                yield from self.call("ALMotion", "wakeUp", limit_s=20.0)

    def measure(self, joints: Sequence[str]) -> Calling:
        """Ask where some joints are now; rad by name."""
        names = list(joints)
        angles = yield from self.call("ALMotion", "getAngles", names, True)
        measured = dict(zip(names, map(float, angles), strict=False))
        self.take_in(measured)
        return measured

    def check_reached(self, goal: Mapping[str, float]) -> Calling:
        """Raise ActionFailed when joints are not where they were sent, and do not get there."""
        end_s = time.monotonic() + SETTLING_S
        while missed := _missed(goal, (yield from self.measure(list(goal)))):
            if time.monotonic() > end_s:
                raise ActionFailed(
                    f"{self.name}'s joint {missed} did not get where it was sent. "
                    "Look whether something holds it, or whether its motors are hot."
                )

    def take_in(self, angles: Mapping[str, float]) -> None:
        """Keep where joints are; what cannot be an angle is left out."""
        index = self.known.body.index
        for name, angle in angles.items():
            if name in index and abs(angle) <= LARGEST_RAD:  # which "not a number" is not
                self.known.angles[index[name]] = angle

    def be_at(self, place: Sequence[float]) -> tuple[float, float, float]:
        """Keep where the robot is on the floor (x m, y m, theta rad). Raises ValueError."""
        x, y, theta = map(float, place)
        if not all(map(math.isfinite, (x, y, theta))):
            raise ValueError("a place that is none")
        self.known.base[:] = x, y, theta
        return x, y, theta

    def stand_as_told(self) -> None:
        """Let the picture stand on the floor as its joints and its place say."""
        known = self.known
        posture = known.body.postures.get(known.posture)
        down = posture.down if posture is not None else UPRIGHT
        known.stance.put_down(known.angles, known.base, down)

    def goal_of(self, angles: Mapping[str, float]) -> tuple[dict[str, float], list[str]]:
        """Return the nearest angles that joints can have, and the joints that were clamped."""
        body = self.known.body
        goal = self.known.angles.copy()
        for name, angle in angles.items():
            motor = body.same_motor.get(name, name)
            for other in (name, motor):
                goal[body.index[other]] = angle
        allowed, clamped = body.clamped(goal)
        clamped = [name for name in clamped if name in angles]
        return self.picked(allowed, angles), clamped

    def picked(self, angles: Angles, joints: Iterable[str]) -> dict[str, float]:
        """Return some joints out of the angles of all."""
        body = self.known.body
        return {name: float(angles[body.index[name]]) for name in joints}

    def go_to(self, goal: Mapping[str, float], speed: float) -> Calling:
        """Move joints to angles, with at most a part of their top speed, and look that they are."""
        if not goal:
            return
        names, angles = list(goal), list(goal.values())
        limit_s = 4.0 + self._time_s(goal) / speed
        yield from self.call(
            "ALMotion",
            "angleInterpolationWithSpeed",
            names,
            angles,
            float(speed),
            limit_s=limit_s,
            uses=names,
        )
        yield from self.check_reached(goal)

    def _time_s(self, goal: Mapping[str, float]) -> float:
        """How long the slowest joint needs at its top speed, generously."""
        body = self.known.body
        ways = [
            abs(self.known.angles[body.index[name]] - angle) / body.max_speed[body.index[name]]
            for name, angle in goal.items()
        ]
        return 3.0 * float(np.max(ways, initial=0.0))


def _missed(goal: Mapping[str, float], measured: Mapping[str, float]) -> str:
    """A joint that is not where it should be, "" when all are."""
    for name, angle in goal.items():
        near = HANDS_NEAR if name.endswith("Hand") else NEAR_RAD
        if abs(measured.get(name, angle) - angle) > near:
            return name
    return ""
