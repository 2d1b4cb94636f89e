"""One kind of robot as it looks, posed as a state says: where each of its parts is in the room."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache
from itertools import product
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
UP = np.array([0.0, 0.0, 1.0])
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
    bare: Indices
    """The numbers of the parts that lie on no other."""

    @classmethod
    def of(cls, shaped: Sequence[Shaped]) -> Assembly:
        """Put parts that are ready to be placed together."""
        parts = tuple(one.part for one in shaped)
        numbers = {part.name: number for number, part in enumerate(parts)}
        riders = tuple((number, numbers[part.on]) for number, part in enumerate(parts) if part.on)
        solids = Solids.of([one.blobs for one in shaped])
        bare = np.flatnonzero([not part.on for part in parts])
        return cls(parts, solids, np.array([one.normal for one in shaped]), riders, bare)

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
        solids = self.solids
        kept = np.isin(solids.owner, numbers)
        owner = np.searchsorted(numbers, solids.owner[kept]).astype(np.intp)
        blobs = solids.centre[kept], solids.size[kept], solids.powers[kept]
        alone = Solids.boxed(owner, *blobs, len(numbers))
        return numbers, Assembly(parts, alone, self.normals[numbers], (), np.arange(len(parts)))


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
        np.concatenate([start + one.bare for start, one in zip(starts, many, strict=False)]),
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

    def middles(self) -> Array:
        """The middles (parts, 3) of the parts."""
        along = np.einsum("pij,pj->pi", self.turns, self.assembly.solids.middle)
        middles: Array = self.origins + along
        return middles

    def farthest(self, ways: Array) -> Array:
        """The farthest points (parts, k, 3) of the parts in directions of the room.

        Directions are (k, 3), or (parts, k, 3) where they differ.
        """
        points = self.assembly.solids.farthest(ways @ self.turns)
        return self.origins[:, None] + points @ self.turns.transpose(0, 2, 1)

    def corners(self) -> Array:
        """Points (14 * parts, 3) that no part goes far beyond, to fit a camera."""
        steps = [np.array(step) for step in product((-1.0, 0.0, 1.0), repeat=3)]
        ways = np.stack([step for step in steps if np.abs(step).sum() in (1, 3)])
        return self.farthest(ways).reshape(-1, 3)


class RobotFigure:
    """A robot's folder: its body with the joints, and its look with the parts."""

    def __init__(self, folder: Path) -> None:
        self.body = load_body(folder)
        self.skeleton = Skeleton(self.body)
        view = read_view(folder / VIEW_FILE)
        self.colours, self.head, self.top_m = view.colours, view.head, view.top_m
        shaped = list(all_parts(view))
        links = self.skeleton.links
        wrong = next((one.part for one in shaped if one.part.link not in links), None)
        if wrong is not None:
            raise NodeStartError(
                "The robot in {folder} has no link {link} for its part {name}.",
                checklist=("Name a link of body.json in {view_file}: {links}.",),
                folder=folder,
                link=wrong.link,
                name=wrong.name,
                view_file=VIEW_FILE,
                links=", ".join(links),
            )
        self.assembly = Assembly.of(shaped)
        self.parts = self.assembly.parts
        self.sensors = tuple(dict.fromkeys(p.sensor for p in self.parts if p.sensor))
        self._at = np.array([one.at for one in shaped])
        self._turn = np.array([one.turn for one in shaped])
        self._link = np.array([links.index(part.link) for part in self.parts])
        self._hinges = [(i, part.hinge) for i, part in enumerate(self.parts) if part.hinge]
        self._resting = lru_cache(maxsize=4)(self._rest)

    def pose(self, state: RobotState) -> Placed:
        """Place all parts; on its feet, or its lowest point, where the torso is not told."""
        angles = np.array([state.joints.get(name, 0.0) for name in self.body.names])
        # A torso that is not told lies or stands as its posture does.
        told = state.torso or self._resting(tuple(angles), state.base, state.posture)
        torso = np.eye(4)
        torso[:3, :3], torso[:3, 3] = turned_by(*told[3:]), told[:3]
        frames = torso @ self.skeleton.transforms(angles)
        links = dict(zip(self.skeleton.links, frames, strict=True))
        at, turn = self._at.copy(), self._turn.copy()
        # Joints outside of the skeleton turn parts too, such as fingers, as far as they are open.
        for part, hinge in self._hinges:
            opened = state.joints.get(hinge.joint, 0.5)
            degrees = hinge.closed_deg + (hinge.open_deg - hinge.closed_deg) * opened
            spin, about = rotation(np.array(hinge.axis), math.radians(degrees)), np.array(hinge.at)
            at[part] = about + spin @ (at[part] - about)
            turn[part] = spin @ turn[part]
        ours = frames[self._link]
        origins = ours[:, :3, 3] + np.einsum("pij,pj->pi", ours[:, :3, :3], at)
        placed = Placed(self.assembly, origins, ours[:, :3, :3] @ turn, links)
        if state.torso is None:
            low = np.array([0.0, 0.0, placed.farthest(-UP[None])[..., 2].min()])
            frames[:, :3, 3] -= low  # also where the links are
            placed = replace(placed, origins=placed.origins - low)
        return placed

    def _rest(
        self, angles: tuple[float, ...], base: tuple[float, float, float], posture: str
    ) -> TorsoPose:
        known = self.body.postures.get(posture)
        down = UPRIGHT if known is None else known.down
        return self.skeleton.torso_over_floor(np.array(angles), base, down)


load_figure = cache(RobotFigure)
"""The figure of a robot's folder, read once. Raises NodeStartError when it cannot be used."""
