"""What the plots show, as it is heard: streams of sensors and fields, and marks of gestures."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, Protocol

import msgspec
import numpy as np
from PySide6.QtCore import QObject, Signal

from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu
from nep_studio.ui.running.runner import Heard, Tap

from .streams import Channel, ImuStream, Stream, StreamKey, imu_key

# The numbers in messages: found by their paths, such as ``joints.HeadYaw``.

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
    numbers = (one for one in _numbers(data, "", 0) if one[0] != "time")
    return dict(islice(numbers, _MOST_FIELDS))


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


MOST_STREAMS = 24
MOST_MARKS = 500
_LATEST_S = 2.0
"""A message that seems to be on its way longer comes from a computer with another time."""
_GESTURE = "gesture_"


class Taps(Protocol):
    """Where topics are heard; the Runner is one."""

    def tap(
        self, topic: str, *, kind: type[Any] | None = None, most: int = 2000, parent: QObject
    ) -> Tap:
        """Hear a topic."""


@dataclass(frozen=True)
class Mark:
    """What a person did, and when (s since 1970)."""

    time_s: float
    words: str


@dataclass(frozen=True)
class Field:
    """A number that is plotted: its topic, and its path in the messages."""

    topic: str
    path: str


class SensorFeed(QObject):
    """Hears sensors and chosen fields while somebody looks, sensors also while they are recorded.

    ``streams_changed`` tells that a stream came or went; ``imu_heard`` gives what sensors sent.
    """

    streams_changed = Signal()
    imu_heard = Signal(list)

    def __init__(self, taps: Taps, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.streams: dict[StreamKey, Stream] = {}
        self.marks: deque[Mark] = deque(maxlen=MOST_MARKS)
        self.fields: list[Field] = []
        self._taps = taps
        self._open: dict[tuple[str, str], Tap] = {}
        self._is_watched = self._is_recorded = self._has_changed = False

    @property
    def topics_heard(self) -> list[str]:
        """What it listens to now."""
        return [topic for _, topic in self._open]

    @property
    def oldest_s(self) -> float:
        """When the oldest sample was measured; infinity when there is none."""
        return min((stream.first_s for stream in self.streams.values()), default=float("inf"))

    @property
    def newest_s(self) -> float:
        """When the newest sample was measured; minus infinity when there is none."""
        return max((stream.last_s for stream in self.streams.values()), default=-float("inf"))

    def watch(self, is_watched: bool) -> None:
        """Hear what is plotted, or not any more."""
        self._is_watched = is_watched
        self._fit_taps()

    def record(self, is_recorded: bool) -> None:
        """Hear sensors whether somebody looks or not."""
        self._is_recorded = is_recorded
        self._fit_taps()

    def plot(self, field: Field) -> None:
        """Plot a number from now on."""
        if field not in self.fields:
            self.fields.append(field)
            self._fit_taps()

    def leave(self, field: Field) -> None:
        """Plot a number no more."""
        if field in self.fields:
            self.fields.remove(field)
        gone = [key for key in self.streams if (key.topic, key.path) == (field.topic, field.path)]
        for key in gone:
            del self.streams[key]
        self._fit_taps()
        if gone:
            self.streams_changed.emit()

    def clear(self) -> None:
        """Forget all samples and marks."""
        self.streams.clear()
        self.marks.clear()
        self.streams_changed.emit()

    def hear_imu(self, batch: Sequence[Heard]) -> None:
        """Take batches of sensors."""
        for heard in batch:
            stream = self._stream(imu_key(heard.message, heard.sender))
            if isinstance(stream, ImuStream):
                had_rotation = stream.has_rotation
                stream.hear(heard.message, _moment(heard))
                self._has_changed |= stream.has_rotation != had_rotation
        self._tell_change()
        self.imu_heard.emit([heard.message for heard in batch])

    def hear_marks(self, batch: Sequence[Heard]) -> None:
        """Take what persons did."""
        self.marks.extend(_mark(heard.message, _moment(heard)) for heard in batch)

    def hear_field(self, topic: str, batch: Sequence[Heard]) -> None:
        """Take messages of a topic, fields of which are plotted."""
        for heard in batch:
            self._take_apart(topic, heard.message)
            for path in [field.path for field in self.fields if field.topic == topic]:
                # The robot that a message tells of, else the node that sent it
                robot = heard.message.get("robot") if isinstance(heard.message, dict) else None
                sender = robot if isinstance(robot, str) else heard.sender
                stream = self._stream(StreamKey(topic, sender, path))
                if isinstance(stream, FieldStream):
                    stream.hear(heard.message, _moment(heard))
        self._tell_change()

    def _take_apart(self, topic: str, message: Any) -> None:
        """Plot the numbers of a field that is a list or a group, in its place."""
        for field in [one for one in self.fields if one.topic == topic]:
            if parts := parts_of(message, field.path):
                place = self.fields.index(field)
                self.fields[place : place + 1] = [Field(topic, path) for path in parts]

    def _stream(self, key: StreamKey) -> Stream:
        if key not in self.streams:
            if len(self.streams) >= MOST_STREAMS:
                del self.streams[min(self.streams, key=lambda one: self.streams[one].last_s)]
            self.streams[key] = FieldStream(key) if key.path else ImuStream(key)
            self._has_changed = True
        return self.streams[key]

    def _tell_change(self) -> None:
        if self._has_changed:
            self._has_changed = False
            self.streams_changed.emit()

    def _fit_taps(self) -> None:
        """Open what is to be heard, close the rest."""
        wanted: set[tuple[str, str]] = set()
        if self._is_watched or self._is_recorded:
            wanted.add(("sensors", IMU))
        if self._is_watched:
            wanted |= {("marks", HUMAN_BEHAVIOR), *(("fields", one.topic) for one in self.fields)}
        for key in self._open.keys() - wanted:
            self._open.pop(key).close()
        for what, topic in wanted - self._open.keys():
            self._open[what, topic] = self._tap(what, topic)

    def _tap(self, what: str, topic: str) -> Tap:
        kinds: dict[str, type[Any] | None] = {"sensors": Imu, "marks": HumanBehavior}
        tap = self._taps.tap(topic, kind=kinds.get(what), parent=self)
        if what == "sensors":
            tap.arrived.connect(self.hear_imu)
        elif what == "marks":
            tap.arrived.connect(self.hear_marks)
        else:
            tap.arrived.connect(lambda batch: self.hear_field(topic, batch))
        return tap


def _moment(heard: Heard) -> float:
    """When a message was sent, by this computer's clock."""
    now_s = time.time()
    return heard.time_s if 0 <= now_s - heard.time_s < _LATEST_S else now_s


def _mark(message: HumanBehavior, time_s: float) -> Mark:
    """A mark such as "karate 93 %"; what is no gesture is certain."""
    name = message.human_state.removeprefix(_GESTURE).replace("_", " ")[:40]
    is_gesture = message.human_state.startswith(_GESTURE)
    return Mark(time_s, f"{name} {message.certainty * 100:.0f} %" if is_gesture else name)
