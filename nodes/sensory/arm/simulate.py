"""Recordings of simulated people: a gesture, a session of several, everyday movement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from nodes.recordings import Recording
from nodes.sensory.arm.everyday import CALM, EVERYDAY, rest
from nodes.sensory.arm.gestures import gesture_named
from nodes.sensory.arm.moving import Activity
from nodes.sensory.arm.people import person_numbered
from nodes.sensory.arm.performer import Performer, Samples

_FIDGETING = 0.35  # the part of the pauses of a session in which the hands do something


def perform(gesture: str, person: int, take: int, rate_hz: float = 50.0) -> Recording:
    """One gesture with rest before and after it; each ``take`` is another performance.

    Raises ParameterError for a gesture that the simulated people do not know.
    """
    performer = Performer(person_numbered(person), rate_hz, take)
    performer.live(rest)
    performer.make(gesture_named(gesture))
    performer.live(rest)
    return _recording(f"simulated {gesture} {take}", person, [performer.planned_samples()])


def simulate_session(
    person: int, gestures: Sequence[str], repetitions: int, rate_hz: float = 50.0, seed: int = 0
) -> Recording:
    """One labelled stream: every gesture so many times in random order, pauses in between."""
    order = [gesture_named(name) for name in gestures for _ in range(repetitions)]
    chance = np.random.default_rng([3, person, seed])
    performer = Performer(person_numbered(person), rate_hz, seed)

    def parts() -> Iterator[Samples]:
        for index in chance.permutation(len(order)):
            _pause(performer, chance)
            performer.make(order[index])
            yield performer.planned_samples()
        _pause(performer, chance)
        yield performer.planned_samples()

    return _recording(f"simulated session {seed}", person, list(parts()))


def simulate_everyday(
    person: int,
    seconds: float,
    rate_hz: float = 50.0,
    seed: int = 0,
    activities: Sequence[Activity] = EVERYDAY,
) -> Recording:
    """Everyday movement without any gesture: walking, drinking, typing, sitting down, ...

    ``activities``: EVERYDAY, or LIVELY for what is harder to tell from a gesture.
    """
    chance = np.random.default_rng([4, person, seed])
    performer = Performer(person_numbered(person), rate_hz, seed)

    def parts() -> Iterator[Samples]:
        while performer.now_s < seconds:
            performer.live(activities[int(chance.integers(len(activities)))])
            left = max(0, round((seconds - performer.now_s) * rate_hz))
            planned = int((performer.planned_until_s - performer.now_s) * rate_hz)
            if not left:
                return
            yield performer.samples(min(left, planned))

    return _recording(f"simulated everyday movement {seed}", person, list(parts()))


def _pause(performer: Performer, chance: np.random.Generator) -> None:
    performer.live(rest)
    if chance.random() < _FIDGETING:
        performer.live(CALM[chance.integers(len(CALM))])


def _recording(source: str, person: int, parts: list[Samples]) -> Recording:
    return Recording(
        source=source,
        t=np.concatenate([part.t for part in parts]),
        acc=np.concatenate([part.acc for part in parts]),
        gyr=np.concatenate([part.gyr for part in parts]),
        labels=[label for part in parts for label in part.labels],
        gravity_included=True,
        person=str(person),
        simulated=True,
    )
