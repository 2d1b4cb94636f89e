"""The block language of one session: the definitions, and the choices that their slots offer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .definitions import Category, Definition
from .profile import RobotProfile
from .sentence import Slot


@dataclass(frozen=True, slots=True)
class Language:
    """Definitions by block type and choices by table (value to label).

    A table that is absent or empty is not known here (no node manifests were given, say), and
    then any value passes. ``profile`` is the kind of robot.
    """

    definitions: Mapping[str, Definition]
    categories: tuple[Category, ...]
    choices: Mapping[str, Mapping[str, str]]
    profile: RobotProfile

    def choices_of(self, slot: Slot) -> Mapping[str, str]:
        """The values that a slot offers with their labels; empty when they are not known."""
        return self.choices.get("gestures" if slot.kind.name == "gesture" else slot.table, {})

    def why_not_choice(self, slot: Slot, value: object) -> str | None:
        """Why a choice slot cannot hold this value, or None when it can."""
        if slot.kind.name != "choice":
            return None
        offered = self.choices.get(slot.table, {})
        if not offered or value in offered:
            return None
        return f"“{value}” is not one of: {', '.join(offered)}."
