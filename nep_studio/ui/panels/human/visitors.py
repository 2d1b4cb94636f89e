"""Lets a person, a ball or a mark come before a robot, nearer or farther, and go again."""

from __future__ import annotations

import math
from typing import Literal

import msgspec
from PySide6.QtCore import QObject, Signal

from nep_core.messages import RobotState, Thing, ThingKind
from nep_studio.surroundings import AHEAD_M, SIZES, named
from nep_studio.ui.panels.robots.floor import Floor

What = Literal["face", "ball", "mark"]
KINDS: dict[str, ThingKind] = {"face": "person", "ball": "ball", "mark": "mark"}
BESIDE_RAD = {"face": 0.0, "ball": -0.38, "mark": 0.38}
"""A ball and a mark come beside where a robot looks, so that a person does not hide them."""


class Visitors(QObject):
    """One of each may be there; ``changed`` tells that they came, went or moved."""

    changed = Signal()

    def __init__(self, floor: Floor, parent: QObject) -> None:
        super().__init__(parent)
        self._floor = floor
        self.states: dict[str, RobotState] = {}
        """How the robots are, as far as it is known: a visitor comes to where one looks."""
        floor.changed.connect(self.changed)

    def find(self, what: str) -> Thing | None:
        """The visitor of a kind, if it is there."""
        return self._floor.find(_id(what))

    def come(self, what: str, robot: str, name: str = "", way_m: float | None = None) -> None:
        """Let it come to where a robot looks, as far away as it was, or so many m."""
        before, kind = self.find(what), KINDS[what]
        if way_m is None:
            way_m = self.way_m(what, robot) if before is not None else AHEAD_M[kind]
        x, y, angle = self._before(robot, way_m, BESIDE_RAD[what])
        thing = Thing(
            id=_id(what),
            kind=kind,
            place=(x, y, 0.0),
            heading=math.remainder(angle + math.pi, math.tau),
            size=SIZES[kind],
            name=before.name if before is not None and not name else "",
        )
        self._floor.show(named(thing, name) if name else thing)

    def rename(self, what: str, name: str) -> None:
        """Give it another name, or number."""
        if (thing := self.find(what)) is not None:
            self._floor.show(named(thing, name))

    def go(self, what: str) -> None:
        """Let it go."""
        self._floor.hide(_id(what))

    def go_all(self) -> None:
        """Let all go."""
        for what in KINDS:
            self.go(what)

    def way_m(self, what: str, robot: str) -> float:
        """How far it is from a robot."""
        thing = self.find(what)
        if thing is None:
            return AHEAD_M[KINDS[what]]
        x, y, _ = self._base(robot)
        return math.hypot(thing.place[0] - x, thing.place[1] - y)

    def stand(self, what: str, robot: str, way_m: float) -> None:
        """Let it come closer or step back, along the line to the robot."""
        thing = self.find(what)
        if thing is None:
            return
        x, y, theta = self._base(robot)
        angle = math.atan2(thing.place[1] - y, thing.place[0] - x)
        if self.way_m(what, robot) < 1e-3:
            angle = theta
        place = x + way_m * math.cos(angle), y + way_m * math.sin(angle)
        rounded = (round(place[0], 3), round(place[1], 3), thing.place[2])
        self._floor.show(msgspec.structs.replace(thing, place=rounded))

    def _before(self, robot: str, way_m: float, beside_rad: float) -> tuple[float, float, float]:
        """The place that a robot looks at, so far away, and in which direction that is."""
        x, y, theta = self._base(robot)
        state = self.states.get(robot)
        angle = (
            theta + beside_rad + (state.joints.get("HeadYaw", 0.0) if state is not None else 0.0)
        )
        return round(x + way_m * math.cos(angle), 3), round(y + way_m * math.sin(angle), 3), angle

    def _base(self, robot: str) -> tuple[float, float, float]:
        state = self.states.get(robot)
        return state.base if state is not None else (0.0, 0.0, 0.0)


def _id(what: str) -> str:
    return f"visitor_{what}"
