"""Goals and priorities as Python, back to the same blocks, and what is told of them before."""

from __future__ import annotations

import pytest
from block_building import B, build, read_program

from nep_studio.blocks.checks import check
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.fixes import apply_fix

CONDITION = {"condition": B("sensing.human_state_is")}
HATS = [
    (B("goal.goal", {"interrupted": "resume"}), '"greet", when="seen_face", interrupted="resume"'),
    (B("goal.goal", {"seconds.1": 20}, groups={"limit": 1}),
     '"greet", when="seen_face", at_most_s=20'),
    (B("goal.goal", {"robot.1": "NAO"}, groups={"robot": 1}),
     '"greet", when="seen_face", robot=nao'),
    (B("goal.goal_when", {"priority": "high"}, inputs=CONDITION),
     '"greet", when=lambda: human_state() == "touched_head", priority="high"'),
    (B("goal.goal_asked"), '"greet"'),
    (B("goal.goal_asked", {"interrupted": "drop"}, groups={"stop": 1}),
     '"greet", stop="touched_head", interrupted="drop"'),
]  # fmt: skip
STATEMENTS = [
    (B("goal.pursue"), 'behavior.pursue("greet")'),
    (B("goal.pursue", groups={"value": 1}), 'behavior.pursue("greet", "Anna")'),
    (B("goal.give_up"), 'behavior.give_up("greet")'),
    (B("goal.priority"), 'set_priority("high")'),
    (B("goal.priority", {"priority": "low", "displaced": "give_up"}),
     'set_priority("low", displaced="give_up")'),
    (B("goal.fail"), "fail_goal()"),
    (B("control.wait_until", inputs={"condition": B("goal.is_pursued")}),
     'wait_until(lambda: behavior.pursues("greet"))'),
    (B("robot.say", inputs={"text": B("goal.value")}), "nao.say(as_text(goal_value()))"),
]  # fmt: skip


def types(project) -> list[str]:
    return sorted(b.type for b in project.blocks.values() if b.type != "robots.robot")


@pytest.mark.parametrize(("hat", "arguments"), HATS, ids=[arguments for _, arguments in HATS])
def test_a_goal_is_a_decorator_and_reads_back(language: Language, hat: B, arguments: str) -> None:
    made = build(language, [hat, B("robot.say")]).project

    text = generate_program(made, language).text
    back = read_program(text, language)

    assert f"@behavior.goal({arguments})\ndef goal_greet():" in text
    assert types(back) == types(made)
    assert generate_program(back, language).text == text


@pytest.mark.parametrize(("block", "line"), STATEMENTS, ids=[line for _, line in STATEMENTS])
def test_what_is_done_with_goals_is_a_line_and_reads_back(
    language: Language, block: B, line: str
) -> None:
    made = build(language, [B("goal.goal_asked"), block]).project

    text = generate_program(made, language).text
    back = read_program(text, language)

    assert f"    {line}\n" in text
    assert types(back) == types(made)
    assert generate_program(back, language).text == text


def found(editor, kind):
    return [one for one in check(editor.project, editor.language) if one.kind == kind]


@pytest.mark.parametrize(
    "block",
    [
        B("goal.pursue", {"name": "Tuor"}),
        B("goal.give_up", {"name": "Tuor"}),
        B("control.wait_until", inputs={"condition": B("goal.is_pursued", {"name": "Tuor"})}),
    ],
    ids=lambda block: block.type,
)
def test_a_goal_that_is_named_and_not_there_is_told_and_the_near_one_offered(
    language: Language, block: B
) -> None:
    goal = [B("goal.goal_asked", {"name": "tour"}), B("robot.say")]
    editor = build(language, goal, [B("event.started"), block])

    (problem,) = found(editor, "unknown_goal")

    assert "Tuor" in str(problem.sentence)
    apply_fix(editor, problem)
    assert not found(editor, "unknown_goal")


@pytest.mark.parametrize("inside", ["goal.fail", "goal.value"])
def test_what_speaks_of_its_goal_is_told_where_there_is_none(
    language: Language, inside: str
) -> None:
    speaks = (
        B("goal.fail")
        if inside == "goal.fail"
        else B("robot.say", inputs={"text": B("goal.value")})
    )
    in_rule = build(language, [B("event.started"), speaks])
    in_goal = build(language, [B("goal.goal_asked"), speaks])
    after_goal = build(language, [B("goal.goal_asked")], [B("goal.when_goal"), speaks])

    assert [one.block for one in found(in_rule, "outside_goal")] == [
        block.id for block in in_rule.project.blocks.values() if block.type == inside
    ]
    assert not found(in_goal, "outside_goal") + found(after_goal, "outside_goal")


def test_goals_of_all_kinds_need_names_of_their_own(language: Language) -> None:
    editor = build(
        language,
        [B("goal.goal"), B("robot.say")],
        [B("goal.goal_asked"), B("robot.say")],
        [B("goal.goal_when", inputs=CONDITION), B("robot.say")],
    )

    assert len(found(editor, "same_goal")) == 2
