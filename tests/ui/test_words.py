"""The words of the window: translated, filled in, and never worse than English."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio import paths
from nep_studio.ui import words
from nep_studio.ui.words import (
    available_languages,
    count_words,
    is_right_to_left,
    language_code,
    tr,
    use_language,
)

TABLE = """
name = "Deutsch"
[window]
"Save" = "Sichern"
"Delete {count} blocks" = "{count} Blöcke löschen"
"1 block" = "1 Block"
"{n} blocks" = "{n} Blöcke"
"Open {name}" = "{nane} öffnen"
"Close {name}" = "{name!q} schließen {"
[blocks]
"wait" = "warte"
"""


@pytest.fixture(autouse=True)
def english_again() -> Iterator[None]:
    yield
    use_language("en")


@pytest.fixture
def german(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A table of a language, in use."""
    (tmp_path / "translations").mkdir()
    (tmp_path / "translations" / "de.toml").write_text(TABLE, encoding="utf-8")
    monkeypatch.setattr(paths, "resources", lambda: tmp_path)
    use_language("de")
    return "de"


def test_without_a_choice_the_words_are_english() -> None:
    assert (language_code(), tr("Save"), is_right_to_left()) == ("en", "Save", False)


def test_words_come_from_the_window_section_of_the_table(german: str) -> None:
    assert (tr("Save"), tr("wait")) == ("Sichern", "wait")


def test_values_are_filled_in(german: str) -> None:
    assert tr("Delete {count} blocks", count=3) == "3 Blöcke löschen"


def test_words_that_are_missing_are_english(german: str) -> None:
    assert tr("Undo {step}", step="move") == "Undo move"


@pytest.mark.parametrize("text", ["Open {name}", "Close {name}"])
def test_a_wrong_translation_gives_the_english_words(
    german: str, text: str, caplog: pytest.LogCaptureFixture
) -> None:
    assert tr(text, name="a.nep") == text.format(name="a.nep")
    assert "cannot be filled in" in caplog.text


def test_a_value_is_never_read_as_a_place_to_fill() -> None:
    assert tr("Open {name}", name="{name.__class__}") == "Open {name.__class__}"


def test_words_without_values_may_have_braces() -> None:
    assert tr("Write {robot} where it goes") == "Write {robot} where it goes"


@pytest.mark.parametrize(("count", "said"), [(0, "0 Blöcke"), (1, "1 Block"), (2, "2 Blöcke")])
def test_one_and_many_have_words_of_their_own(german: str, count: int, said: str) -> None:
    assert count_words(count, "1 block", "{n} blocks") == said


def test_a_language_without_a_table_leaves_the_window_english(german: str) -> None:
    use_language("tlh")

    assert (language_code(), tr("Save")) == ("en", "Save")


def test_the_languages_to_choose_from_are_english_and_those_with_a_table(german: str) -> None:
    assert available_languages() == {"en": "English", "de": "Deutsch"}


def test_every_shipped_table_can_be_used() -> None:
    for code in available_languages():
        use_language(code)

        assert language_code() == code


def test_the_made_up_language_is_longer_and_written_from_the_right() -> None:
    use_language("qps-rtl")

    said = tr("Delete {count} blocks", count=3)

    assert is_right_to_left()
    assert "3" in said
    assert len(said) >= 1.3 * len("Delete 3 blocks")
    assert "qps-rtl" not in available_languages()


def test_any_words_can_be_said_in_the_made_up_language() -> None:
    use_language(words.PSEUDO)  # once: it reads the tables of all languages

    @given(st.text())
    def say(text: str) -> None:
        assert len(tr(text)) >= len(text)
        assert isinstance(tr(text, name="x"), str)

    say()
