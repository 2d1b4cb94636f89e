"""Services that look or listen while somebody has subscribed to them."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from robots.body.driver import RobotState, plain
from robots.body.inverse import NECK_M
from robots.body.sense_tasks import forget_all_faces
from robots.body.surroundings import SONAR_RANGE_M
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import CODES, code_of, one_of
from .module import Asked, Module, always, kept

PERIOD_MS = 500
PRECISION = 1.0


class Extractor(Module):
    """A service that tells ALMemory what it notices; ``events`` are the names of these events."""

    events: tuple[str, ...] = ()

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._subscribers: dict[str, tuple[int, float]] = {}
        self._is_paused = False

    @property
    def is_on(self) -> bool:
        """Whether it looks or listens now."""
        return bool(self._subscribers) and not self._is_paused

    def _changed(self) -> None:
        """Do what follows from being on, or not any more."""

    @method("subscribe::v(s)", "subscribe::v(sif)")
    def subscribe(self, name: str, period: int = PERIOD_MS, precision: float = PRECISION) -> None:
        """Begin, for a subscriber who wants news every so many milliseconds."""
        self._subscribers[name] = (period, precision)
        self._changed()

    @method("unsubscribe::v(s)")
    def unsubscribe(self, name: str) -> None:
        """End it for a subscriber."""
        self._subscription(name)
        del self._subscribers[name]
        self._changed()

    @method("updatePeriod::v(si)")
    def update_period(self, name: str, period: int) -> None:
        """Change how often a subscriber wants news."""
        self._subscribers[name] = (period, self._subscription(name)[1])

    @method("updatePrecision::v(sf)")
    def update_precision(self, name: str, precision: float) -> None:
        """Change how exact a subscriber wants the news."""
        self._subscribers[name] = (self._subscription(name)[0], precision)

    @method("getCurrentPeriod::i()")
    def current_period(self) -> int:
        """Return how often it looks, in milliseconds: as often as anybody wants."""
        return min((period for period, _ in self._subscribers.values()), default=PERIOD_MS)

    @method("getCurrentPrecision::f()")
    def current_precision(self) -> float:
        """Return how exact it is."""
        return max((precision for _, precision in self._subscribers.values()), default=PRECISION)

    # How often a subscriber wants news, in milliseconds
    my_period = method("getMyPeriod::i(s)")(lambda self, name: self._subscription(name)[0])
    my_precision = method("getMyPrecision::f(s)")(lambda self, name: self._subscription(name)[1])

    @method("getSubscribersInfo::m()")
    def subscribers_info(self) -> list[list[Any]]:
        """Return the name, period and precision of each subscriber."""
        return [[name, *wanted] for name, wanted in self._subscribers.items()]

    event_list = method("getOutputNames::[s]()", "getEventList::[s]()")(
        lambda self: list(self.events)
    )
    memory_key_list = always([], "getMemoryKeyList::[s]()")  # all that it writes are events

    def _subscription(self, name: str) -> tuple[int, float]:
        if name not in self._subscribers:
            raise CallFailed("{name}: “{name_2}” has not subscribed.", name=self.name, name_2=name)
        return self._subscribers[name]


class PausableExtractor(Extractor):
    """One that can be paused; those of a NAO's eyes also have a camera and its settings."""

    @method("pause::v(b)")
    def pause(self, is_paused: bool) -> None:
        """Pause, or go on."""
        self._is_paused = is_paused
        self._changed()

    paused = method("isPaused::b()")(lambda self: self._is_paused)
    processing = method("isProcessing::b()")(lambda self: self.is_on)


# ALSpeechRecognition: hears the words of a vocabulary.

LISTENING_S = 3600.0
SURE = 0.9
UNSURE = 0.2
"""How sure it is of words that are none of the vocabulary, which it only notices."""
Tell = Callable[[str, Any], None]


