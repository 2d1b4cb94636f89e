"""One kind of robot as it looks, posed as a state says: where each of its parts is in the room."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nep_core.errors import NodeStartError
from nep_core.wire.messages import RobotState
from robots.body.body import load_body
from robots.body.kinematics import UPRIGHT, Skeleton, TorsoPose
from robots.body.kinematics import rotation as turned_by

from .parts import VIEW_FILE, Part, Shaped, Solids, all_parts, read_view, rotation

# The parts of robots and things: what they are, and where they are in the room.

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
UP, ASIDE, AHEAD = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
THIN_M = 0.009
"""Parts that are thinner somewhere cast no shadow of their own."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Parts with their shapes, wherever they are; what is known of them is worked out once."""

    parts: tuple[Part, ...]
    solids: Solids
    normals: Array
    """Where the parts (parts, 3) face, along their own axes."""
    riders: tuple[tuple[int, int], ...]
    """The numbers of the parts that lie on others, each with that of its carrier."""

    @classmethod
    def of(cls, shaped: Sequence[Shaped]) -> Assembly:
        """Put parts that are ready to be placed together."""
        parts = tuple(one.part for one in shaped)
        numbers = {part.name: number for number, part in enumerate(parts)}
        riders = tuple((number, numbers[part.on]) for number, part in enumerate(parts) if part.on)
        solids = Solids.of([one.blobs for one in shaped])
        return cls(parts, solids, np.array([one.normal for one in shaped]), riders)

    @cached_property
    def bare(self) -> Indices:
        """The numbers of the parts that lie on no other."""
        return np.flatnonzero([not part.on for part in self.parts])

    @cached_property
    def layers(self) -> Array:
        """The how manieth on its carrier each part is; 0 for those that lie on none."""
        counts: dict[int, int] = {}
        layers = np.zeros(len(self.parts))
        for number, carrier in self.riders:
            layers[number] = counts[carrier] = counts.get(carrier, 0) + 1
        return layers

    @cached_property
    def casting(self) -> tuple[Indices, Assembly]:
        """The parts that cast shadows: their numbers, and these parts alone."""
        thick = self.solids.extent.min(axis=1) > THIN_M
        numbers = self.bare[thick[self.bare]]
        parts = tuple(self.parts[number] for number in numbers.tolist())
        return numbers, Assembly(parts, self.solids.only(numbers), self.normals[numbers], ())


@lru_cache(maxsize=32)
def joined_assembly(many: tuple[Assembly, ...]) -> Assembly:
    """All parts of several, one after the other."""
    starts = np.cumsum([0, *(len(one.parts) for one in many)]).tolist()
    return Assembly(
        tuple(part for one in many for part in one.parts),
        Solids.joined([one.solids for one in many]),
        np.concatenate([one.normals for one in many]),
        tuple(
            (start + number, start + carrier)
            for start, one in zip(starts, many, strict=False)
            for number, carrier in one.riders
        ),
    )


@dataclass(frozen=True, eq=False)
class Placed:
    """Parts in the room: the places (parts, 3) and turns (parts, 3, 3) of them."""

    assembly: Assembly
    origins: Array
    turns: Array
    links: Mapping[str, Array]
    """Each link's frame (4, 4) in the room."""

    @property
    def parts(self) -> tuple[Part, ...]:
        """What the parts are."""
        return self.assembly.parts

    @property
    def solids(self) -> Solids:
        """The shapes of the parts."""
        return self.assembly.solids

    @property
    def normals(self) -> Array:
        """Where the parts (parts, 3) face, along their own axes."""
        return self.assembly.normals

    def casting(self) -> Placed:
        """The parts that cast shadows, where they are."""
        numbers, assembly = self.assembly.casting
        return Placed(assembly, self.origins[numbers], self.turns[numbers], {})

    def middles(self) -> Array:
        """The middles (parts, 3) of the parts."""
        middles: Array = self.origins + np.einsum("pij,pj->pi", self.turns, self.solids.middle)
        return middles

    def farthest(self, way: Array) -> Array:
        """The farthest point (parts, 3) of each part in one direction of the room."""
        ways = np.einsum("pij,i->pj", self.turns, way)[:, None]
        points = self.solids.farthest(ways)[:, 0]
        reached: Array = self.origins + np.einsum("pij,pj->pi", self.turns, points)
        return reached

    def corners(self) -> Array:
        """Points (14 * parts, 3) that no part goes far beyond, to fit a camera."""
        ways = [AHEAD, -AHEAD, ASIDE, -ASIDE, UP, -UP]
        ways += [x + y + z for x in (AHEAD, -AHEAD) for y in (ASIDE, -ASIDE) for z in (UP, -UP)]
        return np.concatenate([self.farthest(way) for way in ways])

    @staticmethod
    def joined(many: Sequence[Placed]) -> Placed:
        """The parts of several, one after the other."""
        return Placed(
            joined_assembly(tuple(one.assembly for one in many)),
            np.concatenate([one.origins for one in many]),
            np.concatenate([one.turns for one in many]),
            {},
        )


