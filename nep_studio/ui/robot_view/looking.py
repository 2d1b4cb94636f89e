"""From where a scene is seen well: all of it, or the face of its first robot."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .camera import Camera, Frame, fitted
from .scene import FloorPlace, Scene, SceneRobot
from .things import placed_thing

Array = NDArray[np.float64]
AIR = 0.1
NEAR_M = 1.6
"""Things that are so near to a robot are seen with it."""
FACE_BOX = np.array([(x, y, z) for x in (-0.4, 0.5) for y in (-0.62, 0.62) for z in (-0.56, 0.56)])
"""What is seen around the middle of a head, in its heights."""


def seeing_all(camera: Camera, scene: Scene, frame: Frame) -> Camera:
    """Return the camera moved so that all robots and what stands near them are seen."""
    placed = [robot.placed for robot in scene.robots]
    places = [robot.state.base[:2] for robot in scene.robots]
    placed += [
        placed_thing(thing)
        for thing in scene.things
        if any(math.dist(thing.place[:2], place) < NEAR_M for place in places)
    ]
    if not placed:
        return camera
    corners = np.concatenate([one.corners() for one in placed])
    return fitted(camera, corners, frame, AIR)


def at_face(camera: Camera, scene: Scene, frame: Frame) -> Camera:
    """Return the camera moved so that the first robot's head fills the picture."""
    if not scene.robots:
        return camera
    places = head_of(scene.robots[0]) + FACE_BOX * scene.robots[0].figure.top_m
    return fitted(camera, places, frame, AIR)


def ahead_of(scene: Scene) -> float:
    """Which way the first robot faces (rad)."""
    if not scene.robots:
        return 0.0
    torso = scene.robots[0].placed.links["torso"]
    return math.atan2(torso[1, 0], torso[0, 0])


def at_floor_of(scene: Scene) -> FloorPlace:
    """Where a robot that is alone stands."""
    return scene.robots[0].state.base[:2] if len(scene.robots) == 1 else (0.0, 0.0)


def head_of(robot: SceneRobot) -> Array:
    """The middle of a robot's head, in the room."""
    frame = robot.placed.links[robot.figure.head]
    place: Array = frame[:3, 3] + frame[:3, 2] * robot.figure.top_m / 2
    return place
