"""An error as data that a person can act on: what happened, and what to try in order."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass

from faults import FaultError, Words

_INVISIBLE = {"Cc", "Cf", "Cs", "Zl", "Zp"}
"""Categories of Unicode: controls, marks such as "write from right to left", ends of lines."""
_JOINERS = "\u200c\u200d"
"""Of these, what Persian words and many emoji need."""


@dataclass(frozen=True)
class Problem:
    """A title, one sentence, where it is, a checklist, and technical details to copy."""

    title: Words
    sentence: Words = ""
    checklist: tuple[Words, ...] = ()
    details: str = ""
    place: str = ""

    def __str__(self) -> str:
        place = f"  at {self.place}" if self.place else ""
        steps = (f"  [ ] {step}" for step in self.checklist)
        return "\n".join(
            on_one_line(str(part)) for part in (self.title, self.sentence, place, *steps) if part
        )


def problem_of(error: FaultError) -> Problem:
    """The problem that an error tells of."""
    return Problem(error.title, error.sentence, error.checklist, error.details)


def on_one_line(text: str) -> str:
    """``text`` without what would move a terminal's cursor, or forge another line."""
    return "".join(
        " " if unicodedata.category(letter) in _INVISIBLE and letter not in _JOINERS else letter
        for letter in text
    )
