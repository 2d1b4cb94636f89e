"""Raises the events of ALMemory: what the robot feels, sees, hears and does, as it happens."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nep_core.messages import RobotState, SenseRequest
from nodes.action.naoqi.services import seen
from nodes.action.naoqi.services.extractor import Extractor
from nodes.action.naoqi.services.memory import ALMemory
from nodes.action.naoqi.services.memory_keys import TOUCH_EVENTS, TOUCH_NAMES
from nodes.action.naoqi.services.posture import family_of, posture_of
from nodes.action.naoqi.services.recognition import ALSpeechRecognition
from nodes.action.naoqi.serving import ServedRobot

NEAR_M = 0.5
"""NAOqi tells of something in front of the sonar when it is nearer than this."""
EVENTS = (
    *TOUCH_EVENTS.values(),
    "TouchChanged",
    "PostureChanged",
    "PostureFamilyChanged",
    "BatteryChargeChanged",
    "robotIsWakeUp",
    "robotHasFallen",
    "FaceDetected",
    "LandmarkDetected",
    "redBallDetected",
    "ALSoundLocalization/SoundLocated",
    "WordRecognized",
    "LastWordRecognized",
    "SpeechDetected",
    "ALTextToSpeech/TextStarted",
    "ALTextToSpeech/TextDone",
    "ALTextToSpeech/CurrentSentence",
    "ALTextToSpeech/Status",
)


class MemoryFeed:
    """Compares how the robot is with how it was, and tells the differences."""

    def __init__(
        self,
        robot: ServedRobot,
        memory: ALMemory,
        looking: dict[str, Extractor],
        recognition: ALSpeechRecognition,
    ) -> None:
        self._robot = robot
        self._memory = memory
        self._looking = looking
        self._recognition = recognition
        self._was: dict[str, Any] = {}
        self._next_s: dict[str, float] = {}
        self._sentences = 0
        memory.declare(*EVENTS)

    def notice(self, state: RobotState, now_s: float) -> None:
        """Tell what has changed up to now (s, on any clock)."""
        self._touch(state)
        self._body(state)
        self._speech(state)
        self._sonar(state)
        self._see("FaceDetected", seen.faces, state, now_s)
        self._see("LandmarkDetected", seen.marks, state, now_s)
        self._see("redBallDetected", seen.ball, state, now_s)
        self._see("ALSoundLocalization/SoundLocated", seen.sound, state, now_s)

    def sense(self, request: SenseRequest) -> None:
        """Take in what the robot was told to hear."""
        if request.sense == "word" and request.name:
            self._recognition.hear(request.name, self._memory.tell)

    def _touch(self, state: RobotState) -> None:
        changed = []
        for sensor, event in TOUCH_EVENTS.items():
            value = state.sensors.get(sensor, 0.0)
            if self._is_new(event, value, at_first=0.0):
                self._memory.tell(event, float(value))
                if sensor in TOUCH_NAMES:
                    changed.append([TOUCH_NAMES[sensor], value > 0.0, []])
        if changed:
            self._memory.tell("TouchChanged", changed)

    def _body(self, state: RobotState) -> None:
        robot = self._robot.robot
        self._tell_new("PostureChanged", posture_of(robot))
        self._tell_new("PostureFamilyChanged", family_of(robot))
        self._tell_new("BatteryChargeChanged", round(state.battery * 100))
        self._tell_new("robotIsWakeUp", bool(state.settings["awake"]))
        if self._is_new("robotHasFallen", state.fallen, at_first=False) and state.fallen:
            self._memory.tell("robotHasFallen", True)

    def _speech(self, state: RobotState) -> None:
        if not self._is_new("saying", state.saying, at_first=""):
            return
        is_speaking = bool(state.saying)
        self._sentences += is_speaking
        self._memory.tell("ALTextToSpeech/CurrentSentence", state.saying)
        self._memory.tell("ALTextToSpeech/TextStarted", int(is_speaking))
        self._memory.tell("ALTextToSpeech/TextDone", int(not is_speaking))
        status = "started" if is_speaking else "done"
        self._memory.tell("ALTextToSpeech/Status", [self._sentences, status])

    def _sonar(self, state: RobotState) -> None:
        for side in ("Left", "Right"):
            distance_m = state.sensors.get(f"sonar_{side.lower()}", NEAR_M)
            if self._is_new(f"near {side}", distance_m < NEAR_M, at_first=False):
                word = "Detected" if distance_m < NEAR_M else "NothingDetected"
                if self._wants(f"Sonar{side}{word}"):
                    self._memory.tell(f"Sonar{side}{word}", distance_m)

    def _see(
        self, event: str, look: Callable[[RobotState], list[Any]], state: RobotState, now_s: float
    ) -> None:
        """Tell what is in sight, again and again, and once that it is not any more."""
        if not self._wants(event):
            return
        value = look(state)
        was_there = self._was.get(event, False)
        if value and now_s >= self._next_s.get(event, now_s):
            extractor = self._looking.get(event)
            period_ms = extractor.current_period() if extractor else 500
            self._next_s[event] = now_s + period_ms / 1000.0
            self._memory.tell(event, value)
        elif was_there and not value:
            self._next_s.pop(event, None)
            self._memory.tell(event, [])
        self._was[event] = bool(value)

    def _wants(self, event: str) -> bool:
        extractor = self._looking.get(event)
        return (extractor is not None and extractor.is_on) or self._memory.is_wanted(event)

    def _tell_new(self, event: str, value: Any) -> None:
        is_first = event not in self._was
        if self._is_new(event, value, at_first=value) and not is_first:
            self._memory.tell(event, value)

    def _is_new(self, what: str, value: Any, *, at_first: Any) -> bool:
        was = self._was.get(what, at_first)
        self._was[what] = value
        return bool(was != value)
