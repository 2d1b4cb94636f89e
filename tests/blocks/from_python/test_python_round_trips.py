"""Blocks to Python to blocks: the same blocks; Python to blocks to Python: the same text."""

from __future__ import annotations

import pytest
from block_building import B, build
from hypothesis import given
from hypothesis import strategies as st
from sound_programs import sound

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Parameter, Procedure, Project
from tests.blocks.block_building import read_program

pytestmark = pytest.mark.long

NUMBERS = st.integers(-9, 99) | st.sampled_from([0.5, -2.25, 1e-7])
TIMES = st.integers(0, 99) | st.just(0.5)
TEXTS = st.sampled_from(
    ["", "hi", 'a "quote"', "größe", "# no comment", "line\nbreak", "\\", "x = 1"]
)
READERS = [B("variable.get", {"variable": "v1"}), B("sensing.human_state")]


def numbers(depth: int):
    """Number blocks to be plugged in."""
    if depth == 0:
        return st.just(B("variable.get", {"variable": "v1"}))
    slots = st.tuples(NUMBERS | numbers(depth - 1), NUMBERS | numbers(depth - 1))
    signs = st.sampled_from(["add", "subtract", "multiply", "divide", "power", "remainder"])
    arithmetic = st.builds(
        lambda sign, ab: filled("math.arithmetic", {"operation": sign}, a=ab[0], b=ab[1]),
        signs,
        slots,
    )
    random = st.builds(lambda ab: filled("math.random_integer", {}, low=ab[0], high=ab[1]), slots)
    return arithmetic | random | st.just(B("variable.get", {"variable": "v1"}))


def questions(depth: int):
    """Yes-or-no blocks to be plugged in."""
    signs = st.sampled_from(["equal", "not_equal", "less", "less_or_equal", "greater"])
    value = NUMBERS | TEXTS | numbers(1)
    compare = st.builds(
        lambda sign, a, b: filled("logic.compare", {"comparison": sign}, a=a, b=b),
        signs,
        numbers(1),
        value,
    ).filter(lambda b: not asks_for_no_rest(b))
    plain = st.sampled_from(
        [
            B("logic.truth", {"truth": "true"}),
            B("logic.truth", {"truth": "false"}),
            B("sensing.human_state_is", {"state": "touched_head"}),
        ]
    )
    if depth == 0:
        return compare | plain
    inner = questions(depth - 1)
    junction = st.builds(
        lambda word, a, b: filled("logic.junction", {"junction": word}, a=a, b=b),
        st.sampled_from(["and", "or"]),
        inner.filter(lambda b: b.type != "logic.junction"),
        inner.filter(lambda b: b.type != "logic.junction"),
    )
    return compare | plain | junction | st.builds(lambda a: filled("logic.not", {}, a=a), inner)


def asks_for_no_rest(compare: B) -> bool:
    """Whether it is the same Python as "is divisible by", which is what such Python becomes."""
    rest = compare.inputs.get("a")
    return (
        rest is not None
        and rest.fields.get("operation") == "remainder"
        and compare.fields["comparison"] == "equal"
        and compare.fields.get("b") == 0
    )


def filled(block_type: str, fields: dict, **slots) -> B:
    """A block whose slots hold values or blocks."""
    made = B(block_type, dict(fields))
    for key, value in slots.items():
        (made.inputs if isinstance(value, B) else made.fields)[key] = value
    return made


