"""Pages and texts of the help in other languages belong to English ones, and lead on as they do."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_studio.help import markdown
from nep_studio.help.texts import (
    ENGLISH,
    block_texts,
    category_texts,
    error_texts,
    examples,
    help_folder,
    node_texts,
    page_texts,
    split,
)
from nep_studio.ui.words import use_language

LANGUAGES = sorted(path.name for path in help_folder().iterdir() if path.is_dir())
OTHERS = [code for code in LANGUAGES if code != ENGLISH]
QUOTED = re.compile(r'"(?:[^"\\]|\\.)*"')


@pytest.fixture(params=OTHERS)
def spoken(request: pytest.FixtureRequest) -> Iterator[str]:
    """Each language in turn that has texts of its own."""
    use_language(request.param)
    yield request.param
    use_language(ENGLISH)


def tables(stem: str, code: str) -> dict[str, dict]:
    found: dict[str, dict] = {}
    for path in sorted((help_folder() / code).glob(f"{stem}*.toml")):
        found |= tomllib.loads(path.read_text(encoding="utf-8"))
    return found


def names_in(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_language_has_no_files_that_are_not_there_in_english(spoken):
    english = names_in(help_folder() / ENGLISH) | {"examples.toml"}

    assert names_in(help_folder() / spoken) - english == set()


def test_a_text_is_of_something_that_has_an_english_one(spoken):
    assert tables("blocks", spoken).keys() <= block_texts(ENGLISH).keys()
    assert tables("categories", spoken).keys() <= category_texts(ENGLISH).keys()
    assert tables("nodes", spoken).keys() <= node_texts(ENGLISH).keys()
    assert tables("errors", spoken).keys() <= error_texts(ENGLISH).keys()


def test_a_translated_block_text_tells_of_the_same_slots(spoken):
    for block, told in tables("blocks", spoken).items():
        if "slots" in told:
            assert told["slots"].keys() == block_texts(ENGLISH)[block].slots.keys(), block


def test_a_translated_text_of_an_example_is_in_an_example(spoken):
    quoted = [text for each in examples().values() for text in QUOTED.findall(each.program)]
    known = {tomllib.loads(f"text = {text}")["text"] for text in quoted}

    assert tables("examples", spoken).keys() <= known


def test_a_translated_page_has_the_headings_code_and_links_of_the_english_one(spoken):
    for name, source in page_texts(spoken).items():
        told = markdown.read(source)
        english = markdown.read(page_texts(ENGLISH)[name])

        assert [(h.depth, h.anchor) for h in told.headings] == [
            (h.depth, h.anchor) for h in english.headings
        ], name
        assert sorted(told.links) == sorted(english.links), name
        assert told.about["order"] == english.about["order"], name
        assert told.about["icon"] == english.about["icon"], name
        assert re.findall(r"^\{\{\w+\}\}$", source, re.M) == re.findall(
            r"^\{\{\w+\}\}$", page_texts(ENGLISH)[name], re.M
        ), name


def test_every_link_of_a_translated_page_leads_to_a_page(spoken, book):
    for name in book.titles:
        for link in re.findall('help:([^"]+)', book.page(name).html):
            assert split(link)[0] in book.titles, f"{name} leads to {link}"
