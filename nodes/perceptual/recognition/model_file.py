"""Gesture models in files: numbers and plain text, never code.

A ``.gestures`` file is a ZIP archive of NumPy arrays (``numpy.savez``). The array ``about`` is
UTF-8 JSON: the format's version, what the sensor must send, the gestures, the recognisers and the
report of the training. Recogniser 0 has its numbers in arrays named ``0.usual_score`` ...
The same model gives the same bytes.
"""

from __future__ import annotations

import io
import json
import os
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels, feature_count
from nodes.perceptual.recognition.gmr import Gmr
from nodes.perceptual.recognition.model import METHODS, Model, Recogniser, Scorer
from nodes.perceptual.recognition.passages import LONGEST_S, SHORTEST_S, is_gesture_name
from nodes.perceptual.recognition.scans import Gesture
from nodes.perceptual.recognition.stream import RATE_HZ
from nodes.perceptual.recognition.trees import Trees

SUFFIX = ".gestures"
VERSION = 1
_FORMAT = "NEP Studio gesture model"
_MAX_BYTES = 200_000_000
_MAX_ARRAYS = 200
_MAX_GESTURES = 200
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1  # a bit of a member's flags in a ZIP archive
# what zipfile, NumPy's reader of array headers, and msgspec raise for bytes that are no model
_DAMAGE = (
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
_TRAIN_AGAIN = (
    "Choose a file that `nep-studio train` has written.",
    "Or train the gestures again from their recordings.",
)
_ANOTHER_PLACE = (
    "Choose a folder that you may write into, such as one in your home folder.",
    "Is there room on the disk?",
)


class _Recogniser(msgspec.Struct):
    method: str
    gravity: bool
    gyroscope: bool


class _Gesture(msgspec.Struct):
    name: str
    shortest_s: float
    typical_s: float
    longest_s: float
    takes: int


class _About(msgspec.Struct):
    rate_hz: float
    units: dict[str, str]
    gestures: list[_Gesture]
    recognisers: list[_Recogniser]
    trained_on: str
    report: dict[str, Any]


class _Version(msgspec.Struct):
    format: str
    version: int


def check_writable(path: Path) -> None:
    """Tell before the work that a model cannot be written there: RecordingError."""
    unfinished = _unfinished(path)
    try:
        unfinished.touch()
        unfinished.unlink()
    except OSError as error:
        raise _not_written(path, error) from error


def write_model(path: Path, model: Model) -> None:
    """Write a model; the file is whole or as it was before. RecordingError when that fails."""
    unfinished = _unfinished(path)
    try:
        unfinished.write_bytes(model_bytes(model))
        unfinished.replace(path)
    except OSError as error:
        raise _not_written(path, error) from error
    finally:
        unfinished.unlink(missing_ok=True)


def model_bytes(model: Model) -> bytes:
    """A model as the content of a file."""
    arrays = {"about": np.frombuffer(_about_text(model).encode(), np.uint8)}
    for number, recogniser in enumerate(model.recognisers):
        numbers = {"usual_score": recogniser.usual, **recogniser.scorer.arrays()}
        scored = {f"{number}.{name}": _small(array) for name, array in numbers.items()}
        arrays.update(scored)
    content = io.BytesIO()
    np.savez_compressed(content, allow_pickle=False, **arrays)
    return content.getvalue()


def read_model(path: Path) -> Model:
    """Read a model; RecordingError names the file and says what is wrong with it."""
    content = _content(path)
    try:
        arrays = _read_arrays(content)
        text = arrays["about"].tobytes()
        _check_version(path, text)
        return _model(msgspec.json.decode(text, type=_About), arrays)
    except _DAMAGE as error:
        raise RecordingError(
            f"{path.name} is not a gesture model, or it is damaged.",
            checklist=_TRAIN_AGAIN,
            details=str(error),
        ) from error


def _unfinished(path: Path) -> Path:
    return path.with_name(f".{path.name}.{os.getpid()}.unfinished")


def _not_written(path: Path, error: OSError) -> RecordingError:
    return RecordingError(
        f"{path} cannot be written: {error.strerror}.", checklist=_ANOTHER_PLACE, details=str(error)
    )


def _content(path: Path) -> bytes:
    """The bytes of a file, one more than a model may have at most."""
    try:
        if path.is_dir():
            raise RecordingError(
                f"{path} is a folder, not a gesture model.", checklist=_TRAIN_AGAIN
            )
        with path.open("rb") as file:
            return file.read(_MAX_BYTES + 1)
    except FileNotFoundError as error:
        raise RecordingError(
            f"There is no gesture model {path}.", checklist=_TRAIN_AGAIN
        ) from error
    except OSError as error:
        raise RecordingError(
            f"{path} cannot be read: {error.strerror}.",
            checklist=("May you open this file?", *_TRAIN_AGAIN),
            details=str(error),
        ) from error


def _about_text(model: Model) -> str:
    about = {
        "format": _FORMAT,
        "version": VERSION,
        "rate_hz": RATE_HZ,
        "units": {"acceleration": "m/s²", "angular velocity": "rad/s", "time": "s"},
        "gestures": [vars(gesture) for gesture in model.gestures],
        "recognisers": [{"method": one.method, **vars(one.channels)} for one in model.recognisers],
        "trained_on": model.trained_on,
        "report": dict(model.report),
    }
    return json.dumps(about, ensure_ascii=False, indent=1)


def _small(array: NDArray[Any]) -> NDArray[Any]:
    return array.astype(np.float32) if array.dtype == np.float64 else array


def _read_arrays(content: bytes) -> dict[str, NDArray[Any]]:
    """The arrays of a file, once their sizes are known to be bearable."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = archive.infolist()
        if any(one.compress_type not in _PACKED or one.flag_bits & _ENCRYPTED for one in members):
            raise ValueError("the file is packed or encrypted as no gesture model is")
        if len(members) > _MAX_ARRAYS or sum(one.file_size for one in members) > _MAX_BYTES:
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


def _check_version(path: Path, text: bytes) -> None:
    found = msgspec.json.decode(text, type=_Version)
    if found.format != _FORMAT:
        raise ValueError("it is another kind of file")
    if found.version != VERSION:
        raise RecordingError(
            f"{path.name} is a gesture model of version {found.version}; this program reads"
            f" version {VERSION}.",
            checklist=("Train the gestures again from their recordings.", "Update NEP Studio."),
        )


def _model(about: _About, arrays: Mapping[str, NDArray[Any]]) -> Model:
    if about.rate_hz != RATE_HZ or not 0 < len(about.gestures) <= _MAX_GESTURES:
        raise ValueError("its rate or its number of gestures is not possible")
    gestures = tuple(_gesture(one) for one in about.gestures)
    if len({gesture.name for gesture in gestures}) < len(gestures):
        raise ValueError("two of its gestures have the same name")
    recognisers = tuple(
        _recogniser(one, len(gestures), _with_prefix(arrays, f"{number}."))
        for number, one in enumerate(about.recognisers)
    )
    if not recognisers:
        raise ValueError("it has no recogniser")
    return Model(gestures, recognisers, about.trained_on, about.report)


def _gesture(found: _Gesture) -> Gesture:
    rising = SHORTEST_S <= found.shortest_s <= found.typical_s <= found.longest_s <= LONGEST_S
    if not is_gesture_name(found.name):
        raise ValueError(f"a gesture cannot have the name {found.name[:40]!r}")
    if not rising:
        raise ValueError(f'the gesture "{found.name}" cannot last as long as it says')
    return Gesture(found.name, found.shortest_s, found.typical_s, found.longest_s, found.takes)


def _recogniser(
    found: _Recogniser, gestures: int, arrays: Mapping[str, NDArray[Any]]
) -> Recogniser:
    channels = Channels(found.gravity, found.gyroscope)
    usual = arrays["usual_score"].astype(float)
    if usual.shape != (gestures,) or not np.all(np.isfinite(usual) & (usual > 0)):
        raise ValueError("its usual scores do not fit")
    scorer: Scorer
    match found.method:
        case "trees":
            scorer = Trees.from_arrays(arrays, gestures, feature_count(channels))
        case "gmr":
            scorer = Gmr.from_arrays(arrays, gestures, channels.signals)
        case _:
            raise ValueError(f"it uses a method other than {' and '.join(METHODS)}")
    return Recogniser(found.method, channels, scorer, usual)


def _with_prefix(arrays: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    return {
        name.removeprefix(prefix): array
        for name, array in arrays.items()
        if name.startswith(prefix)
    }
