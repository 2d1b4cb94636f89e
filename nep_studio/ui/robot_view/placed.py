"""The parts of robots and things: what they are, and where they are in the room."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from .parts import Part, Shaped
from .shapes import Solids

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
