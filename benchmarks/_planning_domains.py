"""Small planning problems that books tell of, as tasks of the planner."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations, pairwise

from nep_core.program.facts import Fact
from nep_core.program.planner import Parameter, Pattern, Task


@dataclass(frozen=True)
class Domain:
    present: frozenset[Fact]
    goal: tuple[Fact, ...]
    tasks: tuple[Task, ...]


def task(name: str, parameters: str, needs: str, makes: str, ends: str = "") -> Task:
    """A task of texts: values that are parameters stand for those."""
    names = tuple(parameters.split())

    def patterns(text: str) -> list[Pattern]:
        return [
            tuple(Parameter(names.index(w)) if w in names else w for w in one.split())
            for one in text.split(",")
            if one.strip()
        ]

    changes = [(p, False) for p in patterns(ends)] + [(p, True) for p in patterns(makes)]
    return Task(name, names, tuple(patterns(needs)), tuple(changes))


def facts(text: str) -> tuple[Fact, ...]:
    return tuple(tuple(one.split()) for one in text.split(",") if one.strip())


def guide(rooms: int = 8, visitors: int = 4) -> Domain:
    """A robot guides visitors, one at a time, through rooms in a row to their own rooms."""
    row = [f"room{n}" for n in range(rooms)]
    present = [("at", row[0]), ("free",)]
    present += [("door", a, b) for a, b in pairwise(row)]
    present += [("door", b, a) for a, b in pairwise(row)]
    present += [("waits", f"v{n}", row[n % rooms]) for n in range(visitors)]
    goal = tuple(("waits", f"v{n}", row[-1 - n]) for n in range(visitors))
    tasks = (
        task("go", "a b", "at a, door a b", "at b", "at a"),
        task("fetch", "v a", "at a, waits v a, free", "follows v", "waits v a, free"),
        task("leave", "v a", "at a, follows v", "waits v a, free", "follows v"),
    )
    return Domain(frozenset(present), goal, tasks)


def blocks_world(count: int = 6) -> Domain:
    """A tower is built anew in the other order."""
    names = [f"b{n}" for n in range(count)]
    present = [("free",), ("clear", names[-1]), ("table", names[0])]
    present += [("on", b, a) for a, b in pairwise(names)]
    order = [*names[::2], *names[1::2]]
    goal = tuple(("on", b, a) for a, b in pairwise(order))
    tasks = (
        task("pick", "x", "clear x, table x, free", "holds x", "clear x, table x, free"),
        task("put", "x", "holds x", "clear x, table x, free", "holds x"),
        task("stack", "x y", "holds x, clear y", "clear x, on x y, free", "holds x, clear y"),
        task("take", "x y", "on x y, clear x, free", "holds x, clear y", "clear x, on x y, free"),
    )
    return Domain(frozenset(present), goal, tasks)


def gripper(balls: int = 6) -> Domain:
    present = facts("room A, room B, at A, hand left, hand right, empty left, empty right")
    names = [f"ball{n}" for n in range(balls)]
    here = [("lies", ball, "A") for ball in names]
    tasks = (
        task("move", "a b", "at a, room b", "at b", "at a"),
        task("pick", "o r h", "lies o r, at r, empty h", "holds h o", "lies o r, empty h"),
        task("drop", "o r h", "holds h o, at r", "lies o r, empty h", "holds h o"),
    )
    return Domain(frozenset([*present, *here]), tuple(("lies", ball, "B") for ball in names), tasks)


def hanoi(count: int = 5) -> Domain:
    pegs, discs = ["p1", "p2", "p3"], [f"d{n}" for n in range(count)]  # d0 is the smallest
    present = [("clear", "d0"), ("clear", "p2"), ("clear", "p3"), ("on", discs[-1], "p1")]
    present += [("on", a, b) for a, b in pairwise(discs)]
    present += [("smaller", a, b) for a, b in combinations(discs, 2)]
    present += [("smaller", a, peg) for a in discs for peg in pegs]
    goal = [
        ("on", discs[-1], "p3"),
        *(("on", a, b) for a, b in pairwise(discs)),
    ]
    move = task(
        *("move", "d x y", "on d x, clear d, clear y, smaller d y"),
        *("on d y, clear x", "on d x, clear y"),
    )
    return Domain(frozenset(present), tuple(goal), (move,))


def ferry(cars: int = 4, places: int = 4) -> Domain:
    shores = [f"s{n}" for n in range(places)]
    present = [("ferry", "s0"), ("empty",), *(("shore", s) for s in shores)]
    present += [("car", f"c{n}", shores[n % places]) for n in range(cars)]
    goal = tuple(("car", f"c{n}", shores[(n + 2) % places]) for n in range(cars))
    tasks = (
        task("sail", "a b", "ferry a, shore b", "ferry b", "ferry a"),
        task("board", "c a", "car c a, ferry a, empty", "on c", "car c a, empty"),
        task("debark", "c a", "on c, ferry a", "car c a, empty", "on c"),
    )
    return Domain(frozenset(present), goal, tasks)


def logistics() -> Domain:
    present = facts(
        "truck t1, truck t2, plane p, in a1 A, in a2 A, in b1 B, in b2 B, airport a1, airport b1,"
        "drives t1 A, drives t2 B, at t1 a2, at t2 b2, at p b1,"
        "parcel x, parcel y, parcel z, at x a2, at y b2, at z a1, vehicle t1, vehicle t2, vehicle p"
    )
    tasks = (
        task("load", "o v l", "parcel o, vehicle v, at o l, at v l", "inside o v", "at o l"),
        task("unload", "o v l", "parcel o, inside o v, at v l", "at o l", "inside o v"),
        task("drive", "t c a b", "truck t, drives t c, in a c, in b c, at t a", "at t b", "at t a"),
        task("fly", "p a b", "plane p, airport a, airport b, at p a", "at p b", "at p a"),
    )
    return Domain(frozenset(present), facts("at x b2, at y a2, at z b2"), tasks)


CLASSICS: dict[str, Callable[[], Domain]] = {
    "guide": guide,
    "blocks world": blocks_world,
    "gripper": gripper,
    "hanoi": hanoi,
    "ferry": ferry,
    "logistics": logistics,
}


def random_domain(seed: int) -> Domain:
    """A few facts and tasks by chance; about a third have no plan."""
    chance = random.Random(seed)
    atoms = [f"f{n}" for n in range(chance.randint(3, 9))]
    values = ["u", "v", "w"][: chance.randint(1, 3)]

    def pattern(names: tuple[str, ...]) -> Pattern:
        name = chance.choice(atoms)
        if int(name[1:]) % 2:  # each fact of odd number has a value
            if names and chance.random() < 0.7:
                return (name, Parameter(chance.randrange(len(names))))
            return (name, chance.choice(values))
        return (name,)

    tasks = []
    for number in range(chance.randint(2, 7)):
        names = ("a", "b")[: chance.randint(0, 2)]
        needs = tuple(pattern(names) for _ in range(chance.randint(0, 3)))
        changes = tuple(
            (pattern(names), chance.random() < 0.6) for _ in range(chance.randint(1, 3))
        )
        tasks.append(Task(f"t{number}", names, needs, changes))
    every = [(a,) if not int(a[1:]) % 2 else (a, v) for a in atoms for v in values]
    present = frozenset(one for one in every if chance.random() < 0.35)
    goal = tuple(chance.sample(every, min(len(every), chance.randint(1, 3))))
    return Domain(present, goal, tuple(tasks))
