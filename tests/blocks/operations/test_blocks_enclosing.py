"""Putting a C block that is there already around blocks."""

from __future__ import annotations

import pytest

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.operations.moving import enclose, why_not_enclose, without_hat
from nep_studio.blocks.operations.selection import Run, runs
from tests.blocks.block_building import B, build


def story(language):
    stack = [B("event.started"), B("robot.say"), B("control.wait"), B("control.repeat")]
    return build(language, stack, [B("control.repeat")])


def test_a_loose_c_block_goes_around_exactly_a_run(language):
    editor = story(language)
    first, second = editor.project.pages["behaviour"]
    hat, say, wait, repeat = first.body
    [outer] = second.body
    before = to_bytes(editor.project)

    enclose(editor, outer, Run(say, 2))

    assert first.body == [hat, outer, repeat]
    assert editor.project.blocks[outer].bodies == {"do": [say, wait]}
    editor.history.undo()
    assert to_bytes(editor.project) == before


def test_a_c_block_of_the_same_stack_comes_out_and_goes_around(language):
    editor = story(language)
    stack = editor.project.pages["behaviour"][0]
    hat, say, wait, repeat = stack.body
    before = to_bytes(editor.project)

    enclose(editor, repeat, Run(say, 2))

    assert stack.body == [hat, repeat]
    assert editor.project.blocks[repeat].bodies == {"do": [say, wait]}
    editor.history.undo()
    assert to_bytes(editor.project) == before


def test_a_c_block_that_holds_something_goes_around_nothing_more(language):
    editor = story(language)
    _, say, wait, repeat = editor.project.pages["behaviour"][0].body
    enclose(editor, repeat, Run(wait, 1))
    before = to_bytes(editor.project)

    with pytest.raises(EditRefused):
        enclose(editor, repeat, Run(say, 1))

    assert to_bytes(editor.project) == before


def test_what_nothing_may_follow_cannot_go_around_the_middle(language):
    editor = story(language)
    _, say, wait, _ = editor.project.pages["behaviour"][0].body

    assert why_not_enclose(editor, "control.forever", Run(say, 1)) is not None
    assert why_not_enclose(editor, "control.forever", Run(wait, 2)) is None
    assert why_not_enclose(editor, "control.repeat", Run(say, 1)) is None


def test_a_hat_stays_outside(language):
    editor = story(language)
    hat, say, *_ = editor.project.pages["behaviour"][0].body

    assert without_hat(editor, Run(hat, 3)) == Run(say, 2)
    assert without_hat(editor, Run(hat, 1)) is None


def test_blocks_that_follow_each_other_are_one_run_in_any_order(language):
    say = [B("event.started"), *[B("robot.say") for _ in range(60)]]
    editor = build(language, say, [B("math.number")])
    first, second = editor.project.pages["behaviour"]
    selected = [*first.body[1:20], *first.body[30:], *second.body]

    found = runs(editor.project, reversed(selected))

    assert found == (Run(first.body[1], 19), Run(first.body[30], 31), Run(second.body[0], 1))
