"""What a robot looks like, as data: the parts in the ``view.toml`` of its folder."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from faults.files import read_toml
from nep_core.errors import NodeStartError
from robots.body.kinematics import rotation as turned_by

# Rounded convex shapes in numpy: how far they reach in any direction.
#
# A part of a robot is the hull of a few superellipsoids (:class:`Solids`). Its farthest point in a
# direction has a closed form, which gives smooth outlines for painting and meshes with exact
# normals.

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Blob:
    """One superellipsoid along the axes of its part; m.

    The powers say how round it is across its z axis and along it: 2 round, 4 a soft box, 8 a box.
    """

    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    size: tuple[float, float, float] = (0.01, 0.01, 0.01)
    powers: tuple[float, float] = (2.0, 2.0)


@dataclass(frozen=True, eq=False)
class Solids:
    """The shapes of some parts, each the hull of the blobs that have its number in ``owner``."""

    owner: Indices
    centre: Array
    size: Array
    powers: Array
    table: Indices = field(repr=False)
    """Blobs by part, (parts, most blobs of a part); short rows repeat their last blob."""
    middle: Array = field(repr=False)
    extent: Array = field(repr=False)
    """The middle and the half lengths of the box around each part, along its axes."""

    @classmethod
    def of(cls, parts: Sequence[Sequence[Blob]]) -> Solids:
        """Put the blobs of parts into arrays."""
        blobs = [blob for part in parts for blob in part]
        owner = np.array([i for i, part in enumerate(parts) for _ in part], dtype=np.intp)
        centre = np.array([blob.at for blob in blobs], dtype=np.float64).reshape(-1, 3)
        size = np.array([blob.size for blob in blobs], dtype=np.float64).reshape(-1, 3)
        powers = np.array([blob.powers for blob in blobs], dtype=np.float64).reshape(-1, 2)
        return cls.boxed(owner, centre, size, powers, len(parts))

    @classmethod
    def joined(cls, many: Sequence[Solids]) -> Solids:
        """All parts of several, one after the other."""
        starts = np.cumsum([0, *(len(one.middle) for one in many)])
        owner = np.concatenate(
            [one.owner + start for one, start in zip(many, starts, strict=False)]
        )
        centre, size, powers = (
            np.concatenate([getattr(one, name) for one in many])
            for name in ("centre", "size", "powers")
        )
        return cls.boxed(owner, centre, size, powers, int(starts[-1]))

    def scaled(self, scale: Array) -> Solids:
        """The shapes longer by these factors (3,) along their axes."""
        parts = (self.centre * scale, self.size * scale, self.powers)
        return self.boxed(self.owner, *parts, len(self.middle))

    @classmethod
    def boxed(cls, owner: Indices, centre: Array, size: Array, powers: Array, count: int) -> Solids:
        """Put so many parts that are in arrays already into their boxes."""
        first = np.searchsorted(owner, np.arange(count))
        counts = np.bincount(owner, minlength=count)
        most = int(counts.max(initial=1))
        table = first[:, None] + np.minimum(np.arange(most), counts[:, None] - 1)
        low = (centre - size)[table].min(axis=1)
        high = (centre + size)[table].max(axis=1)
        return cls(owner, centre, size, powers, table, (low + high) / 2, (high - low) / 2)

    def farthest(self, directions: Array) -> Array:
        """The farthest points (parts, k, 3) in directions (parts, k, 3), along each part's axes."""
        ways = directions[self.owner]
        points = np.empty_like(ways)
        is_round = (self.powers == 2.0).all(axis=1)
        size = self.size[is_round][:, None]
        stretched = ways[is_round] * size
        length = np.sqrt(np.einsum("mkc,mkc->mk", stretched, stretched))
        points[is_round] = stretched * size / np.maximum(length, 1e-12)[..., None]
        edged = ~is_round
        # Superellipsoids |(|x/a|^p + |y/b|^p)^(1/p)|^r + |z/c|^r = 1; p, r are the powers.
        powers, size = self.powers[edged], self.size[edged][:, None]
        across, along = np.moveaxis(powers / (powers - 1), 1, 0)[..., None]
        x, y, z = np.moveaxis(np.abs(ways[edged]) * size + 1e-12, 2, 0)
        part_x, part_y, part_z = x**across, y**across, z**along
        both = part_x + part_y
        flat = both ** (along / across)
        whole = (flat + part_z) ** (1 - 1 / along)
        shared = flat / (both * whole)
        point = np.stack([part_x * shared / x, part_y * shared / y, part_z / (whole * z)], axis=2)
        points[edged] = point * np.sign(ways[edged]) * size
        points += self.centre[:, None]
        if self.table.shape[1] == 1:
            return points
        reach = np.einsum("mkc,mkc->mk", points, ways)
        best = np.argmax(reach[self.table], axis=1)
        chosen = np.take_along_axis(self.table, best, axis=1)
        return points[chosen, np.arange(ways.shape[1])]


