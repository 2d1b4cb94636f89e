"""A few letters find what is meant, and the best comes first."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.ui.shell.commands import Command, match, ranked

WORDS = [
    "Save",
    "Save as…",
    "Save the Python…",
    "Show all",
    "Keyboard shortcuts",
    "Copy the Python",
    "Close the project",
    "Größe des Texts",
    "テーマを選ぶ",
    "Like the computer's",
    "Cut",
]
TITLES = st.text(st.characters(categories=("L", "Nd", "Zs")), min_size=1, max_size=30).filter(
    lambda text: text.strip()
)


def commands(*words: str) -> list[Command]:
    return [Command(word, word, lambda: None) for word in words or WORDS]


def found(typed: str, *recent: str) -> list[str]:
    return [one.command.words for one in ranked(commands(), typed, recent)]


@pytest.mark.parametrize(
    ("typed", "first"),
    [
        ("save", "Save"),
        ("SAVE AS", "Save as…"),
        ("python save", "Save the Python…"),
        ("stp", "Save the Python…"),
        ("keybord", "Keyboard shortcuts"),
        ("shortc", "Keyboard shortcuts"),
        ("grosse", "Größe des Texts"),
        ("größe", "Größe des Texts"),
        ("テーマ", "テーマを選ぶ"),
        ("選", "テーマを選ぶ"),
        ("cut", "Cut"),
    ],
)
def test_what_is_meant_comes_first(typed: str, first: str) -> None:
    assert found(typed)[0] == first


def test_letters_that_lie_about_by_chance_are_no_match() -> None:
    assert "Like the computer's" not in found("cut")


def test_nothing_is_found_for_nonsense() -> None:
    assert found("xyzzy") == []


def test_with_nothing_typed_what_was_used_last_comes_first() -> None:
    assert found("", "Show all", "Cut")[:3] == ["Show all", "Cut", "Save"]


def test_what_was_used_last_wins_between_equals() -> None:
    assert found("the")[0] != "Close the project"
    assert found("the", "Close the project")[0] == "Close the project"


def test_a_better_match_beats_what_was_used_last() -> None:
    assert found("save", "Save the Python…")[0] == "Save"


def test_what_cannot_be_used_now_comes_after_its_equals() -> None:
    off = Command("a", "Undo one", lambda: None, why_not="Nothing has been changed yet.")
    on = Command("b", "Undo two", lambda: None)

    rows = ranked([off, on], "undo", [])

    assert [row.command.id for row in rows] == ["b", "a"]


@given(TITLES)
def test_every_command_is_found_by_its_own_words(words: str) -> None:
    assert match(words, words) is not None


@given(TITLES, TITLES)
def test_the_letters_that_are_shown_as_found_are_in_the_words(typed: str, words: str) -> None:
    fit = match(typed, words)

    if fit is not None:
        assert all(0 <= letter < len(words) for letter in fit.letters)
        assert list(fit.letters) == sorted(set(fit.letters))


@given(TITLES)
def test_the_start_of_a_word_finds_it(words: str) -> None:
    first = words.split()[0]

    assert match(first[: max(1, len(first) // 2)], words) is not None
