"""What stands on the floor beside robots, people, balls, walls and landmarks, as placed parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from nep_core.messages import Thing
from nep_studio import paths

from .parts import Shaped, Triple, ViewFile, all_parts, read_view, rotation
from .placed import Assembly, Placed
from .shapes import Solids

Array = NDArray[np.float64]
UP = np.array([0.0, 0.0, 1.0])
KIND_SIZES: dict[str, Triple] = {
    "person": (0.32, 0.2, 1.15),
    "ball": (0.12, 0.12, 0.12),
    "wall": (1.2, 0.05, 0.7),
    "mark": (0.16, 0.02, 0.5),
}
"""How wide, deep and high things of a kind usually are, m; people are children here."""


@lru_cache(maxsize=128)
def placed_thing(thing: Thing) -> Placed:
    """The parts of a thing where it is; the same object for the same thing."""
    made = _made(thing.kind, thing.size)
    spin = rotation(UP, thing.heading)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = spin, thing.place
    origins = frame[:3, 3] + made.origins @ spin.T
    return replace(made, origins=origins, turns=spin @ made.turns, links={"thing": frame})


def thing_colours(kind: str) -> Mapping[str, str]:
    """The colours of the parts of a kind of thing, by name."""
    return _view(kind).colours


@cache
def _view(kind: str) -> ViewFile:
    return read_view(paths.resources() / "things" / f"{kind}.toml")


@lru_cache(maxsize=64)
def _made(kind: str, size: Triple) -> Placed:
    """The parts of a thing of some size that stands in the middle of the floor."""
    view = _view(kind)
    wide, deep, high = size
    scale = np.array([deep, wide, high] if view.stretches else [high, high, high])
    shaped = list(all_parts(view))
    known = Assembly.of(shaped)
    return Placed(
        replace(known, solids=_scaled(shaped, scale)),
        np.array([one.at for one in shaped]) * scale,
        np.array([one.turn for one in shaped]),
        {},
    )


def _scaled(shaped: list[Shaped], scale: Array) -> Solids:
    """The shapes in their size. Only parts that are not turned can be stretched one way more."""
    a, b, c = scale.tolist()
    blobs = [
        [
            replace(
                blob,
                at=(blob.at[0] * a, blob.at[1] * b, blob.at[2] * c),
                size=(blob.size[0] * a, blob.size[1] * b, blob.size[2] * c),
            )
            for blob in one.blobs
        ]
        for one in shaped
    ]
    return Solids.of(blobs)
