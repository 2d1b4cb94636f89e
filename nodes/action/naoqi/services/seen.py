"""What NAOqi's events say about faces, balls, marks and sounds, from where they are."""

from __future__ import annotations

import math
import time
from typing import Any

from nep_core.messages import RobotState
from nodes.action.naobody.gaze import NECK_M

EYES_ABOVE_NECK_M = 0.06
STANDING_TORSO_M = 0.33
FACE_M, BALL_M, MARK_M = 0.16, 0.06, 0.1
"""How large these are."""
TOP_CAMERA = 0
SURE = 0.9
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
