"""Tells how the arm that wears a watch is held, once each time that it is held so.

The states are ``arm_raised``, ``arm_level`` and ``arm_lowered``; arm_posture.py says what they
mean, and what nobody can tell from a watch.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from nep_core.processes.node import Node
from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu

from .arm_posture import ArmPosture, ArmPostures
from .recognition.sensor_input import Audience, Troubles

ARM = "arm_"
"""What the human states begin with."""

Worn = Literal[
    "automatic", "left wrist", "right wrist", "left wrist, turned", "right wrist, turned"
]

_HANDS = {
    "left wrist": 1,
    "right wrist": -1,
    "left wrist, turned": -1,
    "right wrist, turned": 1,
}
"""Where the x axis of a watch points: 1 to the hand, -1 to the elbow."""
_WRISTS = {"left": 1, "right": -1}
"""The same where a watch that is worn as usual says its wrist."""
_SILENCE_S = 0.3


def run(node: Node, *, worn: Worn) -> None:
    """Publish ``arm_raised``, ``arm_level`` or ``arm_lowered`` on ``/human_behavior``.

    ``node`` is this node, ``worn`` where the watch is worn.
    """
    ears = _Ears(node, worn)
    movement = node.subscriber(IMU, Imu)
    publisher = node.publisher(HUMAN_BEHAVIOR)
    node.ready("tells how an arm with a watch is held")
    while not node.stopping:
        batch = movement.receive(timeout_s=_SILENCE_S)
        for posture in ears.hear(batch) if batch else []:
            publisher.send(HumanBehavior(human_state=f"{ARM}{posture}", source=node.name))
        ears.tell()


_Sensor = tuple[str, bool, str]
"""Its source, whether its acceleration has gravity, its wrist."""


class _Ears:
    """An arm for each watch that is heard; what a sensor lacks is told once."""

    def __init__(self, node: Node, worn: Worn) -> None:
        self._node, self._worn = node, worn
        self._arms: dict[_Sensor, _Arm] = {}
        self._audience = Audience(node, self._forget)

    def hear(self, batch: Imu) -> list[ArmPosture]:
        """The postures that begin in a batch of samples."""
        sensor = (batch.source, batch.gravity_included, batch.wrist)
        if not self._audience.has(batch):
            return []
        if sensor not in self._arms:
            self._arms[sensor] = _Arm(self._node, batch, self._worn)
        return self._arms[sensor].hear(batch)

    def tell(self) -> None:
        """Tell how the forearm slants, as often as a node may."""
        slants = [arm.elevation_deg for arm in self._arms.values()]
        known = [round(slant, 1) for slant in slants if not math.isnan(slant)]
        if known:
            self._node.state("alive", measures={"elevation_deg": known[-1]})

    def _forget(self, source: str) -> None:
        self._arms = {sensor: arm for sensor, arm in self._arms.items() if sensor[0] != source}


class _Arm:
    """The arm that wears one watch, and what a person should know of that watch."""

    def __init__(self, node: Node, first: Imu, worn: Worn) -> None:
        self._node, self._source = node, first.sender
        self._troubles = Troubles(first.sender, node.warn)
        self._postures: ArmPostures | None = None
        self._is_broken = False
        self._hand = _HANDS.get(worn) or _WRISTS.get(first.wrist, 0)
        if not first.gravity_included:
            node.warn(
                "{source} sends its acceleration without gravity, of which nobody can tell how an "
                "arm is held. Choose the acceleration with gravity in its app.",
                source=first.sender,
            )
        elif first.wrist == "hand":
            node.warn(
                "{source} is held in the hand, where nobody can tell how an arm is held. Strap it "
                "to the wrist.",
                source=first.sender,
            )
        else:
            self._postures = ArmPostures(self._hand, is_fixed=worn in _HANDS)
            node.state(
                "running",
                "listens to {source}"
                if self._hand
                else "listens to {source}: let the arm hang, which shows how it is worn",
                source=first.sender,
            )

    @property
    def elevation_deg(self) -> float:
        """How the forearm slants, in degrees; NaN: not known."""
        return math.nan if self._postures is None else self._postures.elevation_deg

    def hear(self, batch: Imu) -> list[ArmPosture]:
        """The postures that begin in a batch of samples."""
        if self._postures is None or self._is_broken or (not batch.t and not batch.acc):
            return []
        if len(batch.t) != len(batch.acc):
            self._is_broken = True
            self._node.warn(
                "{source} sends times and samples that do not belong together", source=self._source
            )
            return []
        t, acc = np.array(batch.t, float), np.array(batch.acc, float)
        self._troubles.look(t, acc)
        found = [posture for _, posture in self._postures.push(t, acc)]
        self._note_hand(self._postures.hand)
        return found

    def _note_hand(self, hand: int) -> None:
        """Say how the watch is worn once that is found out, or turns out to be otherwise."""
        if hand == self._hand:
            return
        self._node.state(
            "running",
            "{source} is worn the other way round: so the arm hangs most of the time."
            if self._hand
            else "{source}: the arm that hangs has shown how it is worn.",
            source=self._source,
        )
        self._hand = hand
