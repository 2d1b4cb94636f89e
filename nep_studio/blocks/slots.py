"""The kinds of slot: how each is drawn, which values may be plugged in, why one is refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

SlotShape = Literal["round", "square", "hexagon", "bracket", "pill", "mouth"]
"""The outline of a slot and of what goes in: number, text, yes or no, list, others, a body."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of slot: what it is called, which block results fit, what a person can type in it.

    ``fits`` are the result types of blocks that may be plugged in; ``typed`` says that the slot
    has a field (a default value that comes back when the plugged block leaves).
    """

    name: str
    noun: str
    shape: SlotShape = "pill"
    fits: frozenset[str] = frozenset()
    typed: bool = True

    @property
    def pluggable(self) -> bool:
        """Whether a reporter block may be put into the slot."""
        return bool(self.fits)


RESULTS = {
    "number": "a number",
    "text": "a text",
    "boolean": "yes or no",
    "list": "a list",
    "colour": "a colour",
    "any": "any value",
}
"""What a reporter gives; ``any`` is known only while the program runs (a variable)."""

RESULT_SHAPES: dict[str, SlotShape] = {
    "number": "round",
    "text": "square",
    "boolean": "hexagon",
    "list": "bracket",
    "colour": "pill",
    "any": "pill",
}
"""The outline of a block that gives such a result."""

_NUMBERS = frozenset({"number", "any"})
_ALL = frozenset(RESULTS)

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("number", "a number", "round", _NUMBERS),
        Kind("angle", "an angle in degrees", "round", _NUMBERS),
        Kind("slider", "a number", "round", _NUMBERS),
        Kind("duration", "a time in seconds", "round", _NUMBERS),
        Kind("text", "a text", "square", _ALL),  # what is no text is written out by str()
        Kind("lines", "a text of several lines", "square", _ALL),
        Kind("line", "one line of text", "square"),
        Kind("date", "a date", "square"),
        Kind("file", "a file", "square"),
        Kind("boolean", "a yes-or-no question", "hexagon", frozenset({"boolean", "any"}), False),
        Kind("list", "a list", "bracket", frozenset({"list", "any"}), False),
        Kind("any", "a value", "pill", _ALL),
        Kind("colour", "a colour", "pill", frozenset({"colour", "any"})),
        Kind("checkbox", "on or off"),
        Kind("state", "a human state"),
        Kind("gesture", "a gesture"),
        Kind("robot", "a robot"),
        Kind("variable", "a variable"),
        Kind("choice", "one of a list"),
        Kind("settings", "a list of settings"),
        Kind("parameter", "a value of this block", typed=False),
        Kind("body", "blocks", "mouth", typed=False),
    )
}


def why_not_fit(kind: Kind, result: str, block_name: str) -> str | None:
    """Why a block whose result is ``result`` cannot be plugged into a slot, or None when it can."""
    if result in kind.fits:
        return None
    if not kind.pluggable:
        return f"This place takes {kind.noun} that is chosen or typed, not a block."
    return f"This place needs {kind.noun}, and “{block_name}” gives {RESULTS[result]}."
