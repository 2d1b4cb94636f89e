"""What a camera of a virtual robot sees of the things around it, as rows of red, green, blue."""

from __future__ import annotations

import math
import os
import shutil
import struct
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from faults.files import make_privately, whole_file

from .body import Camera
from .driver import Thing
from .kinematics import Frames, Points, rotation, turned
from .pose import VirtualRobot
from .surroundings import EYES_PART, HALF_VIEW_RAD, looked_at

# Where the rays of a camera meet simple shapes: balls, upright posts, boxes and discs.
#
# ``eye`` (3,) is where they begin, ``rays`` (rows, columns, 3) their directions. Places, lengths
# and radii are in m; ``heading`` is how something is turned on the floor, rad.

Pixels = NDArray[np.float32]
"""A number, or several, for each pixel of a picture or of a part of it."""
NEAREST = 1e-3


class Hit(NamedTuple):
    """How many lengths of each ray it is to a shape (inf: not met), and which way it faces there.

    ``ways``: (rows, columns); ``faces``: (rows, columns, 3), of length 1.
    """

    ways: Pixels
    faces: Pixels


def _places(eye: Points, rays: Pixels, ways: Pixels) -> Pixels:
    """Return where rays are after so many of their lengths, seen from a place; 0 for inf."""
    reached = np.where(np.isfinite(ways), ways, 0.0)[..., None]
    return (eye + rays * reached).astype(np.float32)


def _ball(eye: Points, rays: Pixels, centre: Points, radius: float) -> Hit:
    """Return where rays from an eye meet a ball."""
    start = eye - centre
    ways = _first_way(
        (rays**2).sum(-1), (rays @ start).astype(np.float32), float(start @ start) - radius**2
    )
    return Hit(ways, _places(start, rays, ways) / np.float32(radius))


def _post(eye: Points, rays: Pixels, foot: Points, height: float, radius: float) -> Hit:
    """Return where rays from an eye meet a round post; it has no lid."""
    start = eye - foot
    flat, flat_rays = start[:2], rays[..., :2]
    nearness = float(flat @ flat) - radius**2
    ways = _first_way((flat_rays**2).sum(-1), (flat_rays @ flat).astype(np.float32), nearness)
    met = _places(start, rays, ways)
    is_met = (met[..., 2] >= 0.0) & (met[..., 2] <= height)
    met[..., 2] = 0.0
    return Hit(np.where(is_met, ways, np.inf).astype(np.float32), met / np.float32(radius))


def _box(eye: Points, rays: Pixels, centre: Points, heading: float, half: Points) -> Hit:
    """Return where rays from an eye meet a box, half as large as ``half``, turned on the floor."""
    turn = turned(heading)
    start, into = (eye - centre) @ turn, rays @ turn
    safe = np.where(np.abs(into) < 1e-9, 1e-9, into)
    first, last = (-half - start) / safe, (half - start) / safe
    enters = np.minimum(first, last)
    axis = enters.argmax(axis=-1)
    way, leaves = enters.max(axis=-1), np.maximum(first, last).min(axis=-1)
    is_met = (way <= leaves) & (way > NEAREST)
    sides = np.eye(3)[axis] * -np.sign(safe)
    ways = np.where(is_met, way, np.inf).astype(np.float32)
    return Hit(ways, (sides @ turn.T).astype(np.float32))


def _disc(eye: Points, rays: Pixels, centre: Points, heading: float, radius: float) -> Hit:
    """Return where rays from an eye meet an upright disc; it faces where it heads, both sides."""
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    start, towards = eye - centre, rays @ ahead
    safe = np.where(np.abs(towards) < 1e-9, 1e-9, towards)
    ways = (-float(start @ ahead) / safe).astype(np.float32)
    met = _places(start, rays, ways)
    is_met = (ways > NEAREST) & ((met**2).sum(-1) <= radius**2)
    facing = np.broadcast_to(ahead.astype(np.float32), rays.shape)
    return Hit(np.where(is_met, ways, np.inf).astype(np.float32), facing)


def _on_disc(hit: Hit, eye: Points, rays: Pixels, centre: Points, heading: float) -> Pixels:
    """Return where on a disc rays meet it: m to the right of who looks at it, and up."""
    met = _places(eye - centre, rays, hit.ways)
    right = met[..., :2] @ np.array([-math.sin(heading), math.cos(heading)])
    return np.stack([right, met[..., 2]], axis=-1).astype(np.float32)


