"""Typing a sentence: what is suggested, what it fills in, how fast, and what is made."""

from __future__ import annotations

from dataclasses import replace

import pytest
from block_building import B, build

from nep_studio.blocks.definitions import parse, slots_of
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.moving import create_and_drop
from nep_studio.blocks.places import InInput, InStack
from nep_studio.blocks.program import Project
from nep_studio.blocks.typing_in.suggesting import clip_of_suggestion, fitting, suggestions


@pytest.fixture
def editor(language):
    return build(
        language,
        [B("event.started"), B("robot.say", {"text": "a"}), B("control.wait")],
        variables=("score", "x"),
    )


def best(text, editor, **options):
    return suggestions(text, editor.language, editor.project, **options)[0]


def create(editor, suggestion, place):
    return create_and_drop(editor, clip_of_suggestion(editor, suggestion), place)[0]


@pytest.mark.parametrize(
    ("text", "block_type", "fields"),
    [
        ("say hello", "robot.say", {"text": "hello"}),
        ("say hello my friend", "robot.say", {"text": "hello my friend"}),
        ("repeat 10", "control.repeat", {"times": 10}),
        ("wait 2", "control.wait", {"seconds": 2}),
        ("wait 2 seconds", "control.wait", {"seconds": 2}),
        ("pause 0,5", "control.wait", {"seconds": 0.5}),
        ("when karate", "event.gesture", {"gesture": "karate"}),
        ("set score to 5", "variable.set", {"variable": "v1", "value": 5}),
        ("change score by 2", "variable.change", {"variable": "v1", "amount": 2}),
        ("if", "control.if", {}),
        ("forever", "control.forever", {}),
        ("ferever", "control.forever", {}),
        ("42", "math.number", {"number": 42}),
        ('"hello"', "text.text", {"text": "hello"}),
        ("score", "variable.get", {"variable": "v1"}),
        ("posture sit", "robot.do", {"posture": "posture_sit"}),
        ("nao walks 0.5", "robot.walk", {"robot": "NAO", "forward": 0.5}),
        ("wait until", "control.wait_until", {}),
        ("tell dance", "event.tell", {"message": "dance"}),
        ("every 5 seconds", "time.every", {"seconds": 5}),
        ("at 17:30", "time.at", {"time": "17:30"}),
        ("stop the rule when the program starts", "control.stop_other_rule", {"rule": "b4"}),
    ],
)
def test_a_typed_sentence_suggests_its_block_with_its_values(editor, text, block_type, fields):
    found = best(text, editor)

    assert found.block_type == block_type
    assert dict(found.fields) == fields


@pytest.mark.parametrize(
    ("text", "fields"),
    [
        ("when the gesture karate is made if it comes again start again", {"again.1": "restart"}),
        ("when karate if it comes again do it again after", {"again.1": "queue"}),
        ("when the gesture karate is made if it comes again", {}),
    ],
)
def test_what_unfolds_in_a_sentence_can_be_typed_with_it(editor, text, fields):
    found = best(text, editor)

    assert found.block_type == "event.gesture"
    assert dict(found.fields) == {"gesture": "karate", **fields}
    assert found.made.groups == {"repeated": 1}
    assert "if it comes again" in found.label


def test_what_is_not_typed_stays_folded(editor):
    found = best("when the gesture karate is made", editor)

    assert found.block_type == "event.gesture" and not found.made.groups
    assert found.label == "when the gesture karate is made"


def test_words_may_come_in_any_order_and_only_begin(editor):
    assert best("seconds wait 3", editor).fields == {"seconds": 3}
    assert best("rep 4", editor).block_type == "control.repeat"


@pytest.mark.parametrize(
    ("text", "types"),
    [
        ("x + 1", ["math.arithmetic", "variable.get"]),
        ("(x + 1) * 2", ["math.arithmetic", "math.arithmetic", "variable.get"]),
        ("score > 3", ["logic.compare", "variable.get"]),
        ("2 × 3", ["math.arithmetic"]),  # noqa: RUF001 the sign that people type
        ("if score > 3", ["control.if", "logic.compare", "variable.get"]),
        ("wait x + 1", ["control.wait", "math.arithmetic", "variable.get"]),
        ("say score", ["robot.say", "variable.get"]),
    ],
)
def test_expressions_become_nested_blocks(editor, text, types):
    new = create(editor, best(text, editor), editor.new_stack("behaviour", 0, 0))

    assert [block.type for block in editor.project.within([new])] == types


