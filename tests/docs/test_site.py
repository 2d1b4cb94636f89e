"""The site can be read by everybody, from a folder, and nothing in it leads nowhere."""

from __future__ import annotations

import posixpath
import re
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from xml.etree.ElementTree import Element

import pytest

from nep_core.cli import COMMANDS
from nep_core.places import node_folders
from nep_core.processes.manifest import NodeCatalog, read_manifest
from nep_core.wire.messages import BY_TOPIC
from nep_studio.help.texts import error_anchor, error_texts
from nep_studio.run.installation import studio_language
from tests.conftest import PROJECT
from tests.docs.conftest import LANGUAGES, MadeSite

pytestmark = pytest.mark.long

ADDRESSES = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "srcset"}
LARGEST_MB = 16.0
THEME = "-(light|dark)$"
DOCS = PROJECT / "docs"
GUIDES = ("install", "first-program", "teachers", "museums", "developers", "study", "whats-new")


def addresses(page: Element) -> Iterator[tuple[str, str]]:
    """What a page leads to and shows: the element's name, and the address."""
    for element in page.iter():
        if (attribute := ADDRESSES.get(element.tag)) is not None:
            yield element.tag, element.attrib[attribute]


def headings(page: Element) -> list[int]:
    return [int(each.tag[1]) for each in page.iter() if re.fullmatch("h[1-6]", each.tag)]


def test_every_page_has_what_readers_of_all_kinds_need(made_site: MadeSite) -> None:
    for name, page in made_site.pages.items():
        tags = Counter(element.tag for element in page.iter())
        assert page.attrib["lang"] == ("ja" if name.startswith("ja/") else "en")
        assert (tags["main"], tags["header"], tags["footer"], tags["h1"]) == (1, 1, 1, 1), name
        assert (page.findtext("head/title") or "").strip(), name
        skip = page.find("body/a")
        assert skip is not None and skip.attrib["href"] == "#text", name
        main = page.find(".//main")
        assert main is not None
        steps = headings(main)
        assert all(b - a <= 1 for a, b in pairwise(steps)), name
        menu = page.find(".//nav[@class='languages']")
        assert menu is not None and len(list(menu.iter("a"))) == len(LANGUAGES) - 1, name
        labels = [{"aria-label", "aria-labelledby"} & set(nav.attrib) for nav in page.iter("nav")]
        assert all(labels), name


def read_aloud(element: Element) -> Iterator[str]:
    """The words of a part of a page, without code and drawings."""
    if element.tag not in ("code", "pre", "svg"):
        yield element.text or ""
        for inner in element:
            yield from read_aloud(inner)
            yield inner.tail or ""


def test_no_page_shows_how_it_is_written(made_site: MadeSite) -> None:
    for name, page in made_site.pages.items():
        main = page.find(".//main")
        assert main is not None
        words = "\n".join(read_aloud(main))
        found = re.search(r"`|\*\*|\]\(|\{\{|\{#|&[a-z]+;|</?[a-z]+>", words)
        assert found is None, (name, words[found.start() - 40 : found.end() + 40])


def test_every_picture_has_words_and_no_place_is_there_twice(made_site: MadeSite) -> None:
    for name, page in made_site.pages.items():
        ids = Counter(each.attrib["id"] for each in page.iter() if "id" in each.attrib)
        assert [each for each, count in ids.items() if count > 1] == [], name
        main = page.find(".//main")
        assert main is not None
        assert all(len(image.attrib["alt"]) > 5 for image in main.iter("img")), name
        assert all(drawing.attrib["aria-label"] for drawing in main.iter("svg")), name


