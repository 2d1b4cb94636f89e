"""What a virtual robot is at this moment: its joints, its place, its lights, its words."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nep_core.messages import Thing
from nodes.action.naobody import leds
from nodes.action.naobody.animations import Animations
from nodes.action.naobody.body import Angles, Body, KeyPose
from nodes.action.naobody.body_language import GestureWords
from nodes.action.naobody.faces import Faces
from nodes.action.naobody.skeleton import Skeleton
from nodes.action.naobody.stance import Stance

AT_START: dict[str, bool | float | str] = {
    "volume": 70.0,
    "language": "en",
    "awareness": False,
    "breathing": False,
    "tracking": "",
    "playing": "",
}
"""How a robot is set when it starts."""


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
    way ``towards`` another one. ``faces``: whom it knows by name.
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
    stance: Stance = field(init=False)
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
