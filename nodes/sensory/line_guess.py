"""Guesses from the numbers themselves which column is which, and in which unit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from statistics import median

from nodes.sensory.line_columns import AXES, GYR_UNITS, TIME_UNITS_S, Layout
from nodes.sensory.reading import G_M_S2

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
    gyr = next((it for it in [*_after(threes, acc), *threes] if _may_turn(columns, it, acc)), ())
    for role, at in zip(("gx", "gy", "gz"), gyr, strict=False):
        roles[at] = role
    return guess_units(Layout(tuple(roles)), rows, arrived_s)


def guess_units(
    layout: Layout, rows: Sequence[Row], arrived_s: Sequence[float], given: Layout | None = None
) -> Layout:
    """The units of these columns; those that are ``given`` are kept."""
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
    fits = [min((_gravity_error(columns, it) for it in way), default=math.inf) for way in ways]
    return ways[fits.index(min(fits))]


def _gravity_error(columns: Sequence[Row], three: Sequence[int]) -> float:
    return min(_acc_unit(_usual([columns[at] for at in three]))[1], _NEAR)


def _acceleration(columns: Sequence[Row], threes: list[tuple[int, ...]]) -> tuple[int, ...]:
    """The steadiest of those that feel gravity, else the first."""
    feeling = [it for it in threes if _gravity_error(columns, it) < _NEAR]
    if not feeling:
        return threes[0]
    return min(feeling, key=lambda it: _change([columns[at] for at in it]))


def _after(threes: list[tuple[int, ...]], acc: tuple[int, ...]) -> list[tuple[int, ...]]:
    return threes[threes.index(acc) + 1 :]


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
