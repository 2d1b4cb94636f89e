"""Python back into blocks: examples, whole programs, snippets, edits, and errors."""

from __future__ import annotations

import ast
import itertools
from pathlib import Path

import pytest
from block_building import B, build, karate

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import load, to_bytes
from nep_studio.blocks.from_python import updating
from nep_studio.blocks.from_python.learning import CodeUnread
from nep_studio.blocks.from_python.pasting import read_snippet
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import paste
from nep_studio.blocks.program import Project
from tests.blocks.block_building import read_program

EXAMPLES = sorted((Path(__file__).parents[3] / "resources/examples").glob("*.nep"))


def code_of(project, language) -> str:
    return generate_program(project, language).text


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_are_read_back_as_they_are_written(language, path):
    project = load(path, language)
    text = code_of(project, language)

    read = read_program(text, language)

    assert code_of(read, language) == text


def test_unchanged_code_changes_nothing(language):
    editor = karate(language)
    before = to_bytes(editor.project)

    update_from_python(editor, code_of(editor.project, language))

    assert to_bytes(editor.project) == before


def test_editing_one_line_changes_one_block_in_one_step(language):
    editor = karate(language)
    editor.project.pages["behaviour"][0].x = 77
    before = {block.id: block.copy() for block in editor.project.blocks.values()}
    text = code_of(editor.project, language).replace("Impressive!", "Wow, well done!")

    update_from_python(editor, text)

    after = editor.project.blocks
    changed = [block for block in before if before[block] != after[block]]
    assert after.keys() == before.keys()
    assert [after[block].fields["text"] for block in changed] == ["Wow, well done!"]
    assert code_of(editor.project, language) == text
    assert editor.history.undo_label == "change the code"
    editor.history.undo()
    assert {block.id: block for block in editor.project.blocks.values()} == before


def test_disabled_blocks_and_loose_stacks_stay(language):
    editor = build(
        language,
        [B("event.started"), B("robot.say", {"text": "a"}), B("robot.say", {"text": "b"})],
        [B("robot.say", {"text": "loose"})],
    )
    _, a, b = editor.project.pages["behaviour"][0].body
    editor.project.blocks[a].disabled = True
    text = code_of(editor.project, language)

    update_from_python(editor, text.replace('nao.say("b")', 'nao.say("c")\n    nao.say("d")'))

    first, loose = editor.project.pages["behaviour"]
    assert first.body[1:3] == [a, b]
    texts = [editor.project.blocks[i].fields["text"] for i in first.body[1:]]
    assert texts == ["a", "c", "d"]
    assert editor.project.blocks[loose.body[0]].fields["text"] == "loose"


def test_lines_can_be_added_moved_and_taken_out(language):
    says = [B("robot.say", {"text": letter}) for letter in "abcdef"]
    editor = build(language, [B("event.started"), *says])
    text = code_of(editor.project, language)
    lines = {letter: f'    nao.say("{letter}")\n' for letter in "abcdefxyz"}
    for order in ("bcdef", "abcdefx", "xabcdef", "fabcde", "axbycz", "x", "xyzabc", "def", ""):
        body = "".join(lines[letter] for letter in order) or "    pass\n"
        start = text.index("def when_started():\n") + len("def when_started():\n")
        changed = text[:start] + body + text[text.index("\n\nbehavior.run") :]
        if not order:
            changed = changed.replace("import Behavior, Robot", "import Behavior")

        update_from_python(editor, changed)

        stack = editor.project.pages["behaviour"][0]
        said = [editor.project.blocks[i].fields["text"] for i in stack.body[1:]]
        assert "".join(said) == order


