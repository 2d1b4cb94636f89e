"""An error as data that a person can act on: what happened, and what to try in order."""

from __future__ import annotations

from dataclasses import dataclass

from nep_core.errors import NepError
from nep_studio.blocks.errors import BlocksError


@dataclass(frozen=True)
class Problem:
    """A title, one sentence, a checklist, and technical details to copy."""

    title: str
    sentence: str
    checklist: tuple[str, ...] = ()
    details: str = ""

    def __str__(self) -> str:
        return "\n".join([self.title, self.sentence, *(f"  [ ] {step}" for step in self.checklist)])


def problem_of(error: NepError | BlocksError) -> Problem:
    """The problem that an error tells of."""
    return Problem(error.title, error.sentence, error.checklist, error.details)
