"""Whatever a field holds, it is refused with a sentence, or it is a constant of the program.

Every field of every definition is tried, typed by a person and read from a file.
"""

from __future__ import annotations

import ast
import json
from functools import cache
from pathlib import Path

import pytest
from block_building import B, build
from generated import assert_tame, constant_of, constants
from hostile import NUMBERS, TEXTS, anything
from hypothesis import given, settings
from hypothesis import strategies as st

from nep_studio.blocks.checks import check
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.project import RenameProject, RenameVariable
from nep_studio.blocks.errors import CodeRefused, EditRefused, ProjectFileError
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_launch, generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Block
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import load_language
from tests.conftest import a_part_of

RESOURCES = Path(__file__).resolve().parents[2] / "resources"
LANGUAGE = load_language(RESOURCES / "blocks", RESOURCES / "robots/nao/robot.toml")
WORST = [*TEXTS, *NUMBERS]
WRITTEN = {"code.lines", "code.program", "code.value", "control.note"}
"""Blocks whose text is written as it is; test_written_python.py and test_notes say how."""

COUNTED = {"list", "text.letter", "control.count"}
"""Blocks that count from 1 where Python counts from 0: their numbers become others."""

FIELDS = [
    (definition.id, key)
    for definition in LANGUAGE.definitions.values()
    for key, slot in definition.keys(dict.fromkeys(definition.groups, 2))
    if slot.kind.typed and definition.id not in WRITTEN
]


@cache
def holder(block_type: str) -> tuple[Editor, Block, bytes]:
    """A program in which a block of this type is used, the block, and the program as a file.

    It is made once; who edits it undoes that.
    """
    definition = LANGUAGE.definitions[block_type]
    block = B(block_type)
    if definition.page != "behaviour":
        editor = build(LANGUAGE, [block], page=definition.page)
    elif definition.shape == "hat":
        editor = build(LANGUAGE, [block, B("control.wait")])
    elif definition.result == "boolean":
        editor = build(
            LANGUAGE, [B("event.started"), B("control.while", inputs={"condition": block})]
        )
    elif definition.is_value:
        editor = build(
            LANGUAGE,
            [B("event.started"), B("variable.set", inputs={"value": block})],
            variables=("x",),
        )
    else:
        editor = build(LANGUAGE, [B("event.started"), block], variables=("x",))
    for made in editor.project.blocks.values():
        if "variable" in LANGUAGE.definitions[made.type].slots:
            made.fields["variable"] = "v1"
    used = next(b for b in editor.project.blocks.values() if b.type == block_type)
    if "rule" in definition.slots:
        used.fields["rule"] = editor.project.pages["behaviour"][0].body[0]
    return Editor(editor.project, LANGUAGE), used, to_bytes(editor.project)


@cache
def lines_before(block_type: str) -> list[bool]:
    """Which lines of the holder's program belong to no block."""
    project = from_bytes(holder(block_type)[2], "x.nep", LANGUAGE)
    return unmade_lines(generate_program(project, LANGUAGE))


def unmade_lines(code: Code) -> list[bool]:
    """Which lines belong to no block; what is imported changes with the values."""
    lines = zip(code.text.splitlines(), code.blocks, strict=True)
    return [block == "" for line, block in lines if not line.startswith("import ")]


def typed(block_type: str, key: str, value: object) -> Editor | None:
    """The program with the value set by a person, or None when it was refused."""
    editor, block, before = holder(block_type)
    while editor.history.undo():  # what was tried before
        pass
    assert to_bytes(editor.project) == before
    try:
        editor.apply(SetField(block.id, key, value))
    except EditRefused as refused:
        assert len(str(refused.sentence)) > 10
        assert to_bytes(editor.project) == before
        return None
    return editor


def from_file(block_type: str, key: str, value: object) -> Editor | None:
    """The program read from a file that holds the value, or None when it was refused."""
    _, block, before = holder(block_type)
    data = json.loads(before)
    entry = next(entry for entry in data["blocks"] if entry["id"] == block.id)
    entry.setdefault("fields", {})[key] = value
    try:
        data = json.dumps(data)
    except ValueError:  # json cannot write a number of more than 4,300 digits
        entry["fields"][key] = "huge"
        data = json.dumps(data).replace('"huge"', "9" * 5000)
    try:
        project = from_bytes(data.encode(), "x.nep", LANGUAGE)
    except ProjectFileError as refused:
        assert str(refused.sentence).startswith("x.nep ")
        return None
    return Editor(project, LANGUAGE)