class ALSpeechRecognition(PausableExtractor):
    """Listens while somebody has subscribed; what it is told to hear is recognized."""

    events = ("WordRecognized", "LastWordRecognized", "SpeechDetected")
    audio = kept("getAudioExpression::b()", True)

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._words: list[str] = []
        self._is_spotting = False
        self._language = "English"
        self._parameters: dict[str, float] = {"Sensitivity": 0.3}
        self._listening: Asked | None = None

    def hear(self, heard: str, tell: Tell) -> None:
        """Take in what is said, and tell the word of the vocabulary that it is.

        Who spots words in sentences is told of others too, without a word, and as unsure.
        """
        if not self.is_on:
            return
        tell("SpeechDetected", 1)
        words = [word for word in self._words if self._fits(word, heard)]
        if words:
            word = f"<...> {words[0]} <...>" if self._is_spotting else words[0]
            tell("WordRecognized", [word, SURE])
            tell("LastWordRecognized", [word, SURE])
        elif self._is_spotting:
            tell("WordRecognized", ["<...>", UNSURE])
        tell("SpeechDetected", 0)

    @method("setVocabulary::v([s]b)")
    def set_vocabulary(self, words: list[str], spotting: bool) -> None:
        """Choose the words; ``spotting``: also in the middle of a sentence."""
        self._words, self._is_spotting = list(words), spotting
        self._changed()

    @method("setWordListAsVocabulary::v([s])")
    def set_word_list(self, words: list[str]) -> None:
        """Choose the words."""
        self.set_vocabulary(words, False)

    @method("setLanguage::v(s)")
    def set_language(self, language: str) -> None:
        """Choose the language."""
        code_of(language)
        self._language = language

    language = method("getLanguage::s()")(lambda self: self._language)
    available_languages = method("getAvailableLanguages::[s]()")(lambda self: list(CODES))

    set_visual_expression = always(None, "setVisualExpression::v(b)")  # the eyes show nothing

    @method("setParameter::v(sf)")
    def set_parameter(self, name: str, value: float) -> None:
        """Set how it listens, such as Sensitivity."""
        self._parameters[name] = value

    @method("getParameter::f(s)")
    def parameter(self, name: str) -> float:
        """Return how it listens."""
        one_of(name, self._parameters, "There is no parameter “{name}”. Possible: {known}.")
        return self._parameters[name]

    @method("removeAllContext::v()")
    def remove_all_context(self) -> None:
        """Forget the words."""
        self.set_vocabulary([], False)

    def _fits(self, word: str, heard: str) -> bool:
        if self._is_spotting:
            return f" {plain(word)} ".replace("_", " ") in f" {plain(heard)} ".replace("_", " ")
        return plain(word) == plain(heard)

    def _changed(self) -> None:
        """Let the robot listen, so that people see which words it waits for."""
        if self._listening is not None:
            self._listening.stop()
            self._listening = None
        if self.is_on:
            self._listening = Asked(self._robot, "listen", words=self._words, seconds=LISTENING_S)


# The services of eyes and ears: faces, marks, balls, sounds and distances.


class ALFaceDetection(PausableExtractor):
    """Sees faces, and names those of people that it was told."""

    events = ("FaceDetected",)
    recognition = kept("isRecognitionEnabled::b()", True)
    tracking = kept("isTrackingEnabled::b()", False)

    learn_face = method("learnFace::b(s)", "reLearnFace::b(s)")(
        lambda self, name: self._do("learn_face", True, name=name)
    )
    forget_person = method("forgetPerson::b(s)")(
        lambda self, name: self._do("forget_face", True, name=name)
    )

    @method("clearDatabase::b()")
    def clear_database(self) -> bool:
        """Forget all faces that it has learnt."""
        with self._robot.lock:
            forget_all_faces(self._robot.robot)
        return True

    @method("getLearnedFacesList::m()")
    def learned_faces(self) -> list[str]:
        """Return the names of the faces that it has learnt."""
        with self._robot.lock:
            return list(self._robot.robot.faces.learnt.values())


class ALLandMarkDetection(PausableExtractor):
    """Sees the round marks that NAO knows by their numbers."""

    events = ("LandmarkDetected",)


class ALRedBallDetection(Extractor):
    """Sees the red ball."""

    events = ("redBallDetected",)


class ALSoundLocalization(PausableExtractor):
    """Hears where a sound comes from."""

    events = ("ALSoundLocalization/SoundLocated",)

    @method("setParameter::v(sm)")
    def set_parameter(self, name: str, value: Any) -> None:
        """Remember how well it hears: Sensitivity (0 to 1) or EnergyComputation."""
        known = ("Sensitivity", "Sensibility", "EnergyComputation")
        one_of(name, known, "There is no parameter “{name}”. Possible: Sensitivity.")
        self._kept[name] = value


