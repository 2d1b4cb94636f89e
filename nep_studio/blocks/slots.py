"""The kinds of slot, which values may be plugged into each, and why one is refused."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of slot: what it is called, which block results fit, what a person can type in it.

    ``fits`` are the result types of blocks that may be plugged in; ``typed`` says that the slot
    has a field (a default value that comes back when the plugged block leaves).
    """

    name: str
    noun: str
    fits: frozenset[str] = frozenset()
    typed: bool = True

    @property
    def pluggable(self) -> bool:
        """Whether a reporter block may be put into the slot."""
        return bool(self.fits)


RESULTS = {"number": "a number", "text": "a text", "boolean": "yes or no", "any": "any value"}
"""What a reporter gives; ``any`` is known only while the program runs (a variable)."""

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("number", "a number", frozenset({"number", "any"})),
        Kind("text", "a text", frozenset(RESULTS)),  # what is no text is written out by str()
        Kind("boolean", "a yes-or-no question", frozenset({"boolean", "any"}), typed=False),
        Kind("any", "a value", frozenset(RESULTS)),
        Kind("line", "one line of text"),
        Kind("state", "a human state"),
        Kind("gesture", "a gesture"),
        Kind("robot", "a robot"),
        Kind("variable", "a variable"),
        Kind("colour", "a colour"),
        Kind("choice", "one of a list"),
        Kind("settings", "a list of settings"),
        Kind("body", "blocks", typed=False),
    )
}


def why_not_fit(kind: Kind, result: str, block_name: str) -> str | None:
    """Why a block whose result is ``result`` cannot be plugged into a slot, or None when it can."""
    if result in kind.fits:
        return None
    if not kind.pluggable:
        return f"This place takes {kind.noun} that is chosen or typed, not a block."
    return f"This place needs {kind.noun}, and “{block_name}” gives {RESULTS[result]}."
