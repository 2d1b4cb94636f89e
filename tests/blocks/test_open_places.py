"""Which places take blocks: a block fits wherever a value of its kind is meant."""

from __future__ import annotations

import ast
from collections import Counter

import pytest
from block_building import B, build, read_program

from nep_core.program.choices import EMOTIONS
from nep_studio.blocks.closed import REASONS
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import PARAMETER_KINDS
from nep_studio.blocks.program import Parameter, Procedure, Project
from nep_studio.run.installation import load_language
from tests.blocks.conftest import RESOURCES

VARIABLE = B("variable.get", {"variable": "v1"})
GIVING = {
    "number": B("math.arithmetic", {"a": 2}, {"b": VARIABLE}),
    "text": B("text.join", {"item.1": "a"}, {"item.2": VARIABLE}),
    "boolean": B("logic.compare", {"b": 2}, {"a": VARIABLE}),
    "list": B("list.create", {"item.1": "a"}, {"item.2": VARIABLE}, groups={"item": 2}),
    "colour": B("colour.mix"),
    "robot": B("robot.named", {}, {"robot": VARIABLE}),
    "any": B("math.random_item", {}, {"list": VARIABLE}),
}
"""A block that gives each kind of result."""
WORDS = ("checkbox", "choice", "colour", "line", "robot", "state")
NO_PLACES = ("body", "parameter")
"""The kinds of slots that no value goes into."""
ALONE = ("my.return",)
"""Blocks that mean something only in the definition of an own block."""


def places(language: Language) -> list[tuple[Definition, Slot]]:
    return [
        (definition, slot)
        for definition in language.definitions.values()
        for slot in definition.slots.values()
        if slot.kind.name not in NO_PLACES
    ]


LANGUAGE = load_language(RESOURCES / "blocks", RESOURCES / "robots/nao/robot.toml")
OPEN = [
    (definition.id, slot.name)
    for definition, slot in places(LANGUAGE)
    if slot.pluggable and definition.id not in ALONE
]


def test_every_place_that_takes_no_block_says_why() -> None:
    closed = [(d, slot) for d, slot in places(LANGUAGE) if not slot.pluggable]

    assert [f"{d.id}.{slot.name}" for d, slot in closed if slot.closed not in REASONS] == []


def test_three_places_of_four_take_a_block() -> None:
    """Of 331 places, 178 took none before; only those are left for which there is a reason."""
    found = Counter(slot.closed or "open" for _, slot in places(LANGUAGE))

    assert found["open"] / found.total() > 0.75
    assert set(found) <= {"open", *REASONS}


def _colours(slot: Slot) -> list[B]:
    """Nothing is made a colour: the variable must hold one."""
    colour = B("variable.set", {"variable": "v1"}, {"value": B("colour.colour")})
    return [colour] if slot.kind.name == "colour" else []


def in_a_rule(definition: Definition, slot: Slot, plugged: B) -> list[B]:
    """A rule with a block in whose place another one stands."""
    key = f"{slot.name}.1" if slot.group else slot.name
    groups = {slot.group: max(1, definition.minimum.get(slot.group, 0))} if slot.group else {}
    block = B(definition.id, {}, {key: plugged}, {}, groups)
    if "variable" in definition.slots:
        block.fields["variable"] = "v2"
    if definition.shape == "hat":
        return [block, B("robot.say")]
    if definition.is_value:
        where = (
            ("control.if", "condition") if definition.result == "boolean" else ("robot.say", "text")
        )
        if definition.result == "list":
            where = ("control.for_each", "list")
        other = B(where[0], {}, {where[1]: block})
        if where[0] == "control.for_each":
            other.fields["variable"] = "v2"
        return [B("event.started"), *_colours(slot), other]
    if "in_loop" in definition.flags:
        block = B("control.forever", {}, {}, {"do": [block]})
    return [B("event.started"), *_colours(slot), block]


@pytest.mark.parametrize(("block", "place"), OPEN, ids=[f"{b}.{p}" for b, p in OPEN])
def test_a_variable_in_a_place_becomes_python_and_comes_back(
    language: Language, block: str, place: str
) -> None:
    definition = language.definitions[block]
    editor = build(
        language,
        in_a_rule(definition, definition.slots[place], VARIABLE),
        variables=("choice", "other"),
    )

    text = generate_program(editor.project, language).text
    project = read_program(text, language)

    ast.parse(text)
    assert not [b.type for b in project.blocks.values() if b.type.startswith("code.")]
    assert generate_program(project, language.of(project)).text == text


@pytest.mark.parametrize("result", GIVING)
def test_every_block_that_fits_becomes_python_that_comes_back(
    language: Language, result: str
) -> None:
    """All places where a word, a switch or a robot is meant, each in a program of its own.

    Random programs have the others in them.
    """
    wrong = []
    for name, place in OPEN:
        definition = language.definitions[name]
        slot = definition.slots[place]
        if result in slot.fits and slot.kind.name in WORDS:
            rule = in_a_rule(definition, slot, GIVING[result])
            editor = build(language, rule, variables=("choice", "other"))
            text = generate_program(editor.project, language).text
            project = read_program(text, language)
            if generate_program(project, language.of(project)).text != text:
                wrong.append((name, place))

    assert wrong == []


