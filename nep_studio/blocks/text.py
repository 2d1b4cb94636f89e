"""A block as a sentence in plain text: for problems, for the screen reader, for typing a block."""

from __future__ import annotations

from collections.abc import Iterator

from .code_text import plainly
from .definitions import Definition, Group, Part, Slot
from .language import Language
from .program import ALL_ROBOTS, Block, Project
from .slots import FieldValue, nearest_colour

LONGEST = 120
_DEEPEST = 4
_EMPTY = "…"


def sentence(project: Project, language: Language, block_id: str) -> str:
    """What a block says, as "NAO says Impressive! with no gesture"; what is too long is cut."""
    text = plainly(_sentence(project, language.of(project), project.blocks[block_id], 0))
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


def _sentence(project: Project, language: Language, block: Block, depth: int) -> str:
    definition = language.definitions.get(block.type)
    if definition is None:
        return f"{language.word('unknown block')} {block.type}"
    if depth > _DEEPEST:
        return _EMPTY
    words = []
    for part, number in _parts(definition.parts, block):
        if isinstance(part, str):
            words.append(part)
            continue
        key = f"{part.name}.{number}" if number else part.name
        if key in block.inputs:
            plugged = project.blocks[block.inputs[key]]
            said = _sentence(project, language, plugged, depth + 1)
            words.append(f"({said})" if _is_open(plugged, definition, language) else said)
        elif part.kind.name != "body":
            value = definition.value(block, key)
            words.append(field_text(project, language, block, part, value, key))
    return " ".join(word for word in words if word).replace(" ,", ",")


def _is_open(plugged: Block, owner: Definition, language: Language) -> bool:
    """Whether a value in another value could be read with what is beside it: (a + b) * c."""
    inner = language.definitions.get(plugged.type)
    if inner is None or not owner.is_value or len(inner.parts) < 2:
        return False
    return not isinstance(inner.parts[0], str) and not isinstance(inner.parts[-1], str)


def _parts(parts: tuple[Part, ...], block: Block) -> Iterator[tuple[str | Slot, int]]:
    """The words and slots of a sentence, groups as often as they are there, numbered from 1."""
    for part in parts:
        if isinstance(part, Group):
            for number in range(1, block.groups.get(part.name, 0) + 1):
                yield from ((inner, number) for inner in part.parts)
        else:
            yield part, 0


def field_text(
    project: Project,
    language: Language,
    block: Block,
    slot: Slot,
    value: FieldValue | None,
    key: str = "",
) -> str:
    """What a field says: the name of a variable, the label of a choice, else the value."""
    if isinstance(value, dict):
        return ", ".join(f"{name}={setting}" for name, setting in value.items())
    if slot.kind.name == "variable":
        variable = project.variable(str(value))
        return variable.name if variable is not None else _EMPTY
    if slot.kind.name == "rule":
        hat = project.blocks.get(str(value))
        return _sentence(project, language, hat, 1) if hat is not None else _EMPTY
    if slot.kind.name == "parameter":
        return slot.label
    if isinstance(value, bool):
        return language.word("on") if value else language.word("off")
    if slot.kind.name == "robot" and value == ALL_ROBOTS:
        return language.word("all robots")
    if value is None or value == "":
        return _EMPTY
    if slot.kind.name == "colour":
        return language.word(nearest_colour(str(value)))
    return language.label_of(slot, value, block, key)
