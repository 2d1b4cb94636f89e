"""What a camera of a virtual robot sees of the things around it, as rows of red, green, blue."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nep_core.messages import Thing
from nodes.action.naobody.body import Camera
from nodes.action.naobody.camera_shapes import Hit, Pixels, ball, box, disc, on_disc, post
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.skeleton import Frames, Points, rotation
from nodes.action.naobody.surroundings import EYES_PART, HALF_VIEW_RAD, looked_at

Picture = NDArray[np.uint8]
Colour = tuple[int, int, int]
Window = tuple[slice, slice]
SIZE = (320, 240)
"""How wide and high a picture is, pixels."""

FLOOR, LINE, HAZE, ABOVE = (196, 190, 178), (150, 144, 132), (222, 226, 230), (150, 185, 220)
GRID_M, LINE_M, HAZY_M = 0.5, 0.006, 8.0
RED, WALL, WHITE, BLACK, STAND = (
    (214, 32, 28),
    (222, 208, 180),
    (245, 245, 245),
    (20, 20, 20),
    (90,) * 3,
)
SKIN, HAIR, SHIRT, TROUSERS = (226, 178, 146), (84, 56, 38), (60, 110, 170), (58, 62, 74)
LIGHT = np.array([-0.35, 0.3, 0.89])
DULL = 0.55
"""So bright is a side that the light does not reach."""
NECK_PART, HIP_PART, HEAD_PART, BODY_PART = 0.84, 0.48, 0.075, 0.4
"""How high on a person, how large its head is, and how much of its width its body's radius."""
EYES_AT = ((0.85, 0.35), (0.85, -0.35))


class _View:
    """A picture that is painted thing by thing; the nearest at each pixel stays."""

    def __init__(self, eye: Points, turn: Frames, size: tuple[int, int]) -> None:
        self.eye, self._turn, self._size = eye, turn, size
        width, height = size
        self._edges = tuple(math.tan(half) for half in HALF_VIEW_RAD)
        left = self._edges[0] * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
        up = self._edges[1] * (1.0 - 2.0 * (np.arange(height) + 0.5) / height)
        rays = np.empty((height, width, 3))
        rays[..., 0], rays[..., 1], rays[..., 2] = 1.0, left[None, :], up[:, None]
        self.rays = (rays @ turn.T).astype(np.float32)
        self.ways = np.full((height, width), np.inf, np.float32)
        self.colours = np.zeros((height, width, 3), np.float32)

    def window(self, centre: Points, radius: float) -> Window | None:
        """Return the part of the picture in which a thing can be; None: it is out of sight."""
        corners = centre - self.eye + radius * _CUBE
        seen = corners @ self._turn
        if seen[:, 0].max() < 0.0:
            return None
        if seen[:, 0].min() < 0.02:
            return slice(None), slice(None)
        parts = []
        for axis, (edge, count) in enumerate(zip(self._edges, self._size, strict=True), start=1):
            at = (1.0 - seen[:, axis] / seen[:, 0] / edge) * count / 2.0
            low, high = max(0, math.floor(at.min())), min(count, math.ceil(at.max()))
            if low >= high:
                return None
            parts.append(slice(low, high))
        return parts[1], parts[0]

    def paint(self, window: Window, hit: Hit, colours: Pixels | Colour) -> None:
        """Paint what is met nearer than all before, brighter where it faces the light."""
        bright = DULL + (1.0 - DULL) * np.clip(hit.faces @ LIGHT, 0.0, 1.0)
        nearer = hit.ways < self.ways[window]
        shaded = np.asarray(colours, np.float32) * bright[..., None]
        self.colours[window][nearer] = shaded[nearer]
        self.ways[window][nearer] = hit.ways[nearer]


_CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)


def picture(robot: VirtualRobot, camera: Camera, size: tuple[int, int] = SIZE) -> Picture:
    """Return what a camera sees now: (rows, columns, 3). The robot's own body is not in it."""
    stance = robot.stance
    eye = stance.link_place("Head", camera.at_m)
    view = _View(eye, stance.link_turn("Head") @ rotation(0.0, camera.down_rad, 0.0), size)
    _paint_room(view)
    for thing in robot.things:
        middle = _above(thing, 0.5 * thing.size[2])
        window = view.window(middle, 0.5 * math.hypot(*thing.size))
        if window:
            _PAINTERS[thing.kind](view, window, thing)
    return np.clip(view.colours, 0, 255).astype(np.uint8)


