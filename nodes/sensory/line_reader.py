"""Reads the lines of one sender: known formats at once, others by columns that are guessed."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from nep_core.errors import ParameterError
from nodes.sensory.line_columns import Layout, named_columns
from nodes.sensory.line_guess import Row, guess_columns, guess_units
from nodes.sensory.lines import (
    is_of_an_app,
    is_of_paper_watch,
    read_app,
    read_json,
    read_paper_watch,
)
from nodes.sensory.reading import Reading, finite_number

_LONGEST_LINE = 8_192
_MOST_COLUMNS = 64
_MOST_FORMS = 4  # lines of different columns that one sender mixes
_ENOUGH = 20  # lines before the first guess, or
_ENOUGH_FEW, _ENOUGH_S = 5, 1.0  # so few when they come slowly
_LOOK_AGAIN = (100, 400, 1600)  # lines after which the guess is made anew
_SEEN = 200  # lines that a guess is made from
_COMMAS = re.compile(r"[;,\t]")
_LONGEST_CELL = 100
_PAIR = re.compile(r"([A-Za-z][\w. ]{0,30}?)\s*[:=]\s*(\S{1,40})")
_DECIMAL_COMMA = re.compile(r"(\d),(\d)")  # as apps write in many languages, between semicolons
_POINT_OR_LIST = re.compile(r"\.|^[^;\t]*$")
_HTTP = re.compile(r"(GET|POST|PUT|HEAD|OPTIONS) \S+ HTTP/")
_NOT_A_NUMBER = re.compile(r"\b(nan|inf|infinity|null)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Fault:
    """A line that cannot be used."""

    line: str

    def told(self, sender: str) -> str:
        """What is wrong, as a sentence."""
        if _HTTP.match(self.line):
            return (
                f"{sender} speaks HTTP, but this port is for lines. "
                "Set “through” to sensor_logger here."
            )
        if self.line.startswith(("\x16\x03", "\x16\ufffd")):
            return f"{sender} sends encrypted data. Switch the encryption off in its app."
        beginning = "".join(sign if sign.isprintable() else "\ufffd" for sign in self.line[:60])
        if _NOT_A_NUMBER.search(self.line):
            return f"{sender} sends values that are not numbers: “{beginning}”."
        return f'{sender} sends a line that cannot be read: "{beginning}"'


@dataclass(frozen=True)
class Read:
    """The readings of some lines, and the first that could not be read."""

    readings: list[Reading]
    fault: Fault | None = None


@dataclass
class _Form:
    """Lines of one number of columns, or of one set of names."""

    given: Layout | None
    layout: Layout | None = None
    count: int = 0
    rows: deque[Row] = field(default_factory=lambda: deque(maxlen=_SEEN))
    arrived_s: deque[float] = field(default_factory=lambda: deque(maxlen=_SEEN))

    def read(self, row: Row, now_s: float) -> list[Reading]:
        """The readings that this line makes, with those before the first guess at its time."""
        self.count += 1
        if self.count <= _LOOK_AGAIN[-1]:
            self.rows.append(row)
            self.arrived_s.append(now_s)
        if self.layout is not None:
            if self.count in _LOOK_AGAIN:
                self._guess()
            reading = self.layout.reading(row)
            return [] if reading is None else [reading]
        if not self._has_enough(now_s):
            return []
        self._guess()
        return self._all() if self.layout else []

    def _has_enough(self, now_s: float) -> bool:
        waited_s = now_s - self.arrived_s[0]
        return self.count >= _ENOUGH or (self.count >= _ENOUGH_FEW and waited_s > _ENOUGH_S)

    def _guess(self) -> None:
        rows, arrived_s = list(self.rows), list(self.arrived_s)
        if self.given is not None:
            self.layout = guess_units(self.given, rows, arrived_s, self.given)
        elif self.layout is None:
            self.layout = guess_columns(rows, arrived_s)
        else:
            self.layout = guess_units(self.layout, rows, arrived_s)

    def _all(self) -> list[Reading]:
        """The lines up to the first guess; only the last where their times are not known."""
        assert self.layout is not None
        has_times = "t" in self.layout.roles
        rows: Sequence[Row] = list(self.rows) if has_times else [self.rows[-1]]
        return [one for row in rows if (one := self.layout.reading(row)) is not None]


def own_columns(columns: str) -> Layout | None:
    """What a person's words for the columns mean, None for no words; raises ParameterError."""
    if not columns.strip():
        return None
    given = named_columns(_COMMAS.split(columns.strip()))
    if given is None or "ax" not in given.roles:
        raise ParameterError(
            f"“{columns}” names no acceleration.",
            checklist=(
                "Name the columns in their order: t, ax, ay, az, gx, gy, gz, and - for others.",
                "Leave “columns” empty to have them guessed.",
            ),
        )
    return given


