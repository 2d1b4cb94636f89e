"""The generator functions that definitions may name."""

from __future__ import annotations

from .hats import HATS
from .names import FUNCTIONS
from .reporters import REPORTERS
from .statements import STATEMENTS


def generator_names() -> dict[str, frozenset[str]]:
    """The names of the generator functions by the kind of block, and of callable functions."""
    return {
        "hat": frozenset(HATS),
        "statement": frozenset(STATEMENTS),
        "value": frozenset(REPORTERS),
        "function": FUNCTIONS,
    }