class RobotFigure:
    """A robot's folder: its body with the joints, and its look with the parts."""

    def __init__(self, folder: Path) -> None:
        self.body = load_body(folder)
        self.skeleton = Skeleton(self.body)
        view = read_view(folder / VIEW_FILE)
        self.colours, self.head, self.top_m = view.colours, view.head, view.top_m
        shaped = list(all_parts(view))
        _check_links(folder, shaped, self.skeleton.links)
        self.assembly = Assembly.of(shaped)
        self.parts = self.assembly.parts
        self.sensors = tuple(dict.fromkeys(p.sensor for p in self.parts if p.sensor))
        self._at = np.array([one.at for one in shaped])
        self._turn = np.array([one.turn for one in shaped])
        self._link_names = tuple(dict.fromkeys(part.link for part in self.parts))
        self._link = np.array([self._link_names.index(part.link) for part in self.parts])
        self._hinges = _Hinges(shaped)
        self._resting = lru_cache(maxsize=4)(self._rest)

    def pose(self, state: RobotState) -> Placed:
        """Place all parts; on its feet, or its lowest point, where the torso is not told."""
        angles = self.angles(state.joints)
        frames = dict(self.skeleton.frames(angles))
        torso = self._torso(state)
        links = {name: torso @ frame for name, frame in frames.items()}
        if state.torso is None:
            self._drop(links, state)
        return self._placed(links, state.joints)

    def angles(self, joints: Mapping[str, float]) -> Array:
        """The angles of a state in the body's joint order."""
        return np.array([joints.get(name, 0.0) for name in self.body.names])

    def _torso(self, state: RobotState) -> Array:
        """The torso's frame; one that is not told lies or stands as its posture does."""
        told = state.torso
        if told is None:
            told = self._resting(tuple(self.angles(state.joints)), state.base, state.posture)
        x, y, z, roll, pitch, yaw = told
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = turned_by(roll, pitch, yaw), (x, y, z)
        return frame

    def _rest(
        self, angles: tuple[float, ...], base: tuple[float, float, float], posture: str
    ) -> TorsoPose:
        known = self.body.postures.get(posture)
        down = UPRIGHT if known is None else known.down
        return self.skeleton.torso_over_floor(np.array(angles), base, down)

    def _drop(self, links: dict[str, Array], state: RobotState) -> None:
        """Let the robot down until its lowest point is on the floor."""
        placed = self._placed(links, state.joints)
        lowest = float(placed.farthest(-UP)[:, 2].min())
        for name, frame in links.items():
            links[name] = frame.copy()
            links[name][2, 3] -= lowest

    def _placed(self, links: Mapping[str, Array], joints: Mapping[str, float]) -> Placed:
        frames = np.stack([links[name] for name in self._link_names])[self._link]
        at, turn = self._hinges.opened(self._at, self._turn, joints)
        origins = frames[:, :3, 3] + np.einsum("pij,pj->pi", frames[:, :3, :3], at)
        turns = frames[:, :3, :3] @ turn
        return Placed(self.assembly, origins, turns, links)


def _check_links(folder: Path, shaped: Sequence[Shaped], links: Sequence[str]) -> None:
    wrong = [one.part for one in shaped if one.part.link not in links]
    if wrong:
        raise NodeStartError(
            "The robot in {folder} has no link {link} for its part {name}.",
            checklist=("Name a link of body.json in {view_file}: {links}.",),
            folder=folder,
            link=wrong[0].link,
            name=wrong[0].name,
            view_file=VIEW_FILE,
            links=", ".join(links),
        )


class _Hinges:
    """The parts that joints outside of the skeleton turn, such as fingers."""

    def __init__(self, shaped: list[Shaped]) -> None:
        self._found = [(i, s.part.hinge) for i, s in enumerate(shaped) if s.part.hinge is not None]

    def opened(self, at: Array, turn: Array, joints: Mapping[str, float]) -> tuple[Array, Array]:
        """The places and turns of all parts, with these turned as far as their joints are open."""
        if not self._found:
            return at, turn
        at, turn = at.copy(), turn.copy()
        for part, hinge in self._found:
            opened = joints.get(hinge.joint, 0.5)
            degrees = hinge.closed_deg + (hinge.open_deg - hinge.closed_deg) * opened
            spin, about = rotation(np.array(hinge.axis), math.radians(degrees)), np.array(hinge.at)
            at[part] = about + spin @ (at[part] - about)
            turn[part] = spin @ turn[part]
        return at, turn


@cache
def load_figure(folder: Path) -> RobotFigure:
    """The figure of a robot's folder, read once. Raises NodeStartError when it cannot be used."""
    return RobotFigure(folder)
