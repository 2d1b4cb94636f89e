"""How the gallery says what an example needs, how hard and how long it is, and what it is about."""

from __future__ import annotations

from nep_studio.examples import Example
from nep_studio.ui.words import count_words, tr

Sign = tuple[str, str]
"""The name of an icon, and words."""


def signs_of(example: Example) -> list[Sign]:
    """What one needs for an example, and how long it takes, each with its icon."""
    known = _needs()
    needs = [known[need] for need in example.needs if need in known]
    return [*(needs or [("circle-check", tr("Needs nothing"))]), _length(example)]


def difficulty_of(example: Example) -> Sign:
    """How much of the block language an example uses."""
    return {
        "first": ("star", tr("Begin here")),
        "next": ("chevron-right", tr("Next step")),
        "more": ("sparkles", tr("For more")),
    }[example.difficulty]


def tag_words(tag: str) -> str:
    """What a tag is called."""
    return _tags().get(tag, tag)


def search_text(example: Example) -> str:
    """All that an example can be found by, in the person's language and in English."""
    shown = [tr(words) for words in example.words()]
    tags = [tag_words(tag) for tag in example.tags]
    signs = [words for _, words in (*signs_of(example), difficulty_of(example))]
    return " ".join([*shown, *example.words(), *tags, *example.tags, *signs]).casefold()


def _length(example: Example) -> Sign:
    if not example.seconds:
        return "repeat", tr("Until you stop it")
    if example.seconds < 60:
        return "clock", tr("{seconds} seconds", seconds=round(example.seconds))
    return "clock", count_words(round(example.seconds / 60), "1 minute", "{n} minutes")


def _needs() -> dict[str, Sign]:
    return {
        "watch": ("watch", tr("A watch, or the virtual one")),
        "two_robots": ("users", tr("Two robots on the screen")),
        "voice": ("message-square-text", tr("Somebody who answers")),
        "people": ("user", tr("Somebody in front of it")),
        "touch": ("hand", tr("Somebody who touches it")),
        "cues": ("flag", tr("Somebody who gives cues")),
    }


def _tags() -> dict[str, str]:
    return {
        "gestures": tr("Gestures"),
        "museum": tr("Museum"),
        "robots": tr("Several robots"),
        "speech": tr("Speech"),
        "theatre": tr("Theatre"),
        "lights": tr("Lights"),
        "feelings": tr("Feelings"),
        "movement": tr("Movement"),
        "games": tr("Games"),
        "values": tr("Counting and keeping"),
        "sensors": tr("Sensors"),
        "goals": tr("Goals"),
        "own_blocks": tr("My blocks"),
    }
