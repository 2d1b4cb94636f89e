"""Edits and their inverses: whatever is done can be undone and done again, to the byte."""

from __future__ import annotations

import msgspec
import pytest
from block_building import B, build, karate
from generated import assert_mapped, assert_tame, has_written_code, parse
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from random_programs import Dice

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import ANY_EDIT
from nep_studio.blocks.edits.content import AddGroup, RemoveGroup, SetField, SetFlag
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from nep_studio.blocks.errors import CodeRefused, EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack
from nep_studio.blocks.program import Block, Parent, Project
from nep_studio.blocks.text import sentence

pytestmark = pytest.mark.long


@given(st.data())
def test_random_edits_undone_and_redone_give_identical_bytes(language, data):
    editor = Editor(karate(language).project, language)
    dice = Dice(data.draw, editor)
    states = [to_bytes(editor.project)]

    for _ in range(data.draw(st.integers(1, 25))):
        try:
            with editor.transaction("random"):
                for _ in range(data.draw(st.integers(1, 3))):
                    editor.apply(dice.edit())
        except EditRefused as refused:
            assert len(str(refused.sentence)) > 10
            assert to_bytes(editor.project) == states[-1]
        else:
            del states[editor.history.steps :]  # typing in one field is one step
            states.append(to_bytes(editor.project))

    for state in reversed(states):
        assert to_bytes(editor.project) == state
        editor.history.undo()
    assert not editor.history.undo()
    for state in states:
        assert to_bytes(editor.project) == state
        editor.history.redo()
    assert not editor.history.redo()


def test_a_property_that_fails_is_told_with_its_example(language):
    @settings(database=None, phases=[Phase.generate])
    @given(number=st.integers(10, 20))
    def fails(language, number):
        assert number < 10

    with pytest.raises(AssertionError) as told:
        fails(language)

    assert 10 < len("".join(told.value.__notes__)) < 500


@given(st.data())
def test_random_programs_load_as_they_were_saved_and_their_code_compiles(language, data):
    editor = Editor(karate(language).project, language)
    generator = ProgramGenerator(editor.project, language)
    dice = Dice(data.draw, editor)
    for _ in range(data.draw(st.integers(1, 25))):
        try:
            editor.apply(dice.edit())
        except EditRefused:
            continue
        project = editor.project

        loaded = from_bytes(to_bytes(project), "x.nep", language)

        assert to_bytes(loaded) == to_bytes(project)
        assert loaded.parents == project.parents
        assert all(problem.sentence for problem in check(project, language))
        assert all(sentence(project, language, block) is not None for block in project.blocks)
        try:
            code = generate_program(loaded, language)
        except CodeRefused:
            with pytest.raises(CodeRefused):
                generator.generate()
            continue
        assert generator.generate() == code
        if has_written_code(project):
            parse(code.text)
        else:
            assert_tame(code.text, language)
            assert_mapped(code, project, language)


@given(st.data())
def test_every_edit_can_be_written_to_a_journal_and_played_again(language, data):
    editor, replayed = Editor(karate(language).project, language), karate(language).project
    dice = Dice(data.draw, editor)
    for _ in range(data.draw(st.integers(1, 25))):
        edit = dice.edit()
        line = msgspec.json.encode(edit)
        try:
            editor.apply(edit)
        except EditRefused:
            continue
        msgspec.json.decode(line, type=ANY_EDIT).apply(replayed)

    assert to_bytes(replayed) == to_bytes(editor.project)


def stack_of_three(language):
    editor = build(language, [B("event.started"), B("robot.do"), B("control.forever")])
    return editor, *editor.project.pages["behaviour"][0].body


def test_a_block_cannot_be_put_inside_itself(language):
    editor = build(language, [B("control.while", bodies={"do": [B("control.while")]})])
    outer = editor.project.pages["behaviour"][0].body[0]
    (inner,) = editor.project.blocks[outer].bodies["do"]

    with pytest.raises(EditRefused, match="inside itself"):
        editor.apply(MoveBlocks(outer, 1, InBody(inner, "do", 0)))


