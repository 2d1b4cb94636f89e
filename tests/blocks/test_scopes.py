"""Where variables are known: by themselves, in the whole program, in all its runs."""

from __future__ import annotations

import pytest
from block_building import B, build, read_program

from nep_core.program import variables
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.project import RenameVariable, SetScope
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import copy, paste
from nep_studio.blocks.program import Project
from nep_studio.blocks.shared_objects import SHARED_OBJECTS


def get(variable="v1"):
    return B("variable.get", {"variable": variable})


def put(value=1, variable="v1"):
    return B("variable.set", {"variable": variable, "value": value})


def say(variable="v1"):
    return B("robot.say", inputs={"text": get(variable)})


def started(*chain):
    return [B("event.started"), *chain]


def touched(*chain):
    return [B("event.human_state", {"state": "touched_head"}), *chain]


def code_of(editor):
    return generate_program(editor.project, editor.language).text


FLAG = B("control.repeat_until", inputs={"condition": get()}, bodies={"do": [B("control.wait")]})
WAIT = B("control.wait_until", inputs={"condition": get()})
TRUE_WHILE = B("plan.true_while", {"fact": "lit"}, {"condition": get()})
STEP = B("tree.step", bodies={"do": [put(), say()]})
EACH = B("control.for_each", {"variable": "v1"}, bodies={"do": [say()]})


def each_robot(*chain):
    return B("control.each_robot", {"robot": "NAO"}, bodies={"do": list(chain)})


@pytest.mark.parametrize(
    ("stacks", "is_local"),
    [
        ([started(put(), say())], True),
        ([started(put())], True),
        ([started(say(), put())], False),
        ([started(B("variable.change", {"variable": "v1"}))], False),
        ([started(put(), B("variable.change", {"variable": "v1"}))], True),
        ([started(put(), say()), touched(put(), say())], True),
        ([started(put(), say()), touched(put())], False),
        ([started(put(), say()), touched(say())], False),
        ([started(put(), FLAG), touched(put(2), say())], False),
        ([started(put(), WAIT), touched(put(2), say())], False),
        ([started(put(), FLAG)], True),
        ([started(put(), TRUE_WHILE)], False),
        ([started(B("control.try", bodies={"do": [put(), say()]})), touched(put(), say())], True),
        ([started(B("control.try", bodies={"do": [put()]}), say())], False),
        ([started(B("control.try", bodies={"do": [put()], "otherwise": [say()]}))], False),
        ([[B("tree.tree", {"name": "a"}), STEP]], False),
        ([[B("event.told"), put(), say()], started(put(), say())], True),
        ([started(EACH), touched(EACH)], True),
        ([started(EACH, say())], False),
        ([started(put(), B("control.together", bodies={"do.1": [say()]}))], False),
        ([started(put(), B("control.repeat", bodies={"do": [say()]})), touched(put(), say())],
         False),
        ([started(B("control.repeat", bodies={"do": [put(), say()]})), touched(put(), say())],
         True),
        ([started(each_robot(put(), say()))], True),
        ([started(put(), each_robot(say()))], False),
        ([started(each_robot(put()), say())], False),
        ([started(put(), each_robot(put(2)), say())], False),
        ([started(put(), each_robot(put(2), say()), say())], False),
        ([started(put(), say(), each_robot(put(2), say()), put(), say())], True),
        ([started(put(), B("control.repeat", bodies={"do": [say(), each_robot(put(2))]}))], False),
        ([started(each_robot(put(), say()), each_robot(put(2), say()))], True),
        ([started(each_robot(put(), say()), each_robot(say()))], False),
        ([started(each_robot(put(), say())), touched(put(), say())], True),
        ([started(each_robot(put())), touched(put(2), say())], False),
        ([started(each_robot(EACH, put(), say()))], True),
        ([started(each_robot(put(), B("control.together", bodies={"do.1": [say()]})))], False),
        ([started(B("control.together", bodies={"do.1": [each_robot(put(), say())]}))], True),
        ([started(each_robot(each_robot(put(), say())))], True),
        ([started(each_robot(put(), each_robot(say())))], False),
    ],
)  # fmt: skip
def test_a_variable_is_by_itself_where_nobody_else_can_see_it(language, stacks, is_local):
    editor = build(language, *stacks, variables=("x",))
    text = code_of(editor)
    before = to_bytes(editor.project)

    assert ("program.x" not in text) is is_local
    assert ("program = Variables(" not in text) is is_local and "global" not in text
    update_from_python(editor, text)
    assert to_bytes(editor.project) == before
    assert code_of(Editor(read_program(text, language), language)) == text


@pytest.mark.parametrize(("scope", "made"), [("program", "Variables"), ("kept", "Kept")])
def test_a_scope_that_is_chosen_is_written_read_and_undone(language, scope, made):
    editor = build(language, started(put(), say()), variables=("high score",))
    before = to_bytes(editor.project)
    editor.apply(SetScope("v1", scope))
    text = code_of(editor)

    assert f"{scope} = {made}(high_score=0)\n" in text and f"{scope}.high_score = 1" in text
    again = read_program(text, language)
    assert [(one.name, one.scope) for one in again.variables] == [("high_score", scope)]
    assert generate_program(again, language).text == text
    loaded = from_bytes(to_bytes(editor.project), "x", language)
    assert loaded.variables == editor.project.variables
    editor.history.undo()
    assert to_bytes(editor.project) == before and '"scope"' not in before.decode()


