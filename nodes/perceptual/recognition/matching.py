"""How the gestures that were found agree with the gestures that were made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from nodes.perceptual.recognition.passages import Take
from nodes.perceptual.recognition.peaks import Detection

NOTHING = ""
_SHARED = 0.25  # of the shorter of the two


@dataclass(frozen=True)
class Tally:
    """Pairs (made, recognised), NOTHING standing for none: one for each take and each extra."""

    pairs: tuple[tuple[str, str], ...] = ()

    def __add__(self, other: Tally) -> Tally:
        return Tally(self.pairs + other.pairs)

    @property
    def made(self) -> int:
        """Gestures that were made."""
        return sum(made != NOTHING for made, _ in self.pairs)

    @property
    def right(self) -> int:
        """Gestures made that were recognised as what they were."""
        return sum(made == found != NOTHING for made, found in self.pairs)

    @property
    def fired(self) -> int:
        """Triggers, right and wrong."""
        return sum(found != NOTHING for _, found in self.pairs)

    @property
    def recall(self) -> float:
        """The part of the gestures made that were recognised."""
        return self.right / self.made if self.made else 0.0

    @property
    def precision(self) -> float:
        """The part of the triggers that were right."""
        return self.right / self.fired if self.fired else 0.0

    @property
    def f1(self) -> float:
        """The harmonic mean of recall and precision."""
        return 2 * self.right / (self.made + self.fired) if self.made + self.fired else 0.0


def match(takes: Sequence[Take], detections: Sequence[Detection]) -> Tally:
    """Pair each take with the trigger it caused, the right one if there are several.

    A trigger that no take caused, and one more than the first for the same take, counts as made
    from nothing.
    """
    left = list(detections)
    pairs = []
    for take in takes:
        caused = [found for found in left if meets(take, found)]
        caused.sort(key=lambda found: found.gesture != take.gesture)
        pairs.append((take.gesture, caused[0].gesture if caused else NOTHING))
        if caused:
            left.remove(caused[0])
    return Tally((*pairs, *((NOTHING, found.gesture) for found in left)))


def meets(take: Take, found: Detection) -> bool:
    """Whether a trigger may have been caused by a take."""
    shared = min(take.end_s, found.t_end) - max(take.start_s, found.t_start)
    return shared > _SHARED * min(take.duration_s, found.t_end - found.t_start)
