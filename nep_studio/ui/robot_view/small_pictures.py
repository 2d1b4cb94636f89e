"""Small pictures of what a robot can do and of things, for lists: drawn once, then kept."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPixmap

from nep_core.errors import NepError
from nep_core.wire.messages import RobotState, Thing, ThingKind
from nep_studio.ui.theme.colours import load_theme
from robots.body.animations import Animation, load_animation
from robots.body.body import Body, posture_name

from .bodies import Bodies, Dress
from .camera import Camera, Frame, Lens, fitted
from .figure import Placed, RobotFigure, load_figure
from .scene import KIND_SIZES, placed_thing, thing_colours
from .shading import Shades
from .view import folder_of

THINGS: dict[str, ThingKind] = {
    "face": "person",
    "person": "person",
    "ball": "ball",
    "mark": "mark",
    "wall": "wall",
}
"""What of a thing stands in the room, by the names that blocks and projects have for it."""

AIR = 0.04
SEEN_FROM = Camera(yaw=0.45, pitch=0.16)
LYING_FROM = Camera(yaw=1.0, pitch=0.35)
USUAL_POSTURE = "Stand"


def small_picture(
    table: str, value: str, *, model: str, theme: str, side: int, ratio: float
) -> QPixmap | None:
    """A picture of a choice by its table ("animations", "postures", "things"), or None.

    ``side`` is how wide and high it is, in pixels of the window; ``theme`` the name of a theme.
    There is none of an animation that the project has itself.
    """
    return _drawn(table, value, folder_of(model), theme, side, ratio)


@lru_cache(maxsize=1024)
def _drawn(
    table: str, value: str, folder: Path, theme: str, side: int, ratio: float
) -> QPixmap | None:
    is_thing = table in ("things", "placed_things")
    found = _thing(value) if is_thing else _robot(table, value, folder)
    if found is None:
        return None
    placed, dress, camera = found
    pixmap = QPixmap(round(side * ratio), round(side * ratio))
    pixmap.setDevicePixelRatio(ratio)
    pixmap.fill(Qt.GlobalColor.transparent)
    camera = fitted(camera, placed.corners(), Frame(side, side), AIR)
    bodies = Bodies.through(Lens(camera, side, side), [(placed, dress)])
    if bodies is not None:
        with QPainter(pixmap) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            bodies.paint(painter, Shades(load_theme(theme)))
    return pixmap


def _thing(name: str) -> tuple[Placed, Dress, Camera] | None:
    kind = THINGS.get(name)
    if kind is None:
        return None
    thing = Thing(id=name, kind=kind, place=(0.0, 0.0, 0.0), size=KIND_SIZES[kind])
    return placed_thing(thing), Dress(thing_colours(kind), {}), SEEN_FROM


def _robot(table: str, value: str, folder: Path) -> tuple[Placed, Dress, Camera] | None:
    figure = load_figure(folder)
    posed = _posed(table, value, folder, figure)
    if posed is None:
        return None
    angles, posture = posed
    state = RobotState(robot="", joints=angles, posture=posture)
    is_upright = figure.body.postures[posture].down[2] < -0.7
    camera = SEEN_FROM if is_upright else LYING_FROM
    return figure.pose(state), Dress(figure.colours, {}), camera


def _posed(
    table: str, value: str, folder: Path, figure: RobotFigure
) -> tuple[dict[str, float], str] | None:
    """The joints and the posture of a choice; None where the robot has no such thing."""
    body = figure.body
    try:
        if table == "postures":
            name = posture_name(body, value)
            return _angles(body, name), name
        animation = _animation(folder, value, figure)
    except NepError:
        return None
    if animation is None:
        return None
    posture = animation.starts_from or USUAL_POSTURE
    return _key_pose(body, posture, animation), posture


def _animation(folder: Path, name: str, figure: RobotFigure) -> Animation | None:
    path = folder / "animations" / f"{name}.toml"
    return load_animation(path, figure.body) if path.is_file() else None


def _angles(body: Body, posture: str) -> dict[str, float]:
    return dict(zip(body.names, map(float, body.posture_angles(posture)), strict=True))


def _key_pose(body: Body, posture: str, animation: Animation) -> dict[str, float]:
    """The pose of an animation that is farthest from that in which it begins: its key pose."""
    rest, tracks = _angles(body, posture), animation.keyframes.tracks
    times = sorted({time for track in tracks.values() for time in track.times})
    poses = [
        {name: float(np.interp(time, track.times, track.keys)) for name, track in tracks.items()}
        for time in times
    ]
    way = [sum(abs(pose[name] - rest.get(name, 0.0)) for name in pose) for pose in poses]
    return rest | poses[int(np.argmax(way))] if poses else rest
