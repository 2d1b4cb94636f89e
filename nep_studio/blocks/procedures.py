"""The definitions of a project's own blocks: header, call, and the values that a call brings."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from msgspec.structs import replace

from faults import Text, text_of

from .definitions import Category, Definition, Part, Shape, Slot
from .program import Origin, Parameter, Procedure, Project
from .slots import FieldValue, kind_of, why_not_line, why_not_name, why_not_text

OWN_CATEGORY = Category("my", "My blocks", "my_blocks", 50, "behaviour")
"""The category of own blocks; resources/blocks/my_blocks.toml has those of all projects."""

DEFINE, CALL, PARAMETER, RETURN = "my.define.", "my.call.", "my.parameter.", "my.return"
PARAMETER_KINDS = ("number", "text", "boolean", "list", "table", "colour", "robot", "any")
MOST_PROCEDURES = 500
MOST_PARTS = 40

NO_WORDS: Mapping[str, str] = {}
MOST_SENTENCES = 40
LONGEST_HELP = 2000
LATEST_VERSION = 1_000_000
_ID = re.compile(r"[a-z][a-z0-9_]{0,63}")
PACK_ID = re.compile(r"[0-9a-z]{1,64}")
_LANGUAGE = re.compile(r"[a-z]{2,3}")
_PLACE = re.compile(r"\{([^{}]*)\}")
"""Where a parameter stands in a sentence of another language."""


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


def changed(
    procedure: Procedure, parts: Iterable[str | Parameter], *, gives_value: bool
) -> Procedure:
    """An own block with another sentence; what says the old one in other languages goes."""
    new = replace(procedure, parts=tuple(parts), gives_value=gives_value)
    is_same = words(new) == words(procedure) and _ids(new) == _ids(procedure)
    return new if is_same else replace(new, sentences={})


def _ids(procedure: Procedure) -> set[str]:
    return {parameter.id for parameter in parameters(procedure)}


def said_in(procedure: Procedure, code: str) -> tuple[str | Parameter, ...]:
    """The sentence of an own block in a language, as far as somebody has written it down."""
    said = procedure.sentences.get(code, "")
    if not said or not _is_whole(procedure, said):
        return procedure.parts
    known = {parameter.id: parameter for parameter in parameters(procedure)}
    pieces = enumerate(_PLACE.split(said))
    found = (known[piece] if number % 2 else piece.strip() for number, piece in pieces)
    return tuple(part for part in found if part)


def _is_whole(procedure: Procedure, said: str) -> bool:
    """Whether a sentence of another language has all parameters, each once, and a word."""
    named = _PLACE.findall(said)
    ids = [parameter.id for parameter in parameters(procedure)]
    return sorted(named) == sorted(ids) and bool(_PLACE.sub("", said).strip())


def with_names(procedure: Procedure, said: str) -> str:
    """A sentence of another language as people write it: with the names of the parameters."""
    names = {parameter.id: parameter.name for parameter in parameters(procedure)}
    return _PLACE.sub(lambda place: "{" + names.get(place[1], place[1]) + "}", said)


def with_ids(procedure: Procedure, said: str) -> str:
    """The same as it is kept; of parameters with the same name the first one is meant first."""
    waiting = parameters(procedure)

    def id_of(place: re.Match[str]) -> str:
        named = next((one for one in waiting if one.name == place[1].strip()), None)
        if named is None:
            return place[0]
        waiting.remove(named)
        return "{" + named.id + "}"

    return _PLACE.sub(id_of, said.strip())


def definitions_of(
    procedures: Iterable[Procedure], words: Mapping[str, str] = NO_WORDS, code: str = ""
) -> dict[str, Definition]:
    """The definitions of own blocks by type: a header, a call, and one for each parameter.

    ``words`` are those of the person's language, whose ``code`` it is, by the English ones.
    """
    found = (d for procedure in procedures for d in _definitions(procedure, words, code))
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
    return _why_not_told(procedure)


def _why_not_told(procedure: Procedure) -> Text | None:
    """Why what is told of an own block cannot be kept: its help, its other sentences, its origin.

    Of most there is nothing.
    """
    if len(procedure.help) > LONGEST_HELP or why_not_text(procedure.help) is not None:
        return text_of("What it does is told in {most} letters at most.", most=LONGEST_HELP)
    if len(procedure.sentences) > MOST_SENTENCES:
        return text_of("An own block has {most} other sentences at most.", most=MOST_SENTENCES)
    for code, said in procedure.sentences.items():
        if not _LANGUAGE.fullmatch(code):
            return text_of("“{code}” is not the short name of a language.", code=code[:20])
        if (reason := why_not_sentence(procedure, said)) is not None:
            return reason
    return None if procedure.origin is None else _why_not_origin(procedure.origin)


def why_not_sentence(procedure: Procedure, said: str) -> Text | None:
    """Why an own block cannot say this in another language, or None when it can."""
    if why_not_name(said) is not None or not _is_whole(procedure, said):
        named = " ".join("{" + parameter.name + "}" for parameter in parameters(procedure))
        return text_of(
            "“{said}” does not fit: a sentence has words, and each value once: {named}",
            said=with_names(procedure, said)[:60],
            named=named or "…",
        )
    return None


def _why_not_origin(origin: Origin) -> Text | None:
    if not PACK_ID.fullmatch(origin.pack) or not _ID.fullmatch(origin.block):
        return Text("The pack that an own block is from has no such name.")
    if not 1 <= origin.version <= LATEST_VERSION:
        return Text("The versions of a pack are 1, 2, 3 and so on.")
    return why_not_name(origin.title) if origin.title else None


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


def _definitions(procedure: Procedure, words: Mapping[str, str], code: str) -> Iterator[Definition]:
    given = parameters(procedure)
    kinds = {p.id: kind_of(p.kind) for p in given}
    slots = {name: Slot(name, kind) for name, kind in kinds.items()}
    defaults = {name: kind.new for name, kind in kinds.items() if kind.new is not None}
    pills: dict[str, Slot] = {}
    for p in given:
        block_type = f"{PARAMETER}{procedure.id}.{p.id}"
        pills[p.id] = Slot(p.id, kind_of("parameter"), block_type, label=p.name)
    said = said_in(procedure, code)
    header = (words.get("define", "define"), *_sentence(said, pills))
    about = procedure.help
    yield _definition(DEFINE, procedure.id, "hat", header, pills, about=about)
    shape: Shape = "reporter" if procedure.gives_value else "statement"
    result = "any" if procedure.gives_value else ""
    call = _sentence(said, slots)
    yield _definition(CALL, procedure.id, shape, call, slots, defaults, result, about)
    for p in given:
        shape = "boolean" if p.kind == "boolean" else "reporter"
        own_id = f"{procedure.id}.{p.id}"
        yield _definition(PARAMETER, own_id, shape, (p.name,), {}, {}, p.kind)


def _sentence(said: Iterable[str | Parameter], slots: dict[str, Slot]) -> tuple[Part, ...]:
    return tuple(p if isinstance(p, str) else slots[p.id] for p in said)


def _definition(
    prefix: str,
    own_id: str,
    shape: Shape,
    parts: tuple[Part, ...],
    slots: dict[str, Slot],
    defaults: dict[str, FieldValue] | None = None,
    result: str = "",
    about: str = "",
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
        about=about,
    )