def test_a_new_rule_a_new_variable_and_a_new_robot_come_from_code(language):
    text = """
from nep_core import Behavior, Robot

anna = Robot("Anna")
behavior = Behavior("Mine")
points = 0


@behavior.when("gesture_wave", again="queue")
def when_waved():
    global points
    # Count first
    points += 1
    if points > 3:
        anna.say("Enough")
    elif points == 2:
        anna.say("Two")
    else:
        anna.say(str(points) + " points", gesture="explain")


behavior.run()
"""

    project = read_program(text, language)

    assert project.name == "Mine"
    assert [variable.name for variable in project.variables] == ["points"]
    types = sorted(block.type for block in project.blocks.values())
    assert types == sorted(
        ["robots.robot", "event.gesture", "variable.change", "control.if", *["logic.compare"] * 2]
        + ["variable.get"] * 3
        + ["robot.say"] * 3
        + ["text.join"]
    )
    comments = [block.comment for block in project.blocks.values() if block.comment]
    assert comments == ["Count first"]
    again = read_program(code_of(project, language), language)
    assert code_of(again, language) == code_of(project, language)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("def f(:\n  pass", 1),
        ("x = 1\nif x\n  pass", 2),
        ("@behavior.when_moon\ndef f():\n    pass", 1),
        ("async def f():\n    yield\n    await\n", 3),
        ("behavior = Behavior(1)\n", 1),
        ("behavior.run()\n@behavior.when_started\ndef f():\n    pass\n", 3),
        ("x = '\x00'", 1),
        ("(" * 500, 1),
    ],
)
def test_what_cannot_be_read_is_told_with_its_line_and_changes_nothing(language, text, line):
    editor = karate(language)
    before = to_bytes(editor.project)

    with pytest.raises(CodeUnread) as told:
        update_from_python(editor, text)

    assert told.value.line == line
    assert f"Line {line}" in str(told.value.sentence)
    assert to_bytes(editor.project) == before


@pytest.mark.parametrize(
    ("text", "types"),
    [
        ('nao.say("hi")\nwait(2)', ["robot.say", "control.wait"]),
        ("for _ in range(4):\n    wait(1)", ["control.repeat", "control.wait"]),
        ("1 + 2", ["math.arithmetic"]),
        ("42", ["math.number"]),
        ('"hello"', ["text.text"]),
        ('human_state() == "touched_head"', ["sensing.human_state_is"]),
        ("while True:\n    pass", ["control.forever"]),
    ],
)
def test_a_few_lines_are_pasted_as_blocks(language, text, types):
    base = karate(language).project

    clip = read_snippet(text, language, base)

    assert [b.type for b in clip.project.within(clip.roots[0])] == types
    editor = Editor(Project(), language)
    paste(editor, clip, "behaviour", 0, 0)
    assert len(editor.project.blocks) == len(types)


BASE = """from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("T")
x = 0


@behavior.when_started
def when_started():
    global x
    x = 1
    nao.say("x")


behavior.run()
"""


def pasted(language, text: str) -> str:
    """The Python of a program with the variable x and the robot NAO, after pasting a text."""
    editor = Editor(read_program(BASE, language), language)
    paste(editor, read_snippet(text, language, editor.project), "behaviour", 0, 0)
    return generate_program(editor.project, language).text


@pytest.mark.parametrize(
    "function",
    [
        "def f(x):\n    x = x + 1\n    return x",
        "def f(x):\n    nao.say(x)",
        "def f(nao):\n    nao.say('x')",
        "def f(nao, wait):\n    nao.say(wait)",
        "def f():\n    x = 2",
        "def f():\n    for x in [1, 2]:\n        wait(x)",
        "def f():\n    nao = 2\n    wait(nao)",
        "def f():\n    with open('a') as x:\n        print(x)",
        "def f():\n    program.x = 2",
        "def f():\n    y = 2\n    wait(y)",
        "y = 1\n\n\ndef f():\n    y = 2\n    wait(y)",
        "def f():\n    return [x for x in [1]]",
        "def f(wait):\n    return wait",
        "def nao():\n    wait(2)",
    ],
)
def test_a_function_that_is_pasted_does_the_same(language, function):
    wanted = ast.parse(function).body[-1]

    made = ast.parse(pasted(language, function))

    assert ast.dump(wanted) in [ast.dump(node) for node in made.body]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('nao.say("a")\n# last', ["last"]),
        ('nao.say("a")  # behind\n\n# one\n# two', ["behind", "one", "two"]),
        ("x = 2\n# last", ["last"]),
        ('print("a")\n# last', ["last"]),
        ("42  # behind", ["behind"]),
        ("# above\n42\n# last", ["above\nlast"]),
        ("def f():\n    wait(1)\n    # in\n\n\n# last", ["in", "# last"]),
        ("def f(a=1):\n    wait(a)\n# last", ["# last"]),
        ("def f():\n    wait(1)\n\n\n# mid\nwait(2)\n# last", ["mid", "last"]),
        ("wait(2)\n# mid\ndef f():\n    wait(1)", ["mid"]),
    ],
)
def test_comments_are_pasted_too(language, text, said):
    clip = read_snippet(text, language, read_program(BASE, language))

    blocks = clip.project.blocks.values()
    notes = [str(b.fields.get("text")) for b in blocks if b.type == "control.note"]
    own = [str(b.fields["code"]) for b in blocks if b.type == "code.program"]
    found = [*[b.comment for b in blocks], *notes, *[code for code in own if code[:1] == "#"]]
    assert sorted(filter(None, found)) == sorted(said)