class LineReader:
    """Reads lines; ``columns`` are a person's own words for them, such as "t(ms),ax(g),ay,az"."""

    def __init__(self, columns: str = "") -> None:
        self._given = own_columns(columns)
        self._header: tuple[str, ...] = ()
        self._forms: dict[object, _Form] = {}

    @property
    def told(self) -> str:
        """How the columns are read; "" before that is known, and for formats that say it."""
        return " | ".join(form.layout.told for form in self._forms.values() if form.layout)

    def read(self, lines: Sequence[bytes], now_s: float) -> Read:
        """The readings of some lines that arrived together."""
        readings: list[Reading] = []
        fault: Fault | None = None
        for raw in lines:
            line = raw[: _LONGEST_LINE + 1].decode("utf-8", errors="replace").strip("\r\n\0 \ufeff")
            if not line:
                continue
            found = None if len(line) > _LONGEST_LINE else self._line(line, now_s)
            if found is None:
                fault = fault or Fault(line)
            else:
                readings.extend(found)
        return Read(readings, fault)

    def _line(self, line: str, now_s: float) -> list[Reading] | None:
        if is_of_paper_watch(line):
            return read_paper_watch(line)
        if line.startswith("{"):
            return self._json(line, now_s)
        cells = _split(line)
        if len(cells) > _MOST_COLUMNS:
            return None
        if pairs := _pairs(cells):
            return self._named(pairs, now_s)
        return self._cells(cells, now_s)

    def _json(self, line: str, now_s: float) -> list[Reading] | None:
        message = read_json(line)
        if message is None:
            return None
        if is_of_an_app(message):
            return read_app(message)
        return self._named(dict(_numbers(message)), now_s)

    def _named(self, values: dict[str, object], now_s: float) -> list[Reading] | None:
        names = tuple(values)
        given = named_columns(names)
        row = _row(list(values.values()))
        if given is None or row is None:
            return None
        return self._read(names, given, row, now_s)

    def _cells(self, cells: list[str], now_s: float) -> list[Reading] | None:
        row = _row(cells)
        if row is None:
            return self._names(cells)
        if len(row) < 3:
            return None
        given = self._given
        if given is None and len(self._header) == len(row):
            given = named_columns(self._header)
        if self._given is not None and len(row) < len(self._given.roles):
            return None
        return self._read(len(row), given, row, now_s)

    def _names(self, cells: list[str]) -> list[Reading] | None:
        """A header line, which names the columns of those that follow; None for any other text."""
        if named_columns(cells) is None:
            return None
        if self._header != tuple(cells):
            self._header = tuple(cells)
            self._forms.clear()
        return []

    def _read(
        self, key: object, given: Layout | None, row: Row, now_s: float
    ) -> list[Reading] | None:
        form = self._forms.get(key)
        if form is None:
            if len(self._forms) >= _MOST_FORMS:
                self._forms.pop(next(iter(self._forms)))
            form = self._forms[key] = _Form(given)
        found = form.read(row[: len(given.roles)] if given else row, now_s)
        is_hopeless = form.layout is None and form.count > _ENOUGH
        return None if is_hopeless and not found else found


def _split(line: str) -> list[str]:
    """The cells of a line, without empty ones at its end."""
    if _DECIMAL_COMMA.search(line) and not _POINT_OR_LIST.search(line):
        line = _DECIMAL_COMMA.sub(r"\1.\2", line)
    cells = [cell.strip() for cell in _COMMAS.split(line)] if _COMMAS.search(line) else line.split()
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _pairs(cells: list[str]) -> dict[str, object]:
    """Cells such as ``ax:0.1`` or ``ax=0.1`` by name; none where one of them is no such pair."""
    found: dict[str, object] = {}
    for cell in cells:
        pair = _PAIR.fullmatch(cell[:_LONGEST_CELL])
        if pair is None:
            return {}
        found[pair[1]] = pair[2]
    return found


def _row(values: Sequence[object]) -> Row | None:
    found = tuple(finite_number(value) for value in values)
    return None if None in found or not found else found  # type: ignore[return-value]


def _numbers(message: dict[str, object]) -> list[tuple[str, object]]:
    """What an object has of a sensor, by name, those of its lists and objects as ``name.x``."""
    found: list[tuple[str, object]] = []
    for name, value in message.items():
        if isinstance(value, dict):
            found += [(f"{name}.{axis}", value[axis]) for axis in "xyz" if axis in value]
        elif isinstance(value, list) and len(value) == 3:
            found += [(f"{name}.{axis}", one) for axis, one in zip("xyz", value, strict=True)]
        elif _is_name(name):
            found.append((name, value))
    return found[:_MOST_COLUMNS]


def _is_name(name: str) -> bool:
    layout = named_columns([name, "gx", "gy", "gz", "ax", "ay", "az"])
    return layout is not None and layout.roles[0] != "-"
