"""What belongs in the mouth of a block: parts of a behaviour tree, values of one, or anything."""

from __future__ import annotations

from typing import Literal, NamedTuple

from faults import Text

from .definitions import Definition

Sort = Literal["", "tree", "ports"]
"""What a mouth takes, and a block is: a part of a tree, a value of a tree in a tree, or neither."""


class Misplaced(NamedTuple):
    """Why a block does not belong in a mouth, and what to do."""

    reason: Text
    remedy: str


_STEP = "Put it into a “step” block, which holds any blocks."
_WRONG: dict[tuple[Sort, Sort], Misplaced] = {
    ("", "tree"): Misplaced(Text("a behaviour tree is made of blocks of its own only."), _STEP),
    ("", "ports"): Misplaced(
        Text("only values that go into a tree, or out of it, belong here."),
        _STEP,
    ),
    ("tree", "ports"): Misplaced(
        Text("only values that go into a tree, or out of it, belong here."),
        "Put it below the “tree” block.",
    ),
}
_TREE_OUTSIDE = Misplaced(
    Text("it is a part of a behaviour tree, and stands in none."),
    "Put it under “behaviour tree”.",
)
_PORTS_OUTSIDE = Misplaced(
    Text("it says what goes into a tree, or out of it, and stands in none."),
    "Put it into a “tree” block that has its values.",
)


def mouth_of(definition: Definition) -> Sort:
    """What the mouths of a block take; those of a hat are what stands below it."""
    if "grows" in definition.flags:
        return "tree"
    return "ports" if "takes_ports" in definition.flags else ""


def sort_of(definition: Definition) -> Sort:
    """What a block is."""
    if "of_tree" in definition.flags:
        return "tree"
    return "ports" if "of_ports" in definition.flags else ""


def why_not_in(mouth: Sort, definition: Definition) -> Misplaced | None:
    """Why a block does not belong in a mouth, or None; notes belong anywhere."""
    sort = sort_of(definition)
    is_free = definition.is_value or definition.shape == "hat" or "silent" in definition.flags
    if sort == mouth or is_free:
        return None
    return _WRONG.get((sort, mouth), _TREE_OUTSIDE if sort == "tree" else _PORTS_OUTSIDE)