def assert_safe(editor: Editor, block_type: str, key: str, value: object) -> None:
    """Check that the program says the value, and nothing else that it did not say before."""
    project = editor.project
    check(project, LANGUAGE)
    for block in project.blocks:
        assert sentence(project, LANGUAGE, block)
    assert to_bytes(from_bytes(to_bytes(project), "x.nep", LANGUAGE)) == to_bytes(project)
    if LANGUAGE.definitions[block_type].page != "behaviour":
        tree = assert_only_starts(generate_launch(project, LANGUAGE).text)
    else:
        try:
            code = generate_program(project, LANGUAGE)
        except CodeRefused as refused:
            assert refused.block in project.blocks and len(str(refused.sentence)) > 10
            return
        tree = assert_tame(code.text, LANGUAGE)
        if is_calculated(block_type, key, value):
            return
        assert unmade_lines(code) == lines_before(block_type)
    definition = LANGUAGE.definitions[block_type]
    kind = definition.slots[key.partition(".")[0]].kind.name
    told = f"gesture_{value}" if kind == "gesture" else value
    if kind == "settings":
        assert {constant_of(setting) for setting in value.values()} <= set(constants(tree))
    elif kind not in ("choice", "variable") and not is_left_out(definition, kind, key, value):
        assert constant_of(told) in constants(tree)


def is_calculated(block_type: str, key: str, value: object) -> bool:
    """Whether the program says another number than the one in the field."""
    kind = LANGUAGE.definitions[block_type].slots[key.partition(".")[0]].kind
    if not kind.is_number:
        return (block_type, key, value) == ("list.split", "mark", "")
    return isinstance(value, str) or bool(COUNTED & {block_type, block_type.partition(".")[0]})


def is_left_out(definition: Definition, kind: str, key: str, value: object) -> bool:
    """Whether the program need not say the value: all robots, and defaults of keywords."""
    if kind == "robot" and value == "*":
        return True
    optional = definition.call.optional if definition.call is not None else ()
    return key in optional and value == definition.defaults[key]


def assert_only_starts(text: str) -> ast.Module:
    """Check that a launch program does nothing but start nodes with constants."""
    tree = ast.parse(text)
    compile(text, "launch.py", "exec")
    start, made, *calls = tree.body
    assert isinstance(start, ast.ImportFrom) and isinstance(made, ast.Assign)
    for call in calls:
        assert ast.unparse(call.value.func) == "launcher.start"
        for keyword in call.value.keywords:
            ast.literal_eval(keyword.value)
    return tree


@pytest.mark.parametrize(("block_type", "key"), FIELDS)
@settings(max_examples=10)  # for each of 300 fields
@given(value=anything)
def test_any_value_is_refused_or_becomes_a_constant(block_type: str, key: str, value: object):
    for put in (typed, from_file):
        editor = put(block_type, key, value)
        if editor is not None and value is not None:
            assert_safe(editor, block_type, key, value)


@pytest.mark.parametrize("number", a_part_of(range(len(WORST))))
def test_the_worst_values_are_refused_or_become_constants_in_every_field(number: int):
    value = WORST[number]
    accepted = 0
    for block_type, key in FIELDS:
        editor = typed(block_type, key, value)
        if editor is not None:
            accepted += 1
            assert_safe(editor, block_type, key, value)
    too_large = not isinstance(value, str) and abs(value) > 10**15
    assert bool(accepted) != (too_large or value in ("\ud800", "a\udfffb"))


@pytest.mark.parametrize("value", ["x\nimport os", 'a"b', "\u2028", "größe", "", "\x00"])
def test_a_spoken_text_reaches_the_robot_exactly(value: str):
    editor = typed("robot.say", "text", value)

    assert editor is not None
    tree = assert_tame(generate_program(editor.project, LANGUAGE).text, LANGUAGE)
    assert constant_of(value) in constants(tree)


@given(st.text(max_size=60), st.text(max_size=60), st.text(max_size=60))
def test_names_of_projects_variables_and_robots_never_become_code(project, variable, robot):
    editor = Editor(from_bytes(holder("variable.change")[2], "x.nep", LANGUAGE), LANGUAGE)
    try:
        editor.apply(RenameProject(project))
        editor.apply(RenameVariable("v1", variable))
    except EditRefused:
        pass
    build(LANGUAGE, [B("event.started"), B("robot.stop")], editor=editor)
    stop = next(b.id for b in editor.project.blocks.values() if b.type == "robot.stop")
    try:
        editor.apply(SetField(stop, "robot", robot))
    except EditRefused:
        robot = "NAO"

    tree = assert_tame(generate_program(editor.project, LANGUAGE).text, LANGUAGE)

    told = constants(tree)
    assert constant_of(editor.project.name) in told
    assert robot == "*" or constant_of(robot) in told


@pytest.mark.parametrize(
    "name", ["今日は\u3000世界", "👩\u200d👩\u200d👧", "\u0645\u06cc\u200c\u062e", "deux\u00a0: 2"]
)
def test_a_name_may_have_the_spaces_and_joiners_of_its_script(name: str) -> None:
    editor = Editor(build(LANGUAGE, [B("event.started")]).project, LANGUAGE)

    editor.apply(RenameProject(name))

    assert from_bytes(to_bytes(editor.project), "a.nep", LANGUAGE).name == name
    ast.parse(generate_program(editor.project, LANGUAGE).text)


@pytest.mark.parametrize("name", ["a\u202eb", "a\nb", "a\u2028b", "a\x00b", "\u3000"])
def test_a_name_has_no_letters_that_turn_or_break_its_line(name: str) -> None:
    editor = Editor(build(LANGUAGE, [B("event.started")]).project, LANGUAGE)

    assert editor.why_not(RenameProject(name)) is not None
