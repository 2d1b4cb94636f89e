"""All services of one virtual robot, put together."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from robots.body.actor import Actor
from robots.body.driver import ActionResult, RobotState, SenseRequest
from robots.body.pose import VirtualRobot
from robots.naoqi.server.server import Server
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.line import Login

from . import life, media, perception
from .animations import ALAnimationPlayer, ALBehaviorManager, load_animation_names
from .memory import TOUCH_EVENTS, TOUCH_NAMES, ALMemory, keys_of
from .module import Module
from .motion import ALMotion
from .perception import ALSpeechRecognition, Extractor
from .posture import ALRobotPosture, family_of, posture_of
from .speech import ALAnimatedSpeech, ALTextToSpeech
from .tracker import ALTracker

# Raises the events of ALMemory: what the robot feels, sees, hears and does, as it happens.

NEAR_M = 0.5
"""NAOqi tells of something in front of the sonar when it is nearer than this."""
SIGHTS = {
    "FaceDetected": perception.faces,
    "LandmarkDetected": perception.marks,
    "redBallDetected": perception.ball,
    "ALSoundLocalization/SoundLocated": perception.sound,
}
"""What gives the value of each event of what is seen or heard."""
EVENTS = (
    *TOUCH_EVENTS.values(),
    "TouchChanged",
    "PostureChanged",
    "PostureFamilyChanged",
    "BatteryChargeChanged",
    "robotIsWakeUp",
    "robotHasFallen",
    *SIGHTS,
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

    def __init__(self, robot: ServedRobot, modules: Iterable[Module], memory: ALMemory) -> None:
        extractors = [one for one in modules if isinstance(one, Extractor)]
        self._robot = robot
        self._memory = memory
        self._looking = {event: one for one in extractors for event in one.events}
        self._was: dict[str, Any] = {}
        self._next_s: dict[str, float] = {}
        self._sentences = 0
        memory.declare(*EVENTS)

    def notice(self, state: RobotState, now_s: float) -> None:
        """Tell what has changed up to now (s, on any clock)."""
        changed = []
        for sensor, event in TOUCH_EVENTS.items():
            value = state.sensors.get(sensor, 0.0)
            if self._is_new(event, value, at_first=0.0):
                self._memory.tell(event, float(value))
                if sensor in TOUCH_NAMES:
                    changed.append([TOUCH_NAMES[sensor], value > 0.0, []])
        if changed:
            self._memory.tell("TouchChanged", changed)
        self._body(state)
        self._speech(state)
        for side in ("Left", "Right"):
            distance_m = state.sensors.get(f"sonar_{side.lower()}", NEAR_M)
            if self._is_new(f"near {side}", distance_m < NEAR_M, at_first=False):
                word = "Detected" if distance_m < NEAR_M else "NothingDetected"
                if self._wants(f"Sonar{side}{word}"):
                    self._memory.tell(f"Sonar{side}{word}", distance_m)
        for event, look in SIGHTS.items():
            if self._wants(event):
                self._see(event, look(state), now_s)

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

    def _see(self, event: str, value: list[Any], now_s: float) -> None:
        """Tell what is in sight, again and again, and once that it is not any more."""
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


NOTICE_S = 0.04
"""So often what has changed is looked for."""


class Services:
    """The services by name, and what keeps ALMemory up to date."""

    def __init__(self, robot: ServedRobot, folder: Path) -> None:
        """``folder``: where the robot's body and animations are described."""
        self.robot = robot
        names = load_animation_names(folder)
        speech, self._recognition = ALTextToSpeech(robot), ALSpeechRecognition(robot)
        self.memory = ALMemory(robot)
        self.memory.measure(keys_of(robot))
        simple = (
            ALMotion,
            ALRobotPosture,
            media.ALLeds,
            ALTracker,
            perception.ALFaceDetection,
            perception.ALLandMarkDetection,
            perception.ALRedBallDetection,
            perception.ALSoundLocalization,
            perception.ALSonar,
            media.ALAudioPlayer,
            media.ALAudioDevice,
            media.ALPhotoCapture,
            media.ALVideoRecorder,
            life.ALBasicAwareness,
            life.ALAutonomousLife,
            life.ALBackgroundMovement,
            life.ALSpeakingMovement,
            life.ALListeningMovement,
            life.ALAutonomousBlinking,
            life.ALTouch,
            life.ALBattery,
            life.ALBodyTemperature,
            life.ALSystem,
            life.ALRobotModel,
        )
        modules: list[Module] = [
            speech,
            self._recognition,
            self.memory,
            ALAnimatedSpeech(robot, names, lambda: speech.voice),
            ALAnimationPlayer(robot, names),
            ALBehaviorManager(robot, names),
            *(kind(robot) for kind in simple),
        ]
        self.by_name = {module.name: module for module in modules}
        self._feed = MemoryFeed(robot, modules, self.memory)
        self._next_s = 0.0
        self.notice()  # what is so now is no event

    def notice(self) -> None:
        """Tell ALMemory what has changed; call it often."""
        now_s = time.monotonic()
        if now_s >= self._next_s:
            self._next_s = now_s + NOTICE_S
            self._feed.notice(self.robot.state(), now_s)

    def sense(self, request: SenseRequest) -> None:
        """Take in what the robot was told to hear."""
        if request.sense == "word" and request.name:
            self._recognition.hear(request.name, self.memory.tell)


# Offers a virtual robot to NAOqi programs on this computer, while its node lets it live.

LOGIN = "NEP_NAOQI_LOGIN"
"""The variable with the user and password that programs must give: ``nao:secret``."""


class Offered:
    """A robot that NAOqi programs ask, at a port of this computer. Raises PortTaken."""

    is_on = True

    def __init__(self, actor: Actor, robot: VirtualRobot, folder: Path, port: int) -> None:
        """``folder``: where the robot's body is described. ``port`` 0 takes any that is free."""
        self.robot = ServedRobot(actor, robot)
        self.lock: contextlib.AbstractContextManager[object] = self.robot.lock
        self._services = Services(self.robot, folder)
        user, colon, password = os.environ.get(LOGIN, "").partition(":")
        login = Login(user, password) if colon else None
        self._server = Server(self._services.by_name, port=port, login=login)
        self._services.memory.call_module = self._server.tell
        self.port = self._server.start()
        self.description = f"offered to NAOqi programs at tcp://127.0.0.1:{self.port}"

    def hear(
        self, told: Iterable[ActionResult], felt: Sequence[SenseRequest]
    ) -> list[ActionResult]:
        """Tell programs what happened; return the results that others asked for."""
        others = self.robot.hear(told)
        for request in felt:
            self._services.sense(request)
        self._services.notice()
        return others

    def close(self) -> None:
        """End all connections."""
        self._server.stop()