class ALSonar(Extractor):
    """Measures how far things in front of it are."""

    events = (
        "SonarLeftDetected",
        "SonarRightDetected",
        "SonarLeftNothingDetected",
        "SonarRightNothingDetected",
    )

    @method("getFilteredValues::[f]()")
    def filtered_values(self) -> list[float]:
        """Return the distances on the left and on the right, m."""
        sensors = self._robot.state().sensors
        return [sensors.get(f"sonar_{side}", SONAR_RANGE_M) for side in ("left", "right")]


# What NAOqi's events say about faces, balls, marks and sounds, from where they are.

EYES_ABOVE_NECK_M = 0.06
STANDING_TORSO_M = 0.33
FACE_M, BALL_M, MARK_M = 0.16, 0.06, 0.1
"""How large these are."""
TOP_CAMERA = 0
NO_NAME = ""

Place = tuple[float, float, float]


def named(state: RobotState, kind: str) -> dict[str, Place]:
    """Return where things of a kind are that the robot sees, by name; "" has none.

    A thing with a name is also seen without one: then only the name counts.
    """
    found = {
        thing.removeprefix(kind).removeprefix("_"): place
        for thing, place in state.sees.items()
        if thing == kind or thing.startswith(f"{kind}_")
    }
    if len(found) > 1:
        found.pop(NO_NAME, None)
    return found


def faces(state: RobotState) -> list[Any]:
    """Return the value of ``FaceDetected``: empty when there is no face."""
    seen = named(state, "face")
    if not seen:
        return []
    infos: list[Any] = [
        [[0, *_direction(state, place), *_size(state, place, FACE_M)], [number, SURE, name]]
        for number, (name, place) in enumerate(seen.items(), start=1)
    ]
    known = [name for name in seen if name]
    filtered: list[Any] = [4] if not known else [2 if len(known) == 1 else 3, known]
    return [_now(), [*infos, filtered], *_camera(state)]


def marks(state: RobotState) -> list[Any]:
    """Return the value of ``LandmarkDetected``: empty when there is no mark."""
    seen = named(state, "mark")
    if not seen:
        return []
    infos = [
        [[1, *_direction(state, place), *_size(state, place, MARK_M), 0.0], [_mark_number(name)]]
        for name, place in seen.items()
    ]
    return [_now(), infos, *_camera(state)[:2], "CameraTop"]


def ball(state: RobotState) -> list[Any]:
    """Return the value of ``redBallDetected``: empty when there is no ball."""
    place = state.sees.get("ball")
    if place is None:
        return []
    info = [*_direction(state, place), *_size(state, place, BALL_M)]
    return [_now(), info, *_camera(state)]


def sound(state: RobotState) -> list[Any]:
    """Return the value of ``ALSoundLocalization/SoundLocated``: empty when there is no sound."""
    place = state.sees.get("sound")
    if place is None:
        return []
    azimuth, down = _direction(state, place)
    head = _camera(state)
    return [_now(), [azimuth, -down, SURE, 0.5], head[0], head[1]]


def _direction(state: RobotState, place: Place) -> tuple[float, float]:
    """Return how far to the left and down (rad) of where the head points a place is."""
    x, y, z = place
    left = math.atan2(y, x) - state.joints.get("HeadYaw", 0.0)
    down = -math.atan2(z - _eyes_m(state), math.hypot(x, y)) - state.joints.get("HeadPitch", 0.0)
    return left, down


def _size(state: RobotState, place: Place, size_m: float) -> tuple[float, float]:
    """Return how wide and how high (rad) something looks."""
    x, y, z = place
    angle = 2.0 * math.atan2(size_m / 2.0, max(math.hypot(x, y, z - _eyes_m(state)), 0.05))
    return angle, angle


def _camera(state: RobotState) -> list[Any]:
    """Return where the camera is, as x, y, z m and turns rad: from torso and feet; its number."""
    turns = [0.0, state.joints.get("HeadPitch", 0.0), state.joints.get("HeadYaw", 0.0)]
    eyes_m = NECK_M + EYES_ABOVE_NECK_M
    return [[0.0, 0.0, eyes_m, *turns], [0.0, 0.0, _eyes_m(state), *turns], TOP_CAMERA]


def _eyes_m(state: RobotState) -> float:
    torso_m = state.torso[2] if state.torso else STANDING_TORSO_M
    return torso_m + NECK_M + EYES_ABOVE_NECK_M


def _mark_number(name: str) -> int:
    return int(name) if name.isascii() and name.isdigit() else 0


def _now() -> list[int]:
    seconds = time.time()
    return [int(seconds), int(seconds % 1.0 * 1e6)]
