"""A model: the gestures that it knows, and recognisers for what a sensor may offer."""

from __future__ import annotations

import io
import json
import struct
import tempfile
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from typing import Any, Literal, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from faults import reason_of
from faults.files import opened, whole_file
from nep_core.errors import RecordingError
from nep_core.wire.messages import Wrist
from nodes.recordings import writing

from .features import (
    Channels,
    Gesture,
    Integers,
    Windows,
    describe,
    feature_count,
    fitting,
    window_lengths,
)
from .gmr import Both, Gmr, with_prefix
from .streams import LONGEST_S, RATE_HZ, SHORTEST_S, Floats, is_gesture_name
from .trees import Trees

METHODS = ("trees", "gmr")
TRIGGER = 0.75
"""The certainty at which a gesture counts as made."""
LOWEST_TRIGGER, HIGHEST_TRIGGER = 0.05, 1.0
FEATURES = 2
"""The way in which windows are described; a file names it."""


class Scorer(Protocol):
    """What a method of recognition can do."""

    def scores(self, windows: Windows) -> Floats:
        """A number from 0 to 1 for each window and gesture; (n, gestures)."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""


@dataclass(frozen=True)
class Recogniser:
    """A scorer for certain channels; ``usual`` (gestures,) are the scores of left-out takes."""

    method: str
    channels: Channels
    scorer: Scorer
    usual: Floats

    def windows(self, raw: Floats, lengths: Integers) -> Windows:
        """Raw windows (n, 32, 3 or 6), described as this recogniser knows them."""
        return describe(raw, lengths, self.channels)

    def certainties(self, windows: Windows) -> Floats:
        """Certainties from 0 to 1; (n, gestures)."""
        return certainty_of(self.scorer.scores(windows), self.usual)


def certainty_of(scores: Floats, usual: Floats) -> Floats:
    """Scores (..., gestures) on a scale that means the same for every model.

    1 is a score as left-out takes usually have; half of that is at TRIGGER.
    """
    shares = np.nan_to_num(scores / usual, nan=0.0)  # a model of numbers too large to reckon with
    return np.interp(shares, [0.0, 0.5, 1.0], [0.0, TRIGGER, 1.0])


class Sensor(msgspec.Struct, frozen=True, rename={"gravity_included": "gravity"}):
    """What recordings were made with, also in a file; ``device`` is "" when nobody said."""

    device: str
    rate_hz: float
    gravity_included: bool
    gyroscope: bool


@dataclass(frozen=True)
class Model:
    """Gestures, recognisers, ``trained_on`` in words, and the report of the training by method.

    ``triggers`` are the certainties at which each gesture counts as made, TRIGGER where none is
    given. ``wrist`` is where the ``sensors`` of the training were worn: left, right, hand, or ""
    when nobody said.
    """

    gestures: tuple[Gesture, ...]
    recognisers: tuple[Recogniser, ...]
    trained_on: str
    report: Mapping[str, Any]
    triggers: Mapping[str, float] = field(default_factory=dict)
    wrist: str = ""
    sensors: tuple[Sensor, ...] = ()

    def __post_init__(self) -> None:
        complete = {name: self.triggers.get(name, TRIGGER) for name in self.names}
        object.__setattr__(self, "triggers", complete)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the gestures."""
        return tuple(gesture.name for gesture in self.gestures)

    @property
    def lengths(self) -> Integers:
        """The lengths of window to look at, in samples."""
        return window_lengths(self.gestures)

    @property
    def fits(self) -> NDArray[np.bool_]:
        """Which lengths may hold which gesture; (lengths, gestures)."""
        return fitting(self.gestures, self.lengths)

    def recogniser(self, method: str, gravity_included: bool, gyroscope: bool) -> Recogniser:
        """The best recogniser for a sensor; RecordingError says what the sensor lacks."""
        of_method = [found for found in self.recognisers if found.method == method]
        if not of_method:
            known = " and ".join(sorted({found.method for found in self.recognisers}))
            raise RecordingError(
                'This gesture model cannot recognise by "{method}": it was trained for {known}.',
                checklist=("Choose the method {known}.", "Or train the model again for both."),
                method=method,
                known=known,
            )
        usable = [
            found
            for found in of_method
            if found.channels.gravity <= gravity_included and found.channels.gyroscope <= gyroscope
        ]
        if not usable:
            least = min(of_method, key=lambda found: found.channels.signals)
            raise RecordingError(
                "This gesture model needs {in_words}, and the sensor does not send that.",
                checklist=(
                    "In the app of the watch or phone, switch on {in_words}.",
                    "Or use the kind of watch or phone that the gestures were recorded with.",
                    "Or record the gestures with this sensor and train again.",
                ),
                in_words=least.channels.in_words,
            )
        return max(usable, key=lambda found: found.channels.signals)


