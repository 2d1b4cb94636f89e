"""What a sentence of advice is, and what it is made from."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Literal

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.trainer.results.findings import Findings, id_of_take

ENOUGH_TAKES = 5
MORE_TAKES = 3

Kind = Literal["problem", "tip", "good"]
What = Literal["", "record", "everyday", "gesture", "point", "takes", "try"]


@dataclass(frozen=True)
class Advice:
    """One sentence; ``what`` helps, with this gesture or these takes (ids)."""

    kind: Kind
    words: str
    what: What = ""
    gesture: str = ""
    takes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Known:
    """What the project has: its gestures by name, people, seconds of everyday movement."""

    gestures: Mapping[str, OwnGesture]
    people: Collection[str] = ()
    everyday_s: float = 0.0

    def title(self, name: str) -> str:
        """What a gesture is called."""
        gesture = self.gestures.get(name)
        return gesture.title if gesture is not None else name


def takes_of_pair(
    findings: Findings, gestures: Mapping[str, OwnGesture], made: str, found: str
) -> tuple[str, ...]:
    """The ids of the takes of one gesture that were taken for another, or for nothing."""
    concerned = (one for one in findings.left_out if (one.gesture, one.recognised) == (made, found))
    ids = (id_of_take(one, gestures) for one in concerned)
    return tuple(take for take in ids if take)
