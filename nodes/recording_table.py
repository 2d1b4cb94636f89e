"""The numbers of a recording's CSV file, checked line by line."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from nep_core.errors import RecordingError
from nodes.recording_columns import Columns, find_columns

Floats = NDArray[np.float64]

MAX_SAMPLES = 1_000_000
_MAX_BYTES = 500_000_000
_HEAD_BYTES = 65_536
_LONGEST_GAP_S = 3600.0
_MOST_MEASURED = 10_000.0  # m/s² (a thousand times gravity), and rotation even in degrees
_LATEST = 1e20  # in any unit: nanoseconds since 1970 are 2e18
_COLUMNS_CHECKLIST = (
    "The first line names the columns, for example t_s,ax,ay,az,gx,gy,gz,gesture.",
    "Every line below it has one value for each column.",
    "Numbers are written with a dot: 9.81.",
)
IS_TEXT = (
    "Choose the CSV file that the app of the watch or phone has saved.",
    "From a spreadsheet, save it as CSV with the encoding UTF-8.",
)
_RECORD_AGAIN = ("Record the movement once more.",)


@dataclass(frozen=True)
class Table:
    """A file as it is: ``about`` from its ``# name: value`` lines, its columns and its cells.

    ``numbers`` (n, 4 or 7) are time, acceleration and gyroscope in the file's own units;
    ``gestures`` are n cells of the gesture column, or none.
    """

    about: dict[str, str]
    columns: Columns
    numbers: Floats
    gestures: list[str]


def check_size(path: Path) -> None:
    """Tell a file that is too long by its size and first lines, without reading it all."""
    if path.is_dir():
        raise IsADirectoryError
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    if b"\0" in head:
        raise RecordingError(
            f"{path.name} is not a text file; a recording is a CSV file.", checklist=IS_TEXT
        )
    lines_in_head = head.count(b"\n")
    if size >= _HEAD_BYTES and not lines_in_head:
        raise RecordingError(
            f"{path.name} is one endless line; a recording has a line a sample.", checklist=IS_TEXT
        )
    samples = size * lines_in_head // max(1, len(head))
    if samples > MAX_SAMPLES * 1.1 or size > _MAX_BYTES:
        raise _too_long(path, f"about {samples:,}")


def read_table(path: Path, file: TextIO) -> Table:
    """Read an open CSV file; RecordingError names the line that cannot be read."""
    about, header_line, header = _read_header(path, file)
    separator = ";" if header.count(";") > header.count(",") else ","
    names = _cells(header, separator)
    columns = find_columns(names)
    if columns is None:
        raise _unknown_columns(path, header_line, names)
    rows = _Rows(path, columns, separator)
    for number, line in enumerate(file, start=header_line + 1):
        if line.strip():
            rows.add(number, line)
    return Table(about, columns, rows.checked_numbers(), rows.gestures)


def _read_header(path: Path, file: TextIO) -> tuple[dict[str, str], int, str]:
    """The lines above the header, and the number and text of the header line."""
    about = {}
    for number, line in enumerate(file, start=1):
        if line.startswith("#"):
            name, _, value = line[1:].partition(":")
            about[name.strip()] = value.strip()
        elif line.strip():
            return about, number, line
    raise RecordingError(f"{path.name} is empty.", checklist=_RECORD_AGAIN)


class _Rows:
    """The lines below the header, as they are read."""

    def __init__(self, path: Path, columns: Columns, separator: str) -> None:
        self.gestures: list[str] = []
        self._path = path
        self._columns = columns
        self._separator = separator
        self._numbers = array("d")
        self._line_numbers = array("q")

    def add(self, line_number: int, line: str) -> None:
        """Take one line; RecordingError when a number is missing or is text."""
        if len(self._line_numbers) >= MAX_SAMPLES:
            raise _too_long(self._path, f"more than {MAX_SAMPLES:,}")
        cells = _cells(line, self._separator)
        try:
            self._numbers.extend([float(cells[at]) for at in self._columns.numbers])
            if self._columns.gesture is not None:
                self.gestures.append(cells[self._columns.gesture])
        except (ValueError, IndexError) as error:
            raise self._unreadable(line_number, cells) from error
        self._line_numbers.append(line_number)

    def checked_numbers(self) -> Floats:
        """All numbers; RecordingError when they make no sense together."""
        numbers = np.array(self._numbers).reshape(-1, len(self._columns.numbers))
        if len(numbers) < 2:
            raise RecordingError(
                f"{self._path.name} has too few samples: {len(numbers)}.", checklist=_RECORD_AGAIN
            )
        self._check_finite(numbers)
        self._check_measurable(numbers)
        self._check_times(numbers[:, 0])
        return numbers

    def _check_finite(self, numbers: Floats) -> None:
        bad_rows = np.flatnonzero(~np.isfinite(numbers).all(axis=1))
        if len(bad_rows):
            raise RecordingError(
                f"Line {self._line_numbers[bad_rows[0]]} of {self._path.name} has a number that is "
                "not finite (NaN or infinity).",
                checklist=("Remove that line, or record the movement once more.",),
            )

    def _check_measurable(self, numbers: Floats) -> None:
        limits = np.full(numbers.shape[1], _MOST_MEASURED)
        limits[0] = _LATEST
        rows, columns = np.nonzero(np.abs(numbers) > limits)
        if len(rows):
            raise RecordingError(
                f"Line {self._line_numbers[rows[0]]} of {self._path.name} has the number "
                f"{numbers[rows[0], columns[0]]:g}, which no sensor can measure.",
                checklist=(
                    "Remove that line, or record the movement once more.",
                    "Acceleration is in m/s², rotation in rad/s.",
                ),
            )

    def _check_times(self, times: Floats) -> None:
        steps = np.diff(times)
        back = np.flatnonzero(steps < 0)
        if len(back):
            raise RecordingError(
                f"The times of {self._path.name} go backwards at line "
                f"{self._line_numbers[back[0] + 1]}.",
                checklist=("Is it two recordings in one file? Save each in a file of its own.",),
            )
        if times[0] == times[-1]:
            raise RecordingError(
                f"The times of {self._path.name} are all the same.",
                checklist=("The first column is the time of each sample, in seconds.",),
            )
        gaps = np.flatnonzero(steps * self._columns.unit_of(steps) > _LONGEST_GAP_S)
        if len(gaps):
            line = self._line_numbers[gaps[0] + 1]
            raise RecordingError(
                f"Line {line} of {self._path.name} is more than an hour later than the one before.",
                checklist=(
                    f"Cut the recording there: save line {line} and all below it in a file of "
                    "their own, with the same header.",
                    "Is only this time wrong? Remove the line.",
                ),
            )

    def _unreadable(self, line_number: int, cells: list[str]) -> RecordingError:
        where = f"Line {line_number} of {self._path.name}"
        for at in self._columns.numbers:
            if at >= len(cells):
                break
            if not _is_number(cells[at]):
                told = f'"{_shown(cells[at][:40])}"' if cells[at] else "nothing"
                return RecordingError(
                    f"{where} has {told} in column {at + 1}, where a number belongs.",
                    checklist=_COLUMNS_CHECKLIST,
                )
        return RecordingError(
            f"{where} has only {len(cells)} columns.", checklist=_COLUMNS_CHECKLIST
        )


def _cells(line: str, separator: str) -> list[str]:
    if separator == ";":
        line = line.replace(",", ".")  # semicolons come with decimal commas
    return [cell.strip() for cell in line.replace('"', "").split(separator)]


def _shown(text: str) -> str:
    """Text from a file, without the characters that would command a terminal."""
    return "".join(one if one.isprintable() else "?" for one in text)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _too_long(path: Path, samples: str) -> RecordingError:
    return RecordingError(
        f"{path.name} has {samples} samples; a recording may have {MAX_SAMPLES:,}.",
        checklist=("Cut it into shorter recordings.",),
    )


def _unknown_columns(path: Path, line_number: int, names: list[str]) -> RecordingError:
    if all(_is_number(name) for name in names):
        sentence = f"{path.name} has no header: line {line_number} holds numbers already."
    else:
        found = ", ".join(_shown(name[:20]) for name in names[:8])
        sentence = (
            f"{path.name} needs the columns t_s, ax, ay and az; "
            f"its header, line {line_number}, names {found}."
        )
    return RecordingError(sentence, checklist=_COLUMNS_CHECKLIST)
