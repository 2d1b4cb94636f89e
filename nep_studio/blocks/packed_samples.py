"""Samples of a sensor as text: rows of little-endian 32-bit floats, deflated, in base64.

A row is a time in s, three accelerations in m/s² and, where there is a gyroscope, three rotation
rates in rad/s.
"""

from __future__ import annotations

import binascii
import math
import sys
import zlib
from array import array
from base64 import b64decode, b64encode
from itertools import pairwise

LARGEST_BYTES = 12_000_000
"""Of the floats: an hour at 100 samples a second with rotation is ten million."""
LARGEST_TEXT = 12_000_000


def packed_samples(rows: bytes) -> str:
    """The text for the bytes of 32-bit floats, row by row."""
    return b64encode(zlib.compress(rows, 6)).decode("ascii")


def unpacked_samples(text: str) -> bytes:
    """The bytes of 32-bit floats; ValueError when the text is no such thing, or too much."""
    unpacking = zlib.decompressobj()
    try:
        rows = unpacking.decompress(b64decode(text, validate=True), LARGEST_BYTES + 1)
    except (binascii.Error, zlib.error, ValueError) as error:
        raise ValueError("The samples cannot be unpacked.") from error
    if len(rows) > LARGEST_BYTES:
        raise ValueError("There are too many samples.")
    if not unpacking.eof or unpacking.unused_data or len(rows) % 4:
        raise ValueError("The samples end in the middle.")
    return rows


def floats_of(rows: bytes) -> array[float]:
    """The numbers, one row after the other."""
    numbers = array("f")
    numbers.frombytes(rows)
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers


def why_not_samples(text: str, columns: int) -> str | None:
    """Why this text is not samples with so many columns, as a sentence; None when it is."""
    if len(text) > LARGEST_TEXT:
        return "it has too many samples."
    try:
        numbers = floats_of(unpacked_samples(text))
    except ValueError as error:
        return f"{error}"
    if not numbers or len(numbers) % columns:
        return "its samples are not whole rows."
    if not math.isfinite(sum(numbers)):  # one number that is none spoils the sum
        return "each of its samples must be a finite number."
    times = numbers[::columns]
    if times[0] < 0 or any(b < a for a, b in pairwise(times)):
        return "the times of its samples must rise."
    return None
