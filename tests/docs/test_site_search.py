"""The search of the site finds pages without a server, run as a browser runs it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable

import pytest
from PySide6.QtQml import QJSEngine

from tests.docs.conftest import LANGUAGES, MadeSite

Search = Callable[[str, str], list[str]]


@pytest.fixture(scope="module")
def search(made_site: MadeSite, qapp: object) -> Search:
    """Gives the addresses that are found in a language; one engine has the search for all."""
    engine = QJSEngine()
    asked = [made_site.text("search.js")]
    for language in LANGUAGES:
        files = (f"search-{language}.js", "search-guides.js")
        asked.append("var NEP_PAGES = [];" + "".join(made_site.text(name) for name in files))
        asked.append(f"var {language} = prepared(NEP_PAGES);")
    assert not engine.evaluate("\n".join(asked)).isError()

    def find(language: str, typed: str) -> list[str]:
        folder = "" if language == "en" else f"{language}/"
        found = f"find({language}, {json.dumps(typed)}, {json.dumps(folder)})"
        answer = engine.evaluate(f"JSON.stringify({found}.map(h => h.address))")
        assert not answer.isError(), answer.toString()
        addresses: list[str] = json.loads(answer.toString())
        return addresses

    return find


@pytest.mark.parametrize(
    ("language", "typed", "first"),
    [
        ("en", "how do I connect a nao", "how-to/connect-nao.html"),
        ("en", "conect nao", "how-to/connect-nao.html"),
        ("en", "the robot does nothing", "problems.html#nothing"),
        ("en", "lessn plan", "teachers.html"),
        ("en", "lesson", "teachers.html#a-lesson-of-45-minutes-the-karate-story"),
        ("en", "exhibit at power on", "museums.html"),
        ("en", "port already in use", "problems.html#error-a-port-is-already-in-use"),
        ("en", "takes the posture", "blocks/robot.html#robot.do"),
        ("en", "human_behavior", "messages.html#human_behavior"),
        ("ja", "授業", "teachers.html"),
        ("ja", "NAOをつなぐ", "ja/how-to/connect-nao.html"),
        ("ja", "ロボットが動かない", "ja/problems.html#nothing"),
    ],
)
def test_the_page_that_was_meant_comes_first(
    search: Search, language: str, typed: str, first: str
) -> None:
    found = search(language, typed)

    assert first in found[:3], found[:6]


def test_what_there_is_not_is_not_found(search: Search) -> None:
    assert search("en", "zzzqqq") == []


@pytest.mark.parametrize("name", [*LANGUAGES, "guides"])
def test_everything_that_can_be_found_is_there(made_site: MadeSite, name: str) -> None:
    text = made_site.text(f"search-{name}.js")
    entries = json.loads(text[text.index("[\n") :].strip().removesuffix(");"))

    for address, *_ in entries:
        path, _, anchor = address.partition("#")
        assert not anchor or anchor in made_site.anchors(path), address
        assert path in made_site.pages
    assert len(entries) > 150
    assert not [text for *_, text in entries if re.search("<(p|td|li|code|svg)[ >]", text)]
