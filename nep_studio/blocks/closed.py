"""Which places of blocks take no block though one gives what is meant there, and why."""

from __future__ import annotations

from dataclasses import dataclass, replace

from faults import Text

from .definitions import PYTHON_KINDS, Group, Part, Slot

REASONS = {
    "page": Text("robots and nodes are there before the program begins"),
    "code": Text("Python is written here, not worked out"),
    "variable": Text("it says which variable is meant, not what that holds"),
    "rule": Text("it says which rule is meant"),
    "note": Text("it is a note for people"),
    "trigger": Text("what a rule waits for is fixed when the program begins"),
    "form": Text("it decides what the block does"),
    "master": Text("it only says which choices the next place offers"),
}
_ALWAYS_WORKED_OUT = frozenset(("boolean", "list", "any", "text", "lines", "colour"))
"""The kinds of places, beside numbers, that hold no name: also those of hats take blocks."""
_WORKED_OUT = frozenset(
    (("emotion", "emotion"), ("when_sensor", "robot"), ("when_sensor", "sensor"))
)
"""Generators and their places that are worked out each time, other than those of their kind."""


@dataclass(frozen=True, slots=True)
class Closing:
    """What of a definition decides which of its places are closed."""

    page: str
    shape: str
    generator: str
    holds_python: bool
    is_silent: bool
    masters: frozenset[str]

    def close(self, part: Part) -> Part:
        """A part of the sentence, closed where nothing that is worked out is meant."""
        if isinstance(part, Group):
            inner = tuple(self.close(one) if isinstance(one, Slot) else one for one in part.parts)
            return replace(part, parts=inner)  # type: ignore[arg-type]  # no group is in a group
        return replace(part, closed=self._why(part)) if isinstance(part, Slot) else part

    def _why(self, slot: Slot) -> str:
        kind = slot.kind
        if self.page != "behaviour":
            return "page"
        if kind.name in PYTHON_KINDS and (self.holds_python or self.is_silent):
            return "code" if self.holds_python else "note"
        if kind.name in ("variable", "rule"):
            return kind.name
        if kind.is_number or kind.name in _ALWAYS_WORKED_OUT or not kind.typed:
            return ""
        if (self.generator, slot.name) in _WORKED_OUT:
            return ""
        if self.shape == "hat":
            return "trigger"
        if slot.name in self.masters:
            return "master"
        return "form" if kind.name == "choice" and self.generator else ""