def with_triggers(model: Model, triggers: Mapping[str, float]) -> Model:
    """The model with other triggers for some of its gestures.

    RecordingError for a gesture that it does not know, or a certainty that makes no sense.
    """
    for name, certainty in triggers.items():
        if name not in model.names:
            raise unknown_gesture(model, name)
        if not LOWEST_TRIGGER <= certainty <= HIGHEST_TRIGGER:
            raise RecordingError(
                "The certainty of {name} is {certainty}, which is not possible.",
                checklist=("Choose one from {lowest_trigger} to {highest_trigger}.",),
                name=name,
                certainty=f"{certainty:g}",
                lowest_trigger=LOWEST_TRIGGER,
                highest_trigger=f"{HIGHEST_TRIGGER:.0f}",
            )
    return replace(model, triggers={**model.triggers, **triggers})


def unknown_gesture(model: Model, name: str) -> RecordingError:
    """The error of a gesture that a model was not trained for."""
    return RecordingError(
        'The gesture model does not know "{name}".',
        checklist=("Choose one of: {names}.", "Or train it and try again."),
        name=name,
        names=", ".join(model.names),
    )


# What a model file tells about itself as JSON: its gestures, sensors, recognisers and report.

FORMAT = "NEP Studio gesture model"
VERSION = 2
_MAX_GESTURES = 200
MAX_SENSORS = 100
_LONGEST_DEVICE = 200


class AboutRecogniser(msgspec.Struct):
    """A recogniser: its method, what the sensor must have besides acceleration, its features."""

    method: str
    gravity: bool
    gyroscope: bool
    features: Literal[2]


class AboutGesture(msgspec.Struct):
    """A gesture as the file tells it."""

    name: str
    shortest_s: float
    typical_s: float
    longest_s: float
    takes: int
    trigger: float

    def checked(self) -> Gesture:
        """The gesture; ValueError when there can be none like it."""
        rising = SHORTEST_S <= self.shortest_s <= self.typical_s <= self.longest_s <= LONGEST_S
        if not is_gesture_name(self.name):
            raise ValueError(f"a gesture cannot have the name {self.name[:40]!r}")
        if not rising:
            raise ValueError(f'the gesture "{self.name}" cannot last as long as it says')
        if not LOWEST_TRIGGER <= self.trigger <= HIGHEST_TRIGGER:
            raise ValueError(f'the gesture "{self.name}" has an impossible trigger')
        return Gesture(self.name, self.shortest_s, self.typical_s, self.longest_s, self.takes)


class About(msgspec.Struct):
    """All that a model file tells in words."""

    rate_hz: float
    units: dict[str, str]
    gestures: list[AboutGesture]
    recognisers: list[AboutRecogniser]
    trained_on: str
    report: dict[str, Any]
    wrist: Wrist
    sensors: list[Sensor]

    def check(self) -> None:
        """ValueError when there can be no such model."""
        if self.rate_hz != RATE_HZ or not 0 < len(self.gestures) <= _MAX_GESTURES:
            raise ValueError("its rate or its number of gestures is not possible")
        if len({gesture.name for gesture in self.gestures}) < len(self.gestures):
            raise ValueError("two of its gestures have the same name")
        if not self.recognisers:
            raise ValueError("it has no recogniser")
        if len(self.sensors) > MAX_SENSORS:
            raise ValueError("it has more sensors than anybody")
        for device in (one.device for one in self.sensors):
            if len(device) > _LONGEST_DEVICE or not device.isprintable():
                raise ValueError("a sensor has a name that cannot be shown")