@pytest.mark.parametrize(
    "text",
    [
        "if x == 1:\n    wait(1)\nelse:  # this\n    wait(2)",
        "global x  # this\nx = 1",
        "# this\nimport random\nwait(1)",
        "import random  # this\n\n\ndef f():\n    wait(1)",
        "nao = Robot('NAO')  # this\nnao.say('x')",
        "def f():\n    if x == 1:\n        wait(1)\n    else:  # this\n        wait(2)",
        "wait(\n    # this\n    1,\n)",
    ],
)
def test_a_comment_anywhere_in_what_is_pasted_is_kept(language, text):
    clip = read_snippet(text, language, read_program(BASE, language))

    said = [f"{block.comment} {block.fields}" for block in clip.project.blocks.values()]
    assert "this" in " ".join(said)


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ('    wait(1)\n    nao.say("b")', 'wait(1)\nnao.say("b")'),
        ('wait(1)\n    nao.say("b")', 'wait(1)\nnao.say("b")'),
        ("\twait(1)\r\n\r\n\twait(2)\r\n", "wait(1)\nwait(2)"),
        ("if x == 1:\n        wait(1)\n    wait(2)", "if x == 1:\n    wait(1)\nwait(2)"),
        ("    if x == 1:\n# c\n        wait(1)", "if x == 1:\n    # c\n    wait(1)"),
        ("# c\n\n    wait(1)\n  # d", "# c\nwait(1)\n# d"),
        ("    y = '''\na\n  b'''\n    wait(y)", "y = '''\na\n  b'''\nwait(y)"),
        ("    def f(a):\n        wait(a)", "def f(a):\n    wait(a)"),
        ("    # all\n    print(1)\n    print(2)", "# all\nprint(1)\nprint(2)"),
    ],
)
def test_lines_of_a_function_are_pasted_without_its_margin(language, text, plain):
    base = read_program(BASE, language)

    clips = [read_snippet(one, language, base) for one in (text, plain)]

    made = [
        [(b.type, b.fields, b.comment) for b in clip.project.within(clip.roots[0])]
        for clip in clips
    ]
    assert made[0] == made[1]


@pytest.mark.parametrize(
    ("text", "told"), [("    x = (", "closed"), ("  wait(1)\n wait(2)", "ind")]
)
def test_a_mistake_in_lines_with_a_margin_is_told_as_without_it(language, text, told):
    with pytest.raises(CodeUnread, match=told) as raised:
        read_snippet(text, language, Project())

    assert raised.value.line in (1, 2)


@pytest.mark.parametrize(
    ("text", "there"),
    [
        ("import math as m\n\n\ndef area(r):\n    return m.pi * r", "import math as m"),
        (
            "# for sin\nfrom math import sin\n\n\ndef f(a=1):\n    wait(sin(a))",
            "# for sin\nfrom math import sin",
        ),
        ("from math import *\nwait(sin(1))", "from math import *"),
        ("from nep_core import *\nwait(2)\nprint(as_text(2))", ""),
        ("from nep_core import *\n\n\ndef f(a):\n    wait(a)", ""),
        ("import math\n\n\ndef f():\n    wait(math.pi)", "import math"),
        ("import math as m\nwait(m.pi)", ""),
    ],
)
def test_what_functions_import_is_pasted_outside_of_them(language, text, there):
    made = pasted(language, text)

    title = '"""T. Made with NEP Studio."""\n'
    above = made.split("from nep_core")[0].replace(title, "")
    assert above == (f"{there}\n" if there else "")
    compile(made, "program.py", "exec")


def test_an_import_of_everything_alone_is_nothing_to_paste(language):
    with pytest.raises(CodeUnread, match="nothing here"):
        read_snippet("from nep_core import *", language, Project())


