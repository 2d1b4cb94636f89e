"""What a real robot feels, sees and hears by itself, as human states and as places on the floor."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

from robots.body.gaze import to_world, torso_height_m
from robots.body.messages import plain, state_of_thing, state_of_word
from robots.body.surroundings import distance_word

from .real import CLICKED_EVENT, TOUCH_EVENTS, RealRobot

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
        self._touched: dict[str, float] = {}
        self._felt: dict[str, dict[str, float]] = {}
        self._seen_s: dict[str, float] = {}

    @property
    def touched(self) -> dict[str, float]:
        """Our touch sensors, 0 or 1, as far as there was an event of them."""
        return dict(self._touched)

    def hear(self, event: str, value: Any) -> list[str]:
        """Take in an event; return the human states that follow from it."""
        if event == CLICKED_EVENT:
            return _touched("chest_button")
        if event == FALLEN:
            self._robot.has_fallen = bool(value)
            return []
        if event in SENSOR_OF:
            return self._feel(SENSOR_OF[event], event, value)
        return list(self._see(event, value))

    def feel(self, sensor: str, value: float) -> list[str]:
        """Take in what a touch sensor measures; return the human states when that is new."""
        return self._feel(sensor, sensor, value)

    def forget(self) -> None:
        """Forget what was not seen for a while."""
        limit_s = time.monotonic() - FORGET_S
        for thing in [name for name, seen_s in self._seen_s.items() if seen_s < limit_s]:
            del self._seen_s[thing]
            self._robot.known.sees.pop(thing, None)

    def _feel(self, sensor: str, source: str, value: Any) -> list[str]:
        """One sensor may have several places that tell of it: it is touched while one is."""
        places = self._felt.setdefault(sensor, {})
        places[source] = float(value) if isinstance(value, int | float) else 0.0
        was, now = self._touched.get(sensor, 0.0), max(places.values())
        self._touched[sensor] = 1.0 if now > 0.0 else 0.0
        return _touched(sensor) if now > 0.0 and was <= 0.0 else []

    def _see(self, event: str, value: Any) -> Iterator[str]:
        try:
            match event:
                case "FaceDetected":
                    yield from self._faces(value)
                case "LandmarkDetected":
                    yield from self._marks(value)
                case "redBallDetected":
                    yield from self._ball(value)
                case "ALSoundLocalization/SoundLocated":
                    yield from self._sound(value)
                case "WordRecognized":
                    yield from self._words(value)
        except (IndexError, TypeError, ValueError, KeyError):
            return  # versions of NAOqi differ: what is not understood is not noticed

    def _faces(self, value: Any) -> Iterator[str]:
        if not value or len(value) < 2:
            return
        camera = value[3] if len(value) > 3 else None
        for face in value[1]:
            if not face or not isinstance(face[0], list) or len(face[0]) < 5:
                continue  # the last entry says who was recognised over time
            _, alpha, beta, width, _ = face[0][:5]
            place = self._place(camera, alpha, beta, FACE_M, width)
            name = str(face[1][2]) if len(face) > 1 and len(face[1]) > 2 else ""
            yield from self._noticed("face", name if name not in UNKNOWN_FACE else "", place)

    def _marks(self, value: Any) -> Iterator[str]:
        if not value or len(value) < 2:
            return
        camera = value[3] if len(value) > 3 else None
        for mark in value[1]:
            _, alpha, beta, width = mark[0][:4]
            place = self._place(camera, alpha, beta, MARK_M, width)
            yield from self._noticed("mark", str(int(mark[1][0])), place)

    def _ball(self, value: Any) -> Iterator[str]:
        if not value or len(value) < 2:
            return
        centre_x, centre_y, width, _ = value[1][:4]
        camera = value[3] if len(value) > 3 else None
        place = self._place(camera, centre_x, centre_y, BALL_M, width)
        yield from self._noticed("ball", "", place)

    def _sound(self, value: Any) -> Iterator[str]:
        if not value or len(value) < 2:
            return
        azimuth, elevation = (float(angle) for angle in value[1][:2])
        head_yaw = float(value[2][5]) if len(value) > 2 and len(value[2]) > 5 else 0.0
        head_pitch = float(value[2][4]) if len(value) > 2 and len(value[2]) > 5 else 0.0
        up = elevation - head_pitch
        yaw = azimuth + head_yaw
        flat = SOUND_M * math.cos(up)
        eyes = torso_height_m(self._robot.known) + 0.13
        place = flat * math.cos(yaw), flat * math.sin(yaw), eyes + SOUND_M * math.sin(up)
        yield from self._noticed("sound", "", place)

    def _words(self, value: Any) -> Iterator[str]:
        if not value:
            return
        word, certainty = str(value[0]), float(value[1])
        words = word.replace("<...>", " ").strip()
        if certainty >= SURE_WORD and plain(words):
            yield state_of_word(words)

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
            was = distance_word(_from_robot(self._robot, before)) if before else ""
            if word != was:
                yield f"person_{word}"

    def _place(
        self, camera: Any, left: float, down: float, size_m: float, width: float
    ) -> tuple[float, float, float]:
        """Return where something is, from the robot's feet: its direction from the camera (rad),

        its distance by how wide (rad) it looks. ``camera``: x, y, z m and rotations rad, as NAOqi
        tells them; without it, where the head is.
        """
        away = min(max(size_m / max(float(width), 1e-3), NEAREST_M), FARTHEST_M)
        x, y, z, yaw, pitch = self._camera(camera)
        yaw, pitch = yaw + float(left), pitch + float(down)
        flat = away * math.cos(pitch)
        return x + flat * math.cos(yaw), y + flat * math.sin(yaw), z - away * math.sin(pitch)

    def _camera(self, told: Any) -> tuple[float, float, float, float, float]:
        if isinstance(told, list | tuple) and len(told) >= 6:
            x, y, z, _, pitch, yaw = (float(part) for part in told[:6])
            return x, y, z, yaw, pitch
        known = self._robot.known
        yaw_column, pitch_column = known.body.head
        eyes = torso_height_m(known) + 0.19
        return 0.05, 0.0, eyes, float(known.angles[yaw_column]), float(known.angles[pitch_column])


def _from_robot(robot: RealRobot, place: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y = place[0] - float(robot.known.base[0]), place[1] - float(robot.known.base[1])
    return x, y, place[2]


def _touched(sensor: str) -> list[str]:
    """The sensor by itself, then the part of the body that it is on."""
    return [f"touched_{sensor}", f"touched_{sensor.partition('_')[0]}"]
