"""Reads the lines of one sender: known formats at once, others by columns that are guessed."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from statistics import median

from faults import Text, text_of
from nep_core.errors import ParameterError
from nep_core.processes.manifest import finite_number

from .connectors.connector import Arrived
from .reading import (
    G_M_S2,
    Reading,
    is_of_an_app,
    is_of_paper_watch,
    read_app,
    read_json,
    read_paper_watch,
    vector,
)

# Which column of a line is which, by names that a person or a header line gives.

TIME_UNITS_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
ACC_UNITS = {"m/s²": 1.0, "g": G_M_S2, "mg": G_M_S2 / 1000}
GYR_UNITS = {"rad/s": 1.0, "°/s": math.radians(1), "m°/s": math.radians(0.001)}
_SPELLINGS = {
    "m/s2": "m/s²", "m/s^2": "m/s²", "ms-2": "m/s²", "deg/s": "°/s", "dps": "°/s", "d/s": "°/s",
    "mdps": "m°/s", "rad": "rad/s", "deg": "°/s", "sec": "s",
}  # fmt: skip
_UNIT = re.compile(r"\s*(?:[(\[]\s*(?P<in>[^)\]]*?)\s*[)\]]|[\s_](?P<after>[a-zµ°/²^\d-]+))?\s*$")
_TIME = re.compile(r"(t|ts|time|timestamp|seconds|elapsed|secondselapsed)(s|ms|us|ns)?")
_ACC = re.compile(r"(?:lin|linear|user|total)?(?:a|acc|accel|acceleration|accelerometer)?([xyz])")
_GYR = re.compile(r"(?:g|gyr|gyro|gyroscope|w|rot|rotation|rotationrate)([xyz])")
_LONGEST_NAME = 60
AXES = ("ax", "ay", "az", "gx", "gy", "gz")


@dataclass(frozen=True)
class Layout:
    """What the columns are: "t", "ax" ... "gz", or "-" for one that is left out; their units."""

    roles: tuple[str, ...]
    time_unit: str = ""
    acc_unit: str = ""
    gyr_unit: str = ""
    gravity_included: bool = True

    @property
    def words(self) -> str:
        """The columns for a person: "t (ms), ax, ay, az (m/s²), gx, gy, gz (rad/s)"."""
        units = {"t": self.time_unit, "az": self.acc_unit, "gz": self.gyr_unit}
        names = [f"{role} ({units[role]})" if units.get(role) else role for role in self.roles]
        return ", ".join(names)

    def reading(self, values: Sequence[float]) -> Reading | None:
        """One line of numbers, as many as there are roles; None when they are too large."""
        found = dict(zip(self.roles, values, strict=False))
        acc = self._three(found, "a", ACC_UNITS.get(self.acc_unit, 1.0))
        gyr = self._three(found, "g", GYR_UNITS.get(self.gyr_unit, 1.0))
        if acc is None and gyr is None:
            return None
        unit_s = TIME_UNITS_S.get(self.time_unit)
        return Reading(acc, gyr, found.get("t"), unit_s, self.gravity_included)

    def _three(
        self, found: dict[str, float], kind: str, unit: float
    ) -> tuple[float, float, float] | None:
        if f"{kind}x" not in self.roles:
            return None
        return vector([found[f"{kind}{axis}"] * unit for axis in "xyz"])


def named_columns(names: Sequence[str]) -> Layout | None:
    """What columns of such names are, with the units that they tell; None without any sensor.

    A time may be ``t``, ``timestamp``, ``time_ms``; an axis ``ax``, ``acc_x``, ``gyro.z (deg/s)``,
    or ``x`` for an acceleration; ``-`` and what is unknown is left out.
    """
    roles: list[str] = []
    units = {"t": "", "a": "", "g": ""}
    for name in names:
        role, unit = _role(name)
        role = "-" if role in roles else role
        roles.append(role)
        if role != "-" and unit:
            units[role[0]] = units[role[0]] or unit
    whole = [role if role == "t" or _is_whole(role, roles) else "-" for role in roles]
    if "ax" not in whole and "gx" not in whole:
        return None
    return Layout(tuple(whole), units["t"], units["a"], units["g"])


def _role(name: str) -> tuple[str, str]:
    """What one name means, and its unit; "-" for what is not needed."""
    name = name[:_LONGEST_NAME].strip().lower()
    found = _UNIT.search(name)
    unit = (found["in"] or found["after"] or "") if found else ""
    unit = _SPELLINGS.get(unit, unit)
    known = unit in TIME_UNITS_S or unit in ACC_UNITS or unit in GYR_UNITS
    bare = name[: found.start()] if found and (known or found["in"] is not None) else name
    plain = re.sub(r"[^a-z0-9]", "", bare)
    if time := _TIME.fullmatch(plain):
        return "t", unit if unit in TIME_UNITS_S else time[2] or ""
    if axis := _GYR.fullmatch(plain):
        return f"g{axis[1]}", unit if unit in GYR_UNITS else ""
    if axis := _ACC.fullmatch(plain):
        return f"a{axis[1]}", unit if unit in ACC_UNITS else ""
    return "-", ""


def _is_whole(role: str, roles: list[str]) -> bool:
    return role != "-" and all(f"{role[0]}{axis}" in roles for axis in "xyz")


# Guesses from the numbers themselves which column is which, and in which unit.

Row = tuple[float, ...]

_ACC_SIZES = {"m/s²": G_M_S2, "g": 1.0, "mg": 1000.0}  # what gravity is in these units
_NEAR = 0.35  # how far a usual size may be from gravity's, as a natural logarithm
_FASTEST_TURN_RAD_S = 40.0  # phones and watches measure up to 35 (2,000 °/s)
_MAGNETIC = (15.0, 0.1)  # a larger size that changes less than this share is the earth's field
_LONG_S = 0.3  # arrivals over less than this do not tell the unit of time
_LEAST_SPAN = 1e-9  # no clock counts so little in any unit, and a smaller number may vanish
_FEW_STEPS, _MOVES = 4, 0.3  # a clock that changes in fewer of its steps is none
_TWICE = 0.8  # as a natural logarithm, with some room: how well the arrivals must fit


def guess_columns(rows: Sequence[Row], arrived_s: Sequence[float]) -> Layout | None:
    """What the columns of these rows (n, c) are; None when there is no acceleration in them."""
    columns = list(zip(*rows, strict=True))
    roles = ["-"] * len(columns)
    time = next((at for at, one in enumerate(columns) if _time_unit(one, arrived_s)), None)
    if time is not None:
        roles[time] = "t"
    rest = [at for at, one in enumerate(columns) if at != time and not _is_counter(one)]
    threes = _threes(columns, rest)
    if not threes:
        return None
    acc = _acceleration(columns, threes)
    for role, at in zip(("ax", "ay", "az"), acc, strict=True):
        roles[at] = role
    after = threes[threes.index(acc) + 1 :]
    gyr = next((it for it in (*after, *threes) if _may_turn(columns, it, acc)), ())
    for role, at in zip(("gx", "gy", "gz"), gyr, strict=False):
        roles[at] = role
    return guess_units(Layout(tuple(roles)), rows, arrived_s)


def guess_units(
    layout: Layout, rows: Sequence[Row], arrived_s: Sequence[float], given: Layout | None = None
) -> Layout:
    """The units of these columns; those that are ``given`` are kept.

    ``layout`` says what the columns are, ``rows`` (n, c) are their numbers, ``arrived_s`` (n,)
    when each row came.
    """
    given = given or Layout(layout.roles)
    columns = dict(zip(layout.roles, zip(*rows, strict=True), strict=False))
    if "t" in columns and _stands_still(columns["t"]):
        del columns["t"]
        layout = replace(layout, roles=tuple("-" if one == "t" else one for one in layout.roles))
    elif "t" in columns:
        unit = given.time_unit or _time_unit(columns["t"], arrived_s) or "s"
        layout = replace(layout, time_unit=unit)
    if "ax" in columns:
        size = _usual([columns[axis] for axis in ("ax", "ay", "az")])
        unit = given.acc_unit or _acc_unit(size)[0] or "m/s²"
        feels_gravity = _acc_unit(size)[0] == unit
        layout = replace(layout, acc_unit=unit, gravity_included=feels_gravity)
    if "gx" in columns:
        layout = replace(layout, gyr_unit=given.gyr_unit or _gyr_unit(columns, layout))
    return layout


def _time_unit(column: Sequence[float], arrived_s: Sequence[float]) -> str:
    """The unit of a column of times; "" where it is none."""
    steps = [after - before for before, after in pairwise(column)]
    if len(steps) < 2 or min(steps) < 0 or sum(step > 0 for step in steps) < 0.6 * len(steps):
        return ""
    span, arrived_span_s = column[-1] - column[0], arrived_s[-1] - arrived_s[0]
    if arrived_span_s < _LONG_S:
        return "" if _is_counter(column) else _by_step(median(steps))
    if not _LEAST_SPAN < span < math.inf:
        return ""
    errors = {
        unit: abs(math.log(span * unit_s / arrived_span_s)) for unit, unit_s in TIME_UNITS_S.items()
    }
    best = min(errors, key=errors.__getitem__)
    return best if errors[best] < _TWICE else ""


def _stands_still(column: Sequence[float]) -> bool:
    """Whether a clock counts too seldom to tell samples apart, such as one of whole seconds."""
    steps = [after - before for before, after in pairwise(column)]
    return len(steps) >= _FEW_STEPS and sum(step != 0 for step in steps) < _MOVES * len(steps)


def _by_step(step: float) -> str:
    """For sensors of about 1 to 1,000 Hz."""
    limits = ((0.9, "s"), (900, "ms"), (9e5, "us"))
    return next((unit for limit, unit in limits if step < limit), "ns")


def _is_counter(column: Sequence[float]) -> bool:
    """Whether it goes up by exactly one."""
    return all(b - a == 1 for a, b in pairwise(column))


def _threes(columns: Sequence[Row], rest: Sequence[int]) -> list[tuple[int, ...]]:
    """Neighbouring columns by three; the beginning is where gravity fits best."""
    ways = []
    for start in range(min(3, len(rest) % 3 + 1)):
        places = rest[start:]
        threes = [tuple(places[at : at + 3]) for at in range(0, len(places) - 2, 3)]
        ways.append([three for three in threes if three[2] - three[0] == 2])
    return min(
        ways, key=lambda way: min((_gravity_error(columns, it) for it in way), default=math.inf)
    )


def _gravity_error(columns: Sequence[Row], three: Sequence[int]) -> float:
    return min(_acc_unit(_usual([columns[at] for at in three]))[1], _NEAR)


def _acceleration(columns: Sequence[Row], threes: list[tuple[int, ...]]) -> tuple[int, ...]:
    """The steadiest of those that feel gravity, else the first."""
    feeling = [it for it in threes if _gravity_error(columns, it) < _NEAR]
    if not feeling:
        return threes[0]
    return min(feeling, key=lambda it: _change([columns[at] for at in it]))


def _may_turn(columns: Sequence[Row], three: tuple[int, ...], acc: tuple[int, ...]) -> bool:
    if three == acc:
        return False
    axes = [columns[at] for at in three]
    size, change = _MAGNETIC
    return not (_usual(axes) > size and _change(axes) < change)


def _acc_unit(size: float) -> tuple[str, float]:
    """In which unit this is gravity's size, and how far it is from it; "" in none."""
    if size <= 0:
        return "", math.inf
    errors = {unit: abs(math.log(size / gravity)) for unit, gravity in _ACC_SIZES.items()}
    best = min(errors, key=errors.__getitem__)
    return (best if errors[best] < _NEAR else ""), errors[best]


