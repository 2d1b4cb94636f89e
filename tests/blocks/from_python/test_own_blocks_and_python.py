"""Own blocks through the clipboard and through Python, and journals of them."""

from __future__ import annotations

import ast

import pytest
from block_building import B, build

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import copy, from_text, paste, to_text
from nep_studio.blocks.operations.finding import definition_of, subjects_of, uses_of
from nep_studio.blocks.operations.moving import create_and_drop, reporter_of
from nep_studio.blocks.places import InInput
from nep_studio.blocks.procedures import words
from nep_studio.blocks.program import Parameter, Procedure, Project
from tests.blocks.block_building import read_program

GREET = Procedure("greet", ("greet", Parameter("who", "person", "text")))


def greeting(language) -> Editor:
    """A rule that calls an own block which says its value."""
    editor = Editor(Project("Own"), language)
    editor.apply(AddProcedure(GREET, 0))
    value = B("my.parameter.greet.who")
    build(
        language,
        [B("my.define.greet"), B("robot.say", inputs={"text": value})],
        [B("event.started"), B("my.call.greet", {"who": "Ada"})],
        editor=editor,
    )
    return editor


def test_a_call_pasted_elsewhere_brings_its_own_block_with_an_empty_header(language):
    source = greeting(language)
    rule = source.project.pages["behaviour"][1].body
    text = to_text(copy(source.project, source.language, rule))
    target = Editor(Project("Other"), language)

    paste(target, from_text(text, language), "behaviour", 0, 0)

    (procedure,) = target.project.procedures.values()
    assert procedure.parts[0] == "greet"
    types = sorted(block.type for block in target.project.blocks.values())
    call, define = f"my.call.{procedure.id}", f"my.define.{procedure.id}"
    assert types == sorted(["event.started", call, define])
    target.history.undo()
    assert not target.project.procedures and not target.project.blocks


def test_a_pasted_call_uses_the_own_block_of_the_same_sentence(language):
    editor = greeting(language)
    call = editor.project.pages["behaviour"][1].body[1]
    clip = copy(editor.project, editor.language, [call])

    (new,) = paste(editor, clip, "behaviour", 0, 0)

    assert editor.project.blocks[new].type == "my.call.greet"
    assert list(editor.project.procedures) == ["greet"]


def test_a_definition_pasted_again_becomes_an_own_block_with_another_name(language):
    editor = greeting(language)
    clip = copy(editor.project, editor.language, editor.project.pages["behaviour"][0].body)

    (header,) = paste(editor, clip, "behaviour", 0, 0)

    _, second = editor.project.procedures.values()
    assert second.parts[0] == "greet 2"
    body = editor.project.stack_of(header).body
    types = [block.type for block in editor.project.within(body)]
    assert types == [
        f"my.define.{second.id}",
        "robot.say",
        f"my.parameter.{second.id}.who",
    ]


def test_a_parameter_is_dragged_out_of_the_header(language):
    editor = greeting(language)
    header, say = editor.project.pages["behaviour"][0].body

    clip = reporter_of(editor.project, editor.language, header, "who")

    assert clip is not None
    (new,) = create_and_drop(editor, clip, InInput(say, "text"), beside=(5, 5))
    assert editor.project.blocks[new].type == "my.parameter.greet.who"


def test_uses_of_an_own_block_and_its_definition(language):
    editor = greeting(language)
    header, say = editor.project.pages["behaviour"][0].body
    call = editor.project.pages["behaviour"][1].body[1]
    value = editor.project.blocks[say].inputs["text"]

    (subject,) = subjects_of(editor.project, editor.language, call)

    assert definition_of(editor.project, editor.language, subject) == header
    assert uses_of(editor.project, editor.language, subject) == (header, value, call)


def test_own_blocks_are_read_back_from_python(language):
    editor = greeting(language)
    text = generate_program(editor.project, editor.language).text

    read = read_program(text, language)
    changed = read_program(text.replace("Ada", "Bo"), language, editor.project)

    assert generate_program(read, language).text == text
    assert list(changed.procedures) == ["greet"]
    call = next(b for b in changed.blocks.values() if b.type == "my.call.greet")
    assert call.fields["who"] == "Bo"
    assert changed.blocks.keys() == editor.project.blocks.keys()


def test_an_own_block_that_gives_a_value_is_read_back(language):
    text = '''"""Sums. Made with NEP Studio."""
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Sums")


def twice(number):
    return number * 2


@behavior.when_started
def when_started():
    nao.say(str(twice(4) + 1))


behavior.run()
'''

    project = read_program(text, language)

    assert generate_program(project, language).text == text
    assert "code.value" not in {block.type for block in project.blocks.values()}


TWO = """from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Two")


def double(n):
    return n * 2


def report(x):
    nao.say(str(double(x)))


@behavior.when_started
def when_started():
    report(2)
    nao.say(str(double(3)))


behavior.run()
"""


@pytest.mark.parametrize(
    "changes",
    [
        [("double", "twice")],
        [("report", "say_it")],
        [("double", "twice"), ("report", "say_it")],
        [("double(n)", "double(much)"), ("n * 2", "much * 2")],
    ],
    ids=str,
)
def test_an_own_block_gets_the_names_of_the_text(language, changes):
    editor = updated(Editor(Project("Two"), language), TWO)
    blocks, own = list(editor.project.blocks), list(editor.project.procedures)
    text = generate_program(editor.project, language).text
    for old, new in changes:
        text = text.replace(old, new)

    updated(editor, text)

    assert generate_program(editor.project, language).text == text
    assert (list(editor.project.blocks), list(editor.project.procedures)) == (blocks, own)
    assert_same_again(editor)


