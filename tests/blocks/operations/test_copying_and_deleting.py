"""Copy, paste, duplicate, delete: in one project, between two, as text."""

from __future__ import annotations

import pytest
from block_building import B, build, karate
from hypothesis import given
from hypothesis import strategies as st
from operating import one_step, rule, say, texts

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused, ProjectFileError
from nep_studio.blocks.operations.copying import (
    copy,
    delete,
    duplicate,
    from_text,
    paste,
    paste_at,
    to_text,
)
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Project


def test_deleted_blocks_let_the_chain_heal_and_can_be_pasted_back(language):
    editor, chain = rule(language, say("a"), say("b"), say("c"), say("d"))

    with one_step(editor):
        clip = delete(editor, [chain[1], chain[3]])

    assert texts(editor.project, editor.project.pages["behaviour"][0].body)[1:] == ["b", "d"]
    assert [texts(clip.project, roots) for roots in clip.roots] == [["a"], ["c"]]
    with one_step(editor):
        paste(editor, clip, "behaviour", 0, 0)


def test_deleting_nothing_is_refused(language):
    editor, _ = rule(language, say("a"))

    with pytest.raises(EditRefused, match="No blocks"):
        delete(editor, [])


def test_a_clip_pasted_into_another_project_brings_its_variables_by_name(language):
    source = karate(language)
    rule_stack = source.project.pages["behaviour"][1].body
    clip = from_text(to_text(copy(source.project, language, rule_stack)), language)
    target = build(language, [B("event.started")], variables=("points",))

    with one_step(target):
        (first,) = paste(target, clip, "behaviour", 300, 400)

    assert [variable.name for variable in target.project.variables] == ["points", "times"]
    made = target.project.variables[1].id
    used = {b.fields["variable"] for b in target.project.blocks.values() if "variable" in b.fields}
    assert used == {made}
    stack = target.project.stack_of(first)
    assert (stack.x, stack.y) == (300, 400)


def test_a_variable_of_the_same_name_is_used_not_made_again(language):
    source = build(language, [B("variable.set", {"variable": "v1"})], variables=("x",))
    target = build(language, variables=("y", "x"))
    clip = copy(source.project, language, source.project.blocks)

    paste(target, clip, "behaviour", 0, 0)

    (block,) = target.project.blocks.values()
    assert target.project.variable(block.fields["variable"]).name == "x"
    assert len(target.project.variables) == 2


def test_stacks_keep_their_distances_when_pasted(language):
    editor = build(language, [say("a")], [say("b")])
    clip = copy(editor.project, language, editor.project.blocks)

    paste(editor, clip, "behaviour", 1000, 1000)

    assert [(s.x, s.y) for s in editor.project.pages["behaviour"][2:]] == [
        (1000, 1000),
        (1000, 1200),
    ]


def test_blocks_of_another_page_are_refused_with_a_reason(language):
    editor, chain = rule(language, say("a"))
    clip = copy(editor.project, language, chain)

    with pytest.raises(EditRefused, match="Behaviour"):
        paste(editor, clip, "robots", 0, 0)


def test_a_clip_of_one_stack_can_be_pasted_into_a_chain(language):
    editor, chain = rule(language, say("a"), say("b"))
    clip = copy(editor.project, language, [chain[2]])

    with one_step(editor):
        paste_at(editor, clip, InStack(editor.project.pages["behaviour"][0].id, 1))

    assert texts(editor.project, editor.project.pages["behaviour"][0].body)[1:] == ["b", "a", "b"]


def test_a_duplicate_lies_beside(language):
    editor, chain = rule(language, say("a"), say("b"))

    with one_step(editor):
        (new,) = duplicate(editor, [chain[1]], {chain[1]: (60, 90)})

    stack = editor.project.stack_of(new)
    assert (texts(editor.project, stack.body), stack.x, stack.y) == (["a"], 84, 114)


@pytest.mark.parametrize(
    "text",
    ["", "hello", "{}", "[1, 2]", '{"format": "nep-studio-project"}', "\ud800", "null", "1e999"],
)
def test_a_clipboard_with_something_else_is_told_clearly(language, text):
    with pytest.raises(ProjectFileError) as told:
        from_text(text, language)

    assert "clipboard" in str(told.value.sentence)
    assert told.value.checklist


def test_a_broken_clip_is_told_clearly(language):
    editor, chain = rule(language, say("a"))
    text = to_text(copy(editor.project, language, chain))

    for end in range(1, len(text) - 2, 7):
        with pytest.raises(ProjectFileError):
            from_text(text[:end], language)


@given(st.data())
def test_whatever_is_copied_reads_back_the_same(language, data):
    editor = karate(language)
    ids = data.draw(st.sets(st.sampled_from(sorted(editor.project.blocks))))

    clip = copy(editor.project, language, ids)

    again = from_text(to_text(clip), language)
    assert to_text(again) == to_text(clip)
    if ids:
        target = Editor(Project("Other"), language)
        with one_step(target):
            paste(target, again, "behaviour", 5, 5)
        assert len(target.project.blocks) == len(clip)