def _gyr_unit(columns: dict[str, Row], layout: Layout) -> str:
    """By what no sensor can measure in rad/s, else by how the acceleration turns with it."""
    turns = list(zip(columns["gx"], columns["gy"], columns["gz"], strict=True))
    if max(max(map(abs, turn)) for turn in turns) > _FASTEST_TURN_RAD_S:
        return "°/s"
    share = _turning(columns, layout) if "ax" in columns and layout.gravity_included else None
    half_way = math.sqrt(GYR_UNITS["°/s"])
    return "°/s" if share is not None and share < half_way else "rad/s"


def _turning(columns: dict[str, Row], layout: Layout) -> float | None:
    """How much of ``-w x a`` the acceleration's change is: 1 in rad/s, 0.017 in °/s.

    A sensor that turns feels gravity turn the other way: da/dt = -w x a. None when it moves too
    little, or too much by other means, to tell.
    """
    if "t" not in columns:
        return None
    unit_s = TIME_UNITS_S[layout.time_unit]
    rows = list(zip(*(columns[role] for role in ("t", *AXES)), strict=True))
    both = predicted = measured = 0.0
    for (t, *before), (later, *after) in pairwise(rows):
        step_s = (later - t) * unit_s
        if step_s <= 0:
            continue
        ax, ay, az, wx, wy, wz = ((a + b) / 2 for a, b in zip(before, after, strict=True))
        cross = (az * wy - ay * wz, ax * wz - az * wx, ay * wx - ax * wy)
        change = [(b - a) / step_s for a, b in zip(before[:3], after[:3], strict=True)]
        both -= sum(one * other for one, other in zip(cross, change, strict=True))
        predicted += sum(one * one for one in cross)
        measured += sum(one * one for one in change)
    if predicted <= 0 or measured <= 0 or both <= 0 or both * both < 0.3 * predicted * measured:
        return None
    return both / predicted


