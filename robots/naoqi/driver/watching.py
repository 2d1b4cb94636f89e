"""What a real robot's state is, and what it feels, sees and hears by itself.

It is looked at again and again: one call for all joints and sensors, a few for how it is set.
Nothing waits: what was asked is taken in when the answer is there.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from robots.body.driver import (
    NOT_UNDERSTOOD,
    plain,
    state_of_thing,
    state_of_word,
    states_of_touch,
)
from robots.body.inverse import from_world, to_world, torso_height_m
from robots.body.surroundings import distance_word
from robots.errors import ActionFailed
from robots.naoqi.wire.errors import NaoqiError
from robots.naoqi.wire.promise import Pending

from . import real
from .moving import RESTING
from .real import CLICKED_EVENT, TOUCH_EVENTS, RealRobot

MOVING_PERIOD_S = 1.0 / 30.0
RESTING_PERIOD_S = 0.15
SLOW_PERIOD_S = 1.0
FROZEN_S = 2.0
"""Who has not told its joints for so long does not answer any more."""
STALL_S = 0.2
"""Who looks again only after so long stood still itself: what came meanwhile is still unread."""

FRAME_WORLD = 1
"""NAOqi's number for where the robot has started."""

TakeIn = Callable[[Any], None]
SETTINGS: tuple[tuple[Any, ...], ...] = (
    ("awake", bool, "ALMotion", "robotIsWakeUp"),
    ("awareness", bool, "ALBasicAwareness", "isEnabled"),
    ("awareness", bool, "ALBasicAwareness", "isAwarenessRunning"),
    ("breathing", bool, "ALMotion", "getBreathEnabled", "Body"),
    ("volume", float, "ALAudioDevice", "getOutputVolume"),
    ("language", real.language_code, "ALTextToSpeech", "getLanguage"),
)
"""How a robot is set, each with how its answer is read, and the call that asks for it."""


class Watching:
    """Keeps the picture of one robot true. ``is_frozen``: it has not answered for too long."""

    def __init__(self, robot: RealRobot) -> None:
        self._robot = robot
        body = robot.known.body
        self._quick, self._slow = real.quick_keys(body), real.slow_keys(body)
        self._asked: list[tuple[Pending, float, TakeIn]] = []
        self._next_quick_s = self._next_slow_s = 0.0
        self._looked_s = time.monotonic()
        self.has_met = False
        """Whether it has told once where its joints are and how it is set."""
        self._has_told_joints = False

    @property
    def is_frozen(self) -> bool:
        """Whether an answer is too late."""
        limit_s = time.monotonic() - FROZEN_S
        return any(asked_s < limit_s for _, asked_s, _ in self._asked)

    def step(self, *, is_moving: bool) -> None:
        """Take in what was answered, and ask what is due."""
        stood_s = time.monotonic() - self._looked_s
        self._looked_s += stood_s
        own_s = stood_s if stood_s > STALL_S else 0.0
        waiting = []
        for pending, asked_s, take_in in self._asked:
            if not pending.done:
                waiting.append((pending, asked_s + own_s, take_in))
                continue
            try:
                take_in(pending.result(0.0))
            except (NaoqiError, TypeError, ValueError, LookupError, ArithmeticError):
                continue  # one robot may not know what another one tells
        self._asked = waiting
        self.has_met = self.has_met or (self._has_told_joints and not self._asked)
        now_s = time.monotonic()
        if self._asked:  # a slow robot is asked less often, not more at once
            return
        if now_s >= self._next_quick_s:
            self._next_quick_s = now_s + (MOVING_PERIOD_S if is_moving else RESTING_PERIOD_S)
            self._ask(self._on_quick, "ALMemory", "getListData", self._quick)
            if is_moving:
                self._ask_place()
        if now_s >= self._next_slow_s:
            self._next_slow_s = now_s + SLOW_PERIOD_S
            settings = self._robot.known.settings
            self._ask(self._on_slow, "ALMemory", "getListData", self._slow)
            self._ask_place()
            self._ask(self._on_posture, "ALRobotPosture", "getPosture")
            for name, read, *call in SETTINGS:
                self._ask(partial(_keep, settings, name, read), *call)

    def _ask_place(self) -> None:
        self._ask(self._on_base, "ALMotion", "getRobotPosition", True)
        self._ask(self._on_torso, "ALMotion", "getPosition", "Torso", FRAME_WORLD, True)

    def _ask(self, take_in: TakeIn, service: str, method: str, *args: Any) -> None:
        if not self._robot.calls.has(service, method):
            return
        try:
            pending = self._robot.calls.begin(service, method, *args)
        except ActionFailed:
            return  # the link is just being lost; who keeps it says so
        self._asked.append((pending, time.monotonic(), take_in))

    def _on_quick(self, values: list[Any]) -> None:
        told = dict(zip(self._quick, values, strict=False))
        body = self._robot.known.body
        self._robot.take_in(real.joint_angles(body, told))
        self._robot.stand_as_told()
        self._robot.sensors |= real.sensors(body, told)
        self._has_told_joints = True

    def _on_slow(self, values: list[Any]) -> None:
        told = dict(zip(self._slow, values, strict=False))
        body, known = self._robot.known.body, self._robot.known
        self._robot.sensors |= real.sensors(body, told)
        loose = real.loose_parts(body, told)
        known.released = frozenset({part for part, is_loose in loose.items() if is_loose}) | (
            known.released - set(loose)
        )
        charge = real.battery(told)
        if charge is not None:
            self._robot.battery = charge
        self._robot.hottest = real.hottest(body, told)

    def _on_base(self, place: list[float]) -> None:
        self._robot.be_at(place)
        self._robot.stand_as_told()

    def _on_torso(self, place: list[float]) -> None:
        x, y, z, roll, pitch, yaw = (float(part) for part in place if math.isfinite(part))
        self._robot.torso = x, y, z, roll, pitch, yaw

    def _on_posture(self, name: Any) -> None:
        known = self._robot.known
        if name in known.body.postures:
            is_resting = known.posture == RESTING and name == "Crouch" and bool(known.released)
            known.posture = RESTING if is_resting else str(name)
            if known.family not in ("", "lying"):
                self._robot.has_fallen = False


