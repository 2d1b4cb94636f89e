"""Find what a person means by a few letters: fuzzy, whatever the case, the accents, the order."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

WHOLE, START, INITIAL, INSIDE, SCATTERED = 100, 60, 40, 25, 10
"""What a typed word is worth: all of a word, its start, first letters of words, a part, letters."""

ALSO_WORTH = 0.5
"""What is found in the other words of a command counts half."""

LETTERS_PER_GAP = 4
"""Letters that lie further apart than a gap for so many are found by accident."""

EXACT = 20
"""What it is worth more when a command is called just what was typed."""


@dataclass(frozen=True)
class Match:
    """How well a text fits, and which of its letters were found."""

    score: float
    letters: tuple[int, ...] = ()


def match(typed: str, text: str, also: str = "") -> Match | None:
    """How well a text fits what was typed; None when a typed word is nowhere in it."""
    plain, places = _folded(text)
    other, _ = _folded(also)
    total, found = 0.0, set[int]()
    for word in _folded(typed)[0].split():
        here, there = _best(word, plain), _together(word, other)
        if here is None and there is None:
            return None
        if here is not None and (there is None or here.score >= there.score * ALSO_WORTH):
            total += here.score
            found.update(places[letter] for letter in here.letters)
        elif there is not None:
            total += there.score * ALSO_WORTH
    total += EXACT if plain == _folded(typed)[0].strip() else 0
    return Match(total - len(plain) / 1000, tuple(sorted(found)))


def _folded(text: str) -> tuple[str, list[int]]:
    """A text without case and accents, and where each of its letters was in the text."""
    letters, places = [], []
    for place, letter in enumerate(text):
        for plain in unicodedata.normalize("NFKD", letter).casefold():
            if not unicodedata.combining(plain):
                letters.append(plain)
                places.append(place)
    return "".join(letters), places


def _best(word: str, text: str) -> Match | None:
    return _together(word, text) or _initials(word, text) or _scattered(word, text)


def _together(word: str, text: str) -> Match | None:
    """The word as it is: at the start of a word if it can be."""
    at = _find_start(word, text)
    if at >= 0:
        end = at + len(word)
        is_whole = end == len(text) or not text[end].isalnum()
        score = (WHOLE if is_whole else START) + (5 if at == 0 else 0)
        return Match(score, tuple(range(at, end)))
    at = text.find(word)
    return Match(INSIDE, tuple(range(at, at + len(word)))) if at >= 0 else None


def _find_start(word: str, text: str) -> int:
    at = text.find(word)
    while at > 0 and text[at - 1].isalnum():
        at = text.find(word, at + 1)
    return at


def _initials(word: str, text: str) -> Match | None:
    """First letters of words, in order: "sp" for "save the Python"."""
    starts = [i for i, c in enumerate(text) if c.isalnum() and (i == 0 or text[i - 1] == " ")]
    found = _in_order(word, text, starts)
    return Match(INITIAL, found) if found and len(word) > 1 else None


def _scattered(word: str, text: str) -> Match | None:
    """The letters in order, most of them beside each other: a letter was left out or is wrong."""
    for start, letter in enumerate(text):
        if letter != word[0] or (start and text[start - 1].isalnum()):
            continue
        found = _in_order(word, text, range(start, len(text)))
        if found and _gaps(found) <= len(word) // LETTERS_PER_GAP:
            return Match(SCATTERED - _gaps(found), found)
    return None


def _in_order(word: str, text: str, places: Sequence[int]) -> tuple[int, ...]:
    """Where the letters of a word are, one after the other, among some places; else ()."""
    found: list[int] = []
    for place in places:
        if len(found) < len(word) and text[place] == word[len(found)]:
            found.append(place)
    return tuple(found) if len(found) == len(word) else ()


def _gaps(places: Sequence[int]) -> int:
    return sum(after != before + 1 for before, after in pairwise(places))