def _usual(axes: Sequence[Sequence[float]]) -> float:
    return median(_sizes(axes))


def _change(axes: Sequence[Sequence[float]]) -> float:
    """The usual change of size, as a share of it."""
    sizes = _sizes(axes)
    usual = median(sizes)
    return median([abs(size - usual) for size in sizes]) / usual if usual > 0 else math.inf


def _sizes(axes: Sequence[Sequence[float]]) -> list[float]:
    return [math.sqrt(sum(one * one for one in values)) for values in zip(*axes, strict=True)]


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

    def sentence(self, sender: str) -> Text:
        """What is wrong, as a sentence."""
        if _HTTP.match(self.line):
            return text_of(
                "{sender} speaks HTTP, but this port is for lines. Set “through” to sensor_logger "
                "here.",
                sender=sender,
            )
        if self.line.startswith(("\x16\x03", "\x16\ufffd")):
            return text_of(
                "{sender} sends encrypted data. Switch the encryption off in its app.",
                sender=sender,
            )
        beginning = "".join(sign if sign.isprintable() else "\ufffd" for sign in self.line[:60])
        if _NOT_A_NUMBER.search(self.line):
            return text_of(
                "{sender} sends values that are not numbers: “{beginning}”.",
                sender=sender,
                beginning=beginning,
            )
        return text_of(
            '{sender} sends a line that cannot be read: "{unreadable}"',
            sender=sender,
            unreadable=beginning,
        )


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
        waited_s = now_s - self.arrived_s[0]
        if not (self.count >= _ENOUGH or (self.count >= _ENOUGH_FEW and waited_s > _ENOUGH_S)):
            return []
        self._guess()
        return self._all() if self.layout else []

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
            "“{columns}” names no acceleration.",
            checklist=(
                "Name the columns in their order: t, ax, ay, az, gx, gy, gz, and - for others.",
                "Leave “columns” empty to have them guessed.",
            ),
            columns=columns,
        )
    return given