# What a real robot feels, sees and hears by itself, as human states and as places on the floor.

FACE, MARK, BALL = "FaceDetected", "LandmarkDetected", "redBallDetected"
SOUND, WORD = "ALSoundLocalization/SoundLocated", "WordRecognized"
FALLEN = "robotHasFallen"
EXTRACTORS = {
    "ALFaceDetection": FACE,
    "ALLandMarkDetection": MARK,
    "ALRedBallDetection": BALL,
    "ALSoundLocalization": SOUND,
    "ALSonar": "",
}
"""What looks and listens only while somebody has subscribed to it, with its event."""
EVENTS = (
    *(event for events in TOUCH_EVENTS.values() for event in events),
    CLICKED_EVENT,
    FACE,
    MARK,
    BALL,
    SOUND,
    WORD,
    FALLEN,
)
SENSOR_OF = {event: name for name, events in TOUCH_EVENTS.items() for event in events}

SURE_WORD = 0.35
"""From this confidence on NAOqi's recognition of a word is taken as heard."""
UNSURE_WORD = 0.15
"""From this one on somebody has said something; below, it may as well be a noise."""
ECHO_S = 0.8
"""So long after a robot has spoken its ears may still be busy with its own words."""
FORGET_S = 2.0
"""What was not seen for so long is not there any more."""
FACE_M, BALL_M, MARK_M = 0.16, 0.06, 0.12
"""How wide these are, about: by that their distance is told."""
SOUND_M = 1.5
NEAREST_M, FARTHEST_M = 0.15, 6.0
UNKNOWN_FACE = ("", "unknown")


