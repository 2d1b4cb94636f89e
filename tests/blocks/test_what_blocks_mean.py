"""The generated Python does what docs/language.md says: it is run, and what it did is asked."""

from __future__ import annotations

import math

import pytest
from block_building import B, build, share_variables

from nep_core.errors import ValueRefused
from nep_core.program import values
from nep_core.program.behavior import Behavior
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.edits.project import SetScope
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import LANGUAGE, SCOPE_PROGRAM, Project
from tests.blocks.block_building import held as held_in
from tests.blocks.block_building import read_program

NAMES = ("out", "l", "w", "n", "i")
OUT, LIST, WORD, NUMBER, ROUND = (f"v{number}" for number in range(1, 6))


@pytest.fixture(autouse=True)
def english_again():
    yield
    values.speak("en")


def get(variable):
    return B("variable.get", {"variable": variable})


def put(variable, value):
    """Set a variable to a block or a value."""
    if isinstance(value, B):
        return B("variable.set", {"variable": variable}, {"value": value})
    return B("variable.set", {"variable": variable, "value": value})


def with_slots(block_type, fields=None, /, **slots):
    """A block whose slots hold values or blocks."""
    block = B(block_type, dict(fields or {}))
    for key, value in slots.items():
        (block.inputs if isinstance(value, B) else block.fields)[key] = value
    return block


def listed(*items):
    """A list block of values or blocks."""
    block = B("list.create", groups={"item": len(items)})
    for number, item in enumerate(items, 1):
        (block.inputs if isinstance(item, B) else block.fields)[f"item.{number}"] = item
    return block


def note(value, many=LIST):
    """Add a value to a list."""
    return with_slots("list.add", None, list=get(many), value=value)


def run(language, *chain, variables=NAMES):
    """What the variables hold after a rule; its Python becomes blocks and the same Python again."""
    editor = build(language, [B("event.started"), *chain], variables=variables)
    share_variables(editor)
    text = generate_program(editor.project, language).text
    assert generate_program(read_program(text, language), language).text == text
    return ran(text)


def ran(text):
    """What a program holds when the rule of its start is done."""
    held = {}
    exec(compile(text.replace("\nbehavior.run()\n", "\n"), "program.py", "exec"), held)
    held["when_started"]()
    return held_in(held)


def told(language, value, *before):
    """How a value is told, by the block that joins texts."""
    joined = with_slots("text.join", {"item.1": ""}, **{"item.2": value})
    joined.groups = {"item": 2}
    return run(language, *before, put(OUT, joined))["out"]


def given(language, value, *before):
    """What a value block gives."""
    return run(language, *before, put(OUT, value))["out"]


A_AND_B = put(LIST, listed("a", "b"))
ABC = put(WORD, "abc")
TWO = with_slots("math.arithmetic", {"operation": "divide"}, a=4, b=2)
"""2.0: a fraction whose value is whole."""


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (with_slots("math.arithmetic", {"operation": "divide"}, a=6, b=3), "2"),
        (with_slots("math.arithmetic", {"operation": "divide"}, a=1, b=3), "0.333333333333"),
        (with_slots("math.arithmetic", None, a=0.1, b=0.2), "0.3"),
        (with_slots("text.number", {"text": "12"}), "12"),
        (with_slots("text.number", {"text": " 1,5 "}), "1.5"),
        (B("logic.truth", {"truth": "true"}), "true"),
        (listed(1, "a"), "1 and a"),
        (listed("Anna", "Ben", "Clara"), "Anna, Ben and Clara"),
        (listed(), ""),
        (listed(listed(1, 2), 0.5), "1 and 2 and 0.5"),
        (with_slots("math.arithmetic", {"operation": "multiply"}, a=1.5, b=1e-7), "1.5e-07"),
        (with_slots("math.round", {"way": "nearest"}, number=2.5), "3"),
        (with_slots("math.round", {"way": "nearest"}, number=-2.5), "-3"),
        (with_slots("text.case", {"case": "title", "text": "don't sTOP"}), "Don't Stop"),
        (with_slots("text.replace", {"text": "abc", "new": "-", "part": ""}), "abc"),
    ],
)
def test_a_value_is_told_in_words(language, value, words):
    assert told(language, value) == words


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("de", "0,5, wahr und Anna"),
        ("es", "0,5, verdadero y Anna"),
        ("fr", "0,5, vrai et Anna"),
        ("it", "0,5, vero e Anna"),
        ("ja", "0.5, 真 と Anna"),
    ],
)
def test_values_are_told_in_the_language_of_the_program(code, words):
    values.speak(code)

    assert values.as_text([0.5, True, "Anna"]) == words