@pytest.mark.parametrize(
    ("edit", "reason"),
    [
        (
            lambda e, hat, do, loop: MoveBlocks(do, 1, InStack(e.project.parents[hat].owner, 0)),
            "above",
        ),
        (
            lambda e, hat, do, loop: MoveBlocks(do, 1, InStack(e.project.parents[hat].owner, 2)),
            "below",
        ),
        (lambda e, hat, do, loop: MoveBlocks(hat, 1, InBody(loop, "do", 0)), "begins a stack"),
        (lambda e, hat, do, loop: MoveBlocks(do, 1, InInput(loop, "do")), "no slot"),
        (lambda e, hat, do, loop: MoveBlocks(do, 1, InBody(loop, "while", 0)), "no place"),
        (lambda e, hat, do, loop: SetField(do, "posture", "fly"), "not one of"),
        (lambda e, hat, do, loop: SetField(do, "wings", "fly"), "no field"),
        (lambda e, hat, do, loop: SetField("b99", "wings", "fly"), "not there"),
        (lambda e, hat, do, loop: DeleteBlocks(loop, 2), "not so many"),
        (lambda e, hat, do, loop: RemoveGroup(loop, "part", 1, ("do",)), "no such part"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_reason(language, edit, reason):
    editor, *blocks = stack_of_three(language)
    before = to_bytes(editor.project)

    with pytest.raises(EditRefused, match=reason):
        editor.apply(edit(editor, *blocks))
    assert to_bytes(editor.project) == before


def test_a_slot_says_which_value_it_needs(language):
    editor = build(language, [B("robot_events.touched"), B("robot.walk")])
    hat, walk = editor.project.pages["behaviour"][0].body

    with pytest.raises(EditRefused, match=r"needs a number, and “join …” gives a text"):
        editor.create("text.join", InInput(walk, "forward"))
    with pytest.raises(EditRefused, match="a rule waits for is fixed"):
        editor.create("text.join", InInput(hat, "robot"))
    with pytest.raises(EditRefused, match=r"needs a robot, and “list of …” gives a list"):
        editor.create("list.create", InInput(walk, "robot"))
    editor.create("math.number", InInput(walk, "forward"))
    with pytest.raises(EditRefused, match="in this slot already"):
        editor.create("math.number", InInput(walk, "forward"))


def test_an_else_if_in_the_middle_moves_the_later_ones_with_their_blocks(language):
    fork = B("control.if", bodies={"also_do.2": [B("robot.do")]}, groups={"also": 2})
    editor = build(language, [B("event.started"), fork])
    project = editor.project
    block = next(b for b in project.blocks.values() if b.type == "control.if")
    (inner,) = block.bodies["also_do.2"]
    slots = ("also_condition", "also_do")
    before = to_bytes(project)

    editor.apply(RemoveGroup(block.id, "also", 1, slots))

    assert block.bodies == {"also_do.1": [inner]} and block.groups["also"] == 1
    assert project.parents[inner] == Parent(block.id, "also_do.1")
    with pytest.raises(EditRefused, match="take them out"):
        editor.apply(RemoveGroup(block.id, "also", 1, slots))
    editor.history.undo()
    assert to_bytes(project) == before


@pytest.mark.parametrize(
    ("slots", "fields", "reason"),
    [
        (("do",), {}, "other slots"),
        (("also_condition", "also_do"), {"also_do": "x"}, "no field “also_do”"),
        (("also_condition", "also_do"), {"x": "x"}, "no field “x”"),
    ],
)
def test_a_part_is_added_with_the_slots_that_it_has(language, slots, fields, reason):
    editor = build(language, [B("event.started"), B("control.if")])
    fork = editor.project.pages["behaviour"][0].body[1]

    with pytest.raises(EditRefused, match=reason):
        editor.apply(AddGroup(fork, "also", 1, slots, fields))
    editor.apply(AddGroup(fork, "also", 1, ("also_condition", "also_do"), {}))


def paste(language, *blocks: Block) -> str | None:
    editor = Editor(Project(), language)
    roots = (blocks[0].id,)
    reason = editor.why_not(CreateBlocks(roots, blocks, NewStack("behaviour", "s1", 0, 0, 0)))
    return None if reason is None else str(reason)


def test_blocks_from_a_clipboard_are_checked_like_those_from_a_file(language):
    text = Block("b2", "text.text", {"text": "x"})
    do = Block("b2", "robot.do")

    assert paste(language, Block("b1", "robot.say", inputs={"text": "b2"}), text) is None
    assert "needs a number" in paste(
        language, Block("b1", "robot.walk", inputs={"left": "b2"}), text
    )
    assert "gives a value" in paste(language, Block("b1", "robot.say", inputs={"text": "b2"}), do)
    assert "into a slot" in paste(
        language, Block("b1", "control.forever", bodies={"do": ["b2"]}), text
    )
    assert "too large" in paste(language, Block("b1", "control.wait", {"seconds": 1e300}))
    assert "not complete" in paste(language, Block("b1", "robot.say", inputs={"text": "b2"}))


def test_do_together_keeps_two_parts_and_takes_twenty(language):
    editor = build(language, [B("event.started"), B("control.together", groups={"part": 20})])
    block = editor.project.pages["behaviour"][0].body[1]

    with pytest.raises(EditRefused, match="more parts"):
        editor.apply(AddGroup(block, "part", 1, ("do",), {}))
    for _ in range(18):
        editor.apply(RemoveGroup(block, "part", 1, ("do",)))
    with pytest.raises(EditRefused, match="fewer parts"):
        editor.apply(RemoveGroup(block, "part", 1, ("do",)))


def test_typing_in_one_field_is_one_step_and_another_field_begins_a_new_one(language):
    editor = build(language, [B("event.started"), B("robot.say")])
    say = editor.project.pages["behaviour"][0].body[1]
    for text in ("I", "Im", "Imp"):
        editor.apply(SetField(say, "text", text))
    editor.apply(SetField(say, "gesture", "happy"))
    editor.history.seal()
    editor.apply(SetField(say, "gesture", "sad"))
    fields = editor.project.blocks[say].fields

    editor.history.undo()
    assert fields["gesture"] == "happy"
    editor.history.undo()
    assert fields["text"] == "Imp" and fields["gesture"] == "no_gesture"
    editor.history.undo()
    assert fields["text"] == "Hello"
    editor.history.redo()
    assert fields["text"] == "Imp"


def test_a_transaction_that_fails_leaves_no_trace(language):
    editor, _, do, _ = stack_of_three(language)
    before, label = to_bytes(editor.project), editor.history.undo_label

    with pytest.raises(EditRefused), editor.transaction("two edits"):
        editor.apply(SetFlag(do, "disabled", True))
        editor.apply(SetField(do, "posture", "fly"))

    assert to_bytes(editor.project) == before and editor.history.undo_label == label


def test_a_new_edit_forgets_what_was_undone(language):
    editor, _, do, _ = stack_of_three(language)
    editor.apply(SetFlag(do, "disabled", True), "Disable")
    editor.history.undo()
    assert editor.history.redo_label == "Disable"

    editor.apply(SetFlag(do, "collapsed", True))

    assert editor.history.redo_label == "" and not editor.history.redo()


def test_blocks_with_a_part_missing_are_not_created(language):
    project = Project()
    block = language.definitions["control.forever"].new_block("b1")
    block.bodies = {"do": ["b2"]}

    with pytest.raises(EditRefused, match="not complete"):
        CreateBlocks(("b1",), (block,), NewStack("behaviour", "s1", 0, 0, 0)).apply(project)


def test_deleting_and_undoing_a_stack_of_ten_thousand_blocks_keeps_all(language):
    editor = build(language, [B("event.started"), *[B("robot.do")] * 10_000])
    before = to_bytes(editor.project)
    first = editor.project.pages["behaviour"][0].body[0]

    editor.apply(DeleteBlocks(first, 10_001))

    assert not editor.project.blocks and not editor.project.stacks
    editor.history.undo()
    assert to_bytes(editor.project) == before
