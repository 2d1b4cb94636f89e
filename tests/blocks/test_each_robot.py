"""What is done for each robot at once, in blocks: its Python, its variables, what is told of it."""

from __future__ import annotations

import pytest
from block_building import B, build, read_program

from nep_studio.blocks.checks import check
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project

THIS = "control.this_robot"


def each(*chain, robot=None, name="NAO"):
    inputs = {"robot": robot} if robot else {}
    return B("control.each_robot", {"robot": name}, inputs, bodies={"do": list(chain)})


def get(variable="v1"):
    return B("variable.get", {"variable": variable})


def ask():
    question = B("robot_speech.ask_for", {"question": "Who?"}, {"robot": B(THIS)})
    return B("variable.set", {"variable": "v1"}, {"value": question})


def say(value):
    return B("robot.say", inputs={"robot": B(THIS), "text": value})


def code(language, *chain, hat=None):
    editor = build(language, [hat or B("event.started"), *chain], variables=("x", "crew"))
    build(language, [B("robots.robot", {"name": "NAO"})], page="robots", editor=editor)
    text = generate_program(editor.project, language).text
    before = to_bytes(editor.project)
    update_from_python(editor, text)
    assert to_bytes(editor.project) == before
    read = read_program(text, language, Project())
    assert generate_program(read, language).text == text
    assert not [b for b in read.blocks.values() if b.type.startswith("code.")]
    return text


def told(language, *stacks):
    editor = build(language, *stacks, variables=("x", "crew"))
    build(language, [B("robots.robot", {"name": "NAO"})], page="robots", editor=editor)
    return {problem.kind for problem in check(editor.project, language)}


def test_it_is_a_function_that_is_called_for_each(language):
    text = code(language, each(say(B("text.text", {"text": "Hello"})), name="*"))

    assert text.endswith(
        "def when_started():\n"
        "    def part_1():\n"
        '        this_robot().say("Hello")\n'
        "\n"
        "    for_each_robot(all_robots, part_1)\n"
        "\n\nbehavior.run()\n"
    )


def test_each_robot_has_the_variable_that_is_set_for_it(language):
    text = code(language, each(ask(), say(get())))

    assert "        x = this_robot().ask(" in text
    assert "        this_robot().say(x)" in text
    assert "program" not in text


def test_what_all_add_to_is_shared_and_whole(language):
    one = B("math.random_integer", {"low": 1, "high": 1})
    total = B("math.arithmetic", {"operation": "add"}, {"a": get(), "b": one})
    add = B("variable.set", {"variable": "v1"}, {"value": total})

    text = code(language, each(add))

    assert "with at_once: program.x = program.x + random.randint(1, 1)" in text


def test_what_waits_between_reading_and_setting_is_told(language):
    asked = B("robot_speech.ask_number", inputs={"robot": B(THIS)})
    total = B("math.arithmetic", {"operation": "add"}, {"a": get(), "b": asked})
    add = B("variable.set", {"variable": "v1"}, {"value": total})

    assert "torn_apart" in told(language, [B("event.started"), each(add)])
    assert "torn_apart" not in told(language, [B("event.started"), add])


def test_a_variable_may_hold_the_robots(language):
    robots = B("list.create", inputs={"item.1": B("robot.named")}, groups={"item": 1})
    crew = B("variable.set", {"variable": "v2"}, {"value": robots})

    text = code(language, crew, each(say(B(THIS)), robot=get("v2")))

    assert "    for_each_robot(as_robot(crew), part_1)" in text
    assert "        this_robot().say(as_text(this_robot()))" in text


def test_loops_and_parts_and_inner_ones_stay_in_it(language):
    inside = each(B("control.repeat", bodies={"do": [each(say(B(THIS))), B("control.wait")]}))
    together = B("control.together", bodies={"do.1": [say(B(THIS))], "do.2": [B("control.wait")]})

    text = code(language, inside, each(together, B("control.stop_rule")))

    assert text.count("for_each_robot(nao, part_") == 3 and "        stop_rule()" in text


def test_in_a_loop_it_is_a_function_above_the_loop(language):
    crew = B("list.create", inputs={"item.1": B("robot.named")}, groups={"item": 1})
    told = B("variable.set", {"variable": "v2"}, {"value": crew})
    loop = B("control.repeat", bodies={"do": [told, each(ask(), say(get()), robot=get("v2"))]})

    text = code(language, loop)

    assert text.index("    def part_1():") < text.index("    for _ in range(3):")
    assert "        for_each_robot(as_robot(crew), part_1)" in text and "program" not in text


def test_this_robot_elsewhere_is_told(language):
    outside = [B("event.started"), say(B(THIS))]
    inside = [B("event.started"), each(B("control.if", bodies={"do": [say(B(THIS))]}))]

    assert "outside_each_robot" in told(language, outside)
    assert "outside_each_robot" not in told(language, inside)
    place = [B("event.started"), each(robot=B(THIS))]
    assert "outside_each_robot" in told(language, place)


@pytest.mark.parametrize("block", ["control.leave_loop", "control.next_round"])
def test_a_loop_around_it_is_not_left_from_inside(language, block):
    editor = build(
        language,
        [B("event.started"), B("control.repeat", bodies={"do": [each(B(block))]})],
    )

    assert "outside_loop" in {problem.kind for problem in check(editor.project, language)}
    with pytest.raises(CodeRefused, match="cannot leave the loop"):
        generate_program(editor.project, language)


@pytest.mark.parametrize(
    "lines",
    [
        "def greet():\n        name = this_robot().ask('Who?')\n        this_robot().say(name)\n"
        "    for_each_robot(nao, greet)",
        "def greet():\n        for n in range(3):\n            this_robot().say(n)\n"
        "    for_each_robot(robots=nao, function=greet)",
        "for_each_robot(nao, lambda: this_robot().say('Hello'))",
        "def greet(other=1):\n        this_robot().say('Hello')\n    for_each_robot(nao, greet)",
        "def greet():\n        return 5\n    for_each_robot(nao, greet)",
        "for_each_robot(nao)",
        "for_each_robot(nao, print, 3)",
    ],
)
def test_what_a_person_writes_of_it_becomes_blocks_or_stays_python(language, lines):
    text = (
        '"""P. Made with NEP Studio."""\n'
        "from nep_core import Behavior, Robot, for_each_robot, this_robot\n\n"
        'nao = Robot("NAO")\nbehavior = Behavior("P")\n\n\n'
        f"@behavior.when_started\ndef when_started():\n    {lines}\n\n\nbehavior.run()\n"
    )

    project = read_program(text, language, Project())

    made = generate_program(project, language).text
    compile(made, "program.py", "exec")
    assert "for_each_robot" in made
    again = read_program(made, language, Project())
    assert generate_program(again, language).text == made
