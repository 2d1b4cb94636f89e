"""Draws the program's icon in all sizes, from its SVG, as each system wants it."""

from __future__ import annotations

import struct
from pathlib import Path

import parts
from PySide6.QtCore import QBuffer, QIODevice, Qt
from PySide6.QtGui import QImage, QPainter
from PySide6.QtSvg import QSvgRenderer

SVG = parts.ROOT / "resources" / "icons" / "nep-studio.svg"
SIZES = (16, 22, 24, 32, 48, 64, 96, 128, 256, 512)
ICO_SIZES = (16, 24, 32, 48, 64, 128, 256)
ICNS_TYPES = {16: b"icp4", 32: b"icp5", 64: b"icp6", 128: b"ic07", 256: b"ic08", 512: b"ic09"}
"""What Apple calls a picture of each size."""


def png(size: int) -> bytes:
    """The icon as a PNG, ``size`` pixels wide and high."""
    image = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    QSvgRenderer(str(SVG)).render(painter)
    painter.end()
    written = QBuffer()
    written.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(written, "PNG")  # type: ignore[call-overload]  # its stub wants bytes, Qt a name
    return bytes(written.data().data())


def ico(pictures: dict[int, bytes]) -> bytes:
    """The icon of a Windows program, from PNGs by their size."""
    head = struct.pack("<HHH", 0, 1, len(pictures))
    place = len(head) + 16 * len(pictures)
    entries = b""
    for size, picture in pictures.items():
        edge = size % 256  # 256 is written as 0
        entries += struct.pack("<BBBBHHII", edge, edge, 0, 0, 1, 32, len(picture), place)
        place += len(picture)
    return head + entries + b"".join(pictures.values())


def icns(pictures: dict[int, bytes]) -> bytes:
    """The icon of a macOS program, from PNGs by their size."""
    body = b"".join(
        ICNS_TYPES[size] + struct.pack(">I", len(picture) + 8) + picture
        for size, picture in pictures.items()
    )
    return b"icns" + struct.pack(">I", len(body) + 8) + body


def write_icons(folder: Path) -> None:
    """Write ``<size>.png`` of all sizes, ``nep-studio.ico`` and ``nep-studio.icns``."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {size: png(size) for size in SIZES}
    for size, picture in pictures.items():
        (folder / f"{size}.png").write_bytes(picture)
    wanted = {size: pictures[size] for size in ICO_SIZES}
    (folder / f"{parts.NAME}.ico").write_bytes(ico(wanted))
    wanted = {size: pictures[size] for size in ICNS_TYPES}
    (folder / f"{parts.NAME}.icns").write_bytes(icns(wanted))
