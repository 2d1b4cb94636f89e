"""What a training found out, as data that its views can trust, and the recognition points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import astuple, replace
from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.own_gestures import TRIGGER, OwnGesture, keep_gesture
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.words import tr

NOTHING = ""
"""Stands for no gesture, made or recognised."""
HOUR_S = 3600.0
_NEAR_S = 0.25
"""A take that was left out begins within so much of the take that a person marked."""


class Point(msgspec.Struct, frozen=True):
    """What a certainty, as recognition point of one gesture, catches and what it lets through."""

    certainty: float
    caught: float
    false_per_hour: float = msgspec.field(default=0.0, name="false_everyday_per_hour")
    false_in_others: float = 0.0


class LeftOut(msgspec.Struct, frozen=True):
    """A take that the recogniser had not seen, and what it took it for (NOTHING for none)."""

    gesture: str
    recording: str = msgspec.field(name="source")
    start_s: float
    certainty: float
    recognised: str


class Person(msgspec.Struct, frozen=True):
    """How many of a person's gestures were recognised by what the others taught."""

    made: int
    right: int

    @property
    def share(self) -> float:
        """From 0 to 1."""
        return self.right / self.made if self.made else 0.0


@dataclass(frozen=True)
class Findings:
    """How the takes of each gesture fared when one method of recognition had not seen them.

    ``confusion`` counts pairs (made, recognised); ``takes`` how many each gesture has.
    """

    takes: Mapping[str, int]
    confusion: Mapping[tuple[str, str], int]
    everyday_triggers: int = 0
    everyday_s: float = 0.0
    curves: Mapping[str, tuple[Point, ...]] = field(default_factory=dict)
    left_out: tuple[LeftOut, ...] = ()
    people: Mapping[str, Person] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """The gestures."""
        return tuple(self.takes)

    @property
    def is_checked(self) -> bool:
        """Whether there were enough takes to leave one of each out."""
        return bool(self.takes) and min(self.takes.values()) > 1

    @property
    def made(self) -> int:
        """How many takes were left out once."""
        return sum(count for (made, _), count in self.confusion.items() if made != NOTHING)

    @property
    def right(self) -> int:
        """How many of them were recognised."""
        return sum(self.confusion.get((name, name), 0) for name in self.takes)

    def made_of(self, name: str) -> int:
        """How many takes of a gesture (or, for NOTHING, false triggers) there are."""
        return sum(count for (made, _), count in self.confusion.items() if made == name)

    def found_at(self, name: str, certainty: float) -> Point | None:
        """What a recognition point of a gesture means, between the points that were measured."""
        return between(self.curves.get(name, ()), certainty)


def between(points: tuple[Point, ...], certainty: float) -> Point | None:
    """The curve at a certainty; None when there is none."""
    if not points:
        return None
    columns = list(zip(*map(astuple, points), strict=True))
    return Point(*(float(np.interp(certainty, columns[0], column)) for column in columns))


def findings_of(report: Mapping[str, Any]) -> dict[str, Findings]:
    """The findings by method; a method whose report cannot be read is left out."""
    found = {}
    for method, figures in report.items():
        try:
            found[method] = _findings(msgspec.convert(figures, _Report))
        except (msgspec.ValidationError, ValueError):
            continue
    return found


def id_of_take(left_out: LeftOut, gestures: Mapping[str, OwnGesture]) -> str:
    """The id of the take in the project, "" when it is gone."""
    gesture = gestures.get(left_out.gesture)
    takes = [one for one in gesture.takes if one.recording == left_out.recording] if gesture else []
    near = min(takes, key=lambda one: abs(one.start_s - left_out.start_s), default=None)
    if near is None or abs(near.start_s - left_out.start_s) > _NEAR_S:
        return ""
    return near.id


class _Report(msgspec.Struct):
    takes: dict[str, int]
    confusion: list[tuple[str, str, int]]
    everyday_triggers: int = 0
    everyday_s: float = 0.0
    curves: dict[str, tuple[Point, ...]] = {}
    left_out: tuple[LeftOut, ...] = ()
    people: dict[str, Person] = {}


def _findings(report: _Report) -> Findings:
    return Findings(
        takes=report.takes,
        confusion={(made, found): count for made, found, count in report.confusion},
        everyday_triggers=report.everyday_triggers,
        everyday_s=report.everyday_s,
        curves={
            name: tuple(sorted(points, key=lambda point: point.certainty))
            for name, points in report.curves.items()
        },
        left_out=report.left_out,
        people=report.people,
    )


# What results and try-out share: the recogniser that is looked at, and the recognition points.

METHODS = ("trees", "gmr")
LOWEST, HIGHEST = 0.05, 0.95
"""Between these the certainty of a recognition point is."""


def method_words() -> dict[str, str]:
    """What the recognisers are called, for people."""
    return {
        "trees": tr("Trees, the usual recogniser"),
        "gmr": tr("Expected curves, as in the paper"),
    }


class Tuning(QObject):
    """``point_changed`` gives the gesture whose recognition point is another, also while it is
    dragged; ``method_changed`` tells that another recogniser is looked at.
    """

    point_changed = Signal(str)
    method_changed = Signal()

    def __init__(self, controller: GestureController, parent: QObject) -> None:
        super().__init__(parent)
        self.controller = controller
        self.method = METHODS[0]
        self._dragged: dict[str, float] = {}
        self._read_from: object = None
        self._findings: dict[str, Findings] = {}

    @property
    def findings(self) -> Findings | None:
        """What the last training found out about the recogniser that is looked at."""
        recogniser = self.controller.recogniser
        if recogniser != self._read_from:
            self._read_from = recogniser
            self._findings = findings_of(recogniser.report) if recogniser is not None else {}
        return self._findings.get(self.method)

    @property
    def points(self) -> dict[str, float]:
        """The recognition point of each gesture, as it is now."""
        return {name: self.point(name) for name in self.controller.gestures}

    def point(self, name: str) -> float:
        """The certainty at which a gesture counts as made."""
        gesture = self.controller.gestures.get(name)
        return self._dragged.get(name, gesture.certainty if gesture is not None else TRIGGER)

    @property
    def moved(self) -> frozenset[str]:
        """The gestures whose recognition point is shown elsewhere than the project has it."""
        return frozenset(self._dragged)

    def preview(self, name: str, certainty: float) -> None:
        """Show what another recognition point would do; the project stays as it is."""
        certainty = min(max(round(certainty, 2), LOWEST), HIGHEST)
        if name in self.controller.gestures and certainty != self.point(name):
            self._dragged[name] = certainty
            self.point_changed.emit(name)

    def keep(self, name: str) -> None:
        """Let the project have the recognition point that is shown, as one step."""
        certainty, gesture = self.point(name), self.controller.gestures.get(name)
        self._dragged.pop(name, None)
        if gesture is not None and certainty != gesture.certainty:
            edit = keep_gesture(name, replace(gesture, certainty=certainty))
            self.controller.change("set a recognition point", [edit])
        self.point_changed.emit(name)

    def reset(self, name: str) -> None:
        """Take the usual recognition point."""
        self.preview(name, TRIGGER)
        self.keep(name)

    def use_method(self, method: str) -> None:
        """Look at the other recogniser."""
        if method in METHODS and method != self.method:
            self.method = method
            self.method_changed.emit()
