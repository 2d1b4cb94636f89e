"""Recordings of a watch or phone: read from CSV files, written to them."""

from __future__ import annotations

import contextlib
import errno
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO, get_args

import numpy as np
from numpy.typing import NDArray

from faults import Text, Words, reason_of, text_of
from faults.files import opened, whole_file
from nep_core.errors import RecordingError
from nep_core.wire.messages import Wrist

# Which column of a recording is which: time, acceleration, gyroscope, gesture.

_UNIT_IN_BRACKETS = re.compile(r"[(\[].*?[)\]]")
_ACCELERATION = r"(?:lin|linear|user)?(?:a|acc|accel|acceleration|accelerometer)"
_ROTATION = r"(?:g|gyr|gyro|gyroscope|rotation|rotationrate)"
_TIME = re.compile(r"(?:t|ts|time|timestamp|seconds|elapsed|secondselapsed)(s|ms|us|ns)?")
_TIME_UNITS_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


@dataclass(frozen=True)
class Columns:
    """Where the columns of a table are, counted from 0; ``time_unit_s`` is None when unsaid."""

    time: int
    time_unit_s: float | None
    acc: tuple[int, int, int]
    gyr: tuple[int, int, int] | None
    gesture: int | None
    gravity_removed: bool

    @property
    def numbers(self) -> tuple[int, ...]:
        """The columns that hold numbers, in the order time, acceleration, gyroscope."""
        return (self.time, *self.acc, *(self.gyr or ()))

    def unit_of(self, steps: NDArray[np.float64]) -> float:
        """The unit of time in s: as the column's name says, or as ``steps`` (n - 1,) suggest."""
        return self.time_unit_s or guess_time_unit_s(float(np.median(steps)))


def find_columns(header: list[str]) -> Columns | None:
    """Find the columns by their names, in any order; None without a time or an acceleration."""
    names = [_plain(name) for name in header]
    acc = _axes(names, _ACCELERATION) or _axes(names, "")
    times = [(at, match) for at, name in enumerate(names) if (match := _TIME.fullmatch(name))]
    if acc is None or not times:
        return None
    at, match = times[0]
    return Columns(
        time=at,
        time_unit_s=_TIME_UNITS_S.get(match[1] or ""),
        acc=acc,
        gyr=_axes(names, _ROTATION),
        gesture=names.index("gesture") if "gesture" in names else None,
        gravity_removed=bool(re.search("lin|user", names[acc[0]])),
    )


def guess_time_unit_s(step: float) -> float:
    """The unit of time stamps that are ``step`` apart, for sensors of about 1 to 1,000 Hz."""
    limits = ((0.9, 1.0), (900.0, 1e-3), (9e5, 1e-6))
    return next((unit_s for limit, unit_s in limits if step < limit), 1e-9)


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", _UNIT_IN_BRACKETS.sub("", name.lower()))


def _axes(names: list[str], what: str) -> tuple[int, int, int] | None:
    found = []
    for axis in "xyz":
        pattern = re.compile(f"{what}{axis}|{axis}{what}")
        at = next((i for i, name in enumerate(names) if pattern.fullmatch(name)), None)
        if at is None:
            return None
        found.append(at)
    return found[0], found[1], found[2]


# The numbers of a recording's CSV file, checked line by line.

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
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is not a file")  # but a pipe, or a device without an end
    size = path.stat().st_size
    with opened(path) as file:
        head = file.read(_HEAD_BYTES)
    if b"\0" in head:
        raise RecordingError(
            "{name} is not a text file; a recording is a CSV file.",
            checklist=IS_TEXT,
            name=path.name,
        )
    lines_in_head = head.count(b"\n")
    if size >= _HEAD_BYTES and not lines_in_head:
        raise RecordingError(
            "{name} is one endless line; a recording has a line a sample.",
            checklist=IS_TEXT,
            name=path.name,
        )
    samples = size * lines_in_head // max(1, len(head))
    if samples > MAX_SAMPLES * 1.1 or size > _MAX_BYTES:
        raise _too_long(path, text_of("about {samples}", samples=f"{samples:,}"))


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
    raise RecordingError("{name} is empty.", checklist=_RECORD_AGAIN, name=path.name)


