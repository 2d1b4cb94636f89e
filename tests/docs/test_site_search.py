"""The search of the site finds pages without a server, run as a browser runs it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable

import pytest
from PySide6.QtQml import QJSEngine

from tests.docs.conftest import LANGUAGES, MadeSite

Search = Callable[[str, str], list[str]]


@pytest.fixture
def search(made_site: MadeSite, qapp: object) -> Search:
    """Gives the addresses that are found in a language."""

    def find(language: str, typed: str) -> list[str]:
        engine = QJSEngine()
        script = made_site.text(f"search-{language}.js") + made_site.text("search.js")
        asked = (
            f"JSON.stringify(find(prepared(NEP_PAGES), {json.dumps(typed)}).map(h => h.address))"
        )
        answer = engine.evaluate(script + asked)
        assert not answer.isError(), answer.toString()
        found: list[str] = json.loads(answer.toString())
        return found

    return find


@pytest.mark.parametrize(
    ("language", "typed", "first"),
    [
        ("en", "how do I connect a nao", "how-to/connect-nao.html"),
        ("en", "conect nao", "how-to/connect-nao.html"),
        ("en", "lesson", "teachers.html#a-lesson-of-45-minutes-the-karate-story"),
        ("en", "port already in use", "problems.html#error-a-port-is-already-in-use"),
        ("en", "takes the posture", "blocks/robot.html#robot.do"),
        ("en", "human_behavior", "messages.html#human_behavior"),
        ("de", "Gesten beibringen", "how-to/teach-gestures.html"),
    ],
)
def test_the_page_that_was_meant_comes_first(
    search: Search, language: str, typed: str, first: str
) -> None:
    found = search(language, typed)

    assert first in found[:3], found[:6]


def test_what_there_is_not_is_not_found(search: Search) -> None:
    assert search("en", "zzzqqq") == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_everything_that_can_be_found_is_there(made_site: MadeSite, language: str) -> None:
    text = made_site.text(f"search-{language}.js").removeprefix("const NEP_PAGES = ")
    entries = json.loads(text.strip().removesuffix(";"))

    folder = "" if language == "en" else f"{language}/"
    for address, *_ in entries:
        path, _, anchor = address.partition("#")
        assert not anchor or anchor in made_site.anchors(folder + path), address
        assert folder + path in made_site.pages
    assert len(entries) > 250
    assert not [text for *_, text in entries if re.search("<(p|td|li|code|svg)[ >]", text)]
