"""The Python of whole programs: golden texts, the line map, limits, and the cache of rules."""

from __future__ import annotations

import pytest
from block_building import B, build, karate
from generated import assert_mapped, assert_tame, parse

from nep_studio.blocks.edits.content import SetComment, SetField, SetFlag
from nep_studio.blocks.edits.project import RenameVariable
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import ProgramGenerator, generate_launch, generate_program
from nep_studio.blocks.places import InStack


def number(value):
    return B("math.number", {"number": value})


def get(variable):
    return B("variable.get", {"variable": variable})


KARATE = '''\
"""Karate greeting. Made with NEP Studio."""
from nep_core import Behavior, Robot, Variables, together

nao = Robot("NAO")
behavior = Behavior("Karate greeting")
program = Variables(times=0)


@behavior.when_started
def when_started():
    nao.do("posture_stand")
    program.times = 0
    nao.say("Show me karate", gesture="explain")


@behavior.when("gesture_karate")
def when_gesture_karate():
    nao.say("Impressive!")

    def part_1():
        nao.play("karate")

    def part_2():
        program.times += 1
        nao.say(f"Karate number {program.times}")

    together(part_1, part_2)


behavior.run()
'''


def test_the_karate_greeting_is_a_program_that_a_teacher_would_show(language):
    assert generate_program(karate(language).project, language).text == KARATE


CONTROL = '''\
"""Test. Made with NEP Studio."""
import random
from nep_core import (
    Behavior, Robot, human_state, stop_program, to_nearest, to_power, wait, wait_until,
)

all_robots = Robot(["NAO", "Pepper 2"])
behavior = Behavior("Test")


@behavior.when("touched head", again="restart")
def when_touched_head():
    for _ in range(random.randint(1, 6)):
        wait(0.5)
    for _ in range(to_nearest(2.5)):
        pass
    while not (True and human_state() == "x"):
        if 1 < 2:
            all_robots.walk(-0.3, left_m=1)
        elif False:
            pass
        else:
            all_robots.turn(to_power(-1, -2) * (3 - (4 - 5)))
    wait_until(lambda: human_state() == "heard_hello")
    while True:
        all_robots.leds("FaceLeds", "#ff0000")
        stop_program()


behavior.run()
'''


def test_control_flow_reads_like_python(language):
    power = B("math.arithmetic", {"operation": "power"}, {"a": number(-1), "b": number(-2)})
    inner = B("math.arithmetic", {"a": 4, "operation": "subtract", "b": 5})
    minus = B("math.arithmetic", {"a": 3, "operation": "subtract"}, {"b": inner})
    times = B("math.arithmetic", {"operation": "multiply"}, {"a": power, "b": minus})
    state = B("logic.compare", {"b": "x"}, {"a": B("sensing.human_state")})
    both = B("logic.junction", inputs={"a": B("logic.truth"), "b": state})
    walk = B("robot.walk", {"robot": "*", "forward": -0.3, "left": 1})
    less = B("logic.compare", {"a": 1, "comparison": "less", "b": 2})
    fork = B(
        "control.if",
        inputs={"condition": less},
        bodies={
            "do": [walk],
            "otherwise_do.1": [B("robot.turn", {"robot": "*"}, {"degrees": times})],
        },
        groups={"also": 1, "otherwise": 1},
    )
    heard = B("sensing.human_state_is", {"state": "heard_hello"})
    lights = B("robot.leds", {"robot": "*", "colour": "#ff0000"})
    stack = [
        B(
            "event.human_state",
            {"state": "touched head", "again.1": "restart"},
            groups={"repeated": 1},
        ),
        B(
            "control.repeat",
            inputs={"times": B("math.random_integer")},
            bodies={"do": [B("control.wait", {"seconds": 0.5})]},
        ),
        B("control.repeat", {"times": 2.5}),
        B(
            "control.while",
            inputs={"condition": B("logic.not", inputs={"a": both})},
            bodies={"do": [fork]},
        ),
        B("control.wait_until", inputs={"condition": heard}),
        B("control.forever", bodies={"do": [lights, B("control.stop_program")]}),
    ]
    editor = build(language, stack)
    robots = [B("robots.robot"), B("robots.robot", {"name": "Pepper 2"})]
    build(language, robots, page="robots", editor=editor)

    code = generate_program(editor.project, language)

    assert code.text == CONTROL
    assert_tame(code.text, language)
    assert_mapped(code, editor.project, language)


def test_the_launch_pages_start_the_robots_and_nodes(language):
    editor = build(language, [B("robots.robot")], page="robots")
    launch = B("nodes.launch", {"parameters": {"gesture": "karate", "level": -2, "on": True}})
    build(language, [launch], page="nodes", editor=editor)

    code = generate_launch(editor.project, language)

    assert code.text == (
        "from nep_core import Launcher\n\nlauncher = Launcher()\n"
        'launcher.start("action/nao", name="NAO", robot="NAO", driver="virtual", address="")\n'
        'launcher.start("perceptual/gesture", name="karate", gesture="karate", level=-2, on=True)\n'
    )
    assert code.block_at(5) is not None
    parse(code.text)


