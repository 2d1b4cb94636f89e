"""What a person wants a robot to do at this moment, and what keys mean."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from PySide6.QtCore import Qt


@dataclass(frozen=True)
class Drive:
    """Parts (-1 to 1) of the highest speeds: forward, left, turning left; head left, head up."""

    forward: float = 0.0
    left: float = 0.0
    turn: float = 0.0
    head_left: float = 0.0
    head_up: float = 0.0

    @property
    def walk(self) -> tuple[float, float, float]:
        """The part of the legs, in steps of a tenth: less is not felt."""
        return (round(self.forward, 1), round(self.left, 1), round(self.turn, 1))

    @property
    def is_walking(self) -> bool:
        """Whether the legs are asked to do something."""
        return any(self.walk)

    def slowed(self, part: float) -> Drive:
        """The same with slower legs."""
        return Drive(
            self.forward * part, self.left * part, self.turn * part, self.head_left, self.head_up
        )


STILL = Drive()
Key = Qt.Key
KEYS: dict[int, Drive] = {
    int(Key.Key_Up): Drive(forward=1.0),
    int(Key.Key_Down): Drive(forward=-1.0),
    int(Key.Key_Left): Drive(turn=1.0),
    int(Key.Key_Right): Drive(turn=-1.0),
    int(Key.Key_Q): Drive(left=1.0),
    int(Key.Key_E): Drive(left=-1.0),
    int(Key.Key_W): Drive(head_up=1.0),
    int(Key.Key_S): Drive(head_up=-1.0),
    int(Key.Key_A): Drive(head_left=1.0),
    int(Key.Key_D): Drive(head_left=-1.0),
}
"""What each key does while it is held."""


def sum_of(drives: Iterable[Drive]) -> Drive:
    """What several keys or devices want together; none goes beyond the highest speed."""
    found = list(drives)

    def within(value: float) -> float:
        return max(-1.0, min(1.0, value))

    return Drive(
        within(sum(one.forward for one in found)),
        within(sum(one.left for one in found)),
        within(sum(one.turn for one in found)),
        within(sum(one.head_left for one in found)),
        within(sum(one.head_up for one in found)),
    )
