"""All services of one virtual robot, put together."""

from __future__ import annotations

import time
from pathlib import Path

from nep_core.messages import SenseRequest
from nodes.action.naoqi.services import body_services, cameras, life, senses, sound
from nodes.action.naoqi.services.animated_speech import ALAnimatedSpeech
from nodes.action.naoqi.services.animation_names import load_animation_names
from nodes.action.naoqi.services.animation_player import ALAnimationPlayer, ALBehaviorManager
from nodes.action.naoqi.services.extractor import Extractor
from nodes.action.naoqi.services.lights import ALLeds
from nodes.action.naoqi.services.memory import ALMemory
from nodes.action.naoqi.services.memory_feed import MemoryFeed
from nodes.action.naoqi.services.memory_keys import keys_of
from nodes.action.naoqi.services.module import Module
from nodes.action.naoqi.services.motion import ALMotion
from nodes.action.naoqi.services.posture import ALRobotPosture
from nodes.action.naoqi.services.recognition import ALSpeechRecognition
from nodes.action.naoqi.services.speech import ALTextToSpeech
from nodes.action.naoqi.services.tracker import ALTracker
from nodes.action.naoqi.serving import ServedRobot

NOTICE_S = 0.04
"""So often what has changed is looked for."""


class Services:
    """The services by name, and what keeps ALMemory up to date."""

    def __init__(self, robot: ServedRobot, folder: Path) -> None:
        """``folder``: where the robot's body and animations are described."""
        self.robot = robot
        names = load_animation_names(folder)
        speech = ALTextToSpeech(robot)
        self.memory = ALMemory(robot)
        self.memory.measure(keys_of(robot))
        simple = (
            ALMotion,
            ALRobotPosture,
            ALLeds,
            ALTracker,
            ALSpeechRecognition,
            senses.ALFaceDetection,
            senses.ALLandMarkDetection,
            senses.ALRedBallDetection,
            senses.ALSoundLocalization,
            senses.ALSonar,
            sound.ALAudioPlayer,
            sound.ALAudioDevice,
            cameras.ALPhotoCapture,
            cameras.ALVideoRecorder,
            life.ALBasicAwareness,
            life.ALAutonomousLife,
            life.ALBackgroundMovement,
            life.ALSpeakingMovement,
            life.ALListeningMovement,
            life.ALAutonomousBlinking,
            body_services.ALTouch,
            body_services.ALBattery,
            body_services.ALBodyTemperature,
            body_services.ALSystem,
            body_services.ALRobotModel,
        )
        modules: list[Module] = [
            speech,
            self.memory,
            ALAnimatedSpeech(robot, names, lambda: speech.voice),
            ALAnimationPlayer(robot, names),
            ALBehaviorManager(robot, names),
            *(kind(robot) for kind in simple),
        ]
        self.by_name = {module.name: module for module in modules}
        self._feed = self._make_feed()
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
        self._feed.sense(request)

    def _make_feed(self) -> MemoryFeed:
        extractors = [one for one in self.by_name.values() if isinstance(one, Extractor)]
        looking = {event: one for one in extractors for event in one.events}
        recognition = self.by_name["ALSpeechRecognition"]
        assert isinstance(recognition, ALSpeechRecognition)
        return MemoryFeed(self.robot, self.memory, looking, recognition)
