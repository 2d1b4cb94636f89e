"""How long a robot takes to say something."""

from __future__ import annotations

import random
import re
import unicodedata
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import msgspec

from faults.files import read_toml
from robots.errors import FilesUnusable

from .animations import NO_GESTURE, Animations
from .limbs import Limb

CHARACTERS_PER_S = 14.0
"""About 2.6 words a second of English: NAO's voice at its usual speed."""
SHORTEST_S = 0.3
PAUSE_S = {",": 0.2, ";": 0.3, ":": 0.3, ".": 0.45, "!": 0.45, "?": 0.45, "、": 0.2, "。": 0.45}
WIDE_CHARACTER = 2.0
"""A Chinese, Japanese or Korean sign takes about as long as this many letters."""


def speaking_time_s(text: str) -> float:
    """Return the seconds that saying ``text`` takes: its letters, and a pause after each mark.

    The last mark makes no pause, nothing to say takes no time.
    """
    # NFKC makes the wide "!" of Japanese text the same mark as ours.
    words = unicodedata.normalize("NFKC", text).strip().rstrip("".join(PAUSE_S))
    if not words:
        return 0.0
    letters = sum(WIDE_CHARACTER if _is_wide(letter) else 1.0 for letter in words)
    pauses_s = sum(
        PAUSE_S.get(mark, 0.0)
        for mark, following in pairwise(words)
        if following.isspace() or _is_wide(following)
    )
    return max(SHORTEST_S, letters / CHARACTERS_PER_S + pauses_s)


def _is_wide(letter: str) -> bool:
    return unicodedata.east_asian_width(letter) in "WF"


# Which gestures go with what a robot says, when it speaks with its body.

CONTEXTUAL, RANDOM = "contextual", "random"
"""Gestures that go with the words, or come by chance."""
BODY_LANGUAGES = frozenset({CONTEXTUAL, RANDOM})
UPPER_BODY = frozenset({Limb.HEAD, Limb.LEFT_ARM, Limb.RIGHT_ARM})
MARKS = ".!?,;:\u3002\uff01\uff1f\u3001"
"""After these a new part of a text begins; the last ones are those of Chinese and Japanese."""
SHORTEST_PART = 25
"""Parts of a text with fewer letters are spoken together with the next one."""


class GestureWords(msgspec.Struct, frozen=True):
    """The words that are spoken with a gesture, by gesture; ``otherwise`` goes with all others."""

    otherwise: str = NO_GESTURE
    words: dict[str, tuple[str, ...]] = {}


class Spoken(NamedTuple):
    """A part of a text, and the gesture that goes with it."""

    text: str
    gesture: str


def load_gesture_words(folder: Path) -> GestureWords:
    """Read ``gesture_words.toml`` of a robot's folder; a robot without it speaks without gestures.

    Raises FilesUnusable when the file cannot be used.
    """
    path = folder / "gesture_words.toml"
    if not path.exists():
        return GestureWords()
    try:
        return msgspec.convert(read_toml(path), GestureWords)
    except (OSError, ValueError, RecursionError) as error:
        raise FilesUnusable(
            "The words for gestures, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
            path=path,
        ) from error


def spoken_parts(text: str, mode: str, animations: Animations, known: GestureWords) -> list[Spoken]:
    """Return the parts of a text, each with its gesture; ``mode`` is one of BODY_LANGUAGES.

    The same text has the same gestures every time.

    ``animations`` are those that the robot has, ``known`` the words that go with gestures.
    """
    possible = [
        name for name in animations.names("gesture") if animations.get(name).limbs <= UPPER_BODY
    ]
    chance = random.Random(text)
    if mode == RANDOM:
        return [Spoken(part, chance.choice(possible or [NO_GESTURE])) for part in _parts(text)]
    return [Spoken(part, _gesture_of(part, possible, known)) for part in _parts(text)]


def _gesture_of(part: str, possible: list[str], known: GestureWords) -> str:
    """Return the gesture whose word comes last in a part of a text."""
    plain = _plain(part)
    found = [
        (plain.rfind(_plain(word)), len(word), gesture)
        for gesture, words in known.words.items()
        for word in words
        if gesture in possible and _plain(word) in plain
    ]
    if found:
        return max(found)[2]
    return known.otherwise if known.otherwise in possible else NO_GESTURE


def _plain(text: str) -> str:
    """Return words with one space round each, and question marks as words of their own."""
    words = re.findall(r"[\w'-]+|\?", text.casefold())
    return f" {' '.join(words)} "


def _parts(text: str) -> list[str]:
    """Return the sentences of a text, and the parts of long ones."""
    parts: list[str] = []
    for piece in re.findall(rf"[^{MARKS}]*[{MARKS}]*\s*", text):
        if parts and len(parts[-1].strip()) < SHORTEST_PART:
            parts[-1] += piece
        elif piece.strip():
            parts.append(piece)
    return parts
