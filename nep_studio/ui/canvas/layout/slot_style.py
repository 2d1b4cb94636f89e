"""How slots and reporters are drawn: the shape of each kind, and the text that a field shows."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import cast

from nep_studio.blocks.arithmetic import ArithmeticRefused, number_of
from nep_studio.blocks.code_text import plainly
from nep_studio.blocks.definitions import Definition, Group, Part, Slot
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.slots import RESULT_SHAPES, FieldValue, Kind
from nep_studio.blocks.text import field_text
from nep_studio.ui.words import tr

from .boxes import Outline

MOST_LINES = 3
"""So many lines of a long text are shown in its field."""


def pill_shape(language: Language, slot: Slot) -> Outline:
    """The shape of a parameter's pill: that of the block that is dragged out of it."""
    definition = language.definitions.get(slot.table)
    return block_outline(definition, is_value=True)


def block_outline(definition: Definition | None, *, is_value: bool) -> Outline:
    """The outline of a block; one of an unknown type looks as its place demands."""
    if definition is None:
        return "pill" if is_value else "statement"
    if definition.shape == "boolean":
        return "hexagon"
    if definition.is_value:
        return cast(Outline, RESULT_SHAPES[definition.result])
    if definition.shape == "hat":
        return "hat"
    return "cap" if definition.is_last else "statement"


@lru_cache(maxsize=1024)
def _said_units(parts: tuple[Part, ...]) -> frozenset[tuple[str, str]]:
    """The slots of a sentence with the word that follows each."""
    flat = [p for part in parts for p in (part.parts if isinstance(part, Group) else (part,))]
    pairs = pairwise(flat)
    return frozenset(
        (slot.name, words.split()[0])
        for slot, words in pairs
        if isinstance(slot, Slot) and isinstance(words, str) and words.strip()
    )


def unit_of(kind: Kind) -> str:
    """What a number means, shown where the sentence does not say it behind the field."""
    return f" {tr(kind.unit)}" if kind.unit.isalpha() else kind.unit


def says_unit(definition: Definition, slot_name: str, unit: str) -> bool:
    """Whether the words behind a slot begin with its unit: then the field does not repeat it."""
    said = (word for name, word in _said_units(definition.parts) if name == slot_name)
    return any(word.casefold().startswith(unit.strip()) for word in said)


def hint_word(kind: Kind) -> str:
    """What an empty place of this kind says of itself."""
    return tr(kind.hint) if kind.hint else ""


def amount_of(slot: Slot, value: FieldValue | None) -> float:
    """How full a slider is, how far an angle is turned, 1 for a tick."""
    if slot.kind.mark == "tick":
        return float(bool(value))
    if slot.kind.mark not in ("dial", "bar"):
        return 0.0
    try:
        number = float(number_of(value))
    except (ArithmeticRefused, TypeError):
        return 0.0
    if slot.low is None or slot.high is None:
        return number
    return min(max((number - slot.low) / (slot.high - slot.low), 0.0), 1.0)


def shown_text(project: Project, language: Language, block: Block, key: str, slot: Slot) -> str:
    """What a field shows, nothing when it is empty; a text of several lines keeps them.

    What could not be seen has signs: long gaps, controls, marks of direction.
    """
    return plainly(_shown_text(project, language, block, key, slot))


def _shown_text(project: Project, language: Language, block: Block, key: str, slot: Slot) -> str:
    kind, value = slot.kind.name, language.definitions[block.type].value(block, key)
    if slot.kind.mark in ("tick", "swatch") or value is None or value == "":
        return ""
    if isinstance(value, dict):
        return ", ".join(f"{name} = {setting}" for name, setting in value.items())
    if kind == "variable":
        variable = project.variable(str(value))
        return variable.name if variable is not None else ""
    if kind == "rule":
        return field_text(project, language, block, slot, value) if value in project.blocks else ""
    if kind == "robot" and value == ALL_ROBOTS:
        return tr("all robots")
    if slot.kind.unit:
        unit = unit_of(slot.kind)
        is_said = says_unit(language.definitions[block.type], slot.name, unit)
        return f"{value}" if is_said else f"{value}{unit}"
    return language.label_of(slot, value, block, key)
