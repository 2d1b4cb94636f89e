"""Where the room is looked at from, and where its places are then on a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = tuple[float, float, float]

NEAREST_M, FARTHEST_M = 0.18, 20.0
LOWEST_RAD, HIGHEST_RAD = math.radians(-12), math.radians(88)
FIELD_RAD = math.radians(28)
"""How much is seen from the lower edge of a picture to the upper one."""
BEFORE_EYE_M = 0.02
"""Nothing nearer than this is drawn."""

PRESETS: dict[str, tuple[float, float]] = {
    "front": (0.0, math.radians(8)),
    "side": (math.pi / 2, math.radians(8)),
    "back": (math.pi, math.radians(14)),
    "top": (0.0, HIGHEST_RAD),
    "face": (math.radians(12), math.radians(4)),
}
"""Yaw and pitch from the robot, which faces yaw 0."""


@dataclass(frozen=True)
class Camera:
    """An eye at ``distance`` m from ``target``; at yaw 0 it stands on the x axis and looks back."""

    yaw: float = math.radians(28)
    pitch: float = math.radians(14)
    distance: float = 1.5
    target: Place = (0.0, 0.0, 0.27)

    def orbited(self, yaw: float, pitch: float) -> Camera:
        """Return the camera gone round its target by these angles (rad)."""
        turned = math.remainder(self.yaw + yaw, 2 * math.pi)
        pitch = min(max(self.pitch + pitch, LOWEST_RAD), HIGHEST_RAD)
        return replace(self, yaw=turned, pitch=pitch)

    def zoomed(self, factor: float) -> Camera:
        """Return the camera nearer to its target by a factor."""
        return replace(self, distance=min(max(self.distance / factor, NEAREST_M), FARTHEST_M))

    def panned(self, right_m: float, up_m: float) -> Camera:
        """Return the camera moved with its target, along the picture."""
        moved = np.array(self.target) + right_m * self.axes[0] + up_m * self.axes[1]
        return replace(self, target=(float(moved[0]), float(moved[1]), float(moved[2])))

    @cached_property
    def axes(self) -> Array:
        """Rows: right, up and forward of the picture, in the room."""
        turn, tilt = (math.cos(self.yaw), math.sin(self.yaw)), math.cos(self.pitch)
        forward = np.array([-tilt * turn[0], -tilt * turn[1], -math.sin(self.pitch)])
        right = np.array([-turn[1], turn[0], 0.0])
        return np.stack([right, np.cross(right, forward), forward])


class Lens:
    """A camera for a picture of some size: from the room to pixels, and back.

    ``ratio`` is how many real pixels there are for one, as on screens with small pixels.
    """

    def __init__(self, camera: Camera, width: float, height: float, ratio: float = 1.0) -> None:
        self.camera, self.width, self.height = camera, max(width, 1.0), max(height, 1.0)
        self.ratio = ratio
        self.scale = self.height / (2 * math.tan(FIELD_RAD / 2))
        self.middle = np.array([self.width / 2, self.height / 2])
        self.eye: Array = np.array(camera.target) - camera.distance * camera.axes[2]
        """Where the eye is, in the room."""

    def depths(self, places: Array) -> Array:
        """How far before the eye places (..., 3) are, m."""
        depth: Array = (places - self.eye) @ self.camera.axes[2]
        return depth

    def project(self, places: Array) -> Array:
        """Where places (..., 3) of the room are on the picture (..., 2), in pixels."""
        seen = (places - self.eye) @ self.camera.axes.T
        depth = np.maximum(seen[..., 2:], BEFORE_EYE_M)
        return self.middle + seen[..., :2] * (self.scale, -self.scale) / depth

    def slopes(self, places: Array) -> Array:
        """How pixels change with places (..., 3): (..., 2, 3) pixels a m."""
        axes = self.camera.axes
        seen = (places - self.eye) @ axes.T
        depth = np.maximum(seen[..., 2:], BEFORE_EYE_M)[..., None]
        across = (seen[..., :2] / depth[..., 0])[..., None] * axes[2]
        slope: Array = (axes[:2] - across) * ((self.scale,), (-self.scale,)) / depth
        return slope

    def rays(self, pixels: Array) -> Array:
        """The directions (..., 3) from the eye through pixels (..., 2); 1 long along forward."""
        across = (pixels - self.middle) * (1 / self.scale, -1 / self.scale)
        ray: Array = across @ self.camera.axes[:2] + self.camera.axes[2]
        return ray

    def floor_at(self, x: float, y: float, above_m: float = 0.0) -> tuple[float, float] | None:
        """The place on the floor under a pixel; None above the horizon."""
        eye, ray = self.eye, self.rays(np.array([x, y]))
        if ray[2] > -1e-3:
            return None
        reach = (above_m - eye[2]) / ray[2]
        if reach <= 0:
            return None
        return float(eye[0] + reach * ray[0]), float(eye[1] + reach * ray[1])

    def plane_at(self, x: float, y: float, through: Place) -> Place:
        """The place under a pixel on the plane that faces the eye through a place."""
        ray = self.rays(np.array([x, y]))
        reach = float(self.depths(np.array(through)))
        place = self.eye + reach * ray
        return float(place[0]), float(place[1]), float(place[2])


@dataclass(frozen=True)
class Frame:
    """A picture of some size, in pixels; nothing needs to be seen in its ``top`` pixels."""

    width: float
    height: float
    top: float = 0.0


def fitted(camera: Camera, places: Array, frame: Frame, air: float) -> Camera:
    """Return the camera moved and set back so that all places (n, 3) are seen; ``air`` around."""
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    camera = replace(camera, target=(float(middle[0]), float(middle[1]), float(middle[2])))
    for is_last in (False, False, False, True):
        # As near to its target as it can be and see all places.
        lens = Lens(camera, frame.width, frame.height)
        across, up, forward = camera.axes @ (places - np.array(camera.target)).T
        per_px = (1 - air) / lens.scale
        above, below = lens.height / 2 - frame.top, lens.height / 2
        sides = np.abs(across) / (per_px * lens.width / 2)
        heights = np.maximum(up / (per_px * above), -up / (per_px * below))
        needed = float((np.maximum(sides, heights) - forward).max())
        camera = replace(camera, distance=min(max(needed, NEAREST_M), FARTHEST_M))
        if not is_last:  # then what is seen goes into the middle, as it is seen from there
            pixels = Lens(camera, frame.width, frame.height).project(places)
            off = (pixels.min(axis=0) + pixels.max(axis=0)) / 2 - lens.middle - (0, frame.top / 2)
            m_per_px = camera.distance / lens.scale
            camera = camera.panned(off[0] * m_per_px, -off[1] * m_per_px)
    return camera