def _paint_room(view: _View) -> None:
    """Paint a floor with lines, as far as one sees, and what is above it."""
    up = view.rays[..., 2]
    is_floor = up < -1e-4 if view.eye[2] > 0.0 else np.zeros_like(up, bool)
    height = np.clip(up / np.linalg.norm(view.rays, axis=-1), 0.0, 1.0)[..., None]
    view.colours[:] = np.array(HAZE) + height * (np.array(ABOVE) - HAZE)
    rays = view.rays[is_floor]
    ways = np.float32(-view.eye[2]) / rays[:, 2]
    met = view.eye[:2].astype(np.float32) + rays[:, :2] * ways[:, None]
    beside = np.abs(met - np.round(met / GRID_M) * GRID_M).min(axis=-1)
    line = (beside < LINE_M + 0.001 * ways)[:, None] * np.array(LINE, np.float32)
    colours = np.where(line > 0.0, line, np.array(FLOOR, np.float32))
    clear = np.exp(-ways / HAZY_M)[:, None]
    view.colours[is_floor] = colours * clear + np.array(HAZE, np.float32) * (1.0 - clear)
    view.ways[is_floor] = ways


def _paint_ball(view: _View, window: Window, thing: Thing) -> None:
    radius = 0.5 * thing.size[0]
    centre = _above(thing, 0.5 * thing.size[2])
    view.paint(window, ball(view.eye, view.rays[window], centre, radius), RED)


def _paint_wall(view: _View, window: Window, thing: Thing) -> None:
    wide, deep, high = thing.size
    centre = _above(thing, 0.5 * high)
    half = 0.5 * np.array([deep, wide, high])
    view.paint(window, box(view.eye, view.rays[window], centre, thing.heading, half), WALL)


def _paint_mark(view: _View, window: Window, thing: Thing) -> None:
    """Paint a white disc with a black figure, which follows from the mark's number, on a stand."""
    wide, _, high = thing.size
    radius, rays = 0.5 * min(wide, high), view.rays[window]
    centre = _above(thing, high - radius)
    hit = disc(view.eye, rays, centre, thing.heading, radius)
    right, up = np.moveaxis(on_disc(hit, view.eye, rays, centre, thing.heading) / radius, -1, 0)
    eighth = (np.arctan2(up, right) / (0.25 * math.pi)).astype(int) % 8
    way = np.hypot(right, up)
    filled = (sum(thing.name.encode()) >> eighth) & 1
    is_black = (way < 0.25) | ((way > 0.4) & (way < 0.8) & (filled > 0))
    view.paint(window, hit, np.where(is_black[..., None], BLACK, WHITE).astype(np.float32))
    behind = 0.15 * radius * np.array([math.cos(thing.heading), math.sin(thing.heading), 0.0])
    stand = post(view.eye, rays, _above(thing) - behind, high - radius, 0.1 * radius)
    view.paint(window, stand, STAND)


def _paint_person(view: _View, window: Window, thing: Thing) -> None:
    """Paint a person, who bends down to a small robot: as low as the robot takes its face to be."""
    wide, rays = thing.size[0], view.rays[window]
    head = np.array(looked_at(thing, view.eye))
    high = (head[2] - thing.place[2]) / EYES_PART
    body, hip, neck = BODY_PART * wide, HIP_PART * high, NECK_PART * high
    legs = post(view.eye, rays, _above(thing), hip, 0.8 * body)
    view.paint(window, legs, TROUSERS)
    chest_m = max(neck - hip - body, 0.0)
    for shape in (
        post(view.eye, rays, _above(thing, hip), chest_m, body),
        ball(view.eye, rays, _above(thing, hip + chest_m), body),
    ):
        view.paint(window, shape, SHIRT)
    hit = ball(view.eye, rays, head, max(HEAD_PART * thing.size[2], 0.04))
    view.paint(window, hit, _face(hit, thing.heading))


def _face(hit: Hit, heading: float) -> Pixels:
    """Return the colours of a head: hair above and behind, a face with two eyes before."""
    cosine, sine = math.cos(heading), math.sin(heading)
    ahead = hit.faces[..., 0] * cosine + hit.faces[..., 1] * sine
    left = hit.faces[..., 1] * cosine - hit.faces[..., 0] * sine
    up = hit.faces[..., 2]
    is_hair = (up > 0.6) | (ahead < 0.0)
    is_eye = np.zeros_like(is_hair)
    for forward, side in EYES_AT:
        is_eye |= (ahead > forward - 0.2) & (np.hypot(left - side, up - 0.1) < 0.14)
    colours = np.where(is_hair[..., None], np.array(HAIR), np.array(SKIN))
    return np.where(is_eye[..., None], np.array(BLACK), colours).astype(np.float32)


def _above(thing: Thing, up_m: float = 0.0) -> Points:
    x, y, z = thing.place
    return np.array([x, y, z + up_m])


_PAINTERS = {
    "ball": _paint_ball,
    "wall": _paint_wall,
    "mark": _paint_mark,
    "person": _paint_person,
}
