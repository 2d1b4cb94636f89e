"""Every method of every service against the table of what a NAO offers."""

from __future__ import annotations

from pathlib import Path

import pytest
from services_table import all_services, known_of, methods_of, page, read_table

DOCS = Path(__file__).resolve().parents[3] / "docs"
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
SERVICES = all_services()


def test_every_service_that_programs_use_is_there() -> None:
    missing = [name for name in WANTED if name not in SERVICES]

    assert missing == []


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_a_service_offers_nothing_that_the_robot_does_not_have(name: str) -> None:
    kind = SERVICES[name]

    assert methods_of(kind) - known_of(name, kind) == set()


def test_most_of_what_the_robot_has_is_offered() -> None:
    table = read_table()

    offered = {
        name: len(methods_of(SERVICES[name]) & table[name]) / len(table[name])
        for name in ("ALMotion", "ALTextToSpeech", "ALMemory", "ALLeds", "ALRobotPosture")
    }

    assert min(offered.values()) > 0.6, offered


def test_the_page_about_the_services_is_up_to_date() -> None:
    made = (DOCS / "naoqi_services.md").read_text(encoding="utf-8")

    assert made == page(), "run tools/robot_pages.py services"
