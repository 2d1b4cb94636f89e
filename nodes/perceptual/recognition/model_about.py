"""What a model file tells about itself as JSON: its gestures, sensors, recognisers and report."""

from __future__ import annotations

import json
from typing import Any, Literal

import msgspec

from nep_core.messages import Wrist
from nodes.perceptual.recognition.model import (
    FEATURES,
    HIGHEST_TRIGGER,
    LOWEST_TRIGGER,
    TRIGGER,
    Model,
    Sensor,
)
from nodes.perceptual.recognition.passages import LONGEST_S, SHORTEST_S, is_gesture_name
from nodes.perceptual.recognition.scans import Gesture
from nodes.perceptual.recognition.stream import RATE_HZ

FORMAT = "NEP Studio gesture model"
VERSION = 2
_MAX_GESTURES = 200
MAX_SENSORS = 100
_LONGEST_DEVICE = 200


class AboutRecogniser(msgspec.Struct):
    """A recogniser: its method, what the sensor must have besides acceleration, its features."""

    method: str
    gravity: bool
    gyroscope: bool
    features: Literal[1, 2] = 1

    @property
    def is_known(self) -> bool:
        """Whether it can still be asked: expected curves are others since version 2."""
        return self.features == FEATURES or self.method != "gmr"


class AboutGesture(msgspec.Struct):
    """A gesture as the file tells it."""

    name: str
    shortest_s: float
    typical_s: float
    longest_s: float
    takes: int
    trigger: float = TRIGGER

    def checked(self) -> Gesture:
        """The gesture; ValueError when there can be none like it."""
        rising = SHORTEST_S <= self.shortest_s <= self.typical_s <= self.longest_s <= LONGEST_S
        if not is_gesture_name(self.name):
            raise ValueError(f"a gesture cannot have the name {self.name[:40]!r}")
        if not rising:
            raise ValueError(f'the gesture "{self.name}" cannot last as long as it says')
        if not LOWEST_TRIGGER <= self.trigger <= HIGHEST_TRIGGER:
            raise ValueError(f'the gesture "{self.name}" has an impossible trigger')
        return Gesture(self.name, self.shortest_s, self.typical_s, self.longest_s, self.takes)


class AboutSensor(msgspec.Struct):
    """A sensor that the training had recordings of."""

    device: str
    rate_hz: float
    gravity: bool
    gyroscope: bool

    def checked(self) -> Sensor:
        """The sensor; ValueError when its name cannot be shown."""
        if len(self.device) > _LONGEST_DEVICE or not (self.device + " ").isprintable():
            raise ValueError("a sensor has a name that cannot be shown")
        return Sensor(self.device, self.rate_hz, self.gravity, self.gyroscope)


class About(msgspec.Struct):
    """All that a model file tells in words; what came with version 2 has defaults."""

    rate_hz: float
    units: dict[str, str]
    gestures: list[AboutGesture]
    recognisers: list[AboutRecogniser]
    trained_on: str
    report: dict[str, Any]
    wrist: Wrist = ""
    sensors: list[AboutSensor] = []

    def check(self) -> None:
        """ValueError when there can be no such model."""
        if self.rate_hz != RATE_HZ or not 0 < len(self.gestures) <= _MAX_GESTURES:
            raise ValueError("its rate or its number of gestures is not possible")
        if len({gesture.name for gesture in self.gestures}) < len(self.gestures):
            raise ValueError("two of its gestures have the same name")
        if not self.recognisers:
            raise ValueError("it has no recogniser")
        if len(self.sensors) > MAX_SENSORS:
            raise ValueError("it has more sensors than anybody")


def about_text(model: Model) -> str:
    """What a model's file tells about it, as JSON."""
    about = {
        "format": FORMAT,
        "version": VERSION,
        "rate_hz": RATE_HZ,
        "units": {"acceleration": "m/s²", "angular velocity": "rad/s", "time": "s"},
        "gestures": [
            {**vars(one), "trigger": round(model.triggers[one.name], 4)} for one in model.gestures
        ],
        "recognisers": [
            {"method": one.method, **vars(one.channels), "features": one.features}
            for one in model.recognisers
        ],
        "wrist": model.wrist,
        "sensors": [
            msgspec.to_builtins(AboutSensor(*vars(one).values()))
            for one in model.sensors[:MAX_SENSORS]
        ],
        "trained_on": model.trained_on,
        "report": dict(model.report),
    }
    return json.dumps(about, ensure_ascii=False, indent=1)