def _first_way(square: Pixels, towards: Pixels, rest: float) -> Pixels:
    """Solve square * way² + 2 * towards * way + rest = 0 for the first way ahead, or inf."""
    under = towards**2 - square * rest
    with np.errstate(invalid="ignore", divide="ignore"):
        way = (-towards - np.sqrt(under)) / square
    is_met = (under > 0.0) & (way > NEAREST)
    return np.where(is_met, way, np.inf).astype(np.float32)


Picture = NDArray[np.uint8]
"""Rows of red, green, blue: (rows, columns, 3)."""
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
    # Paint a floor with lines, as far as one sees, and what is above it
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
    for thing in robot.things:
        middle = _above(thing, 0.5 * thing.size[2])
        if window := view.window(middle, 0.5 * math.hypot(*thing.size)):
            _PAINTERS[thing.kind](view, window, thing)
    return np.clip(view.colours, 0, 255).astype(np.uint8)


def _paint_ball(view: _View, window: Window, thing: Thing) -> None:
    radius = 0.5 * thing.size[0]
    centre = _above(thing, 0.5 * thing.size[2])
    view.paint(window, _ball(view.eye, view.rays[window], centre, radius), RED)


def _paint_wall(view: _View, window: Window, thing: Thing) -> None:
    wide, deep, high = thing.size
    centre = _above(thing, 0.5 * high)
    half = 0.5 * np.array([deep, wide, high])
    view.paint(window, _box(view.eye, view.rays[window], centre, thing.heading, half), WALL)


def _paint_mark(view: _View, window: Window, thing: Thing) -> None:
    """Paint a white disc with a black figure, which follows from the mark's number, on a stand."""
    wide, _, high = thing.size
    radius, rays = 0.5 * min(wide, high), view.rays[window]
    centre = _above(thing, high - radius)
    hit = _disc(view.eye, rays, centre, thing.heading, radius)
    right, up = np.moveaxis(_on_disc(hit, view.eye, rays, centre, thing.heading) / radius, -1, 0)
    eighth = (np.arctan2(up, right) / (0.25 * math.pi)).astype(int) % 8
    way = np.hypot(right, up)
    filled = (sum(thing.name.encode()) >> eighth) & 1
    is_black = (way < 0.25) | ((way > 0.4) & (way < 0.8) & (filled > 0))
    view.paint(window, hit, np.where(is_black[..., None], BLACK, WHITE).astype(np.float32))
    behind = 0.15 * radius * np.array([math.cos(thing.heading), math.sin(thing.heading), 0.0])
    stand = _post(view.eye, rays, _above(thing) - behind, high - radius, 0.1 * radius)
    view.paint(window, stand, STAND)


def _paint_person(view: _View, window: Window, thing: Thing) -> None:
    """Paint a person, who bends down to a small robot: as low as the robot takes its face to be."""
    wide, rays = thing.size[0], view.rays[window]
    head = np.array(looked_at(thing, view.eye))
    high = (head[2] - thing.place[2]) / EYES_PART
    body, hip, neck = BODY_PART * wide, HIP_PART * high, NECK_PART * high
    legs = _post(view.eye, rays, _above(thing), hip, 0.8 * body)
    view.paint(window, legs, TROUSERS)
    chest_m = max(neck - hip - body, 0.0)
    for shape in (
        _post(view.eye, rays, _above(thing, hip), chest_m, body),
        _ball(view.eye, rays, _above(thing, hip + chest_m), body),
    ):
        view.paint(window, shape, SHIRT)
    hit = _ball(view.eye, rays, head, max(HEAD_PART * thing.size[2], 0.04))
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


_PAINTERS = {"ball": _paint_ball, "wall": _paint_wall, "mark": _paint_mark, "person": _paint_person}


# Writes pictures as PNG files and videos as animated PNG files, which browsers play.

