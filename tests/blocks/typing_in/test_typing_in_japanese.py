"""Typing a sentence in a language that is written without spaces."""

from __future__ import annotations

import pytest
from block_building import B, add, build

from nep_studio.blocks.typing_in.suggesting import suggestions
from nep_studio.blocks.typing_in.vocabulary import spaced
from nep_studio.run.installation import studio_language


@pytest.fixture(scope="module")
def editor():
    made = build(studio_language("ja"), [B("event.started")], variables=("score",))
    add(made, B("robots.robot", {"name": "NAO"}), made.new_stack("robots", 40, 40))
    return made


@pytest.mark.parametrize(
    ("typed", "block_type", "fields"),
    [
        ("NAOがこんにちはと言う", "robot.say", {"robot": "NAO", "text": "こんにちは"}),
        ("さようならと言う", "robot.say", {"text": "さようなら"}),
        ("3回繰り返す", "control.repeat", {"times": 3}),
        ("2秒待つ", "control.wait", {"seconds": 2}),
        ("待つ 2", "control.wait", {"seconds": 2}),
        ("ずっと", "control.forever", {}),
        ("scoreを5にする", "variable.set", {"variable": "v1", "value": 5}),
        ("おじぎ", "robot.play", {"animation": "bow"}),
    ],
)
def test_a_sentence_without_spaces_suggests_its_block(editor, typed, block_type, fields) -> None:
    best = suggestions(typed, editor.language, editor.project)[0]

    assert best.block_type == block_type
    assert dict(best.fields) == fields


def test_the_end_of_a_glued_word_is_found_and_marked(editor) -> None:
    best = suggestions("繰り返す", editor.language, editor.project)[0]

    [(start, end)] = best.spans
    assert best.label[start:end] == "繰り返す"


@pytest.mark.parametrize("typed", ["say hello", "x+1", "“回 3”", "", "warten 2"])
def test_what_has_spaces_or_quotes_stays_as_it_is(typed) -> None:
    assert spaced(typed, {"回", "o", "1"}) == typed
