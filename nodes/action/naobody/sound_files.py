"""Sound files of this computer: where a robot finds them, and how long they last."""

from __future__ import annotations

import struct
from pathlib import Path

ROBOTS_HOME = "/home/nao/"
"""Where a real NAO has its files; its part here is the folder of who uses this computer."""
PLACES = (Path(), Path("Music"))
KINDS = ("wav", "mp3", "ogg")
MP3_KBPS = (0, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320)
MP3_KBPS_OF_LOW_RATES = (0, 8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160)
"""Bit rates of layer 3 by their number: for MPEG 1, and for MPEG 2 and 2.5."""
ID3_HEAD = 10
OPUS_HZ = 48000
"""The rate in which the pages of Opus are counted, whatever the sound's own one is."""


def found(file: str) -> Path | None:
    """Return the file of a name or path, in the home folder or in its Music; None for none."""
    path = Path(file.removeprefix(ROBOTS_HOME)).expanduser()
    possible = [Path.home() / place / path for place in PLACES]
    return next((one for one in possible if one.is_file()), None)


def length_s(file: Path) -> float:
    """Return how long a sound lasts. Raises ValueError for what is no such sound, OSError."""
    sound = file.read_bytes()
    try:
        if sound[:4] == b"RIFF" and sound[8:12] == b"WAVE":
            return _wav_s(sound)
        if sound[:4] == b"OggS":
            return _ogg_s(sound)
        return _mp3_s(sound)
    except (struct.error, ZeroDivisionError, IndexError) as error:
        raise ValueError(f"{file.name} is broken") from error


def _wav_s(sound: bytes) -> float:
    """The sound data by their bytes a second; a header may say more than there is."""
    at, bytes_per_s = 12, 0
    while at + 8 <= len(sound):
        kind, size = struct.unpack_from("<4sI", sound, at)
        if kind == b"fmt ":
            (bytes_per_s,) = struct.unpack_from("<I", sound, at + 16)
        elif kind == b"data":
            return float(min(size, len(sound) - at - 8) / bytes_per_s)
        at += 8 + size + size % 2
    raise ValueError("no sound data")


def _ogg_s(sound: bytes) -> float:
    """The place of the last page, in samples, by the samples a second."""
    (samples,) = struct.unpack_from("<q", sound, sound.rindex(b"OggS") + 6)
    head = sound.find(b"\x01vorbis")
    if head < 0:
        return float(max(0, samples) / (OPUS_HZ if b"OpusHead" in sound[:200] else 0))
    (rate_hz,) = struct.unpack_from("<I", sound, head + 12)
    return float(max(0, samples) / rate_hz)


def _mp3_s(sound: bytes) -> float:
    """The size by the bits a second of the first frame: right where all frames have the same."""
    start = 0
    if sound[:3] == b"ID3":
        start = ID3_HEAD + sum((sound[6 + i] & 0x7F) << (21 - 7 * i) for i in range(4))
    if sound[start] != 0xFF or sound[start + 1] & 0xE6 != 0xE2:
        raise ValueError("no sound of a known kind")
    is_mpeg_1 = sound[start + 1] & 0x18 == 0x18
    kbps = (MP3_KBPS if is_mpeg_1 else MP3_KBPS_OF_LOW_RATES)[sound[start + 2] >> 4]
    return (len(sound) - start) * 8.0 / (kbps * 1000.0)
