"""Any call that fits its signature ends with a value or a sentence, and the robot lives on."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed, NaoqiError
from robots.naoqi.wire.metaobject import Signature
from robots.naoqi.wire.service import FIRST_UID, description_of

pytestmark = pytest.mark.long

TEXTS = [
    "HeadYaw",
    "Body",
    "LArm",
    "red",
    "FaceLeds",
    "",
    "Stand",
    "Sit",
    "Face",
    "RHand",
    "é" * 40,
]
NUMBERS = [0.0, 1.0, -1.0, 0.5, 1e9, -1e9, 0.01, math.inf, math.nan, 100.0]
LEFT_OUT = ("pCall", "__pCall", "wait", "exit")
CALLS = 400
CANNOT = ("stopRecording",)
"""What is refused, since nothing is recorded."""


class Chance:
    """Makes arguments for a signature."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def arguments(self, parameters: str) -> list[Any]:
        self._left = list(parameters[1:-1])
        values = []
        while self._left:
            values.append(self._next())
        return values

    def _next(self) -> Any:
        kind = self._left.pop(0)
        if kind == "[":
            value = self._next()
            self._left.pop(0)
            return [value] * self.random.randrange(4)
        if kind == "{":
            key, value = self._next(), self._next()
            self._left.pop(0)
            return {key: value}
        return self._value(kind)

    def _value(self, kind: str, depth: int = 0) -> Any:
        if kind == "s":
            return self.random.choice(TEXTS)
        if kind == "b":
            return self.random.random() < 0.5
        if kind in "iI":
            return self.random.choice([0, 1, 2, 3, 100, 2**31 - 1])
        if kind == "f" or depth > 2:
            return self.random.choice(NUMBERS)
        inner = [lambda: self._value("m", depth + 1) for _ in range(self.random.randrange(4))]
        return self.random.choice(
            [
                lambda: self._value("s"),
                lambda: self._value("f"),
                lambda: {self._value("s"): self._value("m", depth + 1)},
                lambda: [one() for one in inner],
            ]
        )()


def all_methods(theatre: NaoqiTheatre) -> list[tuple[str, Signature]]:
    services = theatre.offered._services.by_name
    return [
        (name, signature)
        for name, service in services.items()
        for uid, signature in description_of(type(service)).meta.methods.items()
        if uid >= FIRST_UID and signature.name not in LEFT_OUT
    ]


@pytest.mark.parametrize("seed", range(3))
def test_no_call_of_a_method_harms_the_robot(seed: int, caplog: pytest.LogCaptureFixture) -> None:
    theatre, chance = NaoqiTheatre(speed=50), Chance(seed)
    methods = all_methods(theatre)
    unclear = []

    for number in range(CALLS):
        service, signature = chance.random.choice(methods)
        arguments = chance.arguments(signature.parameters)
        try:
            pending = theatre.service(service).begin(signature.name, *arguments)
        except NaoqiError:
            continue  # the client saw that it does not fit
        pending.wait(0.02)
        if pending.done and isinstance(pending.failure, CallFailed):
            sentence = str(pending.failure.sentence)
            if not sentence.strip().endswith((".", ")")) or "Traceback" in sentence:
                unclear.append((service, str(signature), arguments, sentence))
        if number % 40 == 39:
            theatre.call("ALMotion", "killAll")
            theatre.call("ALTextToSpeech", "stopAll")

    theatre.call("ALMotion", "killAll")
    assert theatre.call("ALMotion", "getAngles", "Body", True)
    theatre.close()
    assert unclear == []
    assert [record.message for record in caplog.records if record.levelname == "ERROR"] == []


def test_everything_that_can_be_read_without_arguments_has_the_type_that_it_says(
    caplog: pytest.LogCaptureFixture,
) -> None:
    theatre = NaoqiTheatre(speed=50)
    readable = [
        (service, signature)
        for service, signature in all_methods(theatre)
        if signature.parameters == "()" and signature.returns != "v"
    ]

    values = {
        (service, signature.name): theatre.call(service, signature.name)
        for service, signature in readable
        if signature.name not in CANNOT
    }

    theatre.close()
    assert len(values) > 120
    assert [record.message for record in caplog.records if record.levelname == "ERROR"] == []
