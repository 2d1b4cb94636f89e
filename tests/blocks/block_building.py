"""Build programs in tests: a few words instead of many edits."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, SetField
from nep_studio.blocks.edits.project import SetScope
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.reading import scratch_of
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InBody, InInput, InStack
from nep_studio.blocks.program import SCOPE_PROGRAM, Project
from nep_studio.blocks.slots import FieldValue


@dataclass
class B:
    """A block to be built: type, fields, plugged blocks, bodies, groups."""

    type: str
    fields: dict[str, FieldValue] = field(default_factory=dict)
    inputs: dict[str, B] = field(default_factory=dict)
    bodies: dict[str, list[B]] = field(default_factory=dict)
    groups: dict[str, int] = field(default_factory=dict)


def build(
    language: Language,
    *stacks: list[B],
    page: str = "behaviour",
    name: str = "Test",
    variables: tuple[str, ...] = (),
    editor: Editor | None = None,
) -> Editor:
    """An editor whose project has these stacks; variables have the ids v1, v2, ..."""
    editor = editor or Editor(Project(name), language)
    for variable in variables:
        editor.add_variable(variable)
    for number, stack in enumerate(stacks):
        place = editor.new_stack(page, 40, 40 + 200 * number)
        add(editor, stack[0], place)
        for index, block in enumerate(stack[1:], start=1):
            add(editor, block, InStack(place.stack, index))
    return editor


def held(space: dict[str, object]) -> dict[str, object]:
    """The names in a program that was run, with its variables."""
    shared = space.get("program")
    return {**space, **(vars(shared) if shared is not None else {})}


def share_variables(editor: Editor) -> None:
    """Let all variables be the whole program's, so that they hold something at its end."""
    for variable in editor.project.variables:
        editor.apply(SetScope(variable.id, SCOPE_PROGRAM))


def add(editor: Editor, block: B, place) -> str:
    block_id = editor.create(block.type, place)
    definition = editor.language.definitions[block.type]
    for group, count in block.groups.items():
        have = editor.project.blocks[block_id].groups[group]
        for index in range(have + 1, count + 1):
            slots = definition.group_slots(group)
            editor.apply(AddGroup(block_id, group, index, slots, {}))
    for slot, value in block.fields.items():
        editor.apply(SetField(block_id, slot, value))
    for slot, plugged in block.inputs.items():
        add(editor, plugged, InInput(block_id, slot))
    for slot, chain in block.bodies.items():
        for index, inner in enumerate(chain):
            add(editor, inner, InBody(block_id, slot, index))
    return block_id


def karate(language: Language) -> Editor:
    """The karate greeting: a rule that starts, and one with two parallel parts."""
    counted = B(
        "text.join", {"item.1": "Karate number "}, {"item.2": B("variable.get", {"variable": "v1"})}
    )
    return build(
        language,
        [
            B("event.started"),
            B("robot.do"),
            B("variable.set", {"variable": "v1"}),
            B("robot.say", {"text": "Show me karate", "gesture": "explain"}),
        ],
        [
            B("event.gesture"),
            B("robot.say", {"text": "Impressive!"}),
            B(
                "control.together",
                bodies={
                    "do.1": [B("robot.play", {"animation": "karate"})],
                    "do.2": [
                        B("variable.change", {"variable": "v1"}),
                        B("robot.say", inputs={"text": counted}),
                    ],
                },
            ),
        ],
        name="Karate greeting",
        variables=("times",),
    )


def changed_karate(language: Language, change: Callable[..., None]) -> bytes:
    """The file of the karate greeting with something changed in its JSON."""
    data = json.loads(to_bytes(karate(language).project))
    change(data, {block["id"]: block for block in data["blocks"]})
    return json.dumps(data, indent=1).encode()


def read_program(text: str, language: Language, base: Project | None = None) -> Project:
    """The project that a whole program says; of ``base``, what is not said in Python stays."""
    editor = scratch_of(base or Project(), language)
    update_from_python(editor, text)
    return editor.project
