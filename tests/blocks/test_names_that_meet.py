"""Names of people that meet the program's own: an answer, parameters, own blocks pasted."""

from __future__ import annotations

import pytest
from block_building import B, build, read_program

from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import copy, paste
from nep_studio.blocks.procedures import title
from nep_studio.blocks.text import sentence


def code_of(editor):
    return generate_program(editor.project, editor.language).text


def test_asking_does_not_overwrite_a_variable_called_answer(language):
    counted = B("variable.change", {"variable": "v1"})
    ask = B("robot_speech.ask", bodies={"do.1": [counted]}, groups={"answer": 1})
    editor = build(language, [B("event.started"), ask], variables=("answer",))

    text = code_of(editor)

    assert "    answer = nao.ask(" in text
    assert "        program.answer += 1" in text and "Variables(answer=0)" in text


def test_asking_does_not_overwrite_what_a_rule_has_by_itself(language):
    kept = B("variable.set", {"variable": "v1", "value": "kept"})
    ask = B("robot_speech.ask", bodies={"do.1": [B("control.wait")]}, groups={"answer": 1})
    told = B("robot.say", inputs={"text": B("variable.get", {"variable": "v1"})})
    editor = build(language, [B("event.started"), kept, ask, told], variables=("answer",))
    text = code_of(editor)

    again = read_program(text, language, editor.project)

    assert '    answer = "kept"\n' in text and "    nao.say(answer)\n" in text
    assert "    answer_2 = nao.ask(" in text and '    if answer_2 == "yes":' in text
    assert again.blocks == editor.project.blocks


EACH = [("yes", "a"), ("no", "b")]
"""The answers, and what is said to each."""


def asked(name, words, branches, end=""):
    """The lines of a question, and of what is done after each answer."""
    lines = [f'{name} = nao.ask("Well?", {words})']
    for word, said in branches:
        lines += [f'{"if" if len(lines) == 1 else "elif"} {name} == "{word}":']
        lines += [f'    nao.say("{said}")']
    return "\n    ".join([*lines, *filter(None, [end])]) + "\n"


@pytest.mark.parametrize(
    ("rule", "is_block"),
    [
        (asked("answer", ["yes", "no"], EACH), True),
        (asked("answer", ["yes", "no"], EACH[1:]), False),
        (asked("answer", ["yes"], EACH[:1], "nao.say(answer)"), False),
        (asked("reply", ["yes"], EACH[:1]), False),
    ],
)
def test_an_answer_is_a_variable_where_more_is_done_with_it_than_the_block_does(
    language, rule, is_block
):
    editor = build(language, [B("event.started"), B("robot.say", {"text": "hi"})])
    build(language, [B("robots.robot")], page="robots", editor=editor)
    text = code_of(editor).replace('nao.say("hi")\n', rule)

    again = read_program(text, language, editor.project)

    types = [block.type for block in again.blocks.values()]
    assert ("robot_speech.ask" in types) is is_block
    assert ("robot_speech.ask_for" in types) is not is_block
    assert not any(one.startswith("code.") for one in types)
    assert len(again.variables) == (0 if is_block else 1)


def test_own_blocks_may_have_parameters_of_the_same_name(language):
    editor = build(language)
    for word in ("greet", "thank"):
        name = editor.new_parameter("name", "text")
        editor.add_procedure([word, name], place=editor.new_stack("behaviour", 0, 0))

    text = code_of(editor)

    assert "def greet(name):" in text and "def thank(name):" in text


def test_a_pasted_own_block_of_the_same_words_and_another_kind_is_told_apart(language):
    source, target = build(language), build(language)
    for editor, kind in ((source, "number"), (target, "text")):
        times = editor.new_parameter("times", kind)
        editor.add_procedure(["dance", times], place=editor.new_stack("behaviour", 0, 0))
    call = source.create(
        "my.call." + next(iter(source.project.procedures)), source.new_stack("behaviour", 300, 0)
    )

    paste(target, copy(source.project, source.language, [call]), "behaviour", 300, 0)

    titles = [title(procedure) for procedure in target.project.procedures.values()]
    assert titles == ["dance (times)", "dance 2 (times)"]


def test_a_calculation_inside_another_is_told_in_parentheses(language):
    plus = B("math.arithmetic", {"operation": "add", "a": 1, "b": 2})
    product = B("math.arithmetic", {"operation": "multiply", "b": 3}, {"a": plus})
    editor = build(language, [B("event.started"), B("control.wait", inputs={"seconds": product})])
    wait = next(b.id for b in editor.project.blocks.values() if b.type == "control.wait")

    times = language.choices[language.definitions["math.arithmetic"].slots["operation"].table]
    said = sentence(editor.project, language, wait)
    assert said == f"wait (1 + 2) {times['multiply']} 3 seconds"
