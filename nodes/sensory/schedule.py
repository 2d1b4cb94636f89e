"""When the simulated person makes which gesture: ``karate, hand_up`` or ``3 karate, 8 hand_up``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nep_core.errors import ParameterError
from nodes.sensory.arm.gestures import gesture_named
from nodes.sensory.own_takes import Movement

PAUSE_S = 3.0


@dataclass(frozen=True)
class Planned:
    """A gesture and when it is begun: at a second, or (None) a pause after the one before."""

    gesture: Movement
    at_s: float | None


def read_schedule(text: str, find: Callable[[str], Movement] = gesture_named) -> list[Planned]:
    """Read a schedule of gestures that can be found; ParameterError names a part that is wrong."""
    parts = [part.split() for part in text.split(",") if part.strip()]
    return [_read_part(words, find) for words in parts]


def _read_part(words: list[str], find: Callable[[str], Movement]) -> Planned:
    if len(words) == 1:
        return Planned(find(words[0]), None)
    try:
        at_s, name = float(words[0]), words[1]
    except ValueError:
        at_s, name = -1.0, ""
    if len(words) > 2 or not 0 <= at_s < 1e6:
        raise ParameterError(
            f'The schedule of gestures has "{" ".join(words)}", which is not a gesture.',
            checklist=(
                "Write the gestures with commas between them: karate, hand_up.",
                "Or with the second at which each begins: 3 karate, 8 hand_up.",
            ),
        )
    return Planned(find(name), at_s)


class Schedule:
    """Gives out the gestures of a schedule as their time comes."""

    def __init__(self, planned: list[Planned], *, repeat: bool) -> None:
        self._planned = planned
        self._repeat = repeat
        self._next = 0
        self._round_began_s = 0.0
        self._idle_since_s = 0.0

    def due(self, now_s: float, *, is_busy: bool) -> Movement | None:
        """The gesture to begin at ``now_s``, if any; asked again and again as time goes on."""
        if is_busy:
            self._idle_since_s = now_s
        if self._next == len(self._planned):
            if not self._repeat or is_busy or not self._planned:
                return None
            self._next, self._round_began_s = 0, now_s
        planned = self._planned[self._next]
        if planned.at_s is None:
            is_due = not is_busy and now_s >= self._idle_since_s + PAUSE_S
        else:
            is_due = now_s >= self._round_began_s + planned.at_s
        if not is_due:
            return None
        self._next += 1
        self._idle_since_s = now_s
        return planned.gesture
