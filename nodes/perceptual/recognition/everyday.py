"""Movement without gestures, by simulated people, so that a model knows what to ignore."""

from __future__ import annotations

from nodes.recordings import Recording
from nodes.sensory.arm.simulate import simulate_everyday

_PEOPLE = 6
_SECONDS = 60.0


def simulated_everyday(first_person: int = 0) -> list[Recording]:
    """Six simulated people, a minute each."""
    people = range(first_person, first_person + _PEOPLE)
    return [simulate_everyday(person, _SECONDS) for person in people]
