"""The arrays of a model file, which may be from anybody: only numbers, none larger than it is."""

from __future__ import annotations

import io
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

MAX_BYTES = 200_000_000
_MAX_ARRAYS = 200
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1  # a bit of a member's flags in a ZIP archive
# what zipfile, NumPy's reader of array headers, and msgspec raise for bytes that are no model
DAMAGE = (
    ValueError,
    TypeError,
    LookupError,
    ArithmeticError,
    RuntimeError,
    MemoryError,
    EOFError,
    OSError,
    SyntaxError,
    tokenize.TokenError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)


def read_arrays(content: bytes) -> dict[str, NDArray[Any]]:
    """The arrays of a file, once their sizes are known to be bearable."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = archive.infolist()
        if any(one.compress_type not in _PACKED or one.flag_bits & _ENCRYPTED for one in members):
            raise ValueError("the file is packed or encrypted as no gesture model is")
        if len(members) > _MAX_ARRAYS or sum(one.file_size for one in members) > MAX_BYTES:
            raise ValueError("the file is far larger than a gesture model")
        return {one.filename.removesuffix(".npy"): _array(archive.read(one)) for one in members}


def _array(content: bytes) -> NDArray[Any]:
    """One array of numbers; ValueError when it claims to be larger than its bytes."""
    file = io.BytesIO(content)
    version = np.lib.format.read_magic(file)
    if version != (1, 0):
        raise ValueError(f"arrays of version {version} are not read")
    shape, _, kind = np.lib.format.read_array_header_1_0(file)
    if kind.kind not in "biuf" or kind.itemsize * _product(shape) > len(content):
        raise ValueError("an array does not hold what it claims")
    file.seek(0)
    array: NDArray[Any] = np.lib.format.read_array(file, allow_pickle=False)
    return array


def _product(shape: tuple[int, ...]) -> int:
    total = 1
    for size in shape:
        total *= max(0, size)
    return total


def with_prefix(arrays: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    """The arrays whose names begin so, without that beginning."""
    return {
        name.removeprefix(prefix): array
        for name, array in arrays.items()
        if name.startswith(prefix)
    }
