"""What a person types finds the page that they mean."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.help.index import Findable, Index, words_of
from nep_studio.run.installation import studio_language
from nep_studio.ui.plugins.help.repository import Book
from nep_studio.ui.words import use_language


def index_of(book: Book) -> Index:
    index = book.new_index()
    for findable in book.findables():
        index.add(findable)
    return index


INDEX = index_of(Book(studio_language()))


def found(typed: str) -> list[str]:
    return [hit.page for hit in INDEX.search(typed)]


@pytest.mark.parametrize(
    ("typed", "page"),
    [
        ("say", "block/robot.say"),
        ("speak", "block/robot.say"),
        ("loop", "block/control.repeat"),
        ("dance", "block/robot.play"),
        ("dice", "block/math.random_integer"),
        ("parallel", "block/control.together"),
        ("photo", "block/robot_camera.take_picture"),
        ("gestrue", "howto/teach-gestures"),
        ("wizard of oz", "howto/cue-panel"),
        ("real robot", "howto/connect-nao"),
        ("how do I connect a phone", "howto/connect-watch"),
        ("smartwatch", "howto/connect-watch"),
        ("breakpoint", "howto/run-and-stop"),
        ("glossary", "howto/words"),
        ("shortcut", "howto/keyboard"),
        ("master does not answer", "howto/problems"),
        ("own language", "howto/write-a-node"),
        ("certainty", "node/perceptual/gesture"),
        ("KARÁTE", "block/event.gesture"),
        ("leds", "block/robot.leds"),
    ],
)
def test_words_find_the_page_that_is_meant_among_the_first(typed, page):
    assert page in found(typed)[:4]


def test_every_block_is_found_by_what_it_says():
    book = Book(studio_language())
    for definition in book.language.definitions.values():
        page = f"block/{definition.id}"
        if not any(letter.isalpha() for letter in book.titles[page]):
            continue  # a number says its value only
        assert page in found(book.titles[page])[:3], definition.id


def test_every_how_to_page_is_the_first_for_its_title():
    book = Book(studio_language())
    for page, title in book.titles.items():
        if page.startswith("howto/"):
            assert found(title)[0] == page


def test_nothing_is_found_for_nothing_and_for_nonsense():
    assert found("") == found("   ") == found("?!") == found("xqzw") == []


def test_blocks_are_found_in_another_language():
    use_language("de")
    try:
        german = index_of(Book(studio_language("de")))
    finally:
        use_language("en")

    assert "block/robot.say" in [hit.page for hit in german.search("sagt")][:3]
    assert "block/control.wait" in [hit.page for hit in german.search("warten")][:4]


def test_writing_without_spaces_is_found_by_its_signs():
    assert words_of("待つ秒") == ["待つ", "つ秒"]
    index = Index()
    index.add(Findable("p", "10秒間待つ"))

    assert [hit.page for hit in index.search("待つ")] == ["p"]


@given(st.text(max_size=40))
def test_whatever_is_typed_the_best_come_first_and_each_once(typed):
    hits = INDEX.search(typed)

    assert [hit.score for hit in hits] == sorted((hit.score for hit in hits), reverse=True)
    assert len({hit.page for hit in hits}) == len(hits)