def statements(depth: int):
    """One statement block."""
    say = st.builds(
        lambda text, face: filled("robot.say", {"gesture": face}, text=text),
        TEXTS | numbers(1).filter(lambda b: b.type != "x"),
        st.sampled_from(["no_gesture", "explain", "greet"]),
    )
    plain = st.one_of(
        say,
        st.builds(lambda n: filled("control.wait", {}, seconds=n), TIMES | numbers(1)),
        st.builds(
            lambda n: filled("variable.change", {"variable": "v1"}, amount=n), NUMBERS | numbers(1)
        ),
        st.builds(
            lambda n: filled("variable.set", {"variable": "v1"}, value=n),
            NUMBERS | TEXTS | numbers(2),
        ),
        st.builds(lambda q: filled("control.wait_until", {}, condition=q), questions(1)),
        st.sampled_from(["bow", "wave"]).map(lambda a: B("robot.play", {"animation": a})),
        st.builds(lambda n: filled("robot.walk", {}, forward=n), NUMBERS),
    )
    if depth == 0:
        return plain
    body = st.lists(statements(depth - 1), max_size=2)
    repeat = st.builds(
        lambda n, do: with_bodies(filled("control.repeat", {}, times=n), do=do),
        st.integers(0, 9) | numbers(1),
        body,
    )
    loop = st.builds(
        lambda q, do: with_bodies(filled("control.while", {}, condition=q), do=do),
        questions(1).filter(lambda q: q.type not in ("logic.truth", "logic.not")),
        body,
    )
    branch = st.builds(
        branches, questions(1), body, st.lists(st.tuples(questions(0), body), max_size=2), body
    )
    together = st.builds(
        lambda a, b: with_bodies(B("control.together"), **{"do.1": a, "do.2": b}), body, body
    )
    return plain | repeat | loop | branch | together


def with_bodies(block: B, **bodies) -> B:
    block.bodies = {key: chain for key, chain in bodies.items() if chain}
    return block


def branches(condition: B, do: list, also: list, otherwise: list) -> B:
    groups = {"also": len(also), "otherwise": 1 if otherwise else 0}
    made = B("control.if", inputs={"condition": condition}, groups=groups)
    made.bodies = {"do": do}
    for number, (question, chain) in enumerate(also, start=1):
        made.inputs[f"also_condition.{number}"] = question
        made.bodies[f"also_do.{number}"] = chain
    if otherwise:
        made.bodies["otherwise_do.1"] = otherwise
    made.bodies = {key: chain for key, chain in made.bodies.items() if chain}
    return made


HATS = st.sampled_from(
    [
        B("event.started"),
        B("event.gesture", {"gesture": "karate", "again.1": "queue"}, groups={"repeated": 1}),
        B("event.human_state", {"state": "touched_head"}),
    ]
)
ENDS = st.sampled_from([[], [B("control.stop_program")]])
RULES = st.lists(
    st.builds(
        lambda hat, chain, end: [hat, *chain, *end], HATS, st.lists(statements(2), max_size=3), ENDS
    ),
    min_size=1,
    max_size=2,
)


@st.composite
def programs(draw) -> list[list[B]]:
    """The rules of a program; a function, as hypothesis would else print the whole grammar."""
    return draw(RULES)


def shape(project: Project, language) -> list:
    """A program without ids and places: what its blocks hold, in order."""
    names = {variable.id: variable.name for variable in project.variables}

    def told(block_id: str):
        block = project.blocks[block_id]
        definition = language.definitions[block.type]
        fields = {
            key: names.get(definition.value(block, key), definition.value(block, key))
            for key, slot in definition.keys(block.groups)
            if slot.kind.typed and key not in block.inputs
        }
        inputs = {key: told(inner) for key, inner in sorted(block.inputs.items())}
        bodies = {key: [told(i) for i in chain] for key, chain in sorted(block.bodies.items())}
        groups = {name: count for name, count in block.groups.items() if count}
        return (block.type, fields, inputs, bodies, groups, block.comment)

    return [[told(i) for i in stack.body] for stack in project.pages["behaviour"]]


@given(rules=programs())
def test_blocks_become_code_and_the_same_blocks_again(language, rules):
    project = sound(language, *rules).project
    text = generate_program(project, language).text

    read = read_program(text, language)

    assert shape(read, language) == shape(project, language)
    assert generate_program(read, language).text == text


@given(rules=programs(), others=programs())
def test_any_program_can_be_edited_into_any_other(language, rules, others):
    editor = sound(language, *rules)
    wanted = generate_program(sound(language, *others).project, language).text
    before = to_bytes(editor.project)

    update_from_python(editor, wanted)

    assert generate_program(editor.project, language).text == wanted
    after = to_bytes(editor.project)
    if after != before:
        editor.history.undo()
        assert to_bytes(editor.project) == before
        editor.history.redo()
        assert to_bytes(editor.project) == after


