"""The Python of loops, lists, numbers, texts, colours, and of code that a person writes."""

from __future__ import annotations

import pytest
from block_building import B, build
from generated import assert_mapped, parse
from sound_programs import kinds

from nep_studio.blocks.checks import check
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program


def get(variable="v1"):
    return B("variable.get", {"variable": variable})


def lines(language, *blocks, variables=("items", "n", "word")):
    """The lines of a rule with these blocks, whoever their variables belong to."""
    editor = build(language, [B("event.started"), *blocks], variables=variables)
    text = generate_program(editor.project, language).text
    parse(text)
    assert_mapped(generate_program(editor.project, language), editor.project, language)
    body = text.partition("def when_started():\n")[2].partition("\n\n\nbehavior.run")[0]
    found = [line[4:] for line in body.splitlines() if not line.startswith("    global")]
    return [line.replace("program.", "") for line in found]


def value(language, block):
    """The Python of a block that gives a value."""
    (line,) = lines(language, B("variable.set", {"variable": "v2"}, {"value": block}))
    return line.removeprefix("n = ")


@pytest.mark.parametrize(
    ("fields", "head"),
    [
        ({}, "range(1, 11)"),
        ({"step": 2}, "range(1, 11, 2)"),
        ({"first": 10, "last": 1}, "range(10, 0, -1)"),
        ({"first": 10, "last": 0, "step": -2}, "range(10, -1, -2)"),
        ({"last": "2*5"}, "count_from(1, 2 * 5)"),
        ({"last": 2.5}, "count_from(1, 2.5)"),
    ],
)
def test_counting_includes_its_last_number(language, fields, head):
    loop = B("control.count", {"variable": "v2", **fields})

    assert lines(language, loop) == [f"for n in {head}:", "    pass"]


def test_loops_are_left_and_go_on(language):
    each = B(
        "control.for_each",
        {"variable": "v2"},
        {"list": get()},
        {
            "do": [
                B("control.if", bodies={"do": [B("control.leave_loop")]}),
                B("control.next_round"),
            ]
        },
    )
    until = B("control.repeat_until", bodies={"do": [B("control.wait"), B("control.stop_rule")]})

    assert lines(language, each, until) == [
        *("for n in items:", "    if False:", "        break", "    continue"),
        *("while not False:", "    wait(1)", "    return"),
    ]


@pytest.mark.parametrize("block", ["control.leave_loop", "control.next_round"])
def test_a_loop_is_left_only_from_inside(language, block):
    inside = B("control.together", bodies={"do.1": [B(block)]})
    editor = build(language, [B("event.started"), B("control.repeat", bodies={"do": [inside]})])

    assert "outside_loop" in kinds(editor, language)
    with pytest.raises(CodeRefused, match="cannot leave the loop"):
        generate_program(editor.project, language)


def test_a_block_that_leaves_a_loop_needs_one(language):
    editor = build(language, [B("event.started"), B("control.leave_loop")])

    with pytest.raises(CodeRefused, match="is in none"):
        generate_program(editor.project, language)


def test_a_wait_has_a_limit_where_one_is_said(language):
    until = B("control.wait_until", {"seconds.1": 5}, groups={"limit": 1})

    assert lines(language, until) == ["wait_until(lambda: False, 5)"]


def test_a_note_is_a_comment_and_a_body_of_notes_passes(language):
    note = B("control.note", {"text": "to do: sing"})

    assert lines(language, B("control.repeat", bodies={"do": [note]})) == [
        *("for _ in range(3):", "    # to do: sing", "    pass"),
    ]


@pytest.mark.parametrize(
    ("block", "python"),
    [
        (B("list.create", {"item.1": 1, "item.2": "a"}, groups={"item": 2}), '[1, "a"]'),
        (B("list.filled", inputs={}), "[0] * 5"),
        (B("list.length", inputs={"list": get()}), "len(items)"),
        (B("list.is_empty", inputs={"list": get()}), "len(items) == 0"),
        (B("list.contains", {"item": 3}, {"list": get()}), "3 in items"),
        (B("list.find", {"item": 3}, {"list": get()}), "place_of(3, items)"),
        (B("list.get", {"number": 2}, {"list": get()}), "items[1]"),
        (B("list.get", {"number": 1, "end": "end"}, {"list": get()}), "items[-1]"),
        (B("list.get", {"end": "end"}, {"list": get(), "number": get("v2")}),
         "item_of(n, items, from_end=True)"),
        (B("list.get", {}, {"list": get(), "number": get("v2")}), "item_of(n, items)"),
        (B("list.take", {}, {"list": get()}), "items.pop(0)"),
        (B("list.part", {}, {"list": get()}), "items[:3]"),
        (B("list.part", {"first": 2}, {"list": get()}), "items[1:3]"),
        (B("list.sorted", {"order": "down"}, {"list": get()}), "sorted(items, reverse=True)"),
        (B("list.reversed", {}, {"list": get()}), "list(reversed(items))"),
        (B("list.split", {"text": "a b", "mark": " "}), '"a b".split(" ")'),
        (B("list.joined", {"mark": "-"}, {"list": get()}), '"-".join(items)'),
        (B("math.function", {"function": "root"}), "math.sqrt(9)"),
        (B("math.function", {"function": "minus"}), "-9"),
        (B("math.trigonometry"), "math.sin(math.radians(45))"),
        (B("math.arc", {"function": "acos"}), "math.degrees(math.acos(0.5))"),
        (B("math.constant", {"constant": "golden"}), "(1 + math.sqrt(5)) / 2"),
        (B("math.round", {"way": "up"}), "math.ceil(3.1)"),
        (B("math.constrain"), "min(max(50, 1), 100)"),
        (B("math.random_fraction"), "random.random()"),
        (B("math.of_list", {"function": "median"}, {"list": get()}), "statistics.median(items)"),
        (B("math.random_item", {}, {"list": get()}), "random.choice(items)"),
        (B("logic.choose"), "1 if False else 0"),
        (B("logic.number_is", {"property": "odd"}), "0 % 2 == 1"),
        (B("logic.divisible"), "0 % 3 == 0"),
        (B("logic.junction", groups={"more": 1}), "False and False and False"),
        (B("text.lines", {"text": "a\nb"}), '"a\\nb"'),
        (B("text.letter", {"number": 2}), '"hello"[1]'),
        (B("text.contains"), '"ell" in "hello"'),
        (B("text.case", {"case": "title"}), 'title_case("hello")'),
        (B("text.find"), '"hello".find("l") + 1'),
        (B("text.number"), 'number_in("12")'),
        (B("colour.colour"), '"#ff0000"'),
        (B("colour.from"), "colour_from(255, 128, 0)"),
        (B("colour.mix"), 'mix_colours("#ff0000", "#0000ff", 50)'),
        (B("code.value", {"code": "n if n else 2"}), "n if n else 2"),
        (B("math.arithmetic", {"b": 2}, {"a": B("code.value", {"code": "n + 1"})}),
         "as_number(n + 1) + 2"),
    ],
)  # fmt: skip
def test_a_value_is_the_python_that_a_teacher_would_show(language, block, python):
    assert value(language, block) == python


