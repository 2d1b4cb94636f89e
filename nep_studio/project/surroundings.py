"""What stands around the robots on the screen, as a project keeps it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from nep_core.wire.messages import Thing, ThingKind
from nep_studio.blocks.program import Project

KEY = "surroundings"
"""Where a project's file keeps what stands around its robots."""

MOST_THINGS = 60
FARTHEST_M = 20.0
LONGEST_NAME = 60
SIZES: Mapping[ThingKind, tuple[float, float, float]] = {
    "person": (0.4, 0.26, 1.65),
    "ball": (0.12, 0.12, 0.12),
    "wall": (1.2, 0.05, 0.7),
    "mark": (0.16, 0.02, 0.5),
}
"""How wide, deep and high things are, m; a mark is a card on a post."""

AHEAD_M: Mapping[ThingKind, float] = {"person": 1.2, "ball": 0.6, "wall": 1.0, "mark": 0.9}
"""How far before a robot things are put."""

FIRST_NAMES = ("Anna", "Ben", "Clara", "David", "Eva", "Felix")
FIRST_MARK = 64
Place = tuple[float, float, float]


def kept_things(project: Project) -> list[Thing]:
    """What the project's file says of things; what makes no sense there is left out."""
    entries = project.extra.get(KEY)
    found: dict[str, Thing] = {}
    for entry in entries[:MOST_THINGS] if isinstance(entries, list) else ():
        try:
            thing = msgspec.convert(entry, Thing)
        except msgspec.ValidationError:
            continue
        if _is_sound(thing):
            found.setdefault(thing.id, thing)
    return list(found.values())


def to_keep(things: Iterable[Thing]) -> list[dict[str, object]] | None:
    """Things as the value that a project's file keeps; None for none."""
    return [msgspec.to_builtins(thing) for thing in things] or None


def new_thing(
    kind: ThingKind,
    base: Place,
    there: Sequence[Thing],
    name: str = "",
    ahead_m: float | None = None,
) -> Thing:
    """Something new before a robot, which stands at ``base`` (x m, y m, theta rad), facing it.

    Where something stands already, it is put beside that.
    """
    way_m = AHEAD_M[kind] if ahead_m is None else ahead_m
    x, y = _free_place(base, way_m, there)
    return Thing(
        id=_free_id(kind, there),
        kind=kind,
        place=(round(x, 3), round(y, 3), 0.0),
        heading=_turned(base[2] + math.pi),
        size=SIZES[kind],
        name=name or _free_name(kind, there),
    )


def moved(thing: Thing, x: float, y: float) -> Thing:
    """The thing at another place of the floor."""
    place = (round(_near(x), 3), round(_near(y), 3), thing.place[2])
    return msgspec.structs.replace(thing, place=place)


def turned(thing: Thing, heading: float) -> Thing:
    """The thing facing another way (rad)."""
    return msgspec.structs.replace(thing, heading=round(_turned(heading), 4))


def named(thing: Thing, name: str) -> Thing:
    """The thing with another name, or number."""
    return msgspec.structs.replace(thing, name=" ".join(name.split())[:LONGEST_NAME])


def replaced(things: Iterable[Thing], one: Thing) -> list[Thing]:
    """The things, with this in the place of the one of the same id."""
    return [one if thing.id == one.id else thing for thing in things]


def _free_place(base: Place, way_m: float, there: Sequence[Thing]) -> tuple[float, float]:
    for step in range(24):
        side = (step + 1) // 2 * (0.35 if step % 2 else -0.35)  # 0, then left and right in turn
        angle = base[2] + side
        x, y = base[0] + way_m * math.cos(angle), base[1] + way_m * math.sin(angle)
        if all(math.hypot(x - one.place[0], y - one.place[1]) > 0.25 for one in there):
            break
    return _near(x), _near(y)


def _free_id(kind: ThingKind, there: Sequence[Thing]) -> str:
    taken, number = {thing.id for thing in there}, 1
    while f"{kind}{number}" in taken:
        number += 1
    return f"{kind}{number}"


def _free_name(kind: ThingKind, there: Sequence[Thing]) -> str:
    taken = {thing.name for thing in there if thing.kind == kind}
    if kind == "person":
        return next((name for name in FIRST_NAMES if name not in taken), "")
    if kind != "mark":
        return ""
    number = FIRST_MARK
    while str(number) in taken:
        number += 1
    return str(number)


def _near(way_m: float) -> float:
    return min(max(way_m, -FARTHEST_M), FARTHEST_M)


def _turned(angle: float) -> float:
    """The same direction, from -pi to pi."""
    return math.remainder(angle, math.tau)


def _is_sound(thing: Thing) -> bool:
    numbers = (*thing.place, thing.heading, *thing.size)
    if not all(math.isfinite(number) for number in numbers):
        return False
    is_near = all(abs(number) <= FARTHEST_M for number in thing.place)
    has_size = all(0.0 < number <= FARTHEST_M for number in thing.size)
    is_one_line = thing.name.isprintable() and len(thing.name) <= LONGEST_NAME
    return bool(thing.id) and len(thing.id) <= LONGEST_NAME and is_near and has_size and is_one_line
