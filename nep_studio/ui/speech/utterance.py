"""Something that a robot says, and how its voice is."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

from nep_core.messages import RobotState

LONGEST = 2000
"""So many letters of a text are spoken: nobody listens to more."""
LOWEST_PITCH, HIGHEST_PITCH = 0.5, 2.0
OWN_PITCHES = (1.0, 1.25, 0.8, 1.45, 0.9, 1.12, 0.7)
"""Robots that talk with each other are told apart by these."""
USUAL_PERCENT = 100.0


@dataclass(frozen=True)
class Utterance:
    """A text, its language ("en", "pt_br"), and how it is said.

    ``volume`` is 0 to 1; ``pitch`` and ``speed`` are 1 as usual, 2 for twice as high or fast.
    """

    text: str
    language: str = "en"
    volume: float = 1.0
    pitch: float = 1.0
    speed: float = 1.0


def own_pitch(robot: str) -> float:
    """The pitch of a robot's voice, the same each time: the first of the usual names is 1."""
    if robot in ("", "NAO"):
        return OWN_PITCHES[0]
    return OWN_PITCHES[1 + zlib.crc32(robot.encode()) % (len(OWN_PITCHES) - 1)]


def utterance_of(state: RobotState) -> Utterance:
    """What a robot says now, as loud and in the language that it is set to."""
    language = state.settings.get("language")
    pitch = _share(state, "pitch", 200.0) * own_pitch(state.robot)
    return Utterance(
        " ".join(state.saying.split())[:LONGEST],
        language if isinstance(language, str) and language else "en",
        min(_share(state, "volume", USUAL_PERCENT), 1.0),
        min(max(pitch, LOWEST_PITCH), HIGHEST_PITCH),
        min(max(_share(state, "speed", 300.0), 0.5), 3.0),
    )


def _share(state: RobotState, name: str, most: float) -> float:
    """A setting in percent as a share; 1 where the robot does not tell it."""
    value = state.settings.get(name, USUAL_PERCENT)
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
        return 1.0
    return min(max(float(value), 0.0), most) / 100.0
