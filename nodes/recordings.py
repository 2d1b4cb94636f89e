"""Recordings of a watch or phone: read from CSV files, written to them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np

from nep_core.errors import RecordingError
from nep_core.messages import Wrist
from nodes.recording_columns import Columns
from nodes.recording_table import IS_TEXT, Floats, Table, check_size, read_table

_NO_GESTURE = {"", "0", "none", "nothing"}
_IS_THERE = ("Is the name spelled right, and is the file still there?",)
_MAY_OPEN = ("May you open it? Ask whoever owns it, or make a copy in your home folder.",)
_MAY_WRITE = (
    "Choose a folder that you may write into, such as one in your home folder.",
    "Is there room on the disk?",
)
_LONGEST_DEVICE = 100
_EARTH_M_S2 = (6.0, 14.0)  # a sensor whose usual |acceleration| is in here feels gravity, if
_CALM_M_S2 = 3.0  # it is seldom below this: one without gravity is when it rests


@dataclass(frozen=True)
class Recording:
    """n samples of one sensor.

    ``t`` (n,) is s from 0, never going back; ``acc`` (n, 3) is m/s²; ``gyr`` (n, 3) is rad/s or
    None; ``labels`` names the gesture being made at each sample, "" where there is none and "?"
    where nobody knows. ``wrist`` and ``device`` are "" when nobody said.
    """

    source: str
    t: Floats
    acc: Floats
    gyr: Floats | None
    labels: list[str] | None
    gravity_included: bool
    person: str = ""
    simulated: bool = False
    wrist: Wrist = ""
    device: str = ""

    @property
    def rate_hz(self) -> float:
        """Samples a second, gaps left out."""
        steps = np.diff(self.t)
        steps = steps[steps <= 3 * np.median(steps)] if len(steps) else steps
        return float(1 / steps.mean()) if len(steps) and steps.mean() > 0 else 0.0


def read_recordings(directory: Path) -> list[Recording]:
    """Read every CSV file of a folder, in the order of their names; RecordingError says why not."""
    if not directory.is_dir():
        raise RecordingError(
            f"{directory} is not a folder of recordings.",
            checklist=(
                "Put the recordings into a folder, as files that end with .csv.",
                "Give the name of that folder.",
            ),
        )
    try:
        paths = sorted(path for path in directory.iterdir() if path.suffix.lower() == ".csv")
    except OSError as error:
        raise _unreadable(directory, error) from error
    if not paths:
        raise RecordingError(
            f"The folder {directory} has no recordings.",
            checklist=("Put recordings into it as files that end with .csv.",),
        )
    return [read_recording(path) for path in paths]


def read_recording(path: Path) -> Recording:
    """Read one CSV file; raises RecordingError with the file, the line and what to do."""
    try:
        check_size(path)
        with path.open(encoding="utf-8-sig") as file:
            return _recording(path.stem, read_table(path, file))
    except UnicodeDecodeError as error:
        raise RecordingError(
            f"{path.name} is not a text file (UTF-8).",
            checklist=IS_TEXT,
            details=str(error),
        ) from error
    except FileNotFoundError as error:
        raise RecordingError(f"There is no recording {path}.", checklist=_IS_THERE) from error
    except IsADirectoryError as error:
        raise RecordingError(
            f"{path} is a folder, not a recording.", checklist=("Choose a CSV file in it.",)
        ) from error
    except OSError as error:
        raise _unreadable(path, error) from error


def write_recording(path: Path, recording: Recording) -> None:
    """Write a CSV file that ``read_recording`` reads back; the file is whole or as it was."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.unfinished")
    try:
        with unfinished.open("w", encoding="utf-8", newline="\n") as file:
            file.writelines(_lines_of(recording))
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    except OSError as error:
        raise RecordingError(
            f"{path} cannot be written: {error.strerror}.", checklist=_MAY_WRITE, details=str(error)
        ) from error
    finally:
        unfinished.unlink(missing_ok=True)


def _unreadable(path: Path, error: OSError) -> RecordingError:
    return RecordingError(
        f"{path} cannot be read: {error.strerror}.", checklist=_MAY_OPEN, details=str(error)
    )


def _recording(stem: str, table: Table) -> Recording:
    person, gesture = _who_and_what(stem)
    acc = table.numbers[:, 1:4]
    return Recording(
        source=stem,
        t=_seconds(table.numbers[:, 0], table.columns),
        acc=acc,
        gyr=table.numbers[:, 4:7] if table.columns.gyr else None,
        labels=_labels(table.gestures, gesture),
        gravity_included=_feels_gravity(acc, table),
        person=table.about.get("person", person if table.gestures else ""),
        simulated=table.about.get("simulated") == "yes",
        wrist=_wrist(table.about.get("wrist", "")),
        device=_printable(table.about.get("device", "")),
    )


def _printable(text: str) -> str:
    return "".join(one for one in text if one.isprintable())[:_LONGEST_DEVICE]


def _wrist(told: str) -> Wrist:
    return told if told in get_args(Wrist) else ""  # type: ignore[return-value] # in says so


def _seconds(times: Floats, columns: Columns) -> Floats:
    seconds: Floats = (times - times[0]) * columns.unit_of(np.diff(times))
    return seconds


def _feels_gravity(acc: Floats, table: Table) -> bool:
    if "gravity_included" in table.about:
        return table.about["gravity_included"] == "yes"
    calm, usual = np.percentile(np.linalg.norm(acc, axis=1), [20, 50])
    feels = _EARTH_M_S2[0] < usual < _EARTH_M_S2[1] and calm > _CALM_M_S2
    return bool(feels) and not table.columns.gravity_removed


def _who_and_what(stem: str) -> tuple[str, str]:
    """Person and gesture from a file name such as ``j_bounce_up``."""
    person, underscore, gesture = stem.partition("_")
    return (person, gesture) if underscore and gesture else ("", stem)


def _labels(cells: list[str], gesture: str) -> list[str] | None:
    if not cells:
        return None
    names = ["" if cell.lower() in _NO_GESTURE else cell for cell in cells]
    return [gesture if name == "1" else name for name in names]


def _lines_of(recording: Recording) -> Iterator[str]:
    """The file's lines: what is known of the whole, the header, a line a sample."""
    yield f"# person: {_one_line(recording.person)}\n"
    yield f"# gravity_included: {'yes' if recording.gravity_included else 'no'}\n"
    yield f"# simulated: {'yes' if recording.simulated else 'no'}\n"
    if recording.wrist:
        yield f"# wrist: {recording.wrist}\n"
    if recording.device:
        yield f"# device: {' '.join(recording.device.split())}\n"
    gyr_names = ",gx,gy,gz" if recording.gyr is not None else ""
    yield f"t_s,ax,ay,az{gyr_names}{',gesture' if recording.labels is not None else ''}\n"
    parts = [recording.t[:, None], recording.acc]
    table = np.hstack(parts if recording.gyr is None else [*parts, recording.gyr])
    for at, row in enumerate(table):
        label = f",{_one_line(recording.labels[at])}" if recording.labels is not None else ""
        yield f"{row[0]:.6f}," + ",".join(f"{value:.6g}" for value in row[1:]) + f"{label}\n"


def _one_line(text: str) -> str:
    return re.sub(r'[\s,;"]+', "_", text)