def about_text(model: Model) -> str:
    """What a model's file tells about it, as JSON."""
    about = {
        "format": FORMAT,
        "version": VERSION,
        "rate_hz": RATE_HZ,
        "units": {"acceleration": "m/s²", "angular velocity": "rad/s", "time": "s"},
        "gestures": [
            {**vars(one), "trigger": round(model.triggers[one.name], 4)} for one in model.gestures
        ],
        "recognisers": [
            {"method": one.method, **vars(one.channels), "features": FEATURES}
            for one in model.recognisers
        ],
        "wrist": model.wrist,
        "sensors": [msgspec.to_builtins(one) for one in model.sensors[:MAX_SENSORS]],
        "trained_on": model.trained_on,
        "report": dict(model.report),
    }
    return json.dumps(about, ensure_ascii=False, indent=1)


# The arrays of a model file, which may be from anybody: only numbers, none larger than it is.

MAX_BYTES = 200_000_000
_MAX_ARRAYS = 200
_MOST_UNPACKED = 16_000_000
_MOST_PACKED = 12
"""A model is unpacked to no more than 16 MB, or to 12 times its file: numbers pack by 3 at most,
and what packs better was made to fill the memory of who opens it."""
_MAX_ABOUT_BYTES = 1_500_000
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1  # a bit of a member's flags in a ZIP archive
# what zipfile, NumPy's reader of array headers, and msgspec raise for bytes that are no model
DAMAGE = (
    *(ValueError, TypeError, LookupError, ArithmeticError, RuntimeError, MemoryError, EOFError),
    *(OSError, SyntaxError, tokenize.TokenError, struct.error, zipfile.BadZipFile, zlib.error),
)