X, Y = (B("variable.get", {"variable": variable}) for variable in ("v1", "v2"))
GIVEN = B("my.parameter.own.given")
SAYS_X = B("robot.say", inputs={"text": X})
A_TEXT, ONE = B("text.text", {"text": "a"}), B("math.number", {"number": 1})
ABSOLUTE = B("math.function", {"function": "absolute"}, {"number": ONE})
ROUNDED = B("math.round", {"way": "nearest"}, {"number": GIVEN})
LETTER = B("text.letter", inputs={"text": GIVEN, "number": ONE})
TRUE = B("logic.truth", {"truth": "true"})
CHOSEN = B("logic.choose", inputs={"condition": TRUE, "a": GIVEN, "b": A_TEXT})
LESS = B("math.function", {"function": "minus", "number": -1})
BACK_TO_ITSELF = {"variable": "v1", "first": -1, "last": -1, "step": -1, "way": "down"}
COUNTED_DOWN = B("control.count", BACK_TO_ITSELF, bodies={"do": [SAYS_X]})
DEFINED, STARTED = B("my.define.own"), B("event.started")
STOP = [B("control.stop_rule")]
STOPS_ANYWAY = B("control.if", bodies={"do": STOP, "otherwise_do.1": STOP}, groups={"otherwise": 1})


def set_x(value: B) -> B:
    return B("variable.set", {"variable": "v1"}, {"value": value})


def added(a: B, b: B) -> B:
    return B("math.arithmetic", {"operation": "add"}, {"a": a, "b": b})


def joined(a: B, b: B) -> B:
    return B("text.join", inputs={"item.1": a, "item.2": b}, groups={"item": 2})


ALL_OF_X = B("list.part", {"first": 1}, {"last": B("list.length", inputs={"list": X}), "list": X})
ITEMS = B("list.create", {"item.1": 1, "item.2": 2}, groups={"item": 2})
SAID_IN_TWO_WAYS = {
    "a part of all of it": [
        [STARTED, set_x(ITEMS), set_x(B("list.part", {"first": 1, "last": 1}, {"list": ALL_OF_X}))]
    ],
    "added to itself": [[STARTED, set_x(A_TEXT), set_x(added(X, X)), SAYS_X]],
    "set, not changed": [[STARTED, set_x(A_TEXT), set_x(added(X, ABSOLUTE)), SAYS_X]],
    "inside": [
        [STARTED, set_x(A_TEXT), B("control.forever", bodies={"do": [set_x(added(X, X)), SAYS_X]})]
    ],
    "joined, not appended": [[STARTED, set_x(ONE), set_x(joined(X, Y)), SAYS_X]],
    "said by nobody": [[STARTED, STOPS_ANYWAY, SAYS_X]],
    "rounded for nobody": [
        [DEFINED, B("control.repeat", inputs={"times": ROUNDED}, bodies={"do": [SAYS_X]})]
    ],
    "a text for any value": [
        [DEFINED, set_x(joined(X, GIVEN)), SAYS_X],
        [STARTED, B("my.call.own", inputs={"given": B("text.text", inputs={"text": Y})})],
    ],
    "after what was tried": [[STARTED, B("control.try", bodies={"otherwise": [COUNTED_DOWN]})]],
    "a letter for nobody": [[DEFINED, set_x(LETTER), SAYS_X]],
    "appended for nobody": [
        [DEFINED, set_x(A_TEXT), B("text.append", {"variable": "v1"}, {"text": CHOSEN})],
        [STARTED, set_x(A_TEXT), SAYS_X],
    ],
    "less than nothing less": [
        [STARTED, B("variable.change", {"variable": "v1"}, {"amount": LESS})]
    ],
}


@pytest.mark.parametrize("rules", SAID_IN_TWO_WAYS.values(), ids=SAID_IN_TWO_WAYS)
def test_what_two_blocks_may_say_is_the_one_that_says_it_here(language, rules):
    editor = Editor(Project("Ways"), language)
    editor.apply(AddProcedure(Procedure("own", ("own", Parameter("given", "who", "any"))), 0))
    build(language, *rules, variables=("x", "y"), editor=editor)
    text = generate_program(editor.project, language).text

    read = read_program(text, language, Project())

    assert generate_program(read, language).text == text
    assert not [b for b in read.blocks.values() if b.type.startswith("code.")]
