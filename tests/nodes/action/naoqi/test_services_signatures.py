"""Every method of every service against the table of what a NAO offers."""

from __future__ import annotations

from pathlib import Path

import pytest

from nodes.action.naoqi.server import Module
from nodes.action.naoqi.services.all import Services
from nodes.action.naoqi.services.extractor import Extractor
from nodes.action.naoqi.services.module import Module as ServiceModule
from nodes.action.naoqi.wire.service import FIRST_UID, description_of

TABLE = Path(__file__).parent / "robot_signatures.txt"
WANTED = [
    "ALTextToSpeech",
    "ALAnimatedSpeech",
    "ALMotion",
    "ALRobotPosture",
    "ALLeds",
    "ALMemory",
    "ALAnimationPlayer",
    "ALBehaviorManager",
    "ALTracker",
    "ALSpeechRecognition",
    "ALFaceDetection",
    "ALLandMarkDetection",
    "ALRedBallDetection",
    "ALSoundLocalization",
    "ALAudioPlayer",
    "ALAudioDevice",
    "ALTouch",
    "ALBattery",
    "ALSonar",
    "ALBasicAwareness",
    "ALAutonomousLife",
    "ALSpeakingMovement",
    "ALListeningMovement",
    "ALBackgroundMovement",
    "ALAutonomousBlinking",
    "ALPhotoCapture",
    "ALVideoRecorder",
    "ALSystem",
]


def read_table() -> dict[str, set[str]]:
    services: dict[str, set[str]] = {}
    name = ""
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0] == "#":
            continue
        if len(words) == 1 or words[1] == "*":
            name = words[0]
            services[name] = set()
        else:
            services[name].add("::".join(words))
    return services


def all_services() -> dict[str, type[ServiceModule]]:
    assert Services  # every service is known once these are put together
    found: dict[str, type[ServiceModule]] = {}
    waiting = [ServiceModule]
    while waiting:
        for kind in waiting.pop().__subclasses__():
            waiting.append(kind)
            if kind.__name__.startswith("AL"):
                found[kind.__name__] = kind
    return found


def methods_of(kind: type) -> set[str]:
    common = signatures_of(Module)
    return signatures_of(kind) - common


def signatures_of(kind: type) -> set[str]:
    methods = description_of(kind).meta.methods.items()
    return {f"{it.name}::{it.returns}{it.parameters}" for uid, it in methods if uid >= FIRST_UID}


SERVICES = all_services()


def test_every_service_that_programs_use_is_there() -> None:
    missing = [name for name in WANTED if name not in SERVICES]

    assert missing == []


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_a_service_offers_nothing_that_the_robot_does_not_have(name: str) -> None:
    table = read_table()
    kind = SERVICES[name]

    known = table[name] | (table["Extractor"] if issubclass(kind, Extractor) else set())

    assert methods_of(kind) - known == set()


def test_most_of_what_the_robot_has_is_offered() -> None:
    table = read_table()

    offered = {
        name: len(methods_of(SERVICES[name]) & table[name]) / len(table[name])
        for name in ("ALMotion", "ALTextToSpeech", "ALMemory", "ALLeds", "ALRobotPosture")
    }

    assert min(offered.values()) > 0.6, offered
