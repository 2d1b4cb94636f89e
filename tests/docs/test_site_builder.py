"""The builder of the site refuses pages that lead nowhere or hold what it cannot show."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from nep_studio.paths import documentation_folder, first_page
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.words import available_languages
from tests.conftest import PROJECT
from tests.ui.theme.colour_seeing import contrast
from tools.website.frame import Site
from tools.website.page import Page, for_browsers, slug, word
from tools.website.pictures import NAMES, USED_WHEN
from tools.website.written import WrongPage, page_of

GROUPS = {"en": {"start": "Begin here"}, "de": {"start": "Anfang"}}
READ_ON = ("canvas", "panel", "panel_alt", "info_panel", "menu")


def framed(body: str, *more: Page, path: str = "a/b.html") -> tuple[Site, str]:
    page = Page(path, "T", f'<h1 id="t">T</h1>{body}', "start")
    site = Site([page, *more], GROUPS, ["images/x.png", "images/nep-studio.svg"])
    return site, site.framed(page)


def read(tmp_path: Path, text: str) -> Page:
    source = tmp_path / "page.md"
    source.write_text(text, encoding="utf-8")
    return page_of(source, "p.html", "start", lambda link: link, {})


def test_addresses_become_relative_to_the_page() -> None:
    other = Page("c.html", "C", "<h1>C</h1>", "start")

    site, html = framed('<a href="@/c.html#x">c</a> <img src="@/images/x.png" alt="x"/>', other)

    assert '<a href="../c.html#x">' in html and 'src="../images/x.png"' in html
    assert site.wrong_links == []


@pytest.mark.parametrize("body", ['<a href="@/gone.html">g</a>', '<img src="@/images/y.png"/>'])
def test_an_address_that_leads_nowhere_is_told(body: str) -> None:
    site, _ = framed(body)

    assert len(site.wrong_links) == 1 and "a/b.html" in site.wrong_links[0]


def test_a_page_that_is_only_there_in_english_is_reached_from_other_languages() -> None:
    english = Page("c.html", "C", "<h1>C</h1>", "start")
    german = Page("d.html", "D", '<h1>D</h1><a href="@/c.html">c</a>', "start", "de")
    site = Site([english, german], GROUPS, ["images/nep-studio.svg"])

    html = site.framed(german)

    assert '<a href="../c.html">c</a>' in html and site.wrong_links == []


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("No title.\n", "no title"),
        ("# T\n\n<div>x</div>\n", "HTML"),
        ("# T\n\n![a picture](nowhere.png)\n", "no picture"),
        ("# T\n\n![](nowhere.png)\n", "no words"),
    ],
)
def test_a_page_that_cannot_be_shown_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    with pytest.raises(WrongPage, match=reason):
        read(tmp_path, text)


def test_a_written_page_has_anchors_boxes_to_tick_and_no_comments(tmp_path: Path) -> None:
    page = read(
        tmp_path, "# T\n<!-- about: A page. -->\n\n## It is `so` & so\n\n- [ ] Tick *it*.\n"
    )

    assert page.about == "A page." and "<!--" not in page.body
    assert [part.anchor for part in page.parts] == ["t", "it-is-so--so"]
    assert '<input type="checkbox"/> <span>Tick <em>it</em>.</span>' in page.body


def test_pages_of_the_help_become_pages_for_browsers() -> None:
    html = (
        '<h2><a name="x"></a>X</h2><ul><li class="unchecked">a<br>b</li></ul><a href="help:y">y</a>'
    )

    assert for_browsers(html, lambda name: f"@/{name}.html") == (
        '<h2 id="x">X</h2><ul><li class="check"><label><input type="checkbox"/> '
        '<span>a<br/>b</span></label></li></ul><a href="@/y.html">y</a>'
    )


def test_anchors_are_those_of_github() -> None:
    assert slug("Numbers: what is lost, is counted") == "numbers-what-is-lost-is-counted"


@pytest.mark.parametrize("theme", USED_WHEN)
def test_words_can_be_read_on_everything_that_they_stand_on(theme: str) -> None:
    table = load_theme(theme)
    assert set(READ_ON) <= set(NAMES)
    for ground in READ_ON:
        for words in ("text", "link"):
            assert contrast(table.colour(words), table.colour(ground)) >= 4.5, (words, ground)
    for ground in ("canvas", "panel", "menu"):
        assert contrast(table.colour("muted"), table.colour(ground)) >= 4.5, ground


def test_the_frame_speaks_every_language_of_the_window() -> None:
    names = ("skip", "contents", "search", "found", "none", "documentation", "intro")
    for language in available_languages():
        assert all(word(language, name) for name in names)


def test_the_program_finds_its_pages_in_its_language_or_in_english(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert documentation_folder() == PROJECT / "build" / "site"
    monkeypatch.setattr(sys, "_MEIPASS", str(tmp_path), raising=False)

    assert first_page("de") is None
    (tmp_path / "documentation" / "de").mkdir(parents=True)
    (tmp_path / "documentation" / "index.html").touch()
    assert first_page("de") == tmp_path / "documentation" / "index.html"
    (tmp_path / "documentation" / "de" / "index.html").touch()
    assert first_page("de") == tmp_path / "documentation" / "de" / "index.html"
