"""What the gallery says of the examples, and how the examples are made."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

import pytest

from nep_core.wire.messages import HUMAN_BEHAVIOR, SENSE_REQUEST
from nep_studio.blocks.checks import check
from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.files import load
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import LANGUAGES, Block, Project
from nep_studio.project.example_texts import texts_in, texts_of_examples, translate
from nep_studio.project.examples import Example, Try, examples
from nep_studio.run.installation import all_problems, studio_language
from nep_studio.run.plan import VIRTUAL_WATCH, Choices, plan
from nep_studio.ui.words import tr, use_language

EXAMPLES = examples()
MOST_BLOCKS = 50
TOLD = re.compile(r"Change first: ")


@pytest.fixture(params=EXAMPLES, ids=lambda example: example.path.stem)
def example(request: pytest.FixtureRequest) -> Example:
    return request.param


def test_there_are_examples_enough_and_each_is_told_of() -> None:
    assert len(EXAMPLES) >= 14
    assert len({each.title for each in EXAMPLES}) == len(EXAMPLES)
    assert all(str(each.sentence).endswith(".") and each.tags for each in EXAMPLES)


def test_an_example_is_short_and_nothing_in_it_has_to_be_put_right(example: Example) -> None:
    language = studio_language()
    project = load(example.path, language)

    assert check(project, language) == []
    assert project.name == example.title
    assert len(project.blocks) <= MOST_BLOCKS


def test_a_note_says_what_it_shows_and_what_to_change_first(example: Example) -> None:
    project = load(example.path, studio_language())

    notes = [note for note in project.notes.values() if note.page == "behaviour"]
    assert len(notes) == 1 and TOLD.search(notes[0].text)


def test_an_example_needs_what_it_says(example: Example) -> None:
    language = studio_language()
    project = load(example.path, language)
    nodes = plan(project, language, Choices(), example.path.parent)
    robots = robot_entries(project, language)

    assert ("watch" in example.needs) == any(node.node == VIRTUAL_WATCH for node in nodes)
    assert ("two_robots" in example.needs) == (len(robots) == 2)
    assert all(robot.driver == "virtual" for robot in robots)
    assert {"touch"} <= set(example.needs) or not any(each.is_touch for each in example.tries)


def test_what_is_tried_is_a_state_or_something_that_a_robot_notices() -> None:
    chop = Try("Make a karate chop", state="gesture_karate")
    touch = Try("Touch its head", sense="head_middle")

    assert (chop.topic, chop.message().human_state) == (HUMAN_BEHAVIOR, "gesture_karate")
    assert (touch.topic, touch.message().sense, touch.message().value) == (
        SENSE_REQUEST,
        "head_middle",
        1.0,
    )
    assert touch.is_touch and touch.release().value == 0.0
    assert not chop.is_touch


def test_each_thing_to_try_can_be_sent(example: Example) -> None:
    for each in example.tries:
        assert bool(each.state) != bool(each.sense), each
        assert each.words


# In other languages


@pytest.fixture(params=LANGUAGES[1:])
def code(request: pytest.FixtureRequest) -> Iterator[str]:
    """A language that is not English, for the window too."""
    use_language(request.param)
    yield request.param
    use_language("en")


language_in = cache(studio_language)


def told(example: Example, code: str) -> tuple[Project, Language]:
    """An example as somebody who speaks that language opens it."""
    language = language_in(code)
    project = load(example.path, language)
    translate(project, example.path.stem, language, code)
    return project, language


def test_every_text_of_an_example_is_translated(example: Example, code: str) -> None:
    language = language_in(code)
    texts = set(texts_in(load(example.path, language), language))

    known = texts_of_examples(code)[example.path.stem]

    assert {text for text in texts if re.search(r"\w", text)} - known.keys() == set()
    assert known.keys() - texts == set()
    assert all(said.strip() for said in known.values())


def test_a_translated_example_is_in_order_and_makes_python(example: Example, code: str) -> None:
    english = load(example.path, language_in("en"))
    project, language = told(example, code)

    assert all_problems(project, language, example.path.parent) == all_problems(
        load(example.path, language), language, example.path.parent
    )
    python = generate_program(project, language).text
    compile(python, example.path.stem, "exec")
    assert f'language="{code}"' in python
    before = {block.id: shape_of(block) for block in english.blocks.values()}
    assert {block.id: shape_of(block) for block in project.blocks.values()} == before


def shape_of(block: Block) -> dict[str, object]:
    """The fields of a block that no language changes, and that the others are there."""
    names = ["text", "question", "word", "item", "key", "value", "name", "who"]
    if block.type.startswith("state."):
        names += ["state", "target"]
    return {
        key: isinstance(value, str) if key.partition(".")[0] in names else value
        for key, value in block.fields.items()
    }


def test_a_state_is_called_alike_wherever_it_stands(code: str) -> None:
    example = next(each for each in examples() if each.path.stem == "reception")

    project, _ = told(example, code)

    ways = [block for block in project.blocks.values() if block.type.startswith("state.")]
    begun = {way.fields["state"] for way in ways if way.type == "state.begins"}
    left = {way.fields[key] for way in ways for key in ("state", "target") if key in way.fields}
    assert left == begun and len(begun) == 3
    assert "listening" not in begun


def test_spaces_between_joined_words_stay_where_a_language_has_them(code: str) -> None:
    if code == "ja":
        return
    texts = [pair for table in texts_of_examples(code).values() for pair in table.items()]

    wrong = [
        english
        for english, said in texts
        if (english[0] == " ", english[-1] == " ") != (said[0] == " ", said[-1] == " ")
    ]
    assert wrong == []


def test_what_the_gallery_says_to_try_is_what_a_translated_example_hears(
    example: Example, code: str
) -> None:
    project, _ = told(example, code)
    heard = {
        value.casefold()
        for block in project.blocks.values()
        for key, value in block.fields.items()
        if key.startswith(("word", "value")) and isinstance(value, str)
    }

    for one in example.tries:
        if one.sense == "word":
            assert any(word in tr(one.words).casefold() for word in heard), tr(one.words)


def test_a_new_block_speaks_the_language_and_a_saved_one_means_what_it_meant(code: str) -> None:
    language = language_in(code)
    say, part = language.definitions["robot.say"], language.definitions["text.contains"]

    assert say.new_block("b1").fields["text"] not in ("", "Hello")
    assert say.defaults["text"] == "Hello"
    fresh = part.new_block("b2").fields
    assert str(fresh["part"]) in str(fresh["text"])