def test_what_has_no_block_keeps_its_text_in_a_code_block(language):
    if "code.lines" not in language.definitions:
        pytest.skip("this language has no code blocks")
    text = (
        "with open('x') as file:\n    # read all\n    data = file.read()\n"
        "nao.say('ok')\nfoo[3].bar(1)\n"
    )
    base = karate(language).project

    clip = read_snippet(text, language, base)

    first, second, third = (clip.project.blocks[block] for block in clip.roots[0])
    assert (first.type, second.type, third.type) == ("code.lines", "robot.say", "code.lines")
    assert first.fields["code"] == text[: text.index("nao") - 1]
    assert third.fields["code"] == "foo[3].bar(1)"


def test_code_blocks_survive_the_way_through_python(language):
    if "code.lines" not in language.definitions:
        pytest.skip("this language has no code blocks")
    rule = [B("event.started"), B("code.lines", {"code": "try:\n    x = 1\nfinally:\n    pass"})]
    editor = build(language, rule)
    text = code_of(editor.project, language)

    read = read_program(text, language)

    assert code_of(read, language) == text


def test_what_no_block_says_is_not_read_again_and_again(language, monkeypatch) -> None:
    readings = []
    read = updating.read_rules
    monkeypatch.setattr(updating, "read_rules", lambda *a: readings.append(1) or read(*a))
    text = 'from nep_core import Behavior, Robot\n\nnao = Robot("NAO")\n'
    text += 'behavior = Behavior("Karate")\n\n\n@behavior.when_started\n'
    text += "def when_started():\n    def f():\n        pass\n    return f\n\n\nbehavior.run()\n"

    update_from_python(Editor(Project("Karate"), language), text)

    assert 1 < len(readings) <= 4  # with what was learned of its values, and in another way


@pytest.mark.parametrize("signs", [140, 400])
def test_a_long_row_of_signs_is_written_down_at_few_of_its_depths(
    language, monkeypatch, signs: int
) -> None:
    written = []
    write = ast.unparse
    monkeypatch.setattr(ast, "unparse", lambda node: written.append(1) or write(node))
    text = 'from nep_core import Behavior, Robot\n\nnao = Robot("NAO")\n'
    text += 'behavior = Behavior("Karate")\n\n\n@behavior.when_started\n'
    text += f"def when_started():\n    nao.say(str({'-' * signs}points))\n\n\nbehavior.run()\n"
    editor = Editor(Project("Karate"), language)

    update_from_python(editor, text)

    assert len(written) < 140
    code = code_of(editor.project, language).replace("(", "")
    assert f"{'-' * signs}points" in code


@pytest.mark.parametrize(
    ("made", "sentence", "step"),
    [
        ('Robot("NAO", ip="1.2.3.4")', "Robot is given a name here, and nothing else", "address"),
        ('Robot("NAO", "1.2.3.4")', "Robot is given a name here, and nothing else", "address"),
        ("Robot()", "Robot needs a name in quotes", "NAO"),
        ("Behavior(title)", "Behavior needs a name in quotes", "Behavior"),
        ('Behavior("T", speed=2)', "Behavior is given a name here", "Behavior"),
    ],
)
def test_a_header_that_is_made_otherwise_is_told_in_words_that_fit(language, made, sentence, step):
    text = f"from nep_core import Behavior, Robot\n\nit = {made}\n"

    with pytest.raises(CodeUnread, match=sentence) as raised:
        update_from_python(Editor(Project("T"), language), text)

    assert raised.value.line == 3
    assert step in str(raised.value.checklist[0])


def test_rules_that_come_from_python_do_not_lie_on_each_other(language):
    editor = build(language, [B("event.started"), B("robot.say")])
    text = generate_program(editor.project, language).text
    rules = [
        f"@behavior.when_started\ndef rule_{number}():\n" + '    nao.say("Hello")\n' * lines
        for number, lines in enumerate((30, 1, 12))
    ]

    end = "\n\n".join([*rules, "behavior.run()"])
    update_from_python(editor, text.replace("behavior.run()", end))

    stacks = sorted(editor.project.pages["behaviour"], key=lambda stack: stack.y)
    assert len(stacks) == 4
    for above, below in itertools.pairwise(stacks):
        assert below.y - above.y > 42 * len(above.body)  # a line of a block is so high
