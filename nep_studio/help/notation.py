"""Small programs written down line by line, as the examples of the help are.

    event.started
    robot.say text="Hello"
    control.if condition=(sensing.human_state_is state=touched_head)
      robot.say text="That tickles"
     otherwise_do.1:
      robot.play animation=nod

A line is a block with the values of its slots; what is indented more is inside it, in its first
mouth or in the one that a line ``mouth:`` names. A value in brackets is a block. Quoted texts are
for people and can be translated, bare words cannot. ``own p1 value "double" a1:x:number`` defines
an own block, which the lines below use as ``my.define.p1``, ``my.call.p1``, ``my.parameter.p1.a1``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, AddProcedure, SetField
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.blocks.program import Parameter, Procedure, Project, split_slot
from nep_studio.blocks.slots import FieldValue

_TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|[()=]|[^\s()="]+)')
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


class NotationError(ValueError):
    """A line of an example that cannot be read; its text says which."""


class Quoted(str):
    """A text for people."""


Value = "str | int | float | bool | Sketch"


@dataclass
class Sketch:
    """A block as it was written down: its type, its values by slot, what is in its mouths."""

    type: str
    values: dict[str, str | int | float | bool | Sketch] = field(default_factory=dict)
    bodies: dict[str, list[Sketch]] = field(default_factory=dict)

    def types(self) -> Iterator[str]:
        """The type of this block and of all that are in it."""
        yield self.type
        for value in self.values.values():
            if isinstance(value, Sketch):
                yield from value.types()
        for body in self.bodies.values():
            for inner in body:
                yield from inner.types()


@dataclass
class Written:
    """A program as it was written down: its own blocks, and its stacks in their order."""

    procedures: list[Procedure] = field(default_factory=list)
    stacks: list[list[Sketch]] = field(default_factory=list)


FIRST_MOUTH = ""
"""Stands for the first mouth of a block, whatever it is called."""


def read(text: str) -> Written:
    """Read a program; stacks have an empty line between them. Raises NotationError."""
    written = Written()
    chain: list[Sketch] = []
    open_: list[tuple[int, list[Sketch]]] = []
    for line in text.splitlines():
        depth, said = len(line) - len(line.lstrip()), line.strip()
        if not said:
            chain, open_ = [], []
        elif said.startswith("own "):
            written.procedures.append(_procedure(_tokens(said)))
        else:
            if not open_:
                open_ = [(depth, chain)]
                written.stacks.append(chain)
            _take(said, depth, open_)
    return written


def _take(said: str, depth: int, open_: list[tuple[int, list[Sketch]]]) -> None:
    """Put a line where its indentation says."""
    while len(open_) > 1 and depth < open_[-1][0]:
        open_.pop()
    place, chain = open_[-1]
    if said.endswith(":"):
        open_.append((depth + 1, chain[-1].bodies.setdefault(said[:-1], [])))
        return
    if depth > place and chain and FIRST_MOUTH not in chain[-1].bodies:
        inside = chain[-1].bodies.setdefault(FIRST_MOUTH, [])
        open_.append((depth, inside))
        chain = inside
    elif depth > place and chain:
        raise NotationError(f"“{said}” is indented, but in no mouth")
    chain.append(_sketch(said))


def _sketch(said: str) -> Sketch:
    tokens = _tokens(said)
    made = _block(tokens)
    if tokens:
        raise NotationError(f"“{said}”: what is {tokens[0]}?")
    return made


def _block(tokens: list[str]) -> Sketch:
    made = Sketch(tokens.pop(0))
    while tokens and tokens[0] != ")":
        name = tokens.pop(0)
        if len(tokens) < 2 or tokens.pop(0) != "=":
            raise NotationError(f"{made.type}: {name} has no value")
        made.values[name] = _value(tokens)
    return made


def _value(tokens: list[str]) -> str | int | float | bool | Sketch:
    token = tokens.pop(0)
    if token == "(":
        inner = _block(tokens)
        if not tokens or tokens.pop(0) != ")":
            raise NotationError(f"{inner.type} is not closed by )")
        return inner
    if token.startswith('"'):
        return Quoted(json.loads(token))
    if token in ("true", "false"):
        return token == "true"
    if _NUMBER.fullmatch(token):
        return float(token) if "." in token else int(token)
    return token


def _procedure(tokens: list[str]) -> Procedure:
    """``own p1 value "double" a1:x:number``: id, whether it gives a value, words, parameters."""
    _own, name, *rest = tokens
    gives_value = rest[:1] == ["value"]
    parts: list[str | Parameter] = []
    for token in rest[gives_value:]:
        if token.startswith('"'):
            parts.append(json.loads(token))
        else:
            parts.append(Parameter(*token.split(":")))
    return Procedure(name, tuple(parts), gives_value)


def _tokens(said: str) -> list[str]:
    found = _TOKEN.findall(said)
    if "".join(found).replace(" ", "") != re.sub(r"\s", "", said):
        raise NotationError(f"“{said}” cannot be read")
    return found


# Make blocks of a program that was written down, in any language of the person.

STEP = 220.0
"""How far below each other stacks begin; whoever lays them out pushes them apart."""

Translate = Callable[[str], str]


def project_of(written: Written, language: Language, title: str, translate: Translate) -> Project:
    """The program as a project; raises NotationError, and EditRefused where blocks do not fit."""
    editor = Editor(Project(title), language)
    for number, procedure in enumerate(written.procedures):
        editor.apply(AddProcedure(_said(procedure, translate), number))
    for number, chain in enumerate(written.stacks):
        page = _definition(editor, chain[0].type).page
        place = editor.new_stack(page, 40.0, 40.0 + STEP * number)
        _make(editor, chain[0], place, translate)
        for index, sketch in enumerate(chain[1:], start=1):
            _make(editor, sketch, InStack(place.stack, index), translate)
    return editor.project


def _said(procedure: Procedure, translate: Translate) -> Procedure:
    """An own block in the language of the person."""
    parts = (
        translate(part)
        if isinstance(part, str)
        else Parameter(part.id, translate(part.name), part.kind)
        for part in procedure.parts
    )
    return Procedure(procedure.id, tuple(parts), procedure.gives_value)


def _definition(editor: Editor, block_type: str) -> Definition:
    definition = editor.language.definitions.get(block_type)
    if definition is None:
        raise NotationError(f"there is no block {block_type}")
    return definition


def _make(editor: Editor, sketch: Sketch, place: Place, translate: Translate) -> str:
    """Make a block with all that is in it; gives its id."""
    definition = _definition(editor, sketch.type)
    block = editor.create(sketch.type, place)
    bodies = {key or _first_mouth(definition): body for key, body in sketch.bodies.items()}
    _add_groups(editor, definition, block, [*sketch.values, *bodies])
    for key, value in _gathered(sketch.values).items():
        if isinstance(value, Sketch):
            _make(editor, value, InInput(block, key), translate)
        else:
            editor.apply(SetField(block, key, _field(editor, definition, key, value, translate)))
    for key, body in bodies.items():
        for index, inner in enumerate(body):
            _make(editor, inner, InBody(block, key, index), translate)
    return block


def _first_mouth(definition: Definition) -> str:
    mouths = (slot for slot in definition.slots.values() if slot.kind.name == "body")
    slot = next(mouths, None)
    if slot is None:
        raise NotationError(f"{definition.id} has no mouth")
    return f"{slot.name}.1" if slot.group else slot.name


def _add_groups(editor: Editor, definition: Definition, block: str, keys: Iterable[str]) -> None:
    """Make the groups that the keys are in, as ``item.3`` needs three of its group."""
    for key in keys:
        name, number = split_slot(key)
        slot = definition.slots.get(name)
        group = slot.group if slot is not None else ""
        while group and editor.project.blocks[block].groups.get(group, 0) < number:
            index = editor.project.blocks[block].groups.get(group, 0) + 1
            slots = definition.group_slots(group)
            editor.apply(AddGroup(block, group, index, slots, {}))


def _gathered(
    values: dict[str, str | int | float | bool | Sketch],
) -> dict[str, FieldValue | Sketch]:
    """Settings, written ``parameters.gesture=karate``, become one value."""
    gathered: dict[str, FieldValue | Sketch] = {}
    for key, value in values.items():
        name, dot, inner = key.partition(".")
        if dot and not inner.isdigit() and not isinstance(value, Sketch):
            settings = gathered.setdefault(name, {})
            assert isinstance(settings, dict)
            settings[inner] = str(value) if isinstance(value, Quoted) else value
        else:
            gathered[key] = value
    return gathered


def _field(
    editor: Editor, definition: Definition, key: str, value: FieldValue, translate: Translate
) -> FieldValue:
    slot = definition.slots.get(split_slot(key)[0])
    kind = slot.kind.name if slot is not None else ""
    if isinstance(value, bool) and kind == "choice":
        return str(value).lower()
    if not isinstance(value, str):
        return value
    said = translate(str(value)) if isinstance(value, Quoted) else value
    if kind != "variable":
        return said
    known = {variable.name: variable.id for variable in editor.project.variables}
    return known.get(said) or editor.add_variable(said)