def test_lists_are_changed_in_place_and_begin_empty(language):
    blocks = [
        B("list.add", {"value": 5}, {"list": get()}),
        B("list.set", {"number": 2, "value": 6}, {"list": get()}),
        B("list.insert", {"value": 7, "end": "end"}, {"list": get()}),
        B("list.insert", {"value": 7, "end": "end", "number": 2}, {"list": get()}),
        B("list.remove", {"end": "end"}, {"list": get()}),
        B("text.append", {"text": "!", "variable": "v3"}),
    ]
    editor = build(language, [B("event.started"), *blocks], variables=("items", "n", "word"))

    assert lines(language, *blocks) == [
        *(
            "items.append(5)",
            "items[1] = 6",
            "items.append(7)",
            "insert_item(7, 2, items, from_end=True)",
        ),
        *("del items[-1]", 'word += "!"'),
    ]
    assert (
        'program = Variables(items=[], word="")\n'
        in generate_program(editor.project, language).text
    )


def test_written_code_is_printed_as_it_is_where_it_is(language):
    code = 'for i in range(3):\n    n = n + i  # count\ntext = """a\n  b"""\nwait(n)'
    loop = B("control.repeat", bodies={"do": [B("code.lines", {"code": code})]})
    editor = build(language, [B("event.started"), loop], variables=("n",))

    text = generate_program(editor.project, language).text

    assert "from nep_core import Behavior, wait\n" in text and "\nn = 0\n" in text
    assert (
        "    global n\n    for _ in range(3):\n        for i in range(3):\n"
        '            n = n + i  # count\n        text = """a\n  b"""\n        wait(n)\n'
    ) in text


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("x = = 1", "does not understand"),
        ("x = 1\nif", "Line 2"),
        ("break", "outside loop"),
        ("yield 1", "yield"),
        ("global n", "by itself"),
        ("x\x0c= 1", "cannot be seen"),
        ("from os import *", "does not understand"),
        ("(" * 300, "does not understand"),
    ],
)
def test_code_that_python_does_not_understand_is_a_problem_of_its_block(language, code, reason):
    editor = build(language, [B("event.started"), B("code.lines", {"code": code})])
    problem = next(p for p in check(editor.project, language) if p.kind == "wrong_python")

    assert reason in str(problem.sentence) and problem.severity == "error"
    with pytest.raises(CodeRefused) as refused:
        generate_program(editor.project, language)
    assert refused.value.block == problem.block


@pytest.mark.parametrize("code", ["", "1)+(2", "x := 1", "(yield)", "1 # c", "a\nb", "await x"])
def test_a_written_value_is_one_value(language, code):
    wait = B("control.wait", inputs={"seconds": B("code.value", {"code": "1"})})
    wait.inputs["seconds"].fields["code"] = code.replace("\n", " ")
    editor = build(language, [B("event.started"), wait])

    assert "wrong_python" in kinds(editor, language)


def test_the_statement_of_a_value_is_found(language):
    wait = B("control.wait", inputs={"seconds": B("math.arithmetic")})
    project = build(language, [B("event.started"), wait]).project
    code = generate_program(project, language)
    ids = {block.type: block.id for block in project.blocks.values()}

    assert code.statement_of(ids["math.arithmetic"], project) == ids["control.wait"]
    assert code.statement_of("b99", project) is None


def test_less_than_nothing_is_told(language):
    editor = build(language, [B("event.started"), B("control.repeat", {"times": "1-3"})])
    editor.project.blocks[editor.project.pages["behaviour"][0].body[1]].fields["times"] = -2

    assert "negative" in kinds(editor, language)


def test_counting_in_steps_of_nothing_is_told(language):
    loop = B("control.count", {"step": 0, "variable": "v1"})
    editor = build(language, [B("event.started"), loop], variables=("n",))

    assert "no_step" in kinds(editor, language)
