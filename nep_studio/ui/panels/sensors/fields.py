"""The numbers in messages: found by their paths, such as ``joints.HeadYaw``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import msgspec
import numpy as np

from nep_studio.ui.panels.sensors.streams import Channel, Stream, StreamKey

KEPT = 20_000
"""The newest values that are kept of a field."""

_MOST_ITEMS = 32
_MOST_FIELDS = 500
_MOST_DEEP = 6
_MOST_PARTS = 6
_GAP_S, _GAP_STEPS = 5.0, 8.0
"""Silence is a gap when it is longer than both."""


def numbers_in(message: Any) -> dict[str, float]:
    """All numbers of a message by their paths; yes and no are 1 and 0, times of sending left out.

    Of long lists, deep groups and very large messages only the first numbers are given.
    """
    data = msgspec.to_builtins(message) if isinstance(message, msgspec.Struct) else message
    found: dict[str, float] = {}
    for path, value in _numbers(data, "", 0):
        if len(found) >= _MOST_FIELDS:
            break
        if path != "time":
            found[path] = value
    return found


def number_at(message: Any, path: str) -> float | None:
    """The number at a path; None when there is none."""
    value = message
    for part in path.split("."):
        if isinstance(value, Mapping) and part in value:
            value = value[part]
        elif isinstance(value, list | tuple) and part.isdecimal() and int(part) < len(value):
            value = value[int(part)]
        else:
            return numbers_in(message).get(path)  # a key may have a dot in it
    return _number(value)


def parts_of(message: Any, path: str) -> list[str]:
    """The paths of the first numbers in the list or group at a path; none of a number."""
    if number_at(message, path) is not None:
        return []
    inside = [one for one in numbers_in(message) if one.startswith(f"{path}.")]
    return inside[:_MOST_PARTS]


def _numbers(value: Any, path: str, depth: int) -> Iterator[tuple[str, float]]:
    number = _number(value)
    if number is not None:
        yield path or "value", number
    elif depth < _MOST_DEEP:
        for key, item in _items(value):
            yield from _numbers(item, f"{path}.{key}" if path else str(key), depth + 1)


def _items(value: Any) -> Iterator[tuple[object, Any]]:
    if isinstance(value, Mapping):
        yield from value.items()
    elif isinstance(value, list | tuple):
        yield from enumerate(value[:_MOST_ITEMS])


def _number(value: Any) -> float | None:
    if not isinstance(value, bool | int | float):
        return None
    try:
        number = float(value)
    except OverflowError:  # a whole number may have any length
        return None
    return number if math.isfinite(number) else None


class FieldStream(Stream):
    """The values of one field of a topic, as they came."""

    def __init__(self, key: StreamKey, capacity: int = KEPT) -> None:
        group, _, name = key.path.rpartition(".")
        is_joint = group == "joints"
        unit, shared = ("rad", group) if is_joint else ("", key.path)
        super().__init__(key, (Channel(name, unit, shared),), capacity)
        self._step_s = 0.0

    def hear(self, message: Any, arrived_s: float) -> None:
        """Take a message; one without the field is left out."""
        number = number_at(message, self.key.path)
        if number is None:
            return
        step_s = arrived_s - self.last_s
        if step_s <= 0:
            return
        is_late = bool(self._step_s and step_s > max(_GAP_S, _GAP_STEPS * self._step_s))
        if np.isfinite(step_s) and not is_late:
            self._step_s = step_s if not self._step_s else 0.9 * self._step_s + 0.1 * step_s
        self.add(np.array([arrived_s]), np.array([[number]]), is_after_gap=is_late)
