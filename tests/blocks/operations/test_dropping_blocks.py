"""Picking up and dropping: healing, pushing out, cutting off, wrapping, and refusals."""

from __future__ import annotations

import pytest
from block_building import B, build
from operating import count_of_steps, one_step, rule, say, texts

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.copying import clip_of, copy
from nep_studio.blocks.operations.moving import (
    create_and_drop,
    drop,
    move_by,
    pick_up,
    why_not_create,
    why_not_drop,
)
from nep_studio.blocks.operations.selection import Run, runs
from nep_studio.blocks.places import InBody, InInput, InStack


def stacks(editor):
    return editor.project.pages["behaviour"]


def test_a_block_is_picked_up_with_all_below_it_or_alone(language):
    editor, (_, a, b, c) = rule(language, say("a"), say("b"), say("c"))

    assert pick_up(editor.project, b).runs == (Run(b, 2),)
    assert pick_up(editor.project, b, alone=True).runs == (Run(b, 1),)
    assert pick_up(editor.project, b, selected={a, b}).runs == (Run(a, 2),)
    assert pick_up(editor.project, c, selected={a, b}).runs == (Run(c, 1),)


def test_one_block_dragged_out_lets_the_stack_heal(language):
    editor, chain = rule(language, say("a"), say("b"), say("c"))

    with one_step(editor):
        carried = pick_up(editor.project, chain[2], alone=True)
        drop(editor, carried, editor.new_stack("behaviour", 500, 500))

    assert texts(editor.project, stacks(editor)[0].body)[1:] == ["a", "c"]
    assert texts(editor.project, stacks(editor)[1].body) == ["b"]


def test_a_block_dropped_where_it_is_changes_nothing(language):
    editor, chain = rule(language, say("a"), say("b"))
    steps = count_of_steps(editor)

    drop(editor, pick_up(editor.project, chain[1]), InStack(stacks(editor)[0].id, 1))

    assert count_of_steps(editor) == steps


def arithmetic_in_wait(language, loose: B):
    editor = build(
        language,
        [B("control.wait", inputs={"seconds": B("math.random_integer")})],
        [loose],
    )
    wait, new = (stack.body[0] for stack in stacks(editor))
    return editor, wait, editor.project.blocks[wait].inputs["seconds"], new


def test_a_block_pushed_out_of_a_slot_lies_beside_when_several_slots_would_take_it(language):
    editor, wait, old, new = arithmetic_in_wait(language, B("math.arithmetic"))

    with one_step(editor):
        place = InInput(wait, "seconds")
        drop(editor, pick_up(editor.project, new), place, beside=(300, 70))

    assert editor.project.blocks[wait].inputs == {"seconds": new}
    aside = editor.project.stack_of(old)
    assert (aside.body, aside.x, aside.y) == ([old], 300, 70)


def test_a_block_pushed_out_goes_into_the_only_slot_that_takes_it(language):
    inner = B("math.random_integer")
    loose = B("math.arithmetic", inputs={"a": inner})
    editor, wait, old, new = arithmetic_in_wait(language, loose)

    with one_step(editor):
        drop(editor, pick_up(editor.project, new), InInput(wait, "seconds"))

    assert editor.project.blocks[new].inputs["b"] == old


def test_an_inner_value_dropped_on_the_slot_around_it_takes_the_place(language):
    sum_of = B("math.arithmetic", inputs={"a": B("math.random_integer")})
    editor = build(language, [B("control.wait", inputs={"seconds": sum_of})])
    wait = stacks(editor)[0].body[0]
    outer = editor.project.blocks[wait].inputs["seconds"]
    inner = editor.project.blocks[outer].inputs["a"]

    with one_step(editor):
        drop(editor, pick_up(editor.project, inner), InInput(wait, "seconds"))

    assert editor.project.blocks[wait].inputs == {"seconds": inner}
    assert editor.project.stack_of(outer).body == [outer]


def test_blocks_below_a_dropped_cap_become_a_loose_stack(language):
    editor = build(language, [B("event.gesture"), say("a"), say("b")], [B("control.stop_program")])
    stop = stacks(editor)[1].body[0]

    with one_step(editor):
        place = InStack(stacks(editor)[0].id, 2)
        drop(editor, pick_up(editor.project, stop), place, beside=(9, 8))

    assert texts(editor.project, stacks(editor)[0].body)[1:] == ["a", "control.stop_program"]
    assert texts(editor.project, stacks(editor)[1].body) == ["b"]
    assert (stacks(editor)[1].x, stacks(editor)[1].y) == (9, 8)


def test_a_cap_moved_up_in_its_own_stack_leaves_the_rest_loose(language):
    editor, chain = rule(language, say("a"), say("b"), B("control.stop_program"))
    first = stacks(editor)[0]

    with one_step(editor):
        drop(editor, pick_up(editor.project, chain[3]), InStack(first.id, 1))

    assert texts(editor.project, first.body)[1:] == ["control.stop_program"]
    assert texts(editor.project, stacks(editor)[1].body) == ["a", "b"]


