"""What a virtual robot is at this moment: its joints, its place, its lights, its words."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nodes.action.naobody import leds
from nodes.action.naobody.animations import Animations
from nodes.action.naobody.body import Angles, Body


@dataclass
class VirtualRobot:
    """One robot and its present state, which tasks change tick by tick.

    ``angles``: every joint, in the body's order. ``base``: x m, y m, theta rad on the floor.
    ``posture``: the last one reached. ``leds``: 0xRRGGBB by light.
    """

    name: str
    body: Body
    animations: Animations
    posture: str = "Stand"
    angles: Angles = field(init=False)
    base: Angles = field(default_factory=lambda: np.zeros(3))
    leds: dict[str, int] = field(default_factory=lambda: dict(leds.AT_START))
    saying: str = ""

    def __post_init__(self) -> None:
        self.angles = self.body.posture_angles(self.posture)

    @property
    def family(self) -> str:
        """The family of the posture: standing, sitting, lying, crouching, resting."""
        return self.body.postures[self.posture].family
