"""The part of Robot that tells what it feels, sees and is doing, and what needs its cameras."""

from __future__ import annotations

import math

from nep_core.robot_requests import RobotRequests
from nep_core.words import plain

CLOSE_M, MIDDLE_M = 1.0, 2.0
TOUCHES = {
    "head": ("head_front", "head_middle", "head_rear"),
    "hand": ("hand_left", "hand_right"),
    "bumper": ("bumper_left", "bumper_right"),
}
"""Parts with several touch sensors."""


class RobotSenses(RobotRequests):
    """What a robot measures; names of sensors are those of ``/robot_state``."""

    def sensor(self, name: str) -> float:
        """What a sensor measures: "sonar_left" in cm, "angle_x" in degrees, "battery" in percent.

        All others in SI units.
        """
        state = self._state()
        if name == "battery":
            return round(state.battery * 100.0, 1)
        value = state.sensors.get(name, 0.0)
        if name.startswith("angle_"):
            return round(math.degrees(value), 1)
        return round(value * 100.0 if name.startswith("sonar") else value, 3)

    def current(self, joint: str) -> float:
        """How much current the motor of a joint takes, in A."""
        return self._state().sensors.get(f"current_{joint}", 0.0)

    def is_touched(self, part: str) -> bool:
        """Whether it is touched now: "head", "head_front", "hand_left", "bumper_right", ..."""
        sensors = self._state().sensors
        return any(sensors.get(name, 0.0) > 0.0 for name in TOUCHES.get(part, (part,)))

    def sees(self, thing: str, name: object = "") -> bool:
        """Whether it sees a "face" (any, or that of a name), "ball" or "mark", or hears a "sound".

        ``name`` of a mark is its number.
        """
        return _key(thing, name) in self._state().sees

    def seen_name(self, thing: str) -> str:
        """The name of the face, or the number of the mark, that it sees; "" when none."""
        names = [key.partition("_")[2] for key in self._state().sees if key.startswith(f"{thing}_")]
        return names[0].replace("_", " ") if names else ""

    def place_of(self, thing: str, measure: str = "distance") -> float:
        """Where something that it sees is; -1 when it sees none.

        ``measure``: "distance" in cm, "left" or "up" in degrees from straight ahead.
        """
        place = self._state().sees.get(_key(thing, ""))
        if place is None:
            return -1.0
        x, y, z = place
        flat = math.hypot(x, y)
        if measure == "left":
            return round(math.degrees(math.atan2(y, x)), 1)
        if measure == "up":
            return round(math.degrees(math.atan2(z - HEAD_UP_M, flat)), 1)
        return round(flat * 100.0, 1)

    def person_is(self, distance: str) -> bool:
        """Whether the person it sees is "close" (under 1 m), "middle" (under 2 m) or "far"."""
        place = self._state().sees.get("face")
        if place is None:
            return False
        way_m = math.hypot(*place[:2])
        return distance == ("close" if way_m < CLOSE_M else "middle" if way_m < MIDDLE_M else "far")

    def is_doing(self, what: str) -> bool:
        """Whether it is "speaking", "moving", "listening", "awake", "breathing", "aware".

        "fallen": it lies because it lost its balance.
        """
        state = self._state()
        if what in ("awake", "breathing"):
            return bool(state.settings.get(what))
        if what == "aware":
            return bool(state.settings.get("awareness"))
        return {
            "speaking": bool(state.saying),
            "moving": state.moving,
            "listening": bool(state.listening),
            "fallen": state.fallen,
        }.get(what, False)

    def is_in(self, posture: str) -> bool:
        """Whether it is in a posture, such as "posture_sit"."""
        return _word(posture) == _word(self._state().posture)

    def posture(self) -> str:
        """The posture that it is in, such as "Stand"."""
        return self._state().posture

    def learn_face(self, name: str) -> None:
        """Learn the face of the person in front of it, under a name."""
        self._perform("learn_face", name=name)

    def forget_face(self, name: str) -> None:
        """Forget a face: who has it is a plain face until it is learnt again."""
        self._perform("forget_face", name=name)

    def take_picture(self, file: str, camera: str = "top") -> None:
        """Take a picture with the "top" or "bottom" camera, into a file on the robot."""
        self._perform("take_picture", file=file, camera=camera)

    def record_video(self, file: str, seconds: float, camera: str = "top") -> None:
        """Record a video for some seconds, into a file on the robot."""
        self._perform("record_video", file=file, seconds=seconds, camera=camera)

    def play_sound(self, file: str) -> None:
        """Play a sound file of the robot, for the one on the screen of this computer."""
        self._perform("play_sound", file=file)


HEAD_UP_M = 0.45
"""How high the eyes of a standing robot are."""


def _key(thing: str, name: object) -> str:
    return "_".join(filter(None, (thing, plain(str(name)))))


def _word(posture: str) -> str:
    letters = "".join(letter for letter in posture if letter.isalnum()).casefold()
    return letters.removeprefix("posture")
