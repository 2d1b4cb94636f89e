"""Makes the 30 states a second that robots tell into movement that is smooth to the eye."""

from __future__ import annotations

import math

import msgspec

from nep_core.messages import RobotState

SHORTEST_S, LONGEST_S = 0.02, 0.12
"""How long it takes to go from one state to the next: as long as states are apart, about."""
JUMP_M = 0.4
"""A robot that is suddenly so far away has been put there; it did not walk."""
UNSEEN = ("time", "battery", "sees", "settings", "listening", "sensors", "moving")
"""What of a state does not change the picture of it, but for the sensors that are felt."""


class Motion:
    """The way of one robot from the state that is seen to the last one that was told."""

    def __init__(self, state: RobotState, at_s: float) -> None:
        self.goal = self.shown = self._start = state
        self._told_s = self._heard_s = at_s
        self._lasts_s = 0.0

    def go(self, state: RobotState, now_s: float) -> bool:
        """Take in a new state; whether anything is seen of it."""
        since, self._heard_s = now_s - self._heard_s, now_s
        if looks(state) == looks(self.goal):
            self.shown = state if self.shown is self.goal else self.shown
            self.goal = state
            return False
        self._lasts_s = min(max(since, SHORTEST_S), LONGEST_S)
        self._start, self.goal, self._told_s = self.shown, state, now_s
        if math.dist(self.shown.base[:2], state.base[:2]) > JUMP_M:
            self._start = self.shown = state
        return True

    def step(self, now_s: float) -> bool:
        """Go on to where the robot is now; whether there is more to come."""
        share = 1.0 if self._lasts_s <= 0 else (now_s - self._told_s) / self._lasts_s
        if share >= 1.0 or not _moves(self._start, self.goal):
            self.shown = self.goal
            return False
        self.shown = between(self._start, self.goal, max(share, 0.0))
        return True


def looks(state: RobotState) -> tuple[object, ...]:
    """All of a state that is seen; equal for states that look the same."""
    felt = tuple(sorted(name for name, value in state.sensors.items() if value > 0))
    names = (name for name in state.__struct_fields__ if name not in UNSEEN)
    return (felt, *(getattr(state, name) for name in names))


def between(start: RobotState, goal: RobotState, share: float) -> RobotState:
    """The state on the way from one to another; what cannot be halved is as in the goal."""
    joints = {
        name: angle + (goal.joints.get(name, angle) - angle) * share
        for name, angle in start.joints.items()
    }
    x, y = (_mix(a, b, share) for a, b in zip(start.base[:2], goal.base[:2], strict=True))
    base = (x, y, _turned(start.base[2], goal.base[2], share))
    torso = goal.torso
    if start.torso is not None and goal.torso is not None:
        torso = _torso_between(start.torso, goal.torso, share)
    return msgspec.structs.replace(goal, joints=goal.joints | joints, base=base, torso=torso)


Torso = tuple[float, float, float, float, float, float]


def _torso_between(start: Torso, goal: Torso, share: float) -> Torso:
    x, y, z = (_mix(a, b, share) for a, b in zip(start[:3], goal[:3], strict=True))
    roll, pitch, yaw = (_turned(a, b, share) for a, b in zip(start[3:], goal[3:], strict=True))
    return x, y, z, roll, pitch, yaw


def _moves(start: RobotState, goal: RobotState) -> bool:
    return (start.joints, start.base, start.torso) != (goal.joints, goal.base, goal.torso)


def _mix(start: float, goal: float, share: float) -> float:
    return start + (goal - start) * share


def _turned(start: float, goal: float, share: float) -> float:
    """The angle on the shorter way round."""
    return start + math.remainder(goal - start, 2 * math.pi) * share
