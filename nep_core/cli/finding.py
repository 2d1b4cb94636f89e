"""What the doctor found out about one thing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

State = Literal["ok", "look", "unknown", "note"]
"""``look``: something is wrong. ``unknown``: it could not be found out. ``note``: good to know."""


@dataclass(frozen=True)
class Finding:
    """A thing, how it is, in a sentence, and the steps to do when it is wrong."""

    about: str
    state: State
    told: str
    steps: tuple[str, ...] = ()