class LineReader:
    """Reads lines; ``columns`` are a person's own words for them, such as "t(ms),ax(g),ay,az"."""

    def __init__(self, columns: str = "") -> None:
        self._given = own_columns(columns)
        self._header: tuple[str, ...] = ()
        self._forms: dict[object, _Form] = {}

    @property
    def columns(self) -> str:
        """How the columns are read; "" before that is known, and for formats that say it."""
        return " | ".join(form.layout.words for form in self._forms.values() if form.layout)

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
            message = read_json(line)
            if message is None:
                return None
            if is_of_an_app(message):
                return read_app(message)
            return self._named(dict(_numbers(message)), now_s)
        cells = _split(line)
        if len(cells) > _MOST_COLUMNS:
            return None
        if pairs := _pairs(cells):
            return self._named(pairs, now_s)
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

    def _named(self, values: dict[str, object], now_s: float) -> list[Reading] | None:
        names = tuple(values)
        given = named_columns(names)
        row = _row(list(values.values()))
        if given is None or row is None:
            return None
        return self._read(names, given, row, now_s)

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


# Who sends lines: each sender's lines are read in its own way, and no number of them fills us.

_MOST_SENDERS = 32  # remembered at once; the one that was silent longest is forgotten first


class LineSenders:
    """A reader of lines for each sender."""

    def __init__(self, columns: str = "") -> None:
        self._columns = columns
        self._readers: dict[str, LineReader] = {}

    def arrived(self, sender: str, lines: list[bytes], now_s: float) -> Arrived:
        """What these lines of a sender say."""
        reader = self._readers.pop(sender, None) or LineReader(self._columns)
        self._readers[sender] = reader
        if len(self._readers) > _MOST_SENDERS:
            del self._readers[next(iter(self._readers))]
        read = reader.read(lines, now_s)
        trouble = read.fault.sentence(sender) if read.fault else ""
        return Arrived(sender, read.readings, now_s, trouble, reader.columns)
