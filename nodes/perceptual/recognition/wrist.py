"""A movement as the same watch on the other wrist would have felt it."""

from __future__ import annotations

from typing import overload

import numpy as np

from nodes.perceptual.recognition.stream import Floats

# The arms are mirror images, the watch is not: on the right wrist the x of its screen points to
# the elbow, on the left one to the hand; and a mirror turns directions of rotation round.
_ACC = np.array([-1.0, 1.0, 1.0])
_GYR = np.array([1.0, -1.0, -1.0])


@overload
def mirrored(acc: Floats, gyr: Floats) -> tuple[Floats, Floats]: ...
@overload
def mirrored(acc: Floats, gyr: None) -> tuple[Floats, None]: ...
@overload
def mirrored(acc: Floats, gyr: Floats | None) -> tuple[Floats, Floats | None]: ...
def mirrored(acc: Floats, gyr: Floats | None) -> tuple[Floats, Floats | None]:
    """Acceleration (n, 3) and rotation (n, 3) of the mirror image of a movement."""
    return acc * _ACC, None if gyr is None else gyr * _GYR
