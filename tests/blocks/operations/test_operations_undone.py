"""Whatever is done to several blocks, undo brings the same bytes back, and nothing is lost."""

from __future__ import annotations

import pytest
from block_building import B, build
from hypothesis import given
from hypothesis import strategies as st
from operating import assert_sound, count_of_steps, say

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.operations.copying import clip_of, copy, delete, duplicate, paste
from nep_studio.blocks.operations.moving import create_and_drop, drop, move_by, pick_up
from nep_studio.blocks.operations.selection import require_runs
from nep_studio.blocks.operations.wrapping import (
    add_part,
    move_part,
    remove_part,
    set_collapsed,
    set_disabled,
    toggle,
    unwrap,
    wrap,
)
from nep_studio.blocks.places import InBody, InInput, InStack

pytestmark = pytest.mark.long


def program(language):
    join = B("text.join", inputs={"item.1": B("math.random_integer"), "item.2": B("text.text")})
    question = B("logic.compare", inputs={"a": B("variable.get", {"variable": "v1"})})
    return build(
        language,
        [B("event.gesture"), say("a"), B("robot.say", inputs={"text": join}), say("b")],
        [
            B("control.if", inputs={"condition": question}, bodies={"do": [say("c"), say("d")]}),
            B("control.together", bodies={"do.1": [say("e")], "do.2": [B("control.forever")]}),
            B("control.repeat"),
            B("control.stop_program"),
        ],
        [B("math.arithmetic", inputs={"b": B("math.number")})],
        [B("control.repeat", bodies={"do": [say("f")]})],
        [B("control.forever")],
        variables=("x",),
    )


def draw_place(draw, editor):
    project = editor.project
    block = draw(st.sampled_from(sorted(project.blocks)))
    definition = editor.language.definitions[project.blocks[block].type]
    keys = [(key, slot) for key, slot in definition.keys(project.blocks[block].groups)]
    inputs = [InInput(block, key) for key, slot in keys if slot.pluggable]
    bodies = [
        InBody(block, key, draw(st.integers(0, len(project.blocks[block].bodies.get(key, [])))))
        for key, slot in keys
        if slot.kind.name == "body"
    ]
    stack = project.stack_of(block)
    chain = [InStack(stack.id, draw(st.integers(0, len(stack.body))))]
    loose = [editor.new_stack("behaviour", 1, 2)]
    return draw(st.sampled_from([*inputs, *bodies, *chain, *chain, *loose]))


def operate(draw, editor, language):
    """Do one operation; give how many blocks there should be more than before."""
    project, before = editor.project, len(editor.project.blocks)
    ids = draw(st.sets(st.sampled_from(sorted(project.blocks)), min_size=1, max_size=5))
    block = min(ids)
    wraps = draw(st.booleans())
    kind = draw(st.integers(0, 11))
    if kind == 0:
        return -len(delete(editor, ids))
    if kind == 1:
        duplicate(editor, ids)
        return None
    if kind == 2:
        clip = copy(project, language, ids)
        paste(editor, clip, "behaviour", 3, 4)
        return len(clip)
    if kind in (3, 4, 5):
        carried = pick_up(project, block, alone=draw(st.booleans()))
        drop(editor, carried, draw_place(draw, editor), wrap=wraps)
    elif kind == 6:
        move_by(editor, require_runs(editor.project, ids), 5, 5)
    elif kind == 7:
        wrap(editor, ids, draw(st.sampled_from(["control.repeat", "control.forever"])))
        return 1
    elif kind == 8:
        inputs = project.blocks[block].inputs.values()
        gone = 1 + len(list(project.within(list(inputs))))
        unwrap(editor, block)
        return -gone
    elif kind == 9:
        draw(st.sampled_from([set_disabled, set_collapsed]))(editor, ids, wraps)
        toggle(editor, ids, "disabled")
    elif kind == 10:
        types = ["robot.say", "control.repeat", "control.forever", "math.number", "logic.not"]
        clip = clip_of(language, draw(st.sampled_from(types)))
        create_and_drop(editor, clip, draw_place(draw, editor), wrap=wraps)
        return len(project.blocks) - before
    else:
        group = draw(st.sampled_from(["part", "item", "also", "otherwise"]))
        change = draw(st.sampled_from([add_part, remove_part, move_part]))
        numbers = [
            draw(st.integers(1, 3)) for _ in range({add_part: 0, move_part: 2}.get(change, 1))
        ]
        change(editor, block, group, *numbers)
    return 0


@given(st.data())
def test_any_operation_is_undone_to_identical_bytes_and_refused_without_a_trace(language, data):
    editor = program(language)
    for _ in range(data.draw(st.integers(1, 6))):
        before, steps = to_bytes(editor.project), count_of_steps(editor)
        count = len(editor.project.blocks)
        if not count:
            break
        try:
            with editor.transaction("one operation"):
                more = operate(data.draw, editor, language)
        except EditRefused as refused:
            assert str(refused.sentence).endswith(".")
            assert to_bytes(editor.project) == before
            continue

        after = to_bytes(editor.project)
        assert more is None or len(editor.project.blocks) == count + more
        assert count_of_steps(editor) <= steps + 1
        assert_sound(editor)
        if count_of_steps(editor) > steps:
            editor.history.undo()
            assert to_bytes(editor.project) == before
            editor.history.redo()
            assert to_bytes(editor.project) == after
