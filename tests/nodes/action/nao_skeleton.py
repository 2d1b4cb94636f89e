"""Where the virtual NAO's hands, feet and head are: forward kinematics from body.json."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

NAO = Path(__file__).resolve().parents[3] / "resources" / "robots" / "nao"
Vector = NDArray[np.float64]
POINTS = {
    "head_top": ("Head", (0.0, 0.0, 0.11)),
    "left_hand": ("L_wrist", (0.07, 0.0, 0.0)),
    "right_hand": ("R_wrist", (0.07, 0.0, 0.0)),
    "left_sole": ("L_ankle", (0.0, 0.0, -0.045)),
    "right_sole": ("R_ankle", (0.0, 0.0, -0.045)),
}


def frames(angles: Vector) -> dict[str, tuple[Vector, Vector]]:
    """Rotation and place (m, torso's frame) of every link, for all joint angles in body order."""
    table = json.loads((NAO / "body.json").read_text())["joints"]
    angle = {joint["name"]: angles[i] for i, joint in enumerate(table)}
    found = {"torso": (np.eye(3), np.zeros(3))}
    waiting = [joint for joint in table if "parent" in joint]
    while waiting:
        joint = waiting.pop(0)
        if joint["parent"] not in found:
            waiting.append(joint)
            continue
        turn, place = found[joint["parent"]]
        own = turn @ rotation(joint["axis"], angle[joint["name"]])
        found[joint["child"]] = (own, place + turn @ np.array(joint["origin_m"]))
    return found


def point(angles: Vector, name: str) -> Vector:
    """A named point of the body: x forward, y left, z up from the torso (m)."""
    link, offset = POINTS[name]
    turn, place = frames(angles)[link]
    return place + turn @ np.array(offset)


def rotation(axis: list[float], angle: float) -> Vector:
    """Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