def test_every_address_is_a_file_of_the_site_and_a_place_in_it(made_site: MadeSite) -> None:
    outside = set()
    for name, page in made_site.pages.items():
        for tag, address in addresses(page):
            if tag == "a" and address.startswith("https://"):
                outside.add(address)
                continue
            path, _, anchor = address.partition("#")
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path))
            target = target if path else name
            assert (made_site.folder / target).is_file(), f"{name} leads to {address}"
            if anchor:
                assert anchor in made_site.anchors(target), f"{name} leads to {address}"

    assert len(outside) < 10
    styles = made_site.text("style.css") + made_site.text("colours.css")
    fonts = re.findall(r'url\("([^"]+)"\)', styles)
    assert fonts and all((made_site.folder / font).is_file() for font in fonts)
    assert not re.search(
        r"https?:|@import|//[a-z]",
        styles + made_site.text("search.js") + made_site.text("frame.js"),
    )


@pytest.mark.parametrize("language", ["", "ja/"])
def test_the_reference_has_every_block_node_and_message(made_site: MadeSite, language: str) -> None:
    for definition in studio_language().definitions.values():
        page = f"{language}blocks/{definition.category.id}.html"
        assert definition.id in made_site.anchors(page)
        slots = {f"{definition.id}--slot-{slot}" for slot in definition.slots}
        assert slots <= made_site.anchors(page), definition.id
    for path in NodeCatalog(node_folders()).paths():
        manifest = read_manifest(path)
        page = f"{language}nodes/{manifest.type}-{manifest.name}.html"
        settings = {f"setting-{name}" for name in manifest.parameters}
        assert settings <= made_site.anchors(page)
    problems = {error_anchor(title) for title in error_texts("en")}
    assert problems <= made_site.anchors(f"{language}problems.html")


def test_every_block_has_pictures_python_and_robots(made_site: MadeSite) -> None:
    for definition in studio_language().definitions.values():
        text = made_site.text(f"blocks/{definition.category.id}.html")
        part = text.partition(f'<h2 id="{definition.id}">')[2].partition("<h2 ")[0]
        assert part.count('<svg class="blocks"') == 2, definition.id
        assert "<pre" in part and "<h3>On which robots</h3>" in part, definition.id


@pytest.mark.parametrize("language", ["", "ja/"])
def test_a_page_shows_its_examples_and_offers_nothing_that_only_the_window_can_do(
    made_site: MadeSite, language: str
) -> None:
    written = made_site.text(f"{language}how-to/three-ways.html")

    assert written.count('<svg class="blocks"') == 9
    assert "choose:" not in written and "drag:" not in written


def test_messages_commands_and_guides_are_there(made_site: MadeSite) -> None:
    assert {topic.strip("/") for topic in BY_TOPIC} <= made_site.anchors("messages.html")
    assert {"run", "show", "train", "node"} <= made_site.anchors("commands.html")
    told = made_site.anchors("developers/command_line.html")
    assert {f"nep-{command}" for command in COMMANDS} <= told
    assert all(f"{name}.html" in made_site.pages for name in GUIDES)


def test_every_picture_is_made_by_a_script(made_site: MadeSite) -> None:
    story = PROJECT / "tests" / "stories" / "test_window_story.py"
    scripts = [*(PROJECT / "tools").glob("*.py"), story]
    text = "".join(script.read_text(encoding="utf-8") for script in scripts)
    made = set(re.findall(r'(?:scene|step)\("([\w-]+)"|"([\w-]+?)(?:-\{\w+\})?(?:\.png)?"', text))
    shown = [path.stem for path in (made_site.folder / "images").glob("*.png")]

    names = {re.sub(r"^story-\d-", "", name) for name in shown}
    of_themes = {re.sub(THEME, "", name) for name in names}

    assert len(names) > 10
    assert of_themes - {re.sub(THEME, "", name) for pair in made for name in pair} == set()


def test_all_of_it_is_small_enough_to_ship(made_site: MadeSite) -> None:
    files = [path for path in made_site.folder.rglob("*") if path.is_file()]

    assert sum(path.stat().st_size for path in files) < LARGEST_MB * 1e6
    assert not any(path.name.startswith(".") for path in files)
