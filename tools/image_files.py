"""Small files for pictures of a window, and how much two such pictures differ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage, QImageReader, QImageWriter

MOST_COLOURS = 256
AREA = 0.0004
"""A colour with more than this share of a picture keeps a place of its own."""

TOLERATED = 0.004
"""The share of pixels that may differ: edges of letters are drawn a little differently."""

VISIBLE = 48
"""How far a pixel must be from the other in one colour to count."""


def write_small(image: QImage, path: Path) -> str:
    """Write a picture with a table of colours; gives its size in words."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    flags = Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither
    small = image.convertToFormat(QImage.Format.Format_Indexed8, _table(image), flags)
    small.setDotsPerMeterX(0)
    small.setDotsPerMeterY(0)
    path.parent.mkdir(parents=True, exist_ok=True)
    writer = QImageWriter(str(path), b"png")
    writer.setQuality(0)  # of PNG: the smallest file
    if not writer.write(small):
        raise OSError(f"{path} cannot be written: {writer.errorString()}")
    return f"{path.stat().st_size / 1000:.0f} kB"


def difference(image: QImage, path: Path) -> str:
    """Say how a picture differs from the one in a file; an empty text when it does not."""
    if not path.is_file():
        return "is missing"
    old, new = _pixels(QImageReader(str(path)).read()), _pixels(image)
    if old.shape != new.shape:
        return f"has another size: {new.shape[1]} x {new.shape[0]} instead of {old.shape[1::-1]}"
    far = np.abs(old.astype(np.int16) - new.astype(np.int16)).max(axis=2) > VISIBLE
    share = float(far.mean())
    return f"out of date: {share:.1%} of it is different" if share > TOLERATED else ""


def _pixels(image: QImage) -> NDArray[np.uint8]:
    """Height x width x (blue, green, red)."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return rows[:, : 4 * image.width()].reshape(image.height(), image.width(), 4)[:, :, :3].copy()


def _table(image: QImage) -> list[int]:
    """The colours that stand for all: those of areas as they are, then those far from them."""
    pixels = _pixels(image).reshape(-1, 3).astype(np.uint32)
    packed = pixels[:, 2] << 16 | pixels[:, 1] << 8 | pixels[:, 0]
    colours, counts = np.unique(packed, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    colours, counts = colours[order], counts[order]
    channels = np.stack([colours >> 16, colours >> 8 & 255, colours & 255], axis=1).astype(int)
    areas = list(range(min(MOST_COLOURS // 2, int((counts > AREA * len(packed)).sum()))))
    for near in range(2, 256, 2):
        chosen = _apart(channels, areas, near)
        if len(chosen) <= MOST_COLOURS:
            break
    return [0xFF000000 | int(colours[number]) for number in chosen[:MOST_COLOURS]]


def _apart(channels: NDArray[np.int_], areas: list[int], near: int) -> list[int]:
    """The numbers of colours that are apart from each other, the frequent ones first."""
    chosen: list[int] = []
    is_left = np.ones(len(channels), bool)
    for area in areas:
        chosen.append(area)
        is_left &= np.abs(channels - channels[area]).max(axis=1) > near
    while is_left.any() and len(chosen) <= MOST_COLOURS:
        first = int(np.argmax(is_left))
        chosen.append(first)
        is_left &= np.abs(channels - channels[first]).max(axis=1) > near
    return chosen