@pytest.mark.parametrize("block_type", ["control.repeat", "control.forever"])
def test_a_c_block_dropped_to_wrap_takes_the_rest_of_the_chain_into_its_mouth(language, block_type):
    editor = build(language, [B("event.gesture"), say("a"), say("b")], [B(block_type)])
    outer = stacks(editor)[1].body[0]

    with one_step(editor):
        place = InStack(stacks(editor)[0].id, 1)
        drop(editor, pick_up(editor.project, outer), place, wrap=True)

    (only,) = stacks(editor)
    assert texts(editor.project, only.body)[1:] == [block_type]
    assert texts(editor.project, editor.project.blocks[outer].bodies["do"]) == ["a", "b"]


@pytest.mark.parametrize("block_type", ["control.repeat", "control.forever"])
def test_a_c_block_can_wrap_a_whole_loose_stack(language, block_type):
    editor = build(language, [say("a"), say("b")], [B(block_type)])
    loose, outer = stacks(editor)[0], stacks(editor)[1].body[0]

    with one_step(editor):
        place = InStack(loose.id, 0)
        drop(editor, pick_up(editor.project, outer), place, wrap=True, at=(40, 10))

    (only,) = stacks(editor)
    assert (only.body, only.x, only.y) == ([outer], 40, 10)
    assert texts(editor.project, editor.project.blocks[outer].bodies["do"]) == ["a", "b"]


def test_a_c_block_that_is_not_empty_does_not_wrap(language):
    full = B("control.repeat", bodies={"do": [say("x")]})
    editor = build(language, [say("a"), say("b")], [full])
    loose, outer = stacks(editor)[0], stacks(editor)[1].body[0]

    drop(editor, pick_up(editor.project, outer), InStack(loose.id, 1), wrap=True)

    assert texts(editor.project, loose.body) == ["a", "control.repeat", "b"]


def test_refusals_say_why(language):
    editor = build(
        language,
        [B("event.gesture"), B("control.if", bodies={"do": [say("x")]})],
        [B("math.number")],
        [say("a"), say("b")],
    )
    hat, branch = stacks(editor)[0].body
    number, a = stacks(editor)[1].body[0], stacks(editor)[2].body[0]

    def why(block, place):
        return str(why_not_drop(editor, pick_up(editor.project, block), place) or "")

    assert "inside itself" in why(branch, InBody(branch, "do", 0))
    assert "gives a value" in why(number, InStack(stacks(editor)[0].id, 1))
    assert "yes-or-no" in why(number, InInput(branch, "condition"))
    assert "begins a stack" in why(hat, InStack(stacks(editor)[2].id, 1))
    assert "Only one block" in why(a, InInput(branch, "condition"))
    assert "Behaviour" in why(a, editor.new_stack("robots", 0, 0))
    with pytest.raises(EditRefused, match="begins a stack"):
        drop(editor, pick_up(editor.project, hat), InStack(stacks(editor)[2].id, 1))


def test_a_new_block_from_the_palette_is_made_and_dropped_in_one_step(language):
    editor, chain = rule(language, say("a"), say("b"))
    clip = clip_of(language, "control.repeat", times=7)

    with one_step(editor):
        (new,) = create_and_drop(editor, clip, InStack(stacks(editor)[0].id, 1), wrap=True)

    assert stacks(editor)[0].body == [chain[0], new]
    assert editor.project.blocks[new].fields["times"] == 7
    assert len(editor.project.blocks[new].bodies["do"]) == 2


def test_a_new_block_that_does_not_fit_is_not_made(language):
    editor, _ = rule(language, say("a"))
    clip, place = clip_of(language, "math.number"), InStack(stacks(editor)[0].id, 1)
    before = dict(editor.project.blocks)

    assert why_not_create(editor, clip, place) is not None
    with pytest.raises(EditRefused):
        create_and_drop(editor, clip, place)

    assert editor.project.blocks == before
    assert why_not_create(editor, clip_of(language, "robot.say"), place) is None


def test_a_new_value_pushes_the_old_one_out(language):
    editor, (_, wait) = rule(language, B("control.wait", inputs={"seconds": B("math.number")}))
    clip = clip_of(language, "math.random_integer")

    with one_step(editor):
        (new,) = create_and_drop(editor, clip, InInput(wait, "seconds"), beside=(1, 2))

    assert editor.project.blocks[wait].inputs == {"seconds": new}
    assert (stacks(editor)[-1].x, stacks(editor)[-1].y) == (1, 2)


def test_several_stacks_move_together_and_inner_blocks_come_out(language):
    editor = build(language, [say("a"), say("b")], [say("c")])
    first, second = stacks(editor)
    b, c = first.body[1], second.body[0]

    with one_step(editor):
        move_by(editor, runs(editor.project, [b, c]), 10, -5, {b: (100, 100)})

    assert [(s.x, s.y) for s in stacks(editor)] == [(40, 40), (50, 235), (110, 95)]
    assert texts(editor.project, stacks(editor)[2].body) == ["b"]


def test_several_stacks_cannot_be_dropped_into_one_place(language):
    editor = build(language, [say("a")], [say("b")], [B("event.started")])
    a, b, _ = (stack.body[0] for stack in stacks(editor))
    carried = pick_up(editor.project, a, selected={a, b})

    assert "Several stacks" in str(
        why_not_drop(editor, carried, InStack(stacks(editor)[2].id, 1)) or ""
    )
    clip = copy(editor.project, language, [a, b])
    assert why_not_create(editor, clip, InStack(stacks(editor)[2].id, 1)) is not None
