"""Samples in the shape of an ``/imu`` message."""

from __future__ import annotations

from nodes.recording_table import Floats

Row = tuple[float, float, float]


def rows(vectors: Floats) -> list[Row]:
    """An array (n, 3) as n rows."""
    return [(x, y, z) for x, y, z in vectors.tolist()]
