"""The generator functions that definitions may name."""

from __future__ import annotations

from . import hats, reporters, statements
from .expressions import StatementGenerator, ValueGenerator
from .hats import GOAL_HATS, HatGenerator
from .names import FUNCTIONS
from .reporters import ROBOT_REPORTERS, ROBOT_STATEMENTS

HATS: dict[str, HatGenerator] = {**hats.HATS, **GOAL_HATS}
STATEMENTS: dict[str, StatementGenerator] = {**statements.STATEMENTS, **ROBOT_STATEMENTS}
REPORTERS: dict[str, ValueGenerator] = {**reporters.REPORTERS, **ROBOT_REPORTERS}


def generator_names() -> dict[str, frozenset[str]]:
    """The names of the generator functions by the kind of block, and of callable functions."""
    return {
        "hat": frozenset(HATS),
        "statement": frozenset(STATEMENTS),
        "value": frozenset(REPORTERS),
        "function": FUNCTIONS,
    }
