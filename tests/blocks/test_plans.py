"""Blocks of facts and plans: as Python and back, what is told of them, what the planner reads."""

from __future__ import annotations

from pathlib import Path

import pytest
from block_building import B, add, build, held, read_program

from nep_core.program import tasks
from nep_core.program.facts import FACTS
from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.fixes import apply_fix
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Project

PROGRAM = '''\
"""Tour. Made with NEP Studio."""
from nep_core import Behavior, fact, is_true, makes_true, makes_untrue, needs, now_true
from nep_core import reach, the_plan, true_while

behavior = Behavior("Tour")
told = 0
steps = 0
shown = 0


def go_to(here, there):
    global steps
    needs("at", here)
    needs("door", here, there)
    steps += 1
    makes_untrue("at", here)
    makes_true("at", there)
    makes_true("has moved")


def light_the(lamp):
    global told
    told = lamp
    makes_true("lit", lamp)


@behavior.when_started
def when_started():
    global shown
    now_true("at", "hall")
    now_true("door", "hall", "kitchen")
    true_while(lambda: steps > 0, "has moved")
    shown = the_plan(fact("at", "kitchen"), fact("lit", 3))
    if not is_true("at", "kitchen"):
        reach(fact("at", "kitchen"), fact("lit", 3), fact("has moved"))


behavior.run()
'''


def found(editor: Editor, kind: str):
    return [one for one in check(editor.project, editor.language) if one.kind == kind]


def types(project: Project) -> list[str]:
    return sorted(block.type for block in project.blocks.values())


def test_facts_and_plans_are_read_from_python_and_written_again(language):
    project = read_program(PROGRAM, language)

    code = generate_program(project, language.of(project))

    used = types(project)
    assert not {"code.lines", "code.value"}.intersection(used)
    assert used.count("plan.needs") == 2 and used.count("plan.fact") == 5
    assert used.count("plan.true_while") == used.count("plan.reach") == 1
    again = read_program(code.text, language, project)
    assert types(again) == used
    assert generate_program(again, language.of(again)).text == code.text


def test_the_values_of_a_task_may_be_of_any_kind(language):
    editor = Editor(Project("Test"), language)
    lamp = editor.new_parameter("lamp", "any")
    own = editor.add_procedure(["light", lamp])
    value = B(f"my.parameter.{own}.{lamp.id}")
    said = B("robot.say", inputs={"text": value})
    plain = [B("event.started"), B(f"my.call.{own}", {lamp.id: "red"})]
    build(language, [B(f"my.define.{own}"), said], plain, editor=editor)
    before = generate_program(editor.project, editor.language).text

    lit = B("plan.makes_true", {"fact": "lit"}, {"value.1": value}, groups={"of": 1})
    add(editor, lit, InStack(next(iter(editor.project.stacks)), 2))

    text = generate_program(editor.project, editor.language).text
    assert "say(lamp)" in before
    assert "say(as_text(lamp))" in text  # a plan may call it with a number
    assert 'makes_true("lit", lamp)' in text


def test_the_python_of_blocks_is_what_the_planner_reads(language, tmp_path: Path):
    tasks.PROGRAM.cancelled.clear()
    FACTS.clear()
    project = read_program(PROGRAM, language)
    text = generate_program(project, language.of(project)).text.replace("behavior.run()\n", "")
    path = tmp_path / "tour.py"
    path.write_text(text, encoding="utf-8")
    names: dict[str, object] = {"__name__": "tour"}
    exec(compile(text, str(path), "exec"), names)

    names["when_started"]()  # type: ignore[operator]

    after = held(names)
    assert after["steps"] == 1
    assert (after["told"], after["shown"]) == (3, ["light the 3", "go to hall kitchen"])
    FACTS.clear()


@pytest.mark.parametrize("count", [0, 1, 20])
@pytest.mark.parametrize("name", ["now_true", "no_longer_true", "needs", "makes_true"])
def test_a_fact_has_as_many_values_as_its_block(language, name, count):
    fields = {"fact": "is so", **{f"value.{n}": n for n in range(1, count + 1)}}
    editor = build(language, [B("event.started"), B(f"plan.{name}", fields, groups={"of": count})])

    text = generate_program(editor.project, language).text

    said = ", ".join(['"is so"', *map(str, range(1, count + 1))])
    assert f"    {name}({said})\n" in text
    assert types(read_program(text, language, editor.project)) == types(editor.project)


def wanting(name: str, count: int = 1, **fields: object) -> B:
    values = {f"value.{n}": "hall" for n in range(1, count + 1)}
    return B("plan.fact", {"fact": name, **values, **fields}, groups={"of": count})


def reaching(name: str, count: int = 1) -> B:
    return B("plan.reach", inputs={"goal": wanting(name, count)})


def made(name: str, block: str = "now_true", count: int = 1) -> B:
    values = {f"value.{n}": "hall" for n in range(1, count + 1)}
    return B(f"plan.{block}", {"fact": name, **values}, groups={"of": count})


def test_a_fact_that_nothing_makes_true_is_told_and_the_near_one_offered(language):
    editor = build(language, [B("event.started"), made("robot at"), reaching("Robot att")])

    (problem,) = found(editor, "never_true")
    assert problem.severity == "warning"
    apply_fix(editor, problem)

    assert not found(editor, "never_true")
    assert editor.project.blocks[problem.block].fields["fact"] == "robot at"


def test_a_fact_with_other_values_is_another_fact(language):
    editor = build(language, [B("event.started"), made("at", count=2), reaching("at")])

    (problem,) = found(editor, "never_true")

    assert problem.fix is None


@pytest.mark.parametrize("block", ["now_true", "true_while", "makes_true"])
def test_a_fact_that_is_made_true_somewhere_is_not_told(language, block):
    editor = build(
        language, [B("event.started"), reaching("at")], [B("event.gesture"), made("at", block)]
    )

    assert not found(editor, "never_true")


def test_python_may_make_any_fact_true(language):
    code = B("code.lines", {"code": "now_true('at', 'hall')"})
    editor = build(language, [B("event.started"), code, reaching("at")])

    assert not found(editor, "never_true")


def test_a_fact_without_a_name_is_told(language):
    editor = build(language, [B("event.started"), made(" ")])

    (problem,) = found(editor, "no_fact")

    assert problem.severity == "error"


def test_what_a_plan_would_not_see_is_told(language):
    editor = Editor(Project("Test"), language)
    own = editor.add_procedure(["tidy"])
    inside = B("control.forever", bodies={"do": [made("tidy", "makes_true")]})
    build(
        language,
        [B(f"my.define.{own}"), made("tidy", "makes_true"), inside],
        [B("event.started"), made("tidy", "needs"), made("tidy")],
        editor=editor,
    )

    problems = found(editor, "not_planned")

    told = [editor.project.blocks[one.block].type for one in problems]
    assert sorted(told) == ["plan.makes_true", "plan.needs"]
