"""The lines of a menu, and what a menu is about."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF

from .page import Hit

if TYPE_CHECKING:
    from .canvas import Canvas


def _nothing() -> None:
    """A line that opens a menu of its own does nothing itself."""


@dataclass(frozen=True)
class MenuEntry:
    """One line of a menu; ``entries`` make it a menu of its own, ``shortcut`` is only shown."""

    id: str
    label: str
    run: Callable[[], object] = _nothing
    icon: str = ""
    is_enabled: bool = True
    shortcut: str = ""
    entries: tuple[MenuEntry, ...] = ()


@dataclass(frozen=True)
class MenuPlace:
    """What a menu is about: a block that was hit, a note, or neither, and the point of the page."""

    hit: Hit | None
    at: QPointF
    note: str = ""


Section = Callable[["Canvas", MenuPlace], list[MenuEntry]]
"""Gives some entries of a menu; a line separates them from the others. No entries, no section."""