class _Rows:
    """The lines below the header, as they are read."""

    def __init__(self, path: Path, columns: Columns, separator: str) -> None:
        self.gestures: list[str] = []
        self._path, self._columns, self._separator = path, columns, separator
        self._numbers = array("d")
        self._line_numbers = array("q")

    def add(self, line_number: int, line: str) -> None:
        """Take one line; RecordingError when a number is missing or is text."""
        if len(self._line_numbers) >= MAX_SAMPLES:
            raise _too_long(self._path, text_of("more than {samples}", samples=f"{MAX_SAMPLES:,}"))
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
                "{name} has too few samples: {count}.",
                checklist=_RECORD_AGAIN,
                name=self._path.name,
                count=len(numbers),
            )
        self._check_finite(numbers)
        self._check_measurable(numbers)
        self._check_times(numbers[:, 0])
        return numbers

    def _check_finite(self, numbers: Floats) -> None:
        bad_rows = np.flatnonzero(~np.isfinite(numbers).all(axis=1))
        if len(bad_rows):
            raise RecordingError(
                "Line {line_numbers} of {name} has a number that is not finite (NaN or infinity).",
                checklist=("Remove that line, or record the movement once more.",),
                line_numbers=self._line_numbers[bad_rows[0]],
                name=self._path.name,
            )

    def _check_measurable(self, numbers: Floats) -> None:
        limits = np.full(numbers.shape[1], _MOST_MEASURED)
        limits[0] = _LATEST
        rows, columns = np.nonzero(np.abs(numbers) > limits)
        if len(rows):
            raise RecordingError(
                "Line {line_numbers} of {name} has the number {numbers}, which no sensor can "
                "measure.",
                checklist=(
                    "Remove that line, or record the movement once more.",
                    "Acceleration is in m/s², rotation in rad/s.",
                ),
                line_numbers=self._line_numbers[rows[0]],
                name=self._path.name,
                numbers=f"{numbers[rows[0], columns[0]]:g}",
            )

    def _check_times(self, times: Floats) -> None:
        steps = np.diff(times)
        back = np.flatnonzero(steps < 0)
        if len(back):
            raise RecordingError(
                "The times of {name} go backwards at line {line_numbers}.",
                checklist=("Is it two recordings in one file? Save each in a file of its own.",),
                name=self._path.name,
                line_numbers=self._line_numbers[back[0] + 1],
            )
        if times[0] == times[-1]:
            raise RecordingError(
                "The times of {name} are all the same.",
                checklist=("The first column is the time of each sample, in seconds.",),
                name=self._path.name,
            )
        gaps = np.flatnonzero(steps * self._columns.unit_of(steps) > _LONGEST_GAP_S)
        if len(gaps):
            line = self._line_numbers[gaps[0] + 1]
            raise RecordingError(
                "Line {line} of {name} is more than an hour later than the one before.",
                checklist=(
                    "Cut the recording there: save line {line} and all below it in a file of their "
                    "own, with the same header.",
                    "Is only this time wrong? Remove the line.",
                ),
                line=line,
                name=self._path.name,
            )

    def _unreadable(self, line_number: int, cells: list[str]) -> RecordingError:
        where = text_of(
            "Line {line_number} of {name}", line_number=line_number, name=self._path.name
        )
        for at in self._columns.numbers:
            if at >= len(cells):
                break
            if not _is_number(cells[at]):
                told = f'"{_shown(cells[at][:40])}"' if cells[at] else Text("nothing")
                return RecordingError(
                    "{where} has {told} in column {at}, where a number belongs.",
                    checklist=_COLUMNS_CHECKLIST,
                    where=where,
                    told=told,
                    at=at + 1,
                )
        return RecordingError(
            "{where} has only {count} columns.",
            checklist=_COLUMNS_CHECKLIST,
            where=where,
            count=len(cells),
        )


def _cells(line: str, separator: str) -> list[str]:
    if separator == ";":
        line = line.replace(",", ".")  # semicolons come with decimal commas
    return [cell.strip() for cell in line.replace('"', "").split(separator)]


def _shown(text: str) -> str:
    """Text from a file, without the characters that would command a terminal."""
    return "".join(one if one.isprintable() else "?" for one in text)


