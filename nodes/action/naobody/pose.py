"""What a virtual robot is at this moment: its joints, its place, its lights, its words."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nodes.action.naobody import leds
from nodes.action.naobody.animations import Animations
from nodes.action.naobody.body import Angles, Body

AT_START: dict[str, bool | float | str] = {
    "volume": 70.0,
    "language": "en",
    "awareness": False,
    "breathing": False,
    "tracking": "",
}
"""How a robot is set when it starts."""


@dataclass
class VirtualRobot:
    """One robot and its present state, which tasks change tick by tick.

    ``angles``: every joint, in the body's order. ``base``: x m, y m, theta rad on the floor.
    ``posture``: the last one reached. ``leds``: 0xRRGGBB by light. ``released``: parts of the body
    whose motors are off. ``felt``: what sensors were told to measure. ``sees``: where things are
    on the floor (x, y, z m).
    """

    name: str
    body: Body
    animations: Animations
    posture: str = "Stand"
    angles: Angles = field(init=False)
    base: Angles = field(default_factory=lambda: np.zeros(3))
    leds: dict[str, int] = field(default_factory=lambda: dict(leds.AT_START))
    saying: str = ""
    listening: tuple[str, ...] = ()
    released: frozenset[str] = frozenset()
    felt: dict[str, float] = field(default_factory=dict)
    sees: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    settings: dict[str, bool | float | str] = field(default_factory=lambda: dict(AT_START))

    def __post_init__(self) -> None:
        self.angles = self.body.posture_angles(self.posture)

    @property
    def family(self) -> str:
        """The family of the posture: standing, sitting, lying, crouching, resting."""
        return self.body.postures[self.posture].family