Triple = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0)]
VIEW_FILE = "view.toml"
UP = np.array([0.0, 0.0, 1.0])
MIRRORED_WORDS = (("Left", "Right"), ("left", "right"))


Finish = Literal["satin", "matte", "flat"]


class Hinge(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part that a joint outside of the skeleton turns: a finger, closed at 0 and open at 1."""

    joint: str
    at: Triple
    axis: Triple
    closed_deg: float
    open_deg: float = 0.0


class Repeat(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Copies of a part round an axis, the first where the part is; {n} in its texts counts."""

    count: Annotated[int, Meta(ge=1, le=64)]
    at: Triple
    axis: Triple
    step_deg: float
    first: int = 0


class Slice(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of a hull: a superellipsoid; sizes are half lengths in m."""

    at: Triple = (0.0, 0.0, 0.0)
    size: tuple[Positive, Positive, Positive] = (0.01, 0.01, 0.01)
    across: Annotated[float, Meta(gt=1)] = 2.0
    along: Annotated[float, Meta(gt=1)] = 2.0


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One part of a robot, at ``at`` of its link, turned by ``turn`` (degrees about x, y, z).

    Shapes: ``ball`` and ``box`` of half lengths ``size``; ``rod`` from ``at`` to ``to`` with the
    ``radii`` of its ends; ``disc`` of half width, height and thickness ``size`` that faces
    ``facing``; ``lathe`` round ``facing``, of (distance, radius) rows; ``hull`` round slices.

    ``light`` is the light that colours it, ``group`` the light that stands for it if that one is
    not told. ``sensor`` is what a click on it touches. A part that lies ``on`` another one is
    drawn over it, and only seen from the side of ``facing`` (its own z axis where not told).
    ``gloss``: it shines. ``finish``: ``matte`` has little shade, ``flat`` none and no rim.
    """

    name: str
    link: str
    colour: str
    shape: Literal["ball", "box", "rod", "disc", "lathe", "hull"]
    at: Triple = (0.0, 0.0, 0.0)
    size: tuple[Positive, Positive, Positive] = (0.01, 0.01, 0.01)
    turn: Triple = (0.0, 0.0, 0.0)
    across: float = 0.0
    along: float = 0.0
    to: Triple = (0.0, 0.0, 0.0)
    radii: tuple[Positive, Positive] = (0.01, 0.01)
    facing: Triple = (0.0, 0.0, 0.0)
    profile: tuple[tuple[float, Positive], ...] = ()
    slices: tuple[Slice, ...] = ()
    on: str = ""
    light: str = ""
    group: str = ""
    sensor: str = ""
    gloss: float = 0.0
    finish: Finish = "satin"
    mirror: bool = False
    hinge: Hinge | None = None
    repeat: Repeat | None = None


class ViewFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A whole ``view.toml``: the colours by name, the parts, and where the head is for bubbles."""

    colours: dict[str, str]
    part: tuple[Part, ...]
    head: str = "Head"
    top_m: float = 0.13
    stretches: bool = False
    """A thing's lengths are shares of its depth, width and height; else of its height."""


class Shaped(msgspec.Struct, frozen=True):
    """A part ready to be placed: its blobs along its own axes, which ``turn`` turns (3, 3)."""

    part: Part
    at: Triple
    turn: Any
    normal: Any
    """Where it faces, along its own axes."""
    blobs: tuple[Blob, ...]


def read_view(path: Path) -> ViewFile:
    """Read how a robot or a thing looks. Raises NodeStartError when it cannot be used."""
    try:
        view = msgspec.convert(read_toml(path), ViewFile)
        names = {part.name for part in view.part}
        for part in view.part:
            if part.colour not in view.colours:
                raise ValueError(f"part {part.name}: there is no colour {part.colour}")
            if part.on and part.on not in names:
                raise ValueError(f"part {part.name}: there is no part {part.on} that it lies on")
    except (OSError, ValueError, RecursionError) as error:
        raise NodeStartError(
            "The description of how a robot or a thing looks, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
            path=path,
        ) from error
    return view


def all_parts(view: ViewFile) -> Iterator[Shaped]:
    """Every part with its copies round an axis and on the other side."""
    for part in view.part:
        around = part.repeat or Repeat(count=1, at=(0, 0, 0), axis=(0, 0, 1), step_deg=0)
        axis, about = np.array(around.axis), np.array(around.at)
        for number in range(around.count):
            turn = rotation(axis, math.radians(around.step_deg * number))
            spin = about - turn @ about, turn
            name, light = (
                text.replace("{n}", str(around.first + number)) if part.repeat else text
                for text in (part.name, part.light)
            )
            copy = msgspec.structs.replace(part, name=name, light=light)
            yield _shaped(copy, spin, is_mirrored=False)
            if part.mirror:
                yield _shaped(_other_side(copy), spin, is_mirrored=True)


def _other_side(part: Part) -> Part:
    changed: dict[str, Any] = {}
    for key in ("name", "light", "group", "sensor", "on"):
        text = getattr(part, key)
        for left, right in MIRRORED_WORDS:
            text = text.replace(left, right)
        changed[key] = text
    if part.link.startswith("L"):
        changed["link"] = "R" + part.link[1:]
    if (hinge := part.hinge) is not None:
        (x, y, z), (ax, ay, az) = hinge.at, hinge.axis
        joint = "R" + hinge.joint[1:] if hinge.joint.startswith("L") else hinge.joint
        changed["hinge"] = Hinge(
            joint, (x, -y, z), (-ax, ay, -az), hinge.closed_deg, hinge.open_deg
        )
    return msgspec.structs.replace(part, **changed)


def _shaped(part: Part, spin: tuple[Array, Array], *, is_mirrored: bool) -> Shaped:
    turn, blobs = _shape(part)
    normal = turn.T @ facing(np.array(part.facing))[:, 2] if any(part.facing) else UP
    place, turn = spin[0] + spin[1] @ np.array(part.at), spin[1] @ turn
    if is_mirrored:
        flip = np.diag([1.0, -1.0, 1.0])
        # The blobs are mirrored along their own y too, so that the turn stays a rotation.
        place, turn = flip @ place, flip @ turn @ flip
        normal = flip @ normal
        blobs = [Blob((b.at[0], -b.at[1], b.at[2]), b.size, b.powers) for b in blobs]
    x, y, z = (float(value) for value in place)
    return Shaped(part, (x, y, z), turn, normal, tuple(blobs))


LATHE_THIN = 0.12
"""How thick the slices of a lathe are, in their radii."""


def _shape(part: Part) -> tuple[Array, list[Blob]]:
    """The turn (3, 3) of a part in its link, and its blobs along its own axes."""
    turn = turned_by(*np.radians(part.turn))
    match part.shape:
        case "rod":
            way, (start, end) = np.array(part.to) - np.array(part.at), part.radii
            far = (0.0, 0.0, float(np.linalg.norm(way)))
            return facing(way), [Blob(size=(start,) * 3), Blob(far, (end,) * 3)]
        case "lathe":
            powers = (2.0, part.along or 3.0)
            return facing(np.array(part.facing)), [
                Blob((0, 0, z), (r, r, max(r * LATHE_THIN, 1e-3)), powers) for z, r in part.profile
            ]
        case "hull":
            slices = part.slices
            return turn, [Blob(s.at, s.size, (s.across, s.along)) for s in slices]
    across, along = {"ball": (2.0, 2.0), "box": (4.0, 4.0), "disc": (2.0, 4.0)}[part.shape]
    if part.shape == "disc":
        turn = facing(np.array(part.facing)) @ turn
    return turn, [Blob(size=part.size, powers=(part.across or across, part.along or along))]


def rotation(axis: Array, angle: float) -> Array:
    """The matrix that turns about an axis by an angle (rad)."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Array = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return turn


def facing(way: Array) -> Array:
    """A turn whose z axis has a direction, and whose y axis looks up as far as it can."""
    z = way / np.linalg.norm(way)
    above = np.array([0.0, 0.0, 1.0]) if abs(z[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    x = np.cross(above, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