def test_the_looks_of_people_are_those_of_the_blocks(language: Language) -> None:
    assert dict(language.choices["emotions"]) == EMOTIONS


def test_a_robot_of_a_variable_is_asked_by_its_name_only_where_it_may_be_a_text(
    language: Language,
) -> None:
    """What is always a robot stands in Python by itself."""
    held = B("variable.get", {"variable": "v1"})
    put = B("variable.set", {"variable": "v1"}, {"value": B("robot.named")})
    told = B("variable.set", {"variable": "v1"}, {"value": B("text.text", {"text": "NAO"})})
    say = B("robot.say", {"text": "Hello"}, {"robot": held})

    plain = build(language, [B("event.started"), put, say], variables=("which",))
    careful = build(language, [B("event.started"), put, told, say], variables=("which",))

    assert '    which.say("Hello")' in generate_program(plain.project, language).text
    assert '    as_robot(which).say("Hello")' in generate_program(careful.project, language).text


def test_the_words_of_an_answer_are_worked_out_once(language: Language) -> None:
    word = B("math.random_item", {}, {"list": B("variable.get", {"variable": "v1"})})
    ask = B("robot_speech.ask", {}, {"word.1": word}, {"do.1": [B("robot.say")]}, {"answer": 1})
    editor = build(language, [B("event.started"), ask], variables=("words",))

    text = generate_program(editor.project, language).text

    assert text.count("random.choice(program.words)") == 1
    assert "if answer == expected_words[0]:" in text
    project = read_program(text, language)
    assert generate_program(project, language.of(project)).text == text


@pytest.mark.parametrize("kind", PARAMETER_KINDS)
def test_an_own_block_takes_a_value_of_each_kind(language: Language, kind: str) -> None:
    parts = ("show", Parameter("a1", "thing", kind))
    editor = Editor(Project("Test"), language)
    editor.apply(AddProcedure(Procedure("p1", parts, gives_value=True), 0))
    given, x = B("my.parameter.p1.a1"), editor.add_variable("x")
    own = editor.language
    if kind == "robot":
        use = B("robot.say", {}, {"robot": given})
    else:
        use = B("variable.set", {"variable": x}, {"value": given})
    shown = B("robot.say", {}, {"text": B("my.call.p1")})
    build(
        own,
        [B("my.define.p1"), use, B("my.return", {}, {"value": given})],
        [B("event.started"), shown],
        editor=editor,
    )

    text = generate_program(editor.project, editor.language).text
    project = read_program(text, language, editor.project)

    assert generate_program(project, language.of(project)).text == text


def test_a_list_of_robots_is_gone_through(language: Language) -> None:
    robots = B(
        "list.create",
        {},
        {
            "item.1": B("robot.named", {"robot": "NAO"}),
            "item.2": B("robot.named", {"robot": "Nelly"}),
        },
        groups={"item": 2},
    )
    held, each = (B("variable.get", {"variable": v}) for v in ("v1", "v2"))
    rule = [
        B("event.started"),
        B("variable.set", {"variable": "v1"}, {"value": robots}),
        B(
            "control.for_each",
            {"variable": "v2"},
            {"list": held},
            {"do": [B("robot.say", {}, {"robot": each, "text": each})]},
        ),
    ]
    editor = build(language, rule, variables=("robots", "one"))

    text = generate_program(editor.project, language).text

    assert "    robots = [nao, nelly]\n    for one in robots:\n" in text
    assert "        one.say(as_text(one))\n" in text
    project = read_program(text, language)
    assert generate_program(project, language.of(project)).text == text


def test_a_robot_is_given_to_an_own_block_as_it_is_or_by_its_name(language: Language) -> None:
    parts = ("greet", Parameter("a1", "who", "robot"))
    editor = Editor(Project("Test"), language)
    editor.apply(AddProcedure(Procedure("p1", parts, gives_value=False), 0))
    say = B("robot.say", {}, {"robot": B("my.parameter.p1.a1")})
    calls = [B("my.call.p1"), B("my.call.p1", {}, {"a1": B("text.text", {"text": "nao"})})]
    build(editor.language, [B("my.define.p1"), say], [B("event.started"), *calls], editor=editor)

    text = generate_program(editor.project, editor.language).text

    assert 'def greet(who):\n    who.say("Hello")' in text
    assert '    greet(nao)\n    greet(as_robot("nao"))' in text
    project = read_program(text, language, editor.project)
    assert generate_program(project, language.of(project)).text == text
    anew = read_program(text, language)
    assert generate_program(anew, language.of(anew)).text == text
