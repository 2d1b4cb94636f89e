"""Triangles of parts for a GPU: the farthest points in directions all around, as vertices."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .shapes import Solids

Array = NDArray[np.float64]
FINENESS = ((0.0, 5, 10), (0.008, 6, 14), (0.016, 9, 20), (0.034, 14, 30))
"""From which half length on (m) parts have how many rings and corners."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles of many parts: place and normal along the axes of a part, and its number."""

    vertices: NDArray[np.float32]
    """(n, 7)"""
    triangles: NDArray[np.uint32]
    """(m, 3)"""


def mesh_of(solids: Solids) -> Mesh:
    """The triangles of all parts; normals are exact, as each vertex is the farthest along one."""
    classes = np.digitize(solids.extent.max(axis=1), [size for size, _, _ in FINENESS]) - 1
    vertices, triangles, start = [], [], 0
    for one, (_, rings, corners) in enumerate(FINENESS):
        ways, faces = _ball(rings, corners)
        places = solids.farthest(np.broadcast_to(ways, (len(classes), *ways.shape)))
        for number in np.flatnonzero(classes == one).tolist():
            numbers = np.full((len(ways), 1), number)
            vertices.append(np.concatenate([places[number], ways, numbers], axis=1))
            triangles.append(faces + start)
            start += len(ways)
    return Mesh(
        np.concatenate(vertices).astype(np.float32), np.concatenate(triangles).astype(np.uint32)
    )


def _ball(rings: int, corners: int) -> tuple[Array, NDArray[np.int64]]:
    """Directions all around (n, 3), and the triangles between them (m, 3)."""
    tilts = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    turns = np.linspace(0, 2 * math.pi, corners + 1)
    tilt, turn = np.meshgrid(tilts, turns, indexing="ij")
    ways = np.stack([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)], 2)
    row, column = np.meshgrid(np.arange(rings), np.arange(corners), indexing="ij")
    here = (row * (corners + 1) + column).ravel()
    right, above = here + 1, here + corners + 1
    faces = [np.stack([here, right, above + 1], 1), np.stack([here, above + 1, above], 1)]
    # Flat shapes turn what is nearly nothing into something: let it be nothing.
    return ways.reshape(-1, 3).round(9), np.concatenate(faces)
