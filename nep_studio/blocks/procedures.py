"""The definitions of a project's own blocks: header, call, and the values that a call brings."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from faults import Text, text_of

from .definitions import Category, Definition, Part, Shape, Slot
from .program import Parameter, Procedure, Project
from .slots import FieldValue, kind_of, why_not_line, why_not_name

OWN_CATEGORY = Category("my", "My blocks", "my_blocks", 50, "behaviour")
"""The category of own blocks; resources/blocks/my_blocks.toml has those of all projects."""

DEFINE, CALL, PARAMETER, RETURN = "my.define.", "my.call.", "my.parameter.", "my.return"
PARAMETER_KINDS = ("number", "text", "boolean", "list", "table", "colour", "robot", "any")
MOST_PROCEDURES = 500
MOST_PARTS = 40

NO_WORDS: Mapping[str, str] = {}
_ID = re.compile(r"[a-z][a-z0-9_]{0,63}")


def procedure_of(block_type: str) -> str:
    """The id of the own block that a type of block belongs to, or an empty text."""
    for prefix in (DEFINE, CALL, PARAMETER):
        if block_type.startswith(prefix):
            return block_type.removeprefix(prefix).partition(".")[0]
    return ""


def parameter_of(block_type: str) -> str:
    """The id of the parameter that a type of block stands for, or an empty text."""
    return block_type.rpartition(".")[2] if block_type.startswith(PARAMETER) else ""


def parameters(procedure: Procedure) -> list[Parameter]:
    """The values that a call brings, in the order of the sentence."""
    return [part for part in procedure.parts if isinstance(part, Parameter)]


def title(procedure: Procedure) -> str:
    """The sentence of an own block, such as "greet (name) (times) times"."""
    words = [p if isinstance(p, str) else f"({p.name})" for p in procedure.parts]
    return " ".join(words)


def words(procedure: Procedure) -> str:
    """The words of an own block without its values: "greet times"."""
    return " ".join(part for part in procedure.parts if isinstance(part, str))


def definitions_of(
    procedures: Iterable[Procedure], words: Mapping[str, str] = NO_WORDS
) -> dict[str, Definition]:
    """The definitions of own blocks by type: a header, a call, and one for each parameter.

    ``words`` are those of the person's language by the English ones.
    """
    found = (d for procedure in procedures for d in _definitions(procedure, words))
    return {definition.id: definition for definition in found}


def header_of(project: Project, procedure_id: str) -> str:
    """The id of the block that defines an own block, or an empty text: an enabled one first."""
    wanted = DEFINE + procedure_id
    found = ""
    for stack in project.stacks.values():
        first = project.blocks[stack.body[0]]
        if first.type == wanted:
            if not first.disabled:
                return first.id
            found = found or first.id
    return found


def why_not_procedure(procedure: Procedure) -> Text | None:
    """Why an own block cannot be like this, or None when it can."""
    if not _ID.fullmatch(procedure.id):
        return Text("The id of an own block is made of small letters and digits.")
    if not 1 <= len(procedure.parts) <= MOST_PARTS:
        return text_of(
            "An own block has 1 to {most_parts} words and values.", most_parts=MOST_PARTS
        )
    if not any(isinstance(part, str) and part.strip() for part in procedure.parts):
        return Text("An own block needs at least one word.")
    ids: set[str] = set()
    for part in procedure.parts:
        reason = why_not_name(part) if isinstance(part, str) else _why_not_parameter(part, ids)
        if reason is not None:
            return reason
    return None


def _why_not_parameter(parameter: Parameter, ids: set[str]) -> Text | None:
    if not _ID.fullmatch(parameter.id) or parameter.id in ids:
        return Text("Each value of an own block has an id of its own, of small letters and digits.")
    ids.add(parameter.id)
    if parameter.kind not in PARAMETER_KINDS:
        return text_of(
            "A value of an own block is one of: {parameter_kinds}.",
            parameter_kinds=", ".join(PARAMETER_KINDS),
        )
    return why_not_line(parameter.name) or why_not_name(parameter.name)


def _definitions(procedure: Procedure, words: Mapping[str, str]) -> Iterator[Definition]:
    given = parameters(procedure)
    kinds = {p.id: kind_of(p.kind) for p in given}
    slots = {name: Slot(name, kind) for name, kind in kinds.items()}
    defaults = {name: kind.new for name, kind in kinds.items() if kind.new is not None}
    pills: dict[str, Slot] = {}
    for p in given:
        block_type = f"{PARAMETER}{procedure.id}.{p.id}"
        pills[p.id] = Slot(p.id, kind_of("parameter"), block_type, label=p.name)
    header = (words.get("define", "define"), *_sentence(procedure, pills))
    yield _definition(DEFINE, procedure.id, "hat", header, pills)
    shape: Shape = "reporter" if procedure.gives_value else "statement"
    result = "any" if procedure.gives_value else ""
    call = _sentence(procedure, slots)
    yield _definition(CALL, procedure.id, shape, call, slots, defaults, result)
    for p in given:
        shape = "boolean" if p.kind == "boolean" else "reporter"
        own_id = f"{procedure.id}.{p.id}"
        yield _definition(PARAMETER, own_id, shape, (p.name,), {}, {}, p.kind)


def _sentence(procedure: Procedure, slots: dict[str, Slot]) -> tuple[Part, ...]:
    return tuple(p if isinstance(p, str) else slots[p.id] for p in procedure.parts)


def _definition(
    prefix: str,
    own_id: str,
    shape: Shape,
    parts: tuple[Part, ...],
    slots: dict[str, Slot],
    defaults: dict[str, FieldValue] | None = None,
    result: str = "",
) -> Definition:
    kind = prefix.split(".")[1]
    return Definition(
        id=prefix + own_id,
        category=OWN_CATEGORY,
        shape=shape,
        parts=parts,
        slots=slots,
        groups={},
        minimum={},
        defaults=defaults or {},
        result=result,
        help=f"blocks/my_{kind}",
        flags=frozenset({"takes_time"} if kind == "call" else ()),
        generator=f"own_{kind}",
    )
