"""What a virtual robot is at this moment: its joints, its place, its lights, its words."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from . import body as leds
from .animations import Animations
from .body import Angles, Body, KeyPose
from .driver import Thing, plain
from .kinematics import Skeleton
from .speech import GestureWords
from .stance import Stance

# The faces that a virtual robot knows by name: whom it has learnt, and whom it has forgotten.

TOLD = "told "
"""Before the name of a face that the robot was told to see; others are placed things, by id."""


@dataclass
class Faces:
    """Names by face, as long as the robot lives.

    A person who has a name is known by it without being learnt. Once that name is forgotten,
    such a person is a plain face, until the name is learnt again.
    """

    learnt: dict[str, str] = field(default_factory=dict)
    forgotten: set[str] = field(default_factory=set)

    def name_of(self, face: str, own_name: str = "") -> str:
        """The name by which a face is known, as part of a human state; "" for a plain face."""
        name = plain(self.learnt.get(face, own_name))
        return "" if name in self.forgotten else name

    def told_as(self, name: str) -> str:
        """The face that the robot was told to see, and that is known by a name."""
        learnt = (face for face in self.learnt if face.startswith(TOLD))
        known = (face for face in learnt if plain(self.learnt[face]) == name)
        return next(known, TOLD + name)

    def learn(self, face: str, name: str) -> None:
        """Know a face by a name from now on, and no other face that was learnt."""
        self.unlearn(name)
        self.forgotten.discard(plain(name))
        self.learnt[face] = name

    def forget(self, name: str, known: Iterable[str]) -> bool:
        """Notice a name no more; whether it was learnt, or is among the known ones."""
        was_known = self.unlearn(name) or plain(name) in set(known) - self.forgotten
        if was_known:
            self.forgotten.add(plain(name))
        return was_known

    def unlearn(self, name: str) -> bool:
        """Take a name away from the face that was learnt under it; whether there was one."""
        faces = [face for face, old in self.learnt.items() if plain(old) == plain(name)]
        for face in faces:
            del self.learnt[face]
        return bool(faces)


AT_START: dict[str, bool | float | str] = {
    "volume": 70.0,
    "language": "en",
    "awareness": False,
    "breathing": False,
    "tracking": "",
    "playing": "",
}
"""How a robot is set when it starts."""


class Going(Protocol):
    """A walk under way."""

    @property
    def next_base(self) -> Angles:
        """Where the robot will be (x m, y m, theta rad) after what cannot be changed any more."""

    def replace(self, way: Angles) -> bool:
        """Go another way (m, m, rad) after the step under way; False when that cannot be."""


@dataclass
class VirtualRobot:
    """One robot and its present state, which tasks change tick by tick.

    ``angles``: every joint, in the body's order. ``base``: x m, y m, theta rad on the floor.
    ``posture``: the last one reached. ``gesture_words``: which gestures go with what it says.
    ``leds``: 0xRRGGBB by light. ``released``: parts of the body whose motors are off;
    ``stiffness``: of joints that were set singly, 0 to 1. ``felt``: what sensors were told to
    measure. ``sees``: where things are on the floor (x, y, z m) that it was told to see.
    ``stance``: how it stands on the floor. ``fallen``: it lies there because it lost its balance.
    ``things``: what is around it; ``noticed``: what of that it sees, and where; ``bumped``: the
    bumpers with which it ran into something; ``battery``: 0 to 1. ``model``: which robot it is,
    as RobotState has it. ``passed``: the key poses that it has reached since its posture, on the
    way ``towards`` another one. ``faces``: whom it knows by name. ``files``: the folder where it
    keeps its pictures and videos. ``going``: the walk under way.
    """

    name: str
    body: Body
    animations: Animations
    posture: str = "Stand"
    gesture_words: GestureWords = field(default_factory=GestureWords)
    angles: Angles = field(init=False)
    base: Angles = field(default_factory=lambda: np.zeros(3))
    leds: dict[str, int] = field(default_factory=lambda: dict(leds.AT_START))
    saying: str = ""
    listening: tuple[str, ...] = ()
    released: frozenset[str] = frozenset()
    stiffness: dict[str, float] = field(default_factory=dict)
    felt: dict[str, float] = field(default_factory=dict)
    sees: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    fallen: bool = False
    things: tuple[Thing, ...] = ()
    noticed: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    bumped: frozenset[str] = frozenset()
    battery: float = 1.0
    passed: tuple[KeyPose, ...] = ()
    towards: str = ""
    model: str = ""
    faces: Faces = field(default_factory=Faces)
    files: Path = field(default_factory=lambda: Path(tempfile.gettempdir()) / "robot")
    stance: Stance = field(init=False)
    going: Going | None = None
    settings: dict[str, bool | float | str] = field(default_factory=lambda: dict(AT_START))

    def __post_init__(self) -> None:
        self.angles = self.body.posture_angles(self.posture)
        down = self.body.postures[self.posture].down
        self.stance = Stance(Skeleton(self.body), self.angles, down)

    def be_in(self, posture: str) -> None:
        """Have reached a posture."""
        self.posture, self.passed, self.towards = posture, (), ""

    @property
    def seen(self) -> dict[str, tuple[float, float, float]]:
        """Where on the floor is what it sees and hears: what it was told, and what it noticed."""
        return {**self.noticed, **self.sees}

    @property
    def family(self) -> str:
        """The family of the posture: standing, sitting, lying, crouching, resting."""
        return self.body.postures[self.posture].family
