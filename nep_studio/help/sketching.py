"""Make blocks of a program that was written down, in any language of the person."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import AddGroup, AddProcedure, SetField
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.blocks.program import Parameter, Procedure, Project, split_slot
from nep_studio.blocks.values import FieldValue, Setting

from .notation import NotationError, Quoted, Sketch, Written

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
            settings[inner] = _setting(value)
        else:
            gathered[key] = value
    return gathered


def _setting(value: str | int | float | bool) -> Setting:
    return str(value) if isinstance(value, Quoted) else value


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
