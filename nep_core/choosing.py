"""Which of several functions to run: one by chance, or the next in turn."""

from __future__ import annotations

import random
import threading
from types import CodeType, FunctionType

_turns: dict[CodeType, int] = {}
_lock = threading.Lock()


def one_of(*functions: FunctionType) -> None:
    """Run one of the functions, by chance."""
    random.choice(functions)()


def in_turn(*functions: FunctionType) -> None:
    """Run one of the functions: the first time the first, next time the next, and so on.

    The turn belongs to this place in the program, however often its functions are made anew.
    """
    with _lock:
        place = functions[0].__code__
        turn = _turns.get(place, 0)
        _turns[place] = turn + 1
    functions[turn % len(functions)]()