def counted(language, first, last, step, *before):
    loop = with_slots("control.count", {"variable": ROUND}, first=first, last=last, step=step)
    loop.bodies = {"do": [note(get(ROUND))]}
    return run(language, *before, loop)["l"]


@pytest.mark.parametrize(
    ("first", "last", "step", "rounds"),
    [
        (5, 1, -1, [5, 4, 3, 2, 1]),
        (3, 1, 1, [3, 2, 1]),
        (1, 3, -1, [1, 2, 3]),
        (2, 2, 5, [2]),
        (0, 10, 4, [0, 4, 8]),
        (0, 0.3, 0.1, [0, 0.1, 0.2, 0.3]),
        (1, 2, 0.5, [1, 1.5, 2]),
    ],
)
def test_counting_goes_towards_its_end_typed_or_from_a_variable(
    language, first, last, step, rounds
):
    typed = counted(language, first, last, step)
    held = counted(language, first, last, get(NUMBER), put(NUMBER, step))
    ends = counted(language, get(NUMBER), last, step, put(NUMBER, first))

    assert typed == held == ends == pytest.approx(rounds)


@pytest.mark.parametrize(
    "block",
    [
        with_slots("list.get", None, number=0, list=get(LIST)),
        with_slots("list.get", {"end": "end"}, number=0, list=get(LIST)),
        with_slots("list.get", None, number=3, list=get(LIST)),
        with_slots("list.get", None, number=get(NUMBER), list=get(LIST)),
        with_slots("list.take", None, number=-1, list=get(LIST)),
        with_slots("list.get", None, number=1.5, list=get(LIST)),
        with_slots("list.get", None, number=1, list=get(WORD)),
        with_slots("text.letter", None, number=0, text=get(WORD)),
        with_slots("text.letter", None, number=4, text=get(WORD)),
        with_slots("math.arithmetic", {"operation": "power"}, a=-8, b=get(NUMBER)),
        with_slots("math.arithmetic", {"operation": "power"}, a=0, b=-1),
        with_slots("math.arithmetic", {"operation": "multiply"}, a=get(WORD), b=3),
        with_slots("math.arithmetic", None, a=get(LIST), b=get(LIST)),
        with_slots("math.function", {"function": "root"}, number=-1),
        with_slots("math.of_list", {"function": "sum"}, list=get(LIST)),
        with_slots("math.of_list", {"function": "max"}, list=get(LIST)),
        with_slots("math.of_list", {"function": "mean"}, list=listed()),
        with_slots("list.sorted", None, list=listed(1, "a")),
        with_slots("logic.compare", {"comparison": "less"}, a=1, b=get(WORD)),
        with_slots("logic.compare", {"comparison": "less"}, a=B("logic.truth"), b=2),
        with_slots("text.number", {"text": "nan"}),
        with_slots("text.number", {"text": "1.2.3"}),
        with_slots("math.divisible", None, number=4, divisor=0),
        with_slots("math.number_is", None, number=get(WORD)),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_an_error(language, block):
    if block.type in ("math.divisible", "math.number_is"):
        block.type = block.type.replace("math", "logic")
    before = [A_AND_B, ABC, put(NUMBER, 1 / 3)]

    with pytest.raises((ValueRefused, ZeroDivisionError, ValueError, IndexError)):
        given(language, block, *before)


@pytest.mark.parametrize(
    ("statement", "after"),
    [
        (with_slots("list.insert", {"value": "Z"}, number=1, list=get(LIST)), ["Z", "a", "b"]),
        (with_slots("list.insert", {"value": "Z"}, number=3, list=get(LIST)), ["a", "b", "Z"]),
        (with_slots("list.insert", {"value": "Z", "end": "end"}, number=1, list=get(LIST)),
         ["a", "b", "Z"]),
        (with_slots("list.insert", {"value": "Z", "end": "end"}, number=3, list=get(LIST)),
         ["Z", "a", "b"]),
        (with_slots("list.insert", {"value": "Z"}, number=0, list=get(LIST)), None),
        (with_slots("list.insert", {"value": "Z"}, number=4, list=get(LIST)), None),
        (with_slots("list.remove", None, number=0, list=get(LIST)), None),
        (with_slots("list.remove", {"end": "end"}, number=2, list=get(LIST)), ["b"]),
        (with_slots("list.set", {"value": "Z"}, number=get(NUMBER), list=get(LIST)), ["a", "Z"]),
        (with_slots("list.set", {"value": "Z"}, number=-1, list=get(LIST)), None),
    ],
)  # fmt: skip
def test_places_in_lists_are_counted_from_one(language, statement, after):
    chain = [A_AND_B, put(NUMBER, TWO)]
    if after is None:
        with pytest.raises(ValueRefused, match="item"):
            run(language, *chain, statement)
    else:
        assert run(language, *chain, statement)["l"] == after


@pytest.mark.parametrize(
    ("first", "last", "part"),
    [(0, 2, ["a", "b"]), (1, 1, ["a"]), (2, 9, ["b"]), (2, 1, []), (-5, -1, [])],
)
def test_items_that_a_list_does_not_have_are_left_out(language, first, last, part):
    typed = with_slots("list.part", None, first=first, last=last, list=get(LIST))
    held = with_slots("list.part", None, first=get(NUMBER), last=last, list=get(LIST))

    assert given(language, typed, A_AND_B) == part
    assert given(language, held, A_AND_B, put(NUMBER, first)) == part


@pytest.mark.parametrize(
    ("block", "result"),
    [
        (with_slots("text.length", None, text=get(LIST)), 2),
        (with_slots("text.length", None, text=get(WORD)), 3),
        (with_slots("text.length", None, text=B("logic.truth")), 4),
        (with_slots("text.is_empty", None, text=listed()), True),
        (with_slots("logic.compare", None, a=1, b=B("logic.truth")), False),
        (with_slots("logic.compare", None, a=2, b=TWO), True),
        (with_slots("logic.compare", None, a=listed(1), b=listed(B("logic.truth"))), False),
        (with_slots("logic.compare", {"comparison": "not_equal"}, a=listed(1), b=listed(1)), False),
        (with_slots("logic.compare", None, a="1", b=1), False),
        (with_slots("list.contains", None, list=listed(B("logic.truth")), item=1), False),
        (with_slots("list.find", None, list=listed(B("logic.truth"), 1), item=1), 2),
        (with_slots("math.arithmetic", {"operation": "remainder"}, a=-7, b=3), 2),
        (with_slots("math.arithmetic", {"operation": "floor_divide"}, a=-7, b=2), -4),
        (with_slots("math.constrain", None, number=5, low=9, high=3), 3),
        (with_slots("logic.number_is", {"property": "odd"}, number=2.5), False),
        (with_slots("text.find", {"part": "", "text": "abc"}), 1),
        (with_slots("text.find", {"part": "z", "text": "abc"}), 0),
        (with_slots("list.split", {"text": "abc", "mark": ""}), ["a", "b", "c"]),
        (with_slots("list.joined", {"mark": "-"}, list=listed(1, B("logic.truth"))), "1-true"),
        (with_slots("list.filled", {"item": 0}, times=2.5), [0, 0, 0]),
        (with_slots("list.filled", {"item": 0}, times=-1), []),
    ],
)  # fmt: skip
def test_a_block_gives_what_the_page_says(language, block, result):
    found = given(language, block, A_AND_B, ABC)

    assert found == result and type(found) is type(result)


def test_a_junction_is_a_truth_where_a_value_is_needed(language):
    both = with_slots("logic.junction", {"junction": "or"}, a=get(NUMBER), b=get(WORD))

    assert given(language, both, put(NUMBER, 0), put(WORD, "x")) is True


def test_a_list_has_many_names_and_a_filled_list_has_lists_of_its_own(language):
    alias = [A_AND_B, put(WORD, get(LIST)), note("c", WORD)]
    filled = put(OUT, with_slots("list.filled", None, item=listed(), times=2))
    first = with_slots("list.get", None, number=1, list=get(OUT))

    assert run(language, *alias)["l"] == ["a", "b", "c"]
    assert run(language, filled, with_slots("list.add", {"value": 1}, list=first))["out"] == [
        [1],
        [],
    ]


def test_values_are_worked_out_once_and_in_the_order_of_the_sentence(language):
    def taken(many):
        return with_slots("list.take", None, number=1, list=get(many))

    letters = put(LIST, listed("abc", "b", "X"))
    replaced = with_slots("text.replace", None, text=taken(LIST), new=taken(LIST), part=taken(LIST))
    found = with_slots("list.find", None, item=taken(WORD), list=listed(2, 1))

    assert given(language, replaced, put(LIST, listed("abc", "X", "b"))) == "aXc"
    assert run(language, letters, put(WORD, listed(1, 2)), put(OUT, found))["out"] == 2


@pytest.mark.parametrize(("times", "rounds"), [(2.5, 3), (0.4, 0), (-1, 0), (2, 2)])
def test_repeat_rounds_to_the_nearest(language, times, rounds):
    repeat = with_slots("control.repeat", None, times=get(NUMBER))
    repeat.bodies = {"do": [B("variable.change", {"variable": OUT})]}

    assert run(language, put(NUMBER, times), repeat)["out"] == rounds


def test_a_power_that_is_too_large_is_refused_at_once(language):
    inner = with_slots("math.arithmetic", {"operation": "power"}, a=9, b=9)

    with pytest.raises(ValueRefused, match="too large"):
        given(language, with_slots("math.arithmetic", {"operation": "power"}, a=9, b=inner))


def test_append_tells_what_was_there_and_change_needs_a_number(language):
    append = B("text.append", {"variable": OUT, "text": "!"})

    assert run(language, put(OUT, 0.5), append)["out"] == "0.5!"
    assert run(language, append)["out"] == "!"
    for wrong in (B("logic.truth"), "1", listed()):
        with pytest.raises((ValueRefused, TypeError)):
            run(language, put(OUT, wrong), B("variable.change", {"variable": OUT}))


def test_append_tells_a_list_without_what_its_own_value_takes_off_it(language):
    taken = with_slots("list.take", {"end": "end"}, number=1, list=get(OUT))
    append = B("text.append", {"variable": OUT}, {"text": taken})

    assert run(language, put(OUT, listed("a", "b", "c")), append)["out"] == "a and bc"


@pytest.mark.parametrize(
    ("given_to", "first"),
    [("hi", '""'), (B("logic.truth"), "False"), (5, "0"), (listed(1), "0"), (get(NUMBER), "0")],
)
def test_a_variable_begins_as_what_it_is_set_to_looks(language, given_to, first):
    read = [put(OUT, get(WORD)), put(WORD, given_to)]
    editor = build(language, [B("event.started"), *read], variables=NAMES)

    assert f"\nprogram = Variables(w={first}" in generate_program(editor.project, language).text


# Where the kinds are known, the Python stays plain.


def body(language, *chain):
    """The lines of a rule."""
    editor = build(language, [B("event.started"), *chain], variables=NAMES)
    text = generate_program(editor.project, language).text
    lines = text.partition("def when_started():\n")[2].partition("\n\n\nbehavior.run")[0]
    return [line[4:] for line in lines.splitlines()]


def test_what_is_known_stays_plain_python(language):
    more = with_slots("math.arithmetic", None, a=get(NUMBER), b=1)
    greeting = with_slots("text.join", {"item.1": "Hi "}, **{"item.2": get(WORD)})
    greeting.groups = {"item": 2}
    count = with_slots("text.join", {"item.1": "n: "}, **{"item.2": get(NUMBER)})
    count.groups = {"item": 2}
    is_x = with_slots("logic.compare", None, a=get(WORD), b="x")
    repeat = with_slots("control.repeat", None, times=get(NUMBER))
    each = with_slots("control.for_each", {"variable": ROUND}, list=get(LIST))
    each.bodies = {"do": [put(WORD, get(ROUND))]}

    lines = body(
        language,
        *(A_AND_B, put(WORD, "Ada"), put(NUMBER, 1), put(NUMBER, more), put(OUT, greeting)),
        *(put(OUT, count), repeat, each),
        put(OUT, with_slots("list.get", {"number": 1}, list=get(LIST))),
        put(NUMBER, with_slots("list.length", None, list=get(LIST))),
        B("variable.change", {"variable": NUMBER}),
        with_slots("control.if", None, condition=is_x),
    )  # fmt: skip

    assert lines == [
        'l = ["a", "b"]', 'w = "Ada"', "n = 1", "n = n + 1", 'out = f"Hi {w}"',
        'out = f"n: {n}"', "for _ in range(n):", "    pass", "for i in l:", "    w = i",
        "out = l[0]", "n = len(l)", "n += 1", 'if w == "x":', "    pass",
    ]  # fmt: skip


def test_a_truth_is_asked_for_without_comparing_it(language):
    hit = [put(WORD, B("logic.truth"))]
    is_true = with_slots("logic.compare", None, a=get(WORD), b=B("logic.truth"))
    is_false = with_slots(
        "logic.compare", None, a=get(WORD), b=B("logic.truth", {"truth": "false"})
    )

    assert body(language, *hit, put(OUT, is_true))[1] == "out = w"
    assert body(language, *hit, put(OUT, is_false))[1] == "out = not w"


# Own blocks.


def leaves(language, *, more=()):
    """An own block that counts the leaves of a tree with itself, and keeps them in a variable."""
    editor = Editor(Project(), language)
    kept, out = editor.add_variable("total"), editor.add_variable("out")
    depth = editor.new_parameter("depth", "number")
    own = editor.add_procedure(["leaves of", depth], gives_value=True)
    above = B(f"my.parameter.{own}.{depth.id}")
    one = B("control.if", inputs={"condition": with_slots("logic.compare", None, a=above, b=0)})
    one.bodies = {"do": [with_slots("my.return", None, value=1)]}

    def below():
        less = with_slots("math.arithmetic", {"operation": "subtract", "b": 1}, a=above)
        return B(f"my.call.{own}", inputs={depth.id: less})

    total = with_slots("math.arithmetic", None, a=get(kept), b=below())
    chain = [one, *more, put(kept, below()), put(kept, total)]
    define = [B(f"my.define.{own}"), *chain, with_slots("my.return", None, value=get(kept))]
    call = put(out, B(f"my.call.{own}", {depth.id: 4}))
    build(language, define, [B("event.started"), call], editor=editor)
    editor.apply(SetScope(out, SCOPE_PROGRAM))
    return editor.project


def test_a_variable_of_one_own_block_belongs_to_each_of_its_calls(language):
    text = generate_program(leaves(language), language).text
    held = ran(text)

    assert held["out"] == 16 and "program.out = leaves_of(4)" in text
    assert "total" not in held and "    total = leaves_of(depth - 1)" in text
    assert generate_program(read_program(text, language), language).text == text


def test_a_variable_that_is_read_first_belongs_to_the_whole_program(language):
    read_first = B("variable.change", {"variable": "v1"})
    text = generate_program(leaves(language, more=[read_first]), language).text

    assert "program.total += 1" in text and "program = Variables(total=0, out=0)" in text


def test_an_own_block_gives_0_where_it_gives_nothing_back(language):
    editor = Editor(Project(), language)
    out = editor.add_variable("out")
    own = editor.add_procedure(["perhaps"], gives_value=True)
    maybe = B("control.if", inputs={"condition": get(out)})
    maybe.bodies = {"do": [with_slots("my.return", None, value="yes")]}
    call = put(out, B(f"my.call.{own}"))
    build(language, [B(f"my.define.{own}"), maybe], [B("event.started"), call], editor=editor)
    share_variables(editor)
    text = generate_program(editor.project, language).text

    assert ran(text)["out"] == 0
    assert generate_program(read_program(text, language), language).text == text


def with_python(language, code, *more, kind="number"):
    """What an own block with Python in it gives for 2, times 2."""
    editor = Editor(Project("A"), language)
    given_ = editor.new_parameter("n", kind)
    out = editor.add_variable("out")
    own = editor.add_procedure(["own", given_], gives_value=True)
    n = B(f"my.parameter.{own}.{given_.id}")
    sum_ = with_slots("math.arithmetic", {"operation": "add"}, a=n, b=n)
    last = [with_slots("my.return", None, value=sum_)] if not more else list(more)
    call = B(f"my.call.{own}", {given_.id: 2})
    twice = with_slots("math.arithmetic", {"operation": "multiply"}, a=call, b=2)
    define = [B(f"my.define.{own}"), B("code.lines", {"code": code}), *last]
    build(language, define, [B("event.started"), put(out, twice)], editor=editor)
    share_variables(editor)
    text = generate_program(editor.project, language).text
    assert generate_program(read_program(text, language), language).text == text
    return ran(text)["out"]


@pytest.mark.parametrize(
    "code",
    [
        "n = str(n)",
        "for n in 'ab':\n    pass",
        "match str(n):\n    case n:\n        pass",
        "return '5'",
        "if n > 1:\n    return n > 0",
    ],
)
def test_python_may_make_anything_of_what_an_own_block_is_given_and_gives(language, code):
    with pytest.raises(ValueRefused, match="A number belongs here"):
        with_python(language, code)


@pytest.mark.parametrize(
    ("code", "result"),
    [
        ("if n > 2:\n    return 5", 0),
        ("if n > 1:\n    return 5\nelse:\n    return 6", 10),
        ("def f():\n    return 5\nx = f()", 0),
        ("while n:\n    break", 0),
        ("while True:\n    return n", 4),
        ("try:\n    return int('x')\nexcept ValueError:\n    n = 3", 0),
    ],
)
def test_an_own_block_with_python_gives_0_where_it_gives_nothing_back(language, code, result):
    assert with_python(language, code, B("control.wait", {"seconds": 0})) == result


def test_locals_of_a_persons_function_stay_its_own(language):
    text = (
        'from nep_core import Behavior\n\nbehavior = Behavior("T")\n\n\n'
        "def one(x):\n    part = x * 2\n    return part\n\n\n"
        "def two(x):\n    part = one(x)\n    part = part + one(1)\n    return part\n\n\n"
        "@behavior.when_started\ndef when_started():\n    two(1)\n\n\nbehavior.run()\n"
    )
    again = generate_program(read_program(text, language), language).text

    assert "global" not in again and "part = part + one(1)" in again


@pytest.mark.parametrize(
    ("count", "first", "last", "numbers"),
    [
        (values.count_up, 0, -1, []),
        (values.count_up, 1, 3, [1, 2, 3]),
        (values.count_up, 2, 2, [2]),
        (values.count_down, 1, 3, []),
        (values.count_down, 3, 1, [3, 2, 1]),
    ],
)
def test_counting_one_way_does_nothing_where_the_other_would_be_needed(count, first, last, numbers):
    assert list(count(first, last)) == numbers
    with pytest.raises(values.ValueRefused):
        list(count(first, last, 0))


def test_many_powers_and_roundings_agree_with_what_they_are():
    for number in (0.5, 1.5, 2.5, -0.5, -1.5, 0.49999999999999994, 1e15 + 0.5):
        away = math.copysign(math.floor(abs(number) + 0.5), number)
        if number != 0.49999999999999994:
            assert values.to_nearest(number) == away
    assert values.to_nearest(0.49999999999999994) == 0


def test_the_language_of_a_program_is_kept_and_said_in_its_python(language):
    editor = build(language, [B("event.started")])
    editor.apply(SetExtra(LANGUAGE, "de"))
    text = generate_program(editor.project, language).text

    read = read_program(text, language)

    assert 'behavior = Behavior("Test", language="de")\n' in text
    assert read.spoken_language == "de" and generate_program(read, language).text == text
    again = from_bytes(to_bytes(editor.project), "a.nep", language)
    assert again.spoken_language == "de"
    english = read_program(text.replace(', language="de"', ""), language, again)
    assert english.spoken_language == "en" and LANGUAGE not in english.extra


@pytest.mark.parametrize("kept", ["xx", 5, ["de"], None])
def test_a_language_that_is_not_known_is_english(language, kept):
    editor = build(language, [B("event.started")])
    editor.project.extra[LANGUAGE] = kept

    assert 'Behavior("Test")\n' in generate_program(editor.project, language).text


def test_a_program_speaks_the_language_that_its_behaviour_was_given():
    Behavior("T", language="fr")
    assert values.as_text([0.5, True]) == "0,5 et vrai"
    Behavior("T")
    assert values.as_text([0.5, True]) == "0.5 and true"


def test_what_is_added_is_worked_out_before_the_variable_is_read(language):
    editor = Editor(Project(), language)
    n, w = editor.add_variable("n"), editor.add_variable("w")
    own = editor.add_procedure(["bump"], gives_value=True)
    append = B("text.append", {"variable": w, "text": "a"})
    bump = [B("variable.change", {"variable": n}), append, with_slots("my.return", None, value=1)]
    call = B(f"my.call.{own}")
    change = with_slots("variable.change", {"variable": n}, amount=call)
    behind = with_slots("text.append", {"variable": w}, text=call)
    build(
        language,
        [B(f"my.define.{own}"), *bump],
        [B("event.started"), change, behind],
        editor=editor,
    )
    text = generate_program(editor.project, language).text

    held = ran(text)

    assert (held["n"], held["w"]) == (3, "aa1")
    assert generate_program(read_program(text, language), language).text == text


def test_and_in_a_place_for_a_text_is_a_truth(language):
    both = with_slots("logic.junction", {"junction": "and"}, a=get(LIST), b=get(WORD))

    assert told(language, both, A_AND_B, ABC) == "true"
    assert given(language, with_slots("text.length", None, text=both), A_AND_B, ABC) == 4


def test_what_is_no_number_is_refused_before_the_next_slot_is_worked_out(language):
    editor = Editor(Project(), language)
    done, items = editor.add_variable("done"), editor.add_variable("items")
    own = editor.add_procedure(["do it"], gives_value=True)
    body = [put(done, 1), with_slots("my.return", None, value=listed("a", "b"))]
    item = with_slots("list.get", None, number=get(items), list=B(f"my.call.{own}"))
    start = [B("event.started"), put(items, listed("a")), put(done, item)]
    build(language, [B(f"my.define.{own}"), *body], start, editor=editor)
    share_variables(editor)
    text = generate_program(editor.project, language).text
    held = {}
    exec(compile(text.replace("\nbehavior.run()\n", "\n"), "program.py", "exec"), held)

    with pytest.raises(ValueRefused):
        held["when_started"]()

    assert held_in(held)["done"] == 0
    assert generate_program(read_program(text, language), language).text == text


def test_a_list_in_a_list_that_grows_is_gone_through_as_it_was(language):
    inner = with_slots("list.get", {"number": 1}, list=get(LIST))
    loop = with_slots("control.for_each", {"variable": ROUND}, list=inner)
    grow = with_slots("list.add", None, list=inner, value=get(ROUND))
    loop.bodies = {"do": [grow]}

    assert run(language, put(LIST, listed(listed(1, 2))), loop)["l"] == [[1, 2, 1, 2]]


ITSELF = [put(LIST, listed(1)), note(get(LIST))]
DOUBLED = [put(LIST, listed(1)), *[put(LIST, listed(get(LIST), get(LIST)))] * 30]


@pytest.mark.parametrize("chain", [ITSELF, DOUBLED])
@pytest.mark.parametrize(
    ("value", "words"),
    [
        (with_slots("text.join", {"item.1": ""}, **{"item.2": get(LIST)}), "too deep"),
        (with_slots("logic.compare", None, a=get(LIST), b=get(WORD)), "too deep"),
        (with_slots("math.arithmetic", None, a=get(LIST), b=1), "number"),
        (with_slots("logic.compare", {"comparison": "less"}, a=get(LIST), b=get(LIST)), "larger"),
    ],
)
def test_a_list_without_end_is_told_at_once(language, chain, value, words):
    value.groups = {"item": 2} if value.type == "text.join" else {}
    other = [put(WORD, with_slots("list.part", None, first=1, last=9, list=get(LIST)))]

    with pytest.raises(ValueRefused, match=words):
        given(language, value, *chain, *other)


@pytest.mark.parametrize("text", ["0e99999999999999999999", "1e-99999999999999999999"])
def test_a_number_in_a_text_may_be_as_small_as_it_likes(text):
    assert values.number_in(text) == 0


def test_a_number_that_is_larger_than_any_is_refused():
    with pytest.raises(ValueRefused, match="too large"):
        values.number_in("1e99999999999999999999")
    with pytest.raises(ValueRefused, match="too large"):
        values.median_of([1e308, 1e308])


def test_python_that_gives_a_variable_another_value_by_a_pattern_is_seen(language):
    code = B("code.lines", {"code": 'match "5":\n    case n:\n        pass'})
    twice = with_slots("math.arithmetic", {"operation": "multiply"}, a=get(NUMBER), b=2)
    with pytest.raises(ValueRefused, match="A number belongs here"):
        run(language, put(NUMBER, 1), code, put(OUT, twice))


def test_a_number_of_a_million_digits_in_a_text_is_refused_at_once(language):
    with pytest.raises(ValueRefused, match="too large"):
        values.number_in("1234567890" * 100_000)


@pytest.mark.parametrize("number", [0, -2.5, 3])
def test_a_number_with_its_sign_changed_is_read_back(language, number):
    minus = with_slots("math.function", {"function": "minus"}, number=number)

    assert given(language, minus) == -number


def test_the_length_of_another_list_is_no_place_from_the_end(language):
    length = with_slots("list.length", None, list=get(ROUND))
    last = with_slots("list.get", None, number=length, list=get(LIST))

    with pytest.raises(ValueRefused):
        run(language, A_AND_B, put(ROUND, listed()), put(OUT, last))
    assert given(language, last, A_AND_B, put(ROUND, listed("x"))) == "a"


def test_products_of_numbers_below_0_are_not_taken_for_such(language):
    product = with_slots("math.arithmetic", {"operation": "multiply"}, a=-1, b=-2)
    below_0 = with_slots("math.arithmetic", {"operation": "subtract"}, a=1, b=product)
    item = with_slots("list.get", None, number=get(NUMBER), list=get(LIST))

    with pytest.raises(ValueRefused):
        run(language, A_AND_B, put(NUMBER, below_0), put(OUT, item))