def read_arrays(content: bytes) -> dict[str, NDArray[Any]]:
    """The arrays of a file, once their sizes are known to be bearable."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = archive.infolist()
        if any(one.compress_type not in _PACKED or one.flag_bits & _ENCRYPTED for one in members):
            raise ValueError("the file is packed or encrypted as no gesture model is")
        room = max(_MOST_UNPACKED, _MOST_PACKED * len(content))
        if len(members) > _MAX_ARRAYS or sum(one.file_size for one in members) > room:
            raise ValueError("the file is far larger than a gesture model")
        return {one.filename.removesuffix(".npy"): _array(archive.read(one)) for one in members}


def _array(content: bytes) -> NDArray[Any]:
    """One array of numbers; ValueError when it claims to be larger than its bytes."""
    file = io.BytesIO(content)
    version = np.lib.format.read_magic(file)
    if version != (1, 0):
        raise ValueError(f"arrays of version {version} are not read")
    shape, _, kind = np.lib.format.read_array_header_1_0(file)
    claimed = kind.itemsize * prod(max(0, size) for size in shape)
    if kind.kind not in "biuf" or claimed > len(content):
        raise ValueError("an array does not hold what it claims")
    file.seek(0)
    return np.lib.format.read_array(file, allow_pickle=False)


# Gesture models in files: numbers and plain text, never code.
#
# A ``.gestures`` file is a ZIP archive of NumPy arrays (``numpy.savez``). The array ``about`` is
# UTF-8 JSON: the format's version, what the sensor must send, the gestures, the recognisers and the
# report of the training. Recogniser 0 has its numbers in arrays named ``0.usual_score`` ...
# docs/gesture_models.md tells all of it. The same model gives the same bytes.

SUFFIX = ".gestures"
_TRAIN_AGAIN = (
    "Choose a file that `nep-studio train` has written.",
    "Or train the gestures again from their recordings.",
)


class _Version(msgspec.Struct):
    format: str
    version: int


def check_writable(path: Path) -> None:
    """Tell before the work that a model cannot be written there: RecordingError."""
    with writing(path), tempfile.TemporaryFile(dir=path.parent):
        pass


def write_model(path: Path, model: Model) -> None:
    """Write a model; the file is whole or as it was before. RecordingError when that fails."""
    with writing(path), whole_file(path) as file:
        file.write(model_bytes(model))


def model_bytes(model: Model) -> bytes:
    """A model as the content of a file."""
    arrays: dict[str, NDArray[Any]] = {"about": np.frombuffer(about_text(model).encode(), np.uint8)}
    for number, recogniser in enumerate(model.recognisers):
        for name, array in {"usual_score": recogniser.usual, **recogniser.scorer.arrays()}.items():
            small = array.astype(np.float32) if array.dtype == np.float64 else array
            arrays[f"{number}.{name}"] = small
    content = io.BytesIO()
    np.savez_compressed(content, allow_pickle=False, **arrays)
    return content.getvalue()


def read_model(path: Path) -> Model:
    """Read a model; RecordingError names the file and says what is wrong with it."""
    content = _content(path)
    try:
        arrays = read_arrays(content)
        text = arrays["about"].tobytes()
        if len(text) > _MAX_ABOUT_BYTES:
            raise ValueError("it tells more about itself than a gesture model")
        found = msgspec.json.decode(text, type=_Version)
        if found.format != FORMAT:
            raise ValueError("it is another kind of file")
        if found.version != VERSION:
            raise RecordingError(
                "{name} is a gesture model of version {version}; this program reads version {map}.",
                checklist=("Train the gestures again from their recordings.", "Update NEP Studio."),
                name=path.name,
                version=found.version,
                map=VERSION,
            )
        return _model(msgspec.json.decode(text, type=About), arrays)
    except DAMAGE as error:
        raise RecordingError(
            "{name} is not a gesture model, or it is damaged.",
            checklist=_TRAIN_AGAIN,
            details=str(error),
            name=path.name,
        ) from error


def _content(path: Path) -> bytes:
    """The bytes of a file, one more than a model may have at most."""
    try:
        if path.is_dir():
            raise RecordingError(
                "{path} is a folder, not a gesture model.", checklist=_TRAIN_AGAIN, path=path
            )
        with opened(path) as file:
            return file.read(MAX_BYTES + 1)
    except FileNotFoundError as error:
        raise RecordingError(
            "There is no gesture model {path}.", checklist=_TRAIN_AGAIN, path=path
        ) from error
    except OSError as error:
        raise RecordingError(
            "{path} cannot be read: {reason}.",
            checklist=("May you open this file?", *_TRAIN_AGAIN),
            details=str(error),
            path=path,
            reason=reason_of(error),
        ) from error


def _model(about: About, arrays: Mapping[str, NDArray[Any]]) -> Model:
    about.check()
    recognisers = tuple(
        _recogniser(one, len(about.gestures), with_prefix(arrays, f"{number}."))
        for number, one in enumerate(about.recognisers)
    )
    return Model(
        tuple(one.checked() for one in about.gestures),
        recognisers,
        about.trained_on,
        about.report,
        triggers={one.name: one.trigger for one in about.gestures},
        wrist=about.wrist,
        sensors=tuple(about.sensors),
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
            if "mean" in arrays:  # several people have taught it
                scorer = Both.from_arrays(arrays, gestures, channels)
            else:
                scorer = Trees.from_arrays(arrays, gestures, feature_count(channels))
        case "gmr":
            scorer = Gmr.from_arrays(arrays, gestures, channels)
        case _:
            raise ValueError(f"it uses a method other than {' and '.join(METHODS)}")
    return Recogniser(found.method, channels, scorer, usual)
