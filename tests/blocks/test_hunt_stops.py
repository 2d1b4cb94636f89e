"""Where a program pauses that is to pause at a block."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio import paths
from nep_studio.blocks import files
from nep_studio.blocks.edits.content import SetComment
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from tests.blocks.block_building import B, build

SAY = B("robot.say", {"text": "after"})


def beside(project: Project, language: Language) -> list[str]:
    """The types of the blocks at which a program would pause elsewhere."""
    code = generate_program(project, language)
    stops = {block: code.stop_at(block) for block in project.blocks}
    found = {block: code.block_at(line) for block, line in stops.items() if line}
    return [
        project.blocks[block].type
        for block, there in found.items()
        if there is None or not is_in(project, language, there, block)
    ]


def is_in(project: Project, language: Language, there: str, block: str) -> bool:
    """Whether a block is another one, or, when that is a rule, in it."""
    definition = language.of(project).definitions[project.blocks[block].type]
    if definition.shape == "hat":
        return chain_of(project, there) == chain_of(project, block)
    return there == block


def chain_of(project: Project, block: str) -> str:
    while (parent := project.parents.get(block)) is not None:
        block = parent.owner
    return block


@pytest.mark.parametrize("example", sorted(paths.examples().glob("*.nep")), ids=lambda p: p.stem)
def test_a_program_pauses_at_the_block_itself(language: Language, example: Path) -> None:
    project = files.load(example, language)

    assert beside(project, language) == []


@pytest.mark.parametrize("kind", ["control.together", "goal.in_turn", "goal.one_of"])
def test_parts_that_go_on_beside_each_other_are_paused_at_before_they_begin(
    language: Language, kind: str
) -> None:
    editor = build(language, [B("event.started"), B(kind), SAY])
    build(language, [B("robots.robot")], page="robots", editor=editor)

    assert beside(editor.project, language) == []


def test_a_rule_without_steps_does_not_pause_the_next_one(language: Language) -> None:
    editor = build(language, [B("event.started")], [B("event.gesture"), SAY])
    build(language, [B("robots.robot")], page="robots", editor=editor)

    assert beside(editor.project, language) == []


@pytest.mark.parametrize("kind", ["control.together", "goal.in_turn", "goal.one_of"])
def test_parts_in_a_loop_are_paused_at_in_the_loop(language: Language, kind: str) -> None:
    around = B("control.repeat", bodies={"do": [SAY, B(kind)]})
    editor = build(language, [B("event.started"), around])
    build(language, [B("robots.robot")], page="robots", editor=editor)
    code = generate_program(editor.project, language)
    stops = {b.type: code.stop_at(id_) for id_, b in editor.project.blocks.items()}

    assert beside(editor.project, language) == []
    assert stops[kind] > stops["robot.say"] > stops["control.repeat"]


def test_a_block_with_a_comment_is_paused_at_where_it_does_something(language: Language) -> None:
    editor = build(language, [B("event.started"), B("robot.say", {"text": "a"})])
    build(language, [B("robots.robot")], page="robots", editor=editor)
    block = next(id_ for id_, b in editor.project.blocks.items() if b.type == "robot.say")
    editor.apply(SetComment(block, "why"))
    code = generate_program(editor.project, language)

    assert code.text.splitlines()[code.stop_at(block) - 1].strip() == 'nao.say("a")'
