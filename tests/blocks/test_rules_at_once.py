"""Programs whose parts change the same variables and lists at once, and rules that end early."""

from __future__ import annotations

import sys
import threading
from textwrap import dedent

import pytest
from block_building import B, build, held, read_program

from nep_core.program.tasks import RuleStopped
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import ON_ERROR

ONE = B("math.random_integer", {"low": 1, "high": 1})
TWO = ("n", "items")


def get(variable="v1"):
    return B("variable.get", {"variable": variable})


def plus_one():
    return B("math.arithmetic", {"operation": "add"}, {"a": get(), "b": ONE})


def set_n(value=None):
    return B("variable.set", {"variable": "v1"}, {"value": value or plus_one()})


def repeat(times, *blocks):
    return B("control.repeat", {"times": times}, bodies={"do": list(blocks)})


def together(*parts):
    bodies = {f"do.{number}": part for number, part in enumerate(parts, 1)}
    return B("control.together", bodies=bodies, groups={"part": len(parts)})


def add_to_items(value=None):
    return B("list.add", {"value": "x"}, {"list": get("v2"), **({"value": value} if value else {})})


def made(language, *stacks):
    """The Python of these stacks, which is read back as the same blocks."""
    editor = build(language, *stacks, variables=TWO)
    text = generate_program(editor.project, language).text
    before = dict(editor.project.blocks)
    update_from_python(editor, text)
    assert editor.project.blocks == before
    again = read_program(text, language)
    assert generate_program(again, language).text == text
    assert count_code(again.blocks) <= count_code(before)
    return text


def count_code(blocks):
    """How many of the blocks are Python that a person wrote."""
    return sum(block.type == "code.lines" for block in blocks.values())


def played(text, functions=()):
    """The names of a program that was run to its end, or whose functions were run side by side."""
    space = {"__name__": "program"}
    exec(compile(text.replace("behavior.run()", ""), "program", "exec"), space)
    threads = [threading.Thread(target=space[name]) for name in functions]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return held(space)


