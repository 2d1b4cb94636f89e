"""Where the virtual NAO's hands, feet and head are: forward kinematics from body.json."""

from __future__ import annotations

import json
from functools import cache
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
    """Rotation and place (m, torso's frame) of every link, for all joint angles in body order.

    Of one pose (joints,) or of many (poses, joints).
    """
    found = {"torso": (np.eye(3), np.zeros(3))}
    for parent, child, column, axis, origin_m in joints():
        turn, place = found[parent]
        found[child] = (turn @ rotation(axis, angles[..., column]), place + turn @ origin_m)
    return found


@cache
def joints() -> list[tuple[str, str, int, list[float], Vector]]:
    """Parent, child, place in the body's order, axis and origin; parents come first."""
    table = json.loads((NAO / "body.json").read_text())["joints"]
    known, ordered = {"torso"}, []
    waiting = [(column, joint) for column, joint in enumerate(table) if "parent" in joint]
    while waiting:
        column, joint = waiting.pop(0)
        if joint["parent"] not in known:
            waiting.append((column, joint))
            continue
        known.add(joint["child"])
        origin_m = np.array(joint["origin_m"])
        ordered.append((joint["parent"], joint["child"], column, joint["axis"], origin_m))
    return ordered


def point(angles: Vector, name: str) -> Vector:
    """A named point of the body: x forward, y left, z up from the torso (m)."""
    link, offset = POINTS[name]
    turn, place = frames(angles)[link]
    return place + turn @ np.array(offset)


def rotation(axis: list[float], angle: float | Vector) -> Vector:
    """Rodrigues' formula."""
    cross, square = crosses(*axis)
    angle = np.asarray(angle)[..., None, None]
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * square


@cache
def crosses(x: float, y: float, z: float) -> tuple[Vector, Vector]:
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return cross, cross @ cross
