"""A command of the palette as data: what it is called, what it does, why it cannot be used now."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from PySide6.QtGui import QIcon


@dataclass(frozen=True)
class Command:
    """Something that a person can do.

    ``id`` is the same each time and in every language; ``kind`` says in a word what it is ("Panel",
    "Example"), ``also`` are more words that it is found by. ``why_not`` is "" when it can be used.
    """

    id: str
    words: str
    do: Callable[[], object]
    kind: str = ""
    keys: str = ""
    icon: QIcon = field(default_factory=QIcon)
    also: str = ""
    why_not: str = ""
    is_on: bool | None = None


Source = Callable[[], Iterable[Command]]
"""Gives commands as they are at the moment; called each time that the palette opens."""