@pytest.fixture
def eager():
    """Threads take turns as often as they can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.parametrize(
    "count",
    [
        set_n,
        lambda: B("variable.change", {"variable": "v1"}, {"amount": ONE}),
    ],
)
def test_two_parts_lose_no_count(language, eager, count):
    rule = [B("event.started"), together([repeat(100_000, count())], [repeat(100_000, count())])]

    text = made(language, rule)

    assert text.count("with at_once: program.n ") == 2
    assert played(text, ["when_started"])["n"] == 200_000


def test_two_rules_lose_no_count(language, eager):
    rules = [[B("event.started"), repeat(20_000, set_n())] for _ in range(2)]

    text = made(language, *rules)

    assert played(text, ["when_started", "when_started_2"])["n"] == 40_000


def test_two_rules_lose_no_letter_and_no_item(language, eager):
    append = B("text.append", {"variable": "v1"}, {"text": B("text.case", {"text": "x"})})
    last = B(
        "list.set",
        {"end": "end", "number": 1},
        {
            "list": get("v2"),
            "value": B(
                "math.arithmetic",
                {"operation": "add"},
                {"a": B("list.get", {"end": "end", "number": 1}, {"list": get("v2")}), "b": ONE},
            ),
        },
    )
    rules = [[B("event.started"), repeat(5000, append, last)] for _ in range(2)]

    text = made(language, [B("event.started"), add_to_items()], *rules)
    assert text.count("with at_once: program.items[-1] = ") == 2
    space = played(text.replace("items=[]", "items=[0]"), ["when_started_2", "when_started_3"])

    assert (space["n"].casefold().count("x"), space["items"]) == (10_000, [10_000])


@pytest.mark.parametrize(
    "stacks",
    [
        [[B("event.started"), set_n()]],
        [[B("event.started"), together([set_n()], [B("control.wait")])]],
        [[B("event.started"), together([set_n()], [B("control.wait")]), set_n()]],
        [[B("event.started"), B("variable.change", {"variable": "v1"})] for _ in range(2)],
        [[B("event.started"), set_n(B("math.random_integer"))] for _ in range(2)],
        [[B("event.started"), set_n()], [B("control.wait"), set_n()]],
    ],
)
def test_what_nobody_can_tear_apart_is_written_plainly(language, stacks):
    assert "at_once" not in made(language, *stacks)


def test_what_waits_for_an_answer_lets_nobody_wait(language):
    asked = B(
        "math.arithmetic",
        {"operation": "add"},
        {"a": get(), "b": B("text.number", inputs={"text": B("robot_speech.ask_for")})},
    )
    assert "at_once" not in made(language, *([B("event.started"), set_n(asked)] for _ in range(2)))


def test_python_that_sets_a_variable_counts_as_another_rule(language):
    code = [B("event.started"), B("code.lines", {"code": "n = 5"})]

    assert "with at_once: n = " in made(language, code, [B("event.started"), set_n()])


def test_python_without_the_words_becomes_the_same_blocks(language):
    editor = build(language, *([B("event.started"), set_n()] for _ in range(2)), variables=TWO)
    text = generate_program(editor.project, language).text

    update_from_python(editor, text.replace("with at_once: ", ""))

    assert generate_program(editor.project, language).text == text


def test_for_each_goes_through_the_items_that_there_were_when_it_began(language):
    grows = B(
        "control.for_each",
        {"variable": "v1"},
        {"list": get("v2")},
        {"do": [add_to_items(get())]},
    )

    text = made(language, [B("event.started"), add_to_items(), add_to_items(), grows])
    items = played(text, ["when_started"])["items"]

    assert "for n in program.items[:]:" in text
    assert items == ["x"] * 4


def test_a_list_that_another_rule_shrinks_is_gone_through_whole(language):
    each = B("control.for_each", {"variable": "v1"}, {"list": get("v2")}, {"do": [add_to_items()]})
    takes = B("list.remove", {"end": "start", "number": 1}, {"list": get("v2")})

    text = made(language, [B("event.started"), each], [B("event.human_state"), takes])

    assert "for n in program.items[:]:" in text


def test_a_list_that_never_changes_is_gone_through_plainly(language):
    each = B("control.for_each", {"variable": "v1"}, {"list": get("v2")})

    assert "for n in program.items:" in made(language, [B("event.started"), each])


def test_a_loop_that_is_written_without_a_copy_becomes_blocks_where_that_is_the_same(language):
    each = B("control.for_each", {"variable": "v1"}, {"list": get("v2")}, {"do": [set_n(ONE)]})
    editor = build(language, [B("event.started"), each, add_to_items()], variables=TWO)
    text = generate_program(editor.project, language).text

    update_from_python(editor, text.replace("items[:]", "items"))
    assert generate_program(editor.project, language).text == text

    append = "        program.items.append(n)\n        n = "
    grows = text.replace("items[:]", "items").replace("        n = ", append)
    update_from_python(editor, grows)
    assert "    for n in program.items:" in generate_program(editor.project, language).text


def test_stopping_the_rule_in_a_part_or_own_block_ends_the_whole_rule(language):
    stop = B("control.stop_rule")
    parts = B(
        "goal.one_of",
        bodies={"do.1": [stop], "do.2": [stop]},
        groups={"part": 2},
    )
    more = B("variable.change", {"variable": "v1"})
    text = made(language, [B("event.started"), parts, more], [B("event.human_state"), stop])

    assert text.count("        stop_rule()") == 2
    assert "\n    return" in text
    space = {"__name__": "program"}
    exec(compile(text.replace("behavior.run()", ""), "program", "exec"), space)
    with pytest.raises(RuleStopped):
        space["when_started"]()
    assert held(space)["n"] == 0


OWN = """
    from nep_core import Behavior, stop_rule

    behavior = Behavior("Own")
    n = 0


    def check(value):
        if value:
            stop_rule()


    @behavior.when_started
    def when_started():
        global n
        check(1)
        n = 1


    behavior.run()
    """


def test_a_rule_stopped_in_an_own_block_runs_again_at_the_next_event(language):
    project = read_program(dedent(OWN).strip(), language)
    text = generate_program(project, language).text

    assert not any(block.type == "code.lines" for block in project.blocks.values())
    assert "        stop_rule()" in text
    space = {"__name__": "program"}
    exec(compile(text.replace("behavior.run()", ""), "program", "exec"), space)
    for _ in range(2):
        with pytest.raises(RuleStopped):
            space["when_started"]()
    assert held(space)["n"] == 0


def test_what_an_error_ends_is_kept_written_and_read(language):
    editor = build(language, [B("event.started")])
    assert "on_error" not in generate_program(editor.project, language).text

    editor.apply(SetExtra(ON_ERROR, "end"))
    text = generate_program(editor.project, language).text

    assert 'behavior = Behavior("Test", on_error="end")' in text
    assert generate_program(read_program(text, language), language).text == text
    kept = from_bytes(to_bytes(editor.project), "test.nep", language)
    assert kept.ends_on_error
    update_from_python(editor, text.replace(', on_error="end"', ""))
    assert not editor.project.ends_on_error
