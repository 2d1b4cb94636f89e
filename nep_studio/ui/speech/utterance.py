"""Something that a robot says, and how its voice is."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace

from nep_core.messages import ActionRequest, RobotState

LONGEST = 2000
"""So many letters of a text are spoken: nobody listens to more."""
LOWEST_PITCH, HIGHEST_PITCH = 0.5, 2.0
OWN_PITCHES = (1.0, 1.25, 0.8, 1.45, 0.9, 1.12, 0.7)
"""Robots that talk with each other are told apart by these."""
SLOWEST, FASTEST = 0.5, 3.0


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
    return Utterance(
        " ".join(state.saying.split())[:LONGEST],
        language if isinstance(language, str) and language else "en",
        _percent(state.settings.get("volume"), 100.0),
        own_pitch(state.robot),
    )


def spoken_as(utterance: Utterance, request: ActionRequest | None) -> Utterance:
    """The utterance in the language, pitch and speed that were asked for."""
    if request is None:
        return utterance
    language = request.args.get("language")
    pitch = utterance.pitch * _percent(request.args.get("pitch"), 200.0)
    return replace(
        utterance,
        language=language if isinstance(language, str) and language else utterance.language,
        pitch=min(max(pitch, LOWEST_PITCH), HIGHEST_PITCH),
        speed=min(max(_percent(request.args.get("speed"), 300.0), SLOWEST), FASTEST),
    )


def _percent(value: object, most: float) -> float:
    """A number of percent as a share; 1 for what is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
        return 1.0
    return min(max(float(value), 0.0), most) / 100.0
