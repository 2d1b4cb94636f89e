"""What gets another name gets it in the Python that people wrote, too: as one step, or not."""

# ruff: noqa: E501, RUF001 - a table is read more easily with one case in a line

from __future__ import annotations

import pytest
from block_building import B, build
from operating import one_step

from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.edits.project import RenameVariable
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.fixes import rename_robot
from nep_studio.blocks.places import InStack
from nep_studio.blocks.procedures import header_of
from nep_studio.blocks.program import Parameter


def with_python(language, text: str, kind: str = "lines", *more):
    """A program with the variables “score” and “other”, and one block of Python."""
    python = B(f"code.{kind}", {"code": text})
    use = B("variable.change", {"variable": "v1"})
    if kind == "program":
        return build(language, [python], [B("event.started"), use], variables=("score", "other"))
    if kind == "value":
        python = B("robot.say", inputs={"text": python})
    rule = [B("event.started"), use, python, *more]
    return build(language, rule, variables=("score", "other"))


def python_in(editor) -> str:
    blocks = editor.project.blocks.values()
    return next(block.fields["code"] for block in blocks if block.type.startswith("code."))


@pytest.mark.parametrize(
    ("kind", "before", "after"),
    [
        ("lines", "score = 5", "große_zahl = 5"),
        ("lines", "score += 1; nao.score(score)", "große_zahl += 1; nao.score(große_zahl)"),
        ("lines", "x = 'ä'; y = score  # score", "x = 'ä'; y = große_zahl  # score"),
        ("lines", 'nao.say("score " + str(score))', 'nao.say("score " + str(große_zahl))'),
        ("lines", 'nao.say(f"score {score} {{score}}")', 'nao.say(f"score {große_zahl} {{score}}")'),
        ("lines", "x = f'''a\n{score + d['score']}'''", "x = f'''a\n{große_zahl + d['score']}'''"),
        ("lines", "def f(score):\n    return score\nscore = f(1)", "def f(score):\n    return score\ngroße_zahl = f(1)"),
        ("lines", "def f():\n    score = 1\n    return score", "def f():\n    score = 1\n    return score"),
        ("lines", "def f():\n    return score", "def f():\n    return große_zahl"),
        ("lines", "def f():\n    global score\n    score = 2", "def f():\n    global große_zahl\n    große_zahl = 2"),
        ("lines", "x = [score for score in [1]] + [score]", "x = [score for score in [1]] + [große_zahl]"),
        ("lines", "x = sorted(l, key=lambda score: score)", "x = sorted(l, key=lambda score: score)"),
        ("lines", "class A:\n    score = 1\n    def f(self):\n        return score + self.score", "class A:\n    score = 1\n    def f(self):\n        return große_zahl + self.score"),
        ("lines", "f(score=score)", "f(score=große_zahl)"),
        ("lines", "for score in range(3):\n    pass", "for große_zahl in range(3):\n    pass"),
        ("lines", "return score", "return große_zahl"),
        ("lines", "while True:\n    break\n# score", "while True:\n    break\n# score"),
        ("lines", "del score", "del große_zahl"),
        ("lines", "ｓcore = 5", "große_zahl = 5"),
        ("value", "score * 2", "große_zahl * 2"),
        ("value", "f'{score}' + f\"{[score for score in 'ab']}\"", "f'{große_zahl}' + f\"{[score for score in 'ab']}\""),
        ("value", "(lambda: score)()", "(lambda: große_zahl)()"),
        ("program", "score = 5", "große_zahl = 5"),
        ("program", "def f():\n    return score", "def f():\n    return große_zahl"),
        ("program", "score: int = 5", "große_zahl: int = 5"),
    ],
)  # fmt: skip
def test_a_variable_is_renamed_in_python(language, kind, before, after):
    editor = with_python(language, before, kind)

    with one_step(editor):
        editor.apply(RenameVariable("v1", "große zahl"))

    assert python_in(editor) == after


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("lines", "score = = 5"),
        ("lines", "points = score"),
        ("lines", "points = 1"),
        ("lines", "def f(points):\n    return points + score"),
        ("lines", "import score"),
        ("lines", "def score():\n    pass"),
        ("lines", "class A:\n    score = score"),
        ("program", "points = 5"),
        ("program", "points = 5\n\n\ndef f():\n    return score"),
        ("value", "[score for points in [1]]"),
    ],
)
def test_what_cannot_be_renamed_is_told_and_nothing_changes(language, kind, text):
    editor = with_python(language, text, kind)
    before = to_bytes(editor.project)

    with pytest.raises(EditRefused) as refused:
        editor.apply(RenameVariable("v1", "points"))

    assert "Python" in str(refused.value.sentence) and refused.value.checklist
    assert to_bytes(editor.project) == before


