"""What the variables of a program hold, as short texts, and which have changed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import islice
from typing import Any

LONGEST = 60
"""Letters of a value that are shown."""
MOST_DIGITS = 40
MOST_REPORTS = 2000
"""So many places of a program tell what they gave last."""

CUT = "…"
_ENDS: dict[type, str] = {list: "[]", tuple: "()", set: "{}", frozenset: "{}", dict: "{}"}
_DEEPEST = 3


def is_plain(value: object) -> bool:
    """Whether a value is a number, a text, true or false, nothing, or a collection of values."""
    return value is None or type(value) in (bool, int, float, str) or type(value) in _ENDS


def shown(value: object, depth: int = 0) -> str:
    """A plain value as Python, clipped; no code of the program is run for it."""
    if type(value) is str:
        return repr(value) if len(value) < LONGEST else repr(value[: LONGEST - 2]) + CUT
    if type(value) is int:
        return _whole(value)
    if value is None or type(value) in (bool, float):
        return repr(value)
    if type(value) in _ENDS and depth < _DEEPEST:
        return _collection(value, depth)
    return CUT


def _whole(value: int) -> str:
    digits = int(value.bit_length() * math.log10(2))
    if digits <= MOST_DIGITS:
        return repr(value)
    return f"{'-' if value < 0 else ''}1e+{digits}"  # to write all digits could take minutes


def _collection(value: Any, depth: int) -> str:
    kind = type(value)
    opening, closing = _ENDS[kind][0], _ENDS[kind][1]
    text = ""
    for item in islice(value.items() if kind is dict else value, LONGEST):
        told = _pair(item, depth) if kind is dict else shown(item, depth + 1)
        text += f", {told}" if text else told
        if len(text) > LONGEST - 2:
            return f"{opening}{text[: LONGEST - 3]}{CUT}{closing}"
    if kind in (set, frozenset) and not text:
        return f"{kind.__name__}()"
    return f"{opening}{text}{',' if kind is tuple and len(value) == 1 else ''}{closing}"


def _pair(item: tuple[object, object], depth: int) -> str:
    return f"{shown(item[0], depth + 1)}: {shown(item[1], depth + 1)}"


class ProgramValues:
    """The variables of a program, and what the calls in its lines gave last.

    ``namespace`` is where the program keeps its variables, once it has begun.
    """

    def __init__(self, names: frozenset[str]) -> None:
        self._names = sorted(names)
        self._told: dict[str, str] = {}
        self._reports: dict[str, object] = {}
        self.namespace: Mapping[str, object] = {}

    def report(self, place: str, value: object) -> None:
        """Note what the call at a place of the file gave."""
        if is_plain(value) and (place in self._reports or len(self._reports) < MOST_REPORTS):
            self._reports[place] = value

    def changed(self) -> dict[str, str]:
        """The values that are not as they were when this was asked last."""
        try:
            now = self._now()
        except RuntimeError:  # a collection grew while it was read: the next time will tell
            return {}
        changed = {name: text for name, text in now.items() if self._told.get(name) != text}
        self._told |= changed
        return changed

    def _now(self) -> dict[str, str]:
        now = {place: shown(value) for place, value in self._reports.copy().items()}
        for name in self._names:
            value = self.namespace.get(name, self)
            if value is not self and (is_plain(value) or name in self._told):
                now[name] = shown(value)
        return now
