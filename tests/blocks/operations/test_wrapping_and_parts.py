"""C blocks around blocks, repeated parts, flags, and reporters dragged out of fields."""

from __future__ import annotations

import pytest
from block_building import B, build
from operating import one_step, rule, say, texts

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.moving import create_and_drop, reporter_of
from nep_studio.blocks.operations.wrapping import (
    add_part,
    move_part,
    remove_part,
    set_collapsed,
    set_disabled,
    toggle,
    unwrap,
    why_not_wrap,
    wrap,
)
from nep_studio.blocks.places import InInput


def test_a_c_block_is_put_around_a_selected_run(language):
    editor, chain = rule(language, say("a"), say("b"), say("c"))

    with one_step(editor):
        outer = wrap(editor, [chain[1], chain[2]], "control.repeat")

    assert editor.project.pages["behaviour"][0].body == [chain[0], outer, chain[3]]
    assert texts(editor.project, editor.project.blocks[outer].bodies["do"]) == ["a", "b"]


def test_a_whole_loose_stack_can_be_wrapped_where_it_lies(language):
    editor = build(language, [say("a"), say("b")])
    stack = editor.project.pages["behaviour"][0]

    with one_step(editor):
        outer = wrap(editor, stack.body, "control.forever")

    (only,) = editor.project.pages["behaviour"]
    assert (only.body, only.x, only.y) == ([outer], stack.x, stack.y)


def test_a_hat_stays_outside_of_what_is_wrapped(language):
    editor, chain = rule(language, say("a"))

    outer = wrap(editor, chain, "control.repeat")

    assert editor.project.pages["behaviour"][0].body == [chain[0], outer]


def test_blocks_that_do_not_follow_each_other_cannot_be_wrapped(language):
    editor, chain = rule(language, say("a"), say("b"), say("c"))

    assert "follow each other" in str(why_not_wrap(editor, [chain[1], chain[3]]) or "")
    assert why_not_wrap(editor, [chain[1], chain[2]]) is None
    with pytest.raises(EditRefused, match="no place"):
        wrap(editor, [chain[1]], "robot.say")
    with pytest.raises(EditRefused, match="Nothing goes below"):
        wrap(editor, [chain[1]], "control.forever")


def test_an_unwrapped_block_leaves_its_content_in_its_place(language):
    outer = B("control.together", bodies={"do.1": [say("a")], "do.2": [say("b"), say("c")]})
    editor, chain = rule(language, outer, say("d"))

    with one_step(editor):
        unwrap(editor, chain[1])

    assert texts(editor.project, editor.project.pages["behaviour"][0].body)[1:] == list("abcd")


def test_an_empty_block_unwrapped_is_gone(language):
    editor, chain = rule(language, B("control.repeat"), say("d"))

    assert unwrap(editor, chain[1]) == ()

    assert texts(editor.project, editor.project.pages["behaviour"][0].body)[1:] == ["d"]


def test_content_that_cannot_stand_there_is_refused_and_nothing_changes(language):
    outer = B("control.if", bodies={"do": [B("control.stop_program")]})
    editor, chain = rule(language, outer, say("d"))

    with pytest.raises(EditRefused, match="never be reached"):
        unwrap(editor, chain[1])

    assert editor.project.pages["behaviour"][0].body == chain


def test_a_part_comes_with_its_defaults_and_goes_with_its_blocks_set_free(language):
    join = B("text.join", {"item.1": "one"}, {"item.2": B("math.number")})
    editor, (_, talk) = rule(language, B("robot.say", inputs={"text": join}))
    block = editor.project.blocks[talk].inputs["text"]
    number = editor.project.blocks[block].inputs["item.2"]

    with one_step(editor):
        assert add_part(editor, block, "item") == 3
    assert editor.project.blocks[block].fields["item.3"] == ""
    with one_step(editor):
        remove_part(editor, block, "item", 2, beside=(7, 7))

    assert editor.project.stack_of(number).body == [number]
    assert editor.project.stack_of(number).x == 7
    with pytest.raises(EditRefused, match="fewer parts"):
        remove_part(editor, block, "item", 1)


def test_a_part_moves_with_all_that_is_in_it(language):
    bodies = {"do": [say("x")], "also_do.1": [say("1")], "also_do.3": [say("3")]}
    question = {"also_condition.2": B("logic.truth")}
    branch = B("control.if", inputs=question, bodies=bodies, groups={"also": 3})
    editor, (_, block) = rule(language, branch)

    with one_step(editor):
        move_part(editor, block, "also", 3, 1)

    there = editor.project.blocks[block]
    assert {slot: texts(editor.project, chain) for slot, chain in there.bodies.items()} == {
        "do": ["x"],
        "also_do.1": ["3"],
        "also_do.2": ["1"],
    }
    assert list(there.inputs) == ["also_condition.3"]


def test_fields_of_parts_change_places(language):
    join = B(
        "text.join", {"item.1": "one", "item.2": "two", "item.3": "three"}, {}, {}, {"item": 3}
    )
    editor = build(language, [join])
    (block,) = editor.project.blocks.values()

    with one_step(editor):
        move_part(editor, block.id, "item", 1, 3)

    assert [block.fields[f"item.{n}"] for n in (1, 2, 3)] == ["two", "three", "one"]


def test_several_blocks_are_disabled_and_collapsed_in_one_step(language):
    editor, chain = rule(language, say("a"), say("b"), B("control.repeat"))
    blocks = editor.project.blocks

    with one_step(editor):
        set_disabled(editor, chain[1:3], True)
    with one_step(editor):
        assert toggle(editor, chain[1:], "disabled") is True
    assert [blocks[i].disabled for i in chain] == [False, True, True, True]
    assert toggle(editor, chain[1:], "disabled") is False
    with one_step(editor):
        set_collapsed(editor, chain, True)


def test_a_variable_is_dragged_out_of_a_field_as_its_reporter(language):
    editor, (_, change, wait) = rule(
        language, B("variable.change", {"variable": "v1"}), B("control.wait")
    )

    clip = reporter_of(editor.project, language, change, "variable")

    assert clip is not None
    with one_step(editor):
        (new,) = create_and_drop(editor, clip, InInput(wait, "seconds"))
    assert editor.project.blocks[new].type == "variable.get"
    assert editor.project.blocks[new].fields == {"variable": "v1"}
    assert len(editor.project.variables) == 1
    assert reporter_of(editor.project, language, change, "amount") is None