def _is_number(text: str) -> bool:
    with contextlib.suppress(ValueError):
        float(text)
        return True
    return False


def _too_long(path: Path, samples: Words) -> RecordingError:
    return RecordingError(
        "{name} has {samples} samples; a recording may have {max_samples}.",
        checklist=("Cut it into shorter recordings.",),
        name=path.name,
        samples=samples,
        max_samples=f"{MAX_SAMPLES:,}",
    )


def _unknown_columns(path: Path, line_number: int, names: list[str]) -> RecordingError:
    if all(_is_number(name) for name in names):
        sentence = text_of(
            "{name} has no header: line {line_number} holds numbers already.",
            name=path.name,
            line_number=line_number,
        )
    else:
        found = ", ".join(_shown(name[:20]) for name in names[:8])
        sentence = text_of(
            "{name} needs the columns t_s, ax, ay and az; its header, line {line_number}, names "
            "{found}.",
            name=path.name,
            line_number=line_number,
            found=found,
        )
    return RecordingError(sentence, checklist=_COLUMNS_CHECKLIST)


_NO_GESTURE = {"", "0", "none", "nothing"}
_IS_THERE = ("Is the name spelled right, and is the file still there?",)
_MAY_OPEN = ("May you open it? Ask whoever owns it, or make a copy in your home folder.",)
MAY_WRITE = (
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
            "{directory} is not a folder of recordings.",
            checklist=(
                "Put the recordings into a folder, as files that end with .csv.",
                "Give the name of that folder.",
            ),
            directory=directory,
        )
    try:
        paths = sorted(path for path in directory.iterdir() if path.suffix.lower() == ".csv")
    except OSError as error:
        raise _unreadable(directory, error) from error
    if not paths:
        raise RecordingError(
            "The folder {directory} has no recordings.",
            checklist=("Put recordings into it as files that end with .csv.",),
            directory=directory,
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
            "{name} is not a text file (UTF-8).",
            checklist=IS_TEXT,
            details=str(error),
            name=path.name,
        ) from error
    except FileNotFoundError as error:
        raise RecordingError(
            "There is no recording {path}.", checklist=_IS_THERE, path=path
        ) from error
    except IsADirectoryError as error:
        raise RecordingError(
            "{path} is a folder, not a recording.",
            checklist=("Choose a CSV file in it.",),
            path=path,
        ) from error
    except OSError as error:
        raise _unreadable(path, error) from error


def write_recording(path: Path, recording: Recording) -> None:
    """Write a CSV file that ``read_recording`` reads back; the file is whole or as it was."""
    with writing(path), whole_file(path) as file:
        file.writelines(line.encode() for line in _lines_of(recording))


@contextlib.contextmanager
def writing(path: Path) -> Iterator[None]:
    """Tell what to try when ``path`` cannot be written: an OSError becomes a RecordingError."""
    try:
        yield
    except OSError as error:
        raise RecordingError(
            "{path} cannot be written: {reason}.",
            checklist=MAY_WRITE,
            details=str(error),
            path=path,
            reason=reason_of(error),
        ) from error


def _unreadable(path: Path, error: OSError) -> RecordingError:
    return RecordingError(
        "{path} cannot be read: {reason}.",
        checklist=_MAY_OPEN,
        details=str(error),
        path=path,
        reason=reason_of(error),
    )


def _recording(stem: str, table: Table) -> Recording:
    person, gesture = _who_and_what(stem)
    times, acc = table.numbers[:, 0], table.numbers[:, 1:4]
    return Recording(
        source=stem,
        t=(times - times[0]) * table.columns.unit_of(np.diff(times)),
        acc=acc,
        gyr=table.numbers[:, 4:7] if table.columns.gyr else None,
        labels=_labels(table.gestures, gesture),
        gravity_included=_feels_gravity(acc, table),
        person=table.about.get("person", person if table.gestures else ""),
        simulated=table.about.get("simulated") == "yes",
        wrist=_wrist(table.about.get("wrist", "")),
        device="".join(filter(str.isprintable, table.about.get("device", "")))[:_LONGEST_DEVICE],
    )


def _wrist(told: str) -> Wrist:
    return told if told in get_args(Wrist) else ""  # type: ignore[return-value] # in says so


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
