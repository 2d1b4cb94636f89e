"""Gesture models in files: numbers and plain text, never code.

A ``.gestures`` file is a ZIP archive of NumPy arrays (``numpy.savez``). The array ``about`` is
UTF-8 JSON: the format's version, what the sensor must send, the gestures, the recognisers and the
report of the training. Recogniser 0 has its numbers in arrays named ``0.usual_score`` ...
docs/gesture_models.md tells all of it. The same model gives the same bytes.
"""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels, feature_count
from nodes.perceptual.recognition.features_1 import feature_count_1
from nodes.perceptual.recognition.gmr import Both, Gmr
from nodes.perceptual.recognition.model import METHODS, Model, Recogniser, Scorer
from nodes.perceptual.recognition.model_about import (
    FORMAT,
    VERSION,
    About,
    AboutRecogniser,
    about_text,
)
from nodes.perceptual.recognition.model_arrays import DAMAGE, MAX_BYTES, read_arrays, with_prefix
from nodes.perceptual.recognition.trees import Trees

SUFFIX = ".gestures"
_READS = (1, VERSION)
_TRAIN_AGAIN = (
    "Choose a file that `nep-studio train` has written.",
    "Or train the gestures again from their recordings.",
)
_ANOTHER_PLACE = (
    "Choose a folder that you may write into, such as one in your home folder.",
    "Is there room on the disk?",
)


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
    arrays = {"about": np.frombuffer(about_text(model).encode(), np.uint8)}
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
        arrays = read_arrays(content)
        text = arrays["about"].tobytes()
        _check_version(path, text)
        return _model(msgspec.json.decode(text, type=About), arrays)
    except DAMAGE as error:
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
            return file.read(MAX_BYTES + 1)
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


def _small(array: NDArray[Any]) -> NDArray[Any]:
    return array.astype(np.float32) if array.dtype == np.float64 else array


def _check_version(path: Path, text: bytes) -> None:
    found = msgspec.json.decode(text, type=_Version)
    if found.format != FORMAT:
        raise ValueError("it is another kind of file")
    if found.version not in _READS:
        raise RecordingError(
            f"{path.name} is a gesture model of version {found.version}; this program reads"
            f" version {' and '.join(map(str, _READS))}.",
            checklist=("Train the gestures again from their recordings.", "Update NEP Studio."),
        )


def _model(about: About, arrays: Mapping[str, NDArray[Any]]) -> Model:
    about.check()
    recognisers = tuple(
        _recogniser(one, len(about.gestures), with_prefix(arrays, f"{number}."))
        for number, one in enumerate(about.recognisers)
        if one.is_known
    )
    if not recognisers:
        raise _too_old()
    return Model(
        tuple(one.checked() for one in about.gestures),
        recognisers,
        about.trained_on,
        about.report,
        triggers={one.name: one.trigger for one in about.gestures},
        wrist=about.wrist,
        sensors=tuple(one.checked() for one in about.sensors),
    )


def _too_old() -> RecordingError:
    return RecordingError(
        "This gesture model was learned by an earlier version in a way that is no longer used.",
        checklist=("Train the gestures again from their recordings.",),
    )


def _recogniser(
    found: AboutRecogniser, gestures: int, arrays: Mapping[str, NDArray[Any]]
) -> Recogniser:
    channels = Channels(found.gravity, found.gyroscope)
    usual = arrays["usual_score"].astype(float)
    if usual.shape != (gestures,) or not np.all(np.isfinite(usual) & (usual > 0)):
        raise ValueError("its usual scores do not fit")
    scorer: Scorer
    match found.method:
        case "trees":
            count = feature_count_1 if found.features == 1 else feature_count
            if "mean" in arrays:  # several people have taught it
                scorer = Both.from_arrays(arrays, gestures, channels)
            else:
                scorer = Trees.from_arrays(arrays, gestures, count(channels))
        case "gmr":
            scorer = Gmr.from_arrays(arrays, gestures, channels)
        case _:
            raise ValueError(f"it uses a method other than {' and '.join(METHODS)}")
    return Recogniser(found.method, channels, scorer, usual, found.features)