def test_each_line_of_a_rule_is_mapped_to_the_block_that_made_it(language):
    editor = karate(language)
    project = editor.project

    code = generate_program(project, language)

    lines = code.text.splitlines()
    for line_number, line in enumerate(lines, start=1):
        in_rule = 8 < line_number < len(lines) - 2 and line
        assert bool(code.block_at(line_number)) == bool(in_rule), line
    assert_mapped(code, project, language)
    said = [b.id for b in project.blocks.values() if b.fields.get("text") == "Impressive!"]
    (line,) = code.lines_of(said[0])
    assert "Impressive!" in lines[line - 1]
    assert code.block_at(0) is None and code.block_at(len(lines) + 1) is None


def test_comments_are_written_above_their_block_and_cannot_become_code(language):
    editor = build(language, [B("event.started"), B("robot.do")])
    block = editor.project.stacks[next(iter(editor.project.stacks))].body[1]
    editor.apply(SetComment(block, "stand up\nimport os\r\x0cimport sys\x00\u2028x"))

    code = generate_program(editor.project, language)

    tree = assert_tame(code.text, language)
    assert "    # stand up\n    # import os\n" in code.text
    assert len(tree.body) == 6


def test_disabled_blocks_and_loose_stacks_make_no_code(language):
    editor = build(
        language,
        [
            B("event.started"),
            B("robot.do"),
            B("robot.say", inputs={"text": B("sensing.human_state")}),
        ],
        [B("robot.say", {"text": "loose"})],
        [B("event.gesture"), B("robot.say", {"text": "off"})],
    )
    for block in list(editor.project.blocks.values()):
        if block.type in ("robot.do", "sensing.human_state", "event.gesture"):
            editor.apply(SetFlag(block.id, "disabled", True))

    text = generate_program(editor.project, language).text

    assert "do(" not in text and "loose" not in text and "off" not in text
    assert 'nao.say("Hello")' in text and "human_state" not in text


@pytest.mark.parametrize(("depth", "fits"), [(20, True), (21, False)])
@pytest.mark.parametrize("loop", ["control.forever", "control.repeat", "control.while"])
def test_loops_nest_as_deep_as_python_allows_and_no_deeper(language, loop, depth, fits):
    block = B("control.wait")
    for _ in range(depth):
        block = B(loop, bodies={"do": [block]})
    project = build(language, [B("event.started"), block]).project

    if fits:
        parse(generate_program(project, language).text)
    else:
        with pytest.raises(CodeRefused) as refused:
            generate_program(project, language)
        assert refused.value.block in project.blocks


def test_parallel_parts_are_functions_in_which_loops_count_from_zero(language):
    block = B("control.wait")
    for kind in ["control.repeat"] * 20 + ["control.together"] + ["control.repeat"] * 20:
        block = B(kind, bodies={"do.1" if kind == "control.together" else "do": [block]})

    parse(generate_program(build(language, [B("event.started"), block]).project, language).text)


@pytest.mark.parametrize("kind", ["arithmetic", "not", "join", "compare"])
def test_the_deepest_values_that_are_allowed_compile_and_deeper_ones_are_refused(language, kind):
    def nested(depth):
        if kind == "join":
            value = B("sensing.human_state")
            for _ in range(depth - 1):
                value = B("text.join", inputs={"item.2": value})
            return B("robot.say", inputs={"text": value})
        value = number(-1) if kind == "arithmetic" else B("logic.truth")
        for _ in range(depth - 1):
            if kind == "arithmetic":
                value = B("math.arithmetic", {"operation": "power"}, {"a": value, "b": number(2)})
            elif kind == "not":
                value = B("logic.not", inputs={"a": value})
            else:
                value = B("logic.compare", inputs={"b": value})
        slot = {"degrees": value} if kind == "arithmetic" else {"condition": value}
        owner = "robot.turn" if kind == "arithmetic" else "control.wait_until"
        return B(owner, inputs=slot)

    allowed = build(language, [B("event.started"), nested(60)]).project
    refused = build(language, [B("event.started"), nested(66)]).project

    parse(generate_program(allowed, language).text)
    with pytest.raises(CodeRefused, match="too deep"):
        generate_program(refused, language)


def test_a_stack_of_ten_thousand_statements_makes_code(language):
    blocks = [B("event.started"), *[B("robot.do")] * 10_000]

    text = generate_program(build(language, blocks).project, language).text

    assert text.count("nao.do(") == 10_000


def test_code_made_again_after_edits_is_the_code_made_afresh(language):
    editor = karate(language)
    generator = ProgramGenerator(editor.project, language)
    say = next(b.id for b in editor.project.blocks.values() if b.type == "robot.say")
    stack = editor.project.pages["behaviour"][0].id
    edits = [
        SetField(say, "text", "Hello\nthere"),
        SetField(say, "robot", "Pepper"),
        RenameVariable("v1", "nao"),
        SetFlag(say, "disabled", True),
    ]

    for edit in edits:
        editor.apply(edit)
        assert generator.generate() == generate_program(editor.project, language)
    editor.create("control.wait", InStack(stack, 1))
    assert generator.generate() == generate_program(editor.project, language)
    for _ in [*edits, "create"]:
        editor.history.undo()
        assert generator.generate() == generate_program(editor.project, language)
