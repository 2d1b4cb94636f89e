"""The functions of what is done together in a loop are made once, above it, and read from there."""

from __future__ import annotations

import ast

import pytest
from block_building import B, build, read_program
from random_language import Maker

from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.help.texts import examples

LOOPS = ast.For | ast.While
FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef


def made_in_loops(text: str) -> list[str]:
    """The names of the functions that a program makes again in each round of a loop."""
    found: list[str] = []
    waiting: list[tuple[ast.AST, bool]] = [(ast.parse(text), False)]
    while waiting:
        node, is_in_loop = waiting.pop()
        if isinstance(node, FUNCTIONS):
            found += [node.name] if is_in_loop else []
            is_in_loop = False
        is_in_loop = is_in_loop or isinstance(node, LOOPS)
        waiting += [(inner, is_in_loop) for inner in ast.iter_child_nodes(node)]
    return found


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def together(*texts: str, kind: str = "control.together") -> B:
    return B(kind, bodies={f"do.{n}": [say(text)] for n, text in enumerate(texts, 1)})


def project_of(language: Language, *chain: B) -> Project:
    editor = build(language, [B("event.started"), *chain])
    return build(language, [B("robots.robot")], page="robots", editor=editor).project


def nested(language: Language) -> Project:
    """Parts in a loop, in a loop in a loop, in a loop of a part, and in no loop."""
    inner = B("control.repeat", bodies={"do": [together("c", "d", kind="goal.one_of")]})
    deep = B("control.together", bodies={"do.1": [say("a")], "do.2": [inner]})
    chosen = B("control.if", bodies={"do": [together("e", "f")]})
    within = B("control.repeat", bodies={"do": [deep]})
    loop = B("control.repeat", bodies={"do": [say("first"), within, chosen]})
    return project_of(language, say("0"), loop, together("g", "h"), say("last"))


def rule_of(text: str) -> str:
    return text.partition("def when_started():\n")[2].partition("\n\n\nbehavior.run")[0]


def test_they_are_above_the_outermost_loop_of_their_function(language: Language) -> None:
    text = generate_program(nested(language), language).text

    assert not made_in_loops(text)
    assert rule_of(text).splitlines()[:24] == [
        '    nao.say("0")',
        "",
        "    def part_1():",
        '        nao.say("a")',
        "",
        "    def part_2():",
        "        def part_3():",
        '            nao.say("c")',
        "",
        "        def part_4():",
        '            nao.say("d")',
        "",
        "        for _ in range(3):",
        "            one_of(part_3, part_4)",
        "",
        "    def part_5():",
        '        nao.say("e")',
        "",
        "    def part_6():",
        '        nao.say("f")',
        "",
        "    for _ in range(3):",
        '        nao.say("first")',
        "        for _ in range(3):",
    ]


def test_they_read_back_as_the_blocks_that_made_them(language: Language) -> None:
    project = nested(language)
    text = generate_program(project, language).text

    again = read_program(text, language, project)

    assert generate_program(again, language).text == text
    assert again.blocks == project.blocks


def test_an_edit_in_one_changes_that_block_alone(language: Language) -> None:
    project = nested(language)
    text = generate_program(project, language).text

    again = read_program(text.replace('say("d")', 'say("edited")'), language, project)

    changed = [key for key, block in project.blocks.items() if again.blocks.get(key) != block]
    assert [again.blocks[key].fields["text"] for key in changed] == ["edited"]
    assert again.blocks.keys() == project.blocks.keys()


def test_a_note_above_the_loop_stays_there(language: Language) -> None:
    note = B("control.note", {"text": "a note"})
    loop = B("control.repeat", bodies={"do": [together("a", "b")]})
    project = project_of(language, note, loop)
    text = generate_program(project, language).text

    again = read_program(text, language, project)

    assert again.blocks == project.blocks
    assert generate_program(again, language).text == text


IN_THE_LOOP = """\
    nao.say("first")
    # over and over
    for _ in range(3):
        nao.say("a")
        while True:
            # both
            def part_1():
                # inside
                nao.say("x")

            # the other
            def part_2():
                nao.say("y")
                # below

            together(part_1, part_2)
            nao.say("b")
"""


def program(language: Language, rule: str) -> tuple[str, Project]:
    """A whole program with the lines of a rule, and what it was before."""
    project = project_of(language, together("x", "y"))
    text = generate_program(project, language).text
    return text.replace(rule_of(text), rule.rstrip()), project


def test_functions_that_somebody_wrote_in_a_loop_are_blocks_too(language: Language) -> None:
    text, project = program(language, IN_THE_LOOP)

    again = read_program(text, language, project)
    made = generate_program(again, language).text

    assert not [one.type for one in again.blocks.values() if one.type.startswith("code.")]
    assert not made_in_loops(made)
    for said in ("over and over", "both", "inside", "the other", "below"):
        assert made.count(f"# {said}\n") == 1
    assert "            # both\n            # the other\n            together(" in made
    assert generate_program(read_program(made, language, again), language).text == made


@pytest.mark.parametrize(
    "rule",
    [
        # used twice: not only what is done together
        "    def a():\n        nao.say('a')\n\n    def b():\n        nao.say('b')\n\n"
        "    for _ in range(2):\n        together(a, b)\n        together(a, b)\n",
        # one of them is no part of it
        "    def a():\n        nao.say('a')\n\n    def b():\n        nao.say('b')\n\n"
        "    for _ in range(2):\n        a()\n        together(b, a)\n",
        # another one comes between
        "    for _ in range(2):\n        def a():\n            nao.say('a')\n\n"
        "        nao.say('c')\n        together(a, print)\n",
        "    def a():\n        nao.say('a')\n\n    for _ in range(2):\n        together(a, a)\n",
    ],
)
def test_what_blocks_cannot_say_so_stays_the_python_that_it_is(
    language: Language, rule: str
) -> None:
    text, project = program(language, rule)

    again = read_program(text, language, project)

    assert any(one.type == "code.lines" for one in again.blocks.values())
    written = ast.dump(ast.parse(generate_program(again, language).text).body[-2])
    assert written == ast.dump(ast.parse(text).body[-2])


def test_no_example_of_the_help_makes_functions_in_loops(language: Language) -> None:
    for name, example in examples().items():
        text = generate_program(example.project(language, "en", name), language).text
        assert not made_in_loops(text), name


def test_random_programs_make_none_either(language: Language) -> None:
    count = 0
    for seed in range(150):
        try:
            text = generate_program(Maker(seed, language).project(), language).text
        except CodeRefused:
            continue
        count += "together(" in text
        assert not made_in_loops(text), f"program {seed}"
    assert count > 20
