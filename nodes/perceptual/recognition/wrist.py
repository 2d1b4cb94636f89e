"""A movement as the same watch on the other wrist would have felt it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import overload

import numpy as np

from nep_core.messages import Wrist
from nodes.perceptual.recognition.stream import Floats
from nodes.recordings import Recording

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
    """Acceleration (n, 3) and rotation (n, 3) of the mirror image of a movement.

    A watch lies on the back of the wrist: z leaves its screen, y points to the thumb's side on
    both wrists, and x to the hand on the left one, to the elbow on the right one. So between the
    two arms the sensor's frame is mirrored in x. Acceleration is a polar vector, an arrow in
    space, gravity in it too: its x turns round. Rotation is an axial vector, which a mirror turns
    round once more: its x stays, its y and z turn round. Mirrored twice, a movement is as it was.
    """
    return acc * _ACC, None if gyr is None else gyr * _GYR


def usual_wrist(recordings: Sequence[Recording]) -> Wrist:
    """Where most recordings were made; "" when nobody said of any."""
    counts = Counter(one.wrist for one in recordings if one.wrist)
    return counts.most_common(1)[0][0] if counts else ""


def worn_at(recording: Recording, wrist: Wrist) -> Recording:
    """A recording of the other wrist as its mirror image; another one as it is."""
    if {recording.wrist, wrist} != {"left", "right"}:
        return recording
    acc, gyr = mirrored(recording.acc, recording.gyr)
    return replace(recording, acc=acc, gyr=gyr, wrist=wrist)
