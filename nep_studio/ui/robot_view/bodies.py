"""Paints placed parts with QPainter: each an outline with a gradient, the farther ones first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QBrush, QPainter, QTransform

from .camera import Lens
from .figure import Placed, joined_assembly
from .parts import Part
from .shading import Shades
from .silhouettes import Silhouettes, drawing_order, fitting_polygons, silhouettes

OUTLINE_PX = 0.9
RIM_FROM_PX = 6.0
"""Smaller parts have no rim: it would be all that is seen of them."""
GLOW_GROWTH = 3.2
DIMMEST = 0x18
"""A light whose colours are all darker than this looks switched off."""


@dataclass(frozen=True, eq=False)
class Dress:
    """What the parts of one robot or thing are painted with."""

    colours: Mapping[str, str]
    lights: Mapping[str, int]
    is_pale: bool = False

    def light_of(self, part: Part) -> int:
        """The colour 0xRRGGBB of a part that is a light; 0 for one that is off, or no light."""
        if not part.light and not part.group:
            return 0
        if self.is_pale:
            return 0
        number = self.lights.get(part.light, self.lights.get(part.group, 0))
        brightest = max(number >> 16 & 255, number >> 8 & 255, number & 255)
        return number if brightest > DIMMEST else 0


@dataclass(frozen=True, eq=False)
class Bodies:
    """All parts of a picture, seen through a lens, in the order in which they are painted."""

    placed: Placed
    dresses: Sequence[Dress]
    whose: NDArray[np.intp]
    """(parts,) the number of the dress of each."""
    seen: Silhouettes
    order: Sequence[int]

    @classmethod
    def through(cls, lens: Lens, groups: Sequence[tuple[Placed, Dress]]) -> Bodies | None:
        """See the parts of some robots and things through a lens; None when there are none."""
        if not groups:
            return None
        many = [one for one, _ in groups]
        placed = many[0]
        if len(many) > 1:
            placed = Placed(
                joined_assembly(tuple(one.assembly for one in many)),
                np.concatenate([one.origins for one in many]),
                np.concatenate([one.turns for one in many]),
                {},
            )
        whose = np.repeat(np.arange(len(many)), [len(one.origins) for one in many])
        seen = silhouettes(placed, lens)
        # Parts that lie on others come right after these, where they face the eye.
        to_eye = lens.eye - placed.origins
        normals, bare = placed.assembly.normals, placed.assembly.bare
        faces_eye = np.einsum("pij,pj,pi->p", placed.turns, normals, to_eye) > 0
        shown = (faces_eye & seen.is_seen).tolist()
        riders: dict[int, list[int]] = defaultdict(list)
        for number, carrier in placed.assembly.riders:
            if shown[number]:
                riders[carrier].append(number)
        carriers = drawing_order(placed, seen, lens, bare[seen.is_seen[bare]])
        order = [part for number in carriers for part in (number, *riders[number])]
        return cls(placed, [dress for _, dress in groups], whose, seen, order)

    def paint(self, painter: QPainter, shades: Shades) -> None:
        """Paint all parts."""
        painter.setPen(Qt.PenStyle.NoPen)
        sizes = np.ptp(self.seen.outlines, axis=1).max(axis=1) * self.seen.ratio
        rims = fitting_polygons(self.seen.outlines + OUTLINE_PX * self.seen.ways, sizes)
        faces = fitting_polygons(self.seen.outlines, sizes)
        has_rim = (sizes > RIM_FROM_PX).tolist()
        glowing, parts = self._glowing(), self.placed.assembly.parts
        plain = QTransform(painter.transform())
        # From the unit circle to the ellipses of the parts.
        shapes = [
            QTransform(a, b, b, d, *middle)
            for middle, ((a, b), (_, d)) in zip(
                self.seen.centres.tolist(), self.seen.stretches.tolist(), strict=True
            )
        ]
        for number in self.order:
            part, dress = parts[number], self.dresses[self.whose[number]]
            colour, light = dress.colours[part.colour], dress.light_of(part)
            if has_rim[number] and part.finish != "flat":
                painter.setBrush(shades.outline(colour, dress.is_pale))
                painter.drawConvexPolygon(rims[number])
            known = shades.round(colour, dress.is_pale, part.finish)
            brush = QBrush(shades.lamp(light) if light else known)
            brush.setTransform(shapes[number])
            painter.setBrush(brush)
            painter.drawConvexPolygon(faces[number])
            spots = [(_HALO * shapes[i], shades.glow(lamp)) for i, lamp in glowing.get(number, ())]
            if part.gloss and not dress.is_pale:
                spots.insert(0, (_SPOT * shapes[number], shades.gloss(part.gloss)))
            for shape, shed in spots:  # light, each a brush on the unit circle
                painter.setTransform(shape * plain)
                painter.setBrush(shed)
                painter.drawEllipse(-1, -1, 2, 2)
            if spots:
                painter.setTransform(plain)

    def _glowing(self) -> dict[int, list[tuple[int, int]]]:
        """The lights that are on, with their colours, by what they lie on and shed their light on.

        That is painted before them and all else that lies there, so that eyes stay clear.
        """
        glowing: dict[int, list[tuple[int, int]]] = {}
        carrier, parts = -1, self.placed.assembly.parts
        for number in self.order:
            part, dress = parts[number], self.dresses[self.whose[number]]
            carrier = carrier if part.on else number
            light = dress.light_of(part)
            if light:
                glowing.setdefault(carrier, []).append((number, light))
        return glowing

    def part_at(self, x: float, y: float) -> int | None:
        """The number of the part that is seen at a pixel."""
        low, high = self.seen.outlines.min(axis=1), self.seen.outlines.max(axis=1)
        near = ((low <= (x, y)) & (high >= (x, y))).all(axis=1)
        for number in reversed(self.order):
            if near[number] and _holds(self.seen.outlines[number], x, y):
                return int(number)
        return None


_SPOT = QTransform.fromTranslate(-0.4, -0.52).rotate(-38).scale(0.3, 0.2)
_HALO = QTransform.fromScale(GLOW_GROWTH, GLOW_GROWTH)


def _holds(outline: NDArray[np.float64], x: float, y: float) -> bool:
    """Whether a convex outline has a pixel inside."""
    following = np.roll(outline, -1, axis=0)
    edge = following - outline
    side = edge[:, 0] * (y - outline[:, 1]) - edge[:, 1] * (x - outline[:, 0])
    return bool((side >= -1e-9).all() or (side <= 1e-9).all())