class Noticing:
    """Turns events of NAOqi into human states, and keeps what the robot sees and feels."""

    def __init__(self, robot: RealRobot) -> None:
        self._robot = robot
        self.touched: dict[str, float] = {}
        """Our touch sensors, 0 or 1, as far as there was an event of them."""
        self._felt: dict[str, dict[str, float]] = {}
        self._seen_s: dict[str, float] = {}
        self._spoke_s = -math.inf
        """When the robot was last known to speak."""

    def hear(self, event: str, value: Any) -> list[str]:
        """Take in an event; return the human states that follow from it."""
        if event == CLICKED_EVENT:
            return states_of_touch("chest_button")
        if event == FALLEN:
            self._robot.has_fallen = bool(value)
            return []
        if event in SENSOR_OF:
            return self._feel(SENSOR_OF[event], event, value)
        return list(self._see(event, value))

    def forget(self) -> None:
        """Forget what was not seen for a while."""
        if self._robot.known.saying:
            self._spoke_s = time.monotonic()
        limit_s = time.monotonic() - FORGET_S
        for thing in [name for name, seen_s in self._seen_s.items() if seen_s < limit_s]:
            del self._seen_s[thing]
            self._robot.known.sees.pop(thing, None)

    def _feel(self, sensor: str, source: str, value: Any) -> list[str]:
        """One sensor may have several places that tell of it: it is touched while one is."""
        places = self._felt.setdefault(sensor, {})
        places[source] = float(value) if isinstance(value, int | float) else 0.0
        was, now = self.touched.get(sensor, 0.0), max(places.values())
        self.touched[sensor] = 1.0 if now > 0.0 else 0.0
        return states_of_touch(sensor) if now > 0.0 and was <= 0.0 else []

    def _see(self, event: str, value: Any) -> Iterator[str]:
        readers = {
            FACE: self._faces,
            MARK: self._marks,
            BALL: self._ball,
            SOUND: self._sound,
            WORD: self._words,
        }
        try:
            if value and len(value) > 1 and event in readers:
                yield from readers[event](value)
        except (TypeError, ValueError, LookupError, ArithmeticError):
            return  # versions of NAOqi differ: what is not understood is not noticed

    def _faces(self, value: Any) -> Iterator[str]:
        for face in value[1]:
            if not face or not isinstance(face[0], list) or len(face[0]) < 5:
                continue  # the last entry says who was recognised over time
            _, alpha, beta, width, _ = face[0][:5]
            place = self._place(value, alpha, beta, FACE_M, width)
            name = str(face[1][2]) if len(face) > 1 and len(face[1]) > 2 else ""
            yield from self._noticed("face", name if name not in UNKNOWN_FACE else "", place)

    def _marks(self, value: Any) -> Iterator[str]:
        for mark in value[1]:
            _, alpha, beta, width = mark[0][:4]
            place = self._place(value, alpha, beta, MARK_M, width)
            yield from self._noticed("mark", str(int(mark[1][0])), place)

    def _ball(self, value: Any) -> Iterator[str]:
        centre_x, centre_y, width, _ = value[1][:4]
        place = self._place(value, centre_x, centre_y, BALL_M, width)
        yield from self._noticed("ball", "", place)

    def _sound(self, value: Any) -> Iterator[str]:
        azimuth, elevation = (float(angle) for angle in value[1][:2])
        head_pitch, head_yaw = value[2][4:6] if len(value) > 2 and len(value[2]) > 5 else (0.0, 0.0)
        up, yaw = elevation - float(head_pitch), azimuth + float(head_yaw)
        flat = SOUND_M * math.cos(up)
        eyes = torso_height_m(self._robot.known) + 0.13
        place = flat * math.cos(yaw), flat * math.sin(yaw), eyes + SOUND_M * math.sin(up)
        yield from self._noticed("sound", "", place)

    def _words(self, value: Any) -> Iterator[str]:
        word, certainty = str(value[0]), float(value[1])
        words = word.replace("<...>", " ").strip()
        if certainty >= SURE_WORD and plain(words):
            yield state_of_word(words)
        elif certainty >= UNSURE_WORD and self._is_asked():
            yield NOT_UNDERSTOOD

    def _is_asked(self) -> bool:
        """Whether the robot waits for an answer, and does not hear itself."""
        is_quiet = time.monotonic() - self._spoke_s >= ECHO_S
        return bool(self._robot.known.listening) and is_quiet

    def _noticed(self, kind: str, name: str, place: tuple[float, float, float]) -> Iterator[str]:
        if not all(map(math.isfinite, place)):
            return
        known = self._robot.known
        things = [kind, *([f"{kind}_{plain(name)}"] if plain(name) else [])]
        new = [thing for thing in things if thing not in known.sees]
        before = known.sees.get(kind)
        on_floor = to_world(known, place)
        for thing in things:
            known.sees[thing] = on_floor
            self._seen_s[thing] = time.monotonic()
        for thing in reversed(new):
            yield state_of_thing(thing)
        if kind == "face":
            word = distance_word(place)
            if not before or word != distance_word(from_world(known, before)):
                yield f"person_{word}"

    def _place(
        self, value: Any, left: float, down: float, size_m: float, width: float
    ) -> tuple[float, float, float]:
        """Return where something is, from the robot's feet, m.

        It is ``left`` and ``down`` of where the camera looks (rad), which the fourth part of the
        event's value tells; and as far as something of its size looks so wide (rad).
        """
        away = min(max(size_m / max(float(width), 1e-3), NEAREST_M), FARTHEST_M)
        x, y, z, yaw, pitch = self._camera(value[3] if len(value) > 3 else None)
        yaw, pitch = yaw + float(left), pitch + float(down)
        flat = away * math.cos(pitch)
        return x + flat * math.cos(yaw), y + flat * math.sin(yaw), z - away * math.sin(pitch)

    def _camera(self, told: Any) -> tuple[float, float, float, float, float]:
        """Return x, y, z m, yaw and pitch rad, as NAOqi tells them, or else where the head is."""
        if isinstance(told, list | tuple) and len(told) >= 6:
            x, y, z, _, pitch, yaw = (float(part) for part in told[:6])
            return x, y, z, yaw, pitch
        known = self._robot.known
        yaw_column, pitch_column = known.body.head
        eyes = torso_height_m(known) + 0.19
        return 0.05, 0.0, eyes, float(known.angles[yaw_column]), float(known.angles[pitch_column])


def _keep(settings: dict[str, Any], name: str, read: Callable[[Any], Any], value: Any) -> None:
    settings[name] = read(value)
