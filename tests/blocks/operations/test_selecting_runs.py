"""Selections as runs of neighbours."""

from __future__ import annotations

from block_building import B, build
from operating import rule, say

from nep_studio.blocks.operations.selection import Run, run_from, runs


def test_neighbours_of_one_chain_are_one_run_and_a_gap_begins_another(language):
    editor, chain = rule(language, say("a"), say("b"), say("c"), say("d"))
    _, a, b, _, d = chain

    found = runs(editor.project, [d, b, a])

    assert found == (Run(a, 2), Run(d, 1))


def test_blocks_inside_other_selected_blocks_go_with_those(language):
    editor, chain = rule(language, B("control.repeat", bodies={"do": [say("a"), say("b")]}))
    repeat = chain[1]
    inner = editor.project.blocks[repeat].bodies["do"]

    assert runs(editor.project, [*inner, repeat]) == (Run(repeat, 1),)
    assert runs(editor.project, inner) == (Run(inner[0], 2),)


def test_a_plugged_block_is_a_run_of_its_own(language):
    editor, chain = rule(language, B("control.wait", inputs={"seconds": B("math.number")}))
    number = editor.project.blocks[chain[1]].inputs["seconds"]

    assert runs(editor.project, [number]) == (Run(number, 1),)
    assert run_from(editor.project, number) == Run(number, 1)


def test_runs_come_in_page_order(language):
    editor = build(language, [say("a")], [say("b")], [say("c")])
    a, b, c = (stack.body[0] for stack in editor.project.pages["behaviour"])

    assert [run.first for run in runs(editor.project, {c, a, b})] == [a, b, c]


def test_ids_that_are_gone_are_left_out(language):
    editor, chain = rule(language, say("a"))

    assert runs(editor.project, ["gone", chain[1]]) == (Run(chain[1], 1),)