def test_a_scope_of_a_later_version_is_kept_and_is_the_usual_one(language):
    editor = build(language, started(put(), say()), variables=("x",))
    editor.apply(SetScope("v1", "robot"))
    again = from_bytes(to_bytes(editor.project), "x", language)

    assert again.variables[0].scope == "robot"
    assert "    x = 1\n" in generate_program(again, language).text


def test_an_older_project_goes_on_sharing_what_several_stacks_use(language):
    one = build(language, started(put(), say()), touched(put(), say()), variables=("x",))
    alone = build(language, started(put(), say()), variables=("x",))
    for editor, scope in ((one, "program"), (alone, "")):
        data = to_bytes(editor.project).replace(b'"version": 3', b'"version": 2')
        assert from_bytes(data, "x", language).variables[0].scope == scope
        assert from_bytes(to_bytes(editor.project), "x", language).variables[0].scope == ""


def test_the_objects_of_blocks_are_those_that_a_running_program_is_asked_for():
    assert SHARED_OBJECTS == variables.SHARED_OBJECTS


def test_what_is_called_as_the_object_has_another_name(language):
    chain = started(put(), say(), put(2, "v2"), say("v2"))
    text = code_of(build(language, chain, variables=("program", "kept")))

    assert "    program_ = 1\n" in text and "    kept_ = 2\n" in text


def test_a_variable_keeps_its_scope_in_another_project(language):
    editor = build(language, started(put(), say()), variables=("x",))
    editor.apply(SetScope("v1", "kept"))
    other = build(language)
    clip = copy(editor.project, language, editor.project.pages["behaviour"][0].body)

    paste(other, clip, "behaviour", 0, 0)

    assert [(one.name, one.scope) for one in other.project.variables] == [("x", "kept")]


def test_no_line_waits_for_another_because_of_a_variable_by_itself(language):
    more = B(
        "variable.set",
        {"variable": "v1"},
        {"value": B("math.arithmetic", inputs={"a": get(), "b": B("math.random_integer")})},
    )
    by_itself = build(language, started(put(), more), touched(put(), more), variables=("x",))
    shared = build(language, started(more), touched(more), variables=("x",))

    assert "at_once" not in code_of(by_itself) and code_of(shared).count("with at_once: ") == 2


OLD = """
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("T")
points = 0
names = []


@behavior.when_started
def when_started():
    global points
    points = 5
    nao.say(str(points))
    names.append("Ada")


behavior.run()
""".lstrip()


def test_global_names_of_a_text_are_the_whole_program_s(language):
    project = read_program(OLD, language)

    assert [(one.name, one.scope) for one in project.variables] == [
        ("points", "program"),  # it would be by itself
        ("names", ""),
    ]
    text = generate_program(project, language).text
    assert "program = Variables(points=0, names=[])" in text and "global" not in text
    assert not any(block.type.startswith("code") for block in project.blocks.values())


def test_locals_of_two_rules_are_one_variable_that_each_has_for_itself(language):
    editor = Editor(Project("T"), language)
    text = code_of(build(language, started(put(), say()), touched(put(2), say()), variables=("x",)))

    update_from_python(editor, text)

    assert len(editor.project.variables) == 1 and code_of(editor) == text
    shared = text.replace("x = 1", "program.x = 1").replace("say(str(x))", "say(str(program.x))", 1)
    with_both = shared.replace("\n\n\n@", "\nprogram = Variables(x=0)\n\n\n@", 1)
    update_from_python(editor, with_both.replace("    x = 2\n    nao.say(str(x))", "    pass"))
    assert [one.scope for one in editor.project.variables] == ["program"]


def test_own_python_keeps_a_plain_name_and_follows_one_that_is_kept(language):
    line = B("code.lines", {"code": "x = x + 1"})
    editor = build(language, started(put(), line, say()), variables=("x",))
    assert "    global x\n" in code_of(editor) and "\nx = 0\n" in code_of(editor)

    editor.apply(SetScope("v1", "kept"))
    assert "    kept.x = kept.x + 1\n" in code_of(editor) and "global" not in code_of(editor)
    editor.apply(RenameVariable("v1", "best"))
    assert "    kept.best = kept.best + 1\n" in code_of(editor)
    editor.history.undo()
    editor.history.undo()
    assert "    x = x + 1\n" in code_of(editor)


def test_many_variables_have_a_line_each(language):
    names = tuple(f"a long name {number}" for number in range(6))
    chain = [B("variable.change", {"variable": f"v{number}"}) for number in range(1, 7)]
    text = code_of(build(language, started(*chain), variables=names))

    assert "program = Variables(\n    a_long_name_0=0,\n" in text
    assert code_of(Editor(read_program(text, language), language)) == text


def test_a_first_value_that_blocks_do_not_make_is_own_python(language):
    text = code_of(build(language, started(say()), variables=("x",)))
    editor = Editor(Project("T"), language)

    update_from_python(editor, text.replace("Variables(x=0)", "Variables(x=5)"))

    assert "program = Variables()\n\nprogram.x = 5\n" in code_of(editor)
    assert code_of(Editor(read_program(code_of(editor), language), language)) == code_of(editor)