@pytest.mark.parametrize(
    ("text", "times"), [("say hello twice", 2), ("say hello 5 times", 5), ("wave thrice", 3)]
)
def test_twice_puts_the_block_into_a_repeat(editor, text, times):
    before = len(editor.project.blocks)

    found = best(text, editor)
    new = create(editor, found, InStack(editor.project.pages["behaviour"][0].id, 1))

    block = editor.project.blocks[new]
    assert (block.type, block.fields["times"]) == ("control.repeat", times)
    assert len(block.bodies["do"]) == 1
    assert len(editor.project.blocks) == before + 2
    editor.history.undo()
    assert len(editor.project.blocks) == before


def test_a_variable_that_is_not_there_yet_is_made_in_the_same_step(editor):
    found = best("set points to 3", editor)

    create(editor, found, editor.new_stack("behaviour", 0, 0))

    assert [variable.name for variable in editor.project.variables] == ["score", "x", "points"]
    editor.history.undo()
    assert [variable.name for variable in editor.project.variables] == ["score", "x"]


def test_the_label_says_the_sentence_and_marks_what_was_typed(editor):
    found = best("say hello", editor)

    assert "hello" in found.label
    assert [found.label[a:b] for a, b in found.spans] == ["say", "hello"]


def test_only_blocks_that_fit_the_place_are_suggested(editor):
    wait = editor.project.pages["behaviour"][0].body[2]
    place = InInput(wait, "seconds")

    found = suggestions("r", editor.language, editor.project, fitting(editor, place), limit=50)

    results = {editor.language.definitions[s.block_type].result for s in found}
    assert found and results <= {"number", "any"}


def test_recent_blocks_come_first_among_equals_and_when_nothing_is_typed(editor):
    recents = ["variable.change", "control.wait"]

    assert [
        s.block_type for s in suggestions("", editor.language, editor.project, recents=recents)
    ] == recents
    plain = [s.block_type for s in suggestions("w", editor.language, editor.project, limit=40)]
    ranked = [
        s.block_type
        for s in suggestions(
            "w", editor.language, editor.project, recents=["control.wait_until"], limit=40
        )
    ]
    assert ranked.index("control.wait_until") <= plain.index("control.wait_until")


def test_nonsense_suggests_nothing(editor):
    assert suggestions("qwxz vbnm", editor.language, editor.project) == []


def test_the_sentences_of_another_language_are_understood_without_accents(language):
    parts = parse("{robot:robot} dit {text:text} à la fenêtre {gesture:choice(say_gestures)}")
    say = replace(language.definitions["robot.say"], parts=parts, slots=slots_of(parts))
    french = Language(
        {**language.definitions, "robot.say": say},
        language.categories,
        language.choices,
        language.profiles,
    )

    found = suggestions("dit bonjour a la fenetre", french, Project())[0]

    assert (found.block_type, dict(found.fields)) == ("robot.say", {"text": "bonjour"})


@pytest.mark.parametrize(
    ("text", "block_type", "places"),
    [
        ("nao plays the animation favourite", "robot.play", ["animation"]),
        ("which plays the animation favourite", "robot.play", ["animation", "robot"]),
        ("nao plays the animation wave", "robot.play", []),
        ("nao takes the posture favourite", "robot.do", ["posture"]),
        ("nao looks at people by itself favourite", "robot_moves.awareness", ["on"]),
        ("nao lights all lights in favourite", "robot.leds", ["colour"]),
        ("remember favourite for 5", "sensing.remember", ["state"]),
    ],
)
def test_the_name_of_a_variable_goes_where_a_word_is_chosen(language, text, block_type, places):
    rule = [B("event.started"), B("robot.say")]
    editor = build(language, rule, variables=("favourite", "which"))

    place = InStack(editor.project.pages["behaviour"][0].id, 1)

    block = editor.project.blocks[create(editor, best(text, editor), place)]

    assert block.type == block_type
    assert sorted(block.inputs) == places