@pytest.mark.parametrize("text", ["x = = 5", "def f(points):\n    return points", "nao.points()"])
def test_python_that_has_nothing_to_do_with_it_is_no_hindrance(language, text):
    editor = with_python(language, text)

    editor.apply(RenameVariable("v1", "points"))

    assert python_in(editor) == text


def test_two_variables_change_their_names_at_once(language):
    """The one that had to be called otherwise gets the name that is free now."""
    editor = with_python(language, "score = score_2")
    editor.apply(RenameVariable("v2", "score!"))
    assert "score_2" in generate_program(editor.project, language).text

    editor.apply(RenameVariable("v1", "points"))

    assert python_in(editor) == "points = score"


def test_the_first_value_of_a_variable_stays_when_it_is_renamed(language):
    editor = with_python(language, "score = 5", "program")

    editor.apply(RenameVariable("v1", "points"))

    text = generate_program(editor.project, language).text
    assert "points = 5" in text and "points = 0" not in text and "score" not in text


def test_an_own_block_and_its_values_are_renamed_in_python(language):
    editor = with_python(language, "greet(name='Ada'); greet('Bo')")
    place = editor.new_stack("behaviour", 0, 900)
    parameter = editor.new_parameter("name", "text")
    own = editor.add_procedure(("greet", parameter), place=place)
    header = header_of(editor.project, own)
    code = editor.create("code.lines", InStack(editor.project.stack_of(header).id, 1))
    editor.apply(SetField(code, "code", "nao.say(name)"))
    changed = ("say hello to", Parameter(parameter.id, "whom", "text"))

    with one_step(editor):
        editor.change_procedure(own, changed, gives_value=False)

    texts = {b.fields["code"] for b in editor.project.blocks.values() if b.type == "code.lines"}
    assert texts == {"say_hello_to(whom='Ada'); say_hello_to('Bo')", "nao.say(whom)"}


def test_a_robot_is_renamed_in_blocks_and_in_python(language):
    editor = with_python(language, "nao.say('nao')", "lines", B("robot.say"))
    robot = editor.create("robots.robot", editor.new_stack("robots", 0, 0))
    editor.apply(SetField(robot, "name", "NAO"))

    with one_step(editor):
        rename_robot(editor, robot, "Große Otto")

    text = generate_program(editor.project, language).text
    assert python_in(editor) == "große_otto.say('nao')"
    assert 'Robot("Große Otto")' in text or "Robot('Große Otto')" in text
    assert "NAO" not in text


def test_a_robot_of_the_function_itself_is_another(language):
    editor = with_python(language, "nao = 5\nx = nao", "lines", B("robot.say"))
    robot = editor.create("robots.robot", editor.new_stack("robots", 0, 0))
    editor.apply(SetField(robot, "name", "NAO"))

    rename_robot(editor, robot, "Otto")

    assert python_in(editor) == "nao = 5\nx = nao"


def test_disabled_python_follows_too(language):
    editor = with_python(language, "score = 5")
    hat = editor.project.pages["behaviour"][0].body[0]
    editor.apply(SetFlag(hat, "disabled", True))

    editor.apply(RenameVariable("v1", "points"))

    assert python_in(editor) == "points = 5"