SAID = ("nao.say(str(double(3)))", "double(3)")


@pytest.mark.parametrize(
    "changes",
    [
        [("report(x)", "report(x, y)"), ("report(2)", "report(2, 3)")],
        [("report(x)", "report(x, y)"), ("report(2)", "report(2, 3)"), ("report", "say_it")],
        [("nao.say(str(double(x)))", "return x"), ("    report(2)", "    nao.say(str(report(2)))")],
        [("return n * 2", 'nao.say("a")'), ("nao.say(str(double(x)))", "double(x)"), SAID],
        [("double(n)", "double(n, m)"), ("double(x)", "double(x, 1)"), ("e(3)", "e(3, 1)")],
        [("report(x)", "report()"), ("double(x)", "double(1)"), ("report(2)", "report()")],
        [
            ("def double(n):\n    return n * 2\n\n\n", ""),
            ("str(double(x))", '"a"'),
            ("str(double(3))", '"b"'),
        ],
    ],
    ids=str,
)
def test_an_own_block_with_other_values_is_made_anew(language, changes):
    editor = updated(Editor(Project("Two"), language), TWO)
    text = generate_program(editor.project, language).text
    for old, new in changes:
        text = text.replace(old, new)

    updated(editor, text)

    assert generate_program(editor.project, language).text == text
    assert not {"code.lines", "code.program"} & {b.type for b in editor.project.blocks.values()}
    assert len(editor.project.procedures) == text.count("\ndef ") - 1
    assert_same_again(editor)


def test_an_own_block_that_a_loose_block_calls_stays_beside_the_new_one(language):
    editor = updated(Editor(Project("Two"), language), TWO)
    (old,) = (p for p in editor.project.procedures.values() if words(p) == "report")
    build(language, [B(f"my.call.{old.id}")], editor=editor)
    text = generate_program(editor.project, language).text
    text = text.replace("report(x)", "report(x, y)").replace("report(2)", "report(2, 3)")

    updated(editor, text)

    assert generate_program(editor.project, language).text == text
    assert [words(p) for p in editor.project.procedures.values()].count("report") == 2
    assert_same_again(editor)


LIMIT, CLASS = "LIMIT = [1, 2]", "class Friend:\n    def go(self):\n        helper()"
RULES = [f"@behavior.when_started\ndef {name}():\n    wait(1)" for name in ("one", "two")]
HELPERS = [f"def {name}():\n    wait(2)" for name in ("helper", "another")]


@pytest.mark.parametrize(
    "parts",
    [
        [*RULES, *HELPERS],
        [LIMIT, *RULES, HELPERS[0]],
        ["n = 0", RULES[0].replace("wait(1)", "n = 5\n    wait(n)"), HELPERS[0]],
        [RULES[0], LIMIT, HELPERS[0], RULES[1]],
        [RULES[0], HELPERS[0], LIMIT, HELPERS[1]],
        [CLASS, *RULES, HELPERS[0]],
        [RULES[0], CLASS, LIMIT, *HELPERS, RULES[1]],
        [LIMIT, HELPERS[0], "# on its own\nMAX = 2", HELPERS[1], *RULES],
    ],
)
def test_own_blocks_written_anywhere_are_in_the_order_of_the_program(language, parts):
    text = 'from nep_core import Behavior, wait\n\nbehavior = Behavior("T")\n'
    text = "\n\n\n".join([text, *parts, "behavior.run()\n"])

    assert_same_again(updated(Editor(Project("T"), language), text))


@pytest.mark.parametrize("rule", ["wait(1)", "helper(2)", "nao.say('a')", "helper(nao)"])
@pytest.mark.parametrize(
    "function",
    [
        "def helper(nao):\n    nao.say('hi')",
        "def helper(a, nao):\n    nao.say(a)",
        "def helper(a):\n    nao = a\n    wait(nao)",
        "def helper(a):\n    told = lambda nao: nao.say('q')\n    told(a)",
        "def helper(behavior):\n    wait(behavior)",
        "def helper(a):\n    another = a\n    wait(another)\n\n\ndef another():\n    wait(2)",
        "def helper(another):\n    wait(another)\n\n\ndef another():\n    wait(2)",
    ],
)
def test_what_is_called_as_something_of_the_program_in_a_function_alone_stays_there(
    language, function, rule
):
    text = 'from nep_core import Behavior, Robot, wait\n\nnao = Robot("NAO")\n'
    text += f'behavior = Behavior("T")\n\n\n{function}\n\n\n'
    text += f"@behavior.when_started\ndef when_started():\n    {rule}\n\n\nbehavior.run()\n"

    editor = updated(Editor(Project("T"), language), text)

    made = ast.parse(generate_program(editor.project, language).text)
    wanted = ast.parse(text).body[3:-1]
    assert {ast.dump(one) for one in wanted} <= {ast.dump(one) for one in made.body}
    assert_same_again(editor)


def updated(editor: Editor, text: str) -> Editor:
    """The editor with its program made what a text says."""
    update_from_python(editor, text)
    return editor


def assert_same_again(editor: Editor) -> None:
    """The program that has been made becomes no other one by its own text."""
    before = to_bytes(editor.project)

    updated(editor, generate_program(editor.project, editor.language).text)

    assert to_bytes(editor.project) == before