ENDING = ".png"
KNOWN_ENDINGS = (".png", ".apng", ".jpg", ".jpeg", ".bmp", ".avi", ".mp4")
RESERVED = frozenset(
    {"con", "prn", "aux", "nul"} | {f"{d}{n}" for d in ("com", "lpt") for n in range(10)}
)
"""Names that mean devices on Windows."""
LONGEST_NAME_BYTES = 150
SIGNATURE = b"\x89PNG\r\n\x1a\n"
EIGHT_BITS_RGB = (8, 2, 0, 0, 0)
COMPRESSION = 4
UP = 2
"""The PNG filter that keeps how each row differs from the one above it."""
COUNT_AT = len(SIGNATURE) + 25 + 8
"""Where the file of a video says how many frames it has."""
MILLISECONDS = 1000
LONGEST_FRAME_MS = 0xFFFF


def safe_name(name: str, instead: str) -> str:
    """Return a name as a name of a file without folders; ``instead`` is for one that has none."""
    last = name.replace("\\", "/").rsplit("/", 1)[-1].strip()
    stem, dot, ending = last.rpartition(".")
    if f"{dot}{ending.lower()}" in KNOWN_ENDINGS:
        last = stem
    plain = "".join(sign if sign.isalnum() or sign in " -_.()" else "_" for sign in last)
    plain = plain.encode()[:LONGEST_NAME_BYTES].decode(errors="ignore").strip(" .")
    return f"_{plain}" if plain.lower().split(".")[0] in RESERVED else plain or instead


def write_picture(path: Path, picture: Picture) -> None:
    """Write a picture, in the place of an older one. Raises OSError."""
    packed = zlib.compress(_filtered(picture), COMPRESSION)
    parts = [SIGNATURE, _head(picture), _chunk(b"IDAT", packed), _chunk(b"IEND")]
    _replace(path, lambda file: file.writelines(parts))


class VideoFile:
    """A video that grows frame by frame, and is a file at its end. All methods raise OSError."""

    def __init__(self, path: Path) -> None:
        make_privately(path.parent)
        if not os.access(path.parent, os.W_OK):
            raise PermissionError(path.parent)
        self.path = path
        self.frames = 0
        self._chunks = 0
        self._last: tuple[bytes, tuple[int, int]] | None = None
        self._file: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed by end

    def add(self, picture: Picture) -> None:
        """Keep a frame; it is shown until the next one."""
        if not self.frames:
            self._file.write(SIGNATURE + _head(picture) + _chunk(b"acTL", bytes(8)))
        self._last = zlib.compress(_filtered(picture), COMPRESSION), picture.shape[1::-1]

    def show(self, seconds: float) -> None:
        """Say how long the frame that was added last is shown."""
        if self._last is None:
            return
        (packed, (width, height)), self._last = self._last, None
        shown_ms = min(max(1, round(seconds * MILLISECONDS)), LONGEST_FRAME_MS)
        frame = (width, height, 0, 0, shown_ms, MILLISECONDS, 0, 0)
        self._file.write(_chunk(b"fcTL", struct.pack(">5I2H2B", self._number(), *frame)))
        if self.frames:
            self._file.write(_chunk(b"fdAT", struct.pack(">I", self._number()) + packed))
        else:
            self._file.write(_chunk(b"IDAT", packed))
        self.frames += 1

    def end(self) -> None:
        """Make the file of the frames that were shown, in the place of an older one."""
        with self._file as made:
            if self.frames:
                made.write(_chunk(b"IEND"))
                made.seek(COUNT_AT - 8)
                made.write(_chunk(b"acTL", struct.pack(">2I", self.frames, 0)))
                made.seek(0)
                _replace(self.path, lambda file: shutil.copyfileobj(made, file))

    def _number(self) -> int:
        self._chunks += 1
        return self._chunks - 1


def frames_in(path: Path) -> int:
    """Return how many frames the file of a video has. Raises OSError."""
    with path.open("rb") as file:
        file.seek(COUNT_AT)
        return int.from_bytes(file.read(4), "big")


def _replace(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a file beside the place where it goes, so that a broken one never is there."""
    make_privately(path.parent)
    with whole_file(path, is_private=True) as file:
        write(file)


def _filtered(picture: Picture) -> bytes:
    rows = picture.reshape(len(picture), -1)
    filtered = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    filtered[:, 0] = UP
    filtered[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=filtered[1:, 1:])
    return filtered.tobytes()


def _head(picture: Picture) -> bytes:
    height, width = picture.shape[:2]
    return _chunk(b"IHDR", struct.pack(">2I5B", width, height, *EIGHT_BITS_RGB))


def _chunk(kind: bytes, content: bytes = b"") -> bytes:
    check = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)
