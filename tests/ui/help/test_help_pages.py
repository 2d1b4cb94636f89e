"""Every page of the help is there, complete, and leads on to pages that are there."""

from __future__ import annotations

import re
import tomllib

import pytest

from nep_core.errors import NepError
from nep_core.places import node_folders
from nep_core.processes.manifest import NodeCatalog, read_manifest
from nep_studio import paths
from nep_studio.blocks.errors import BlocksError
from nep_studio.help import markdown
from nep_studio.help.texts import (
    BLOCK,
    HOME,
    HOW_TO,
    NODE,
    OWN_BLOCKS,
    block_page,
    block_texts,
    category_texts,
    error_anchor,
    error_texts,
    page_texts,
    split,
)
from nep_studio.run.installation import studio_language
from nep_studio.ui.plugins.help.repository import EVERY_BLOCK, Book
from nep_studio.ui.words import use_language

LANGUAGE = studio_language()
HOW_TOS = (
    "first-steps",
    "run-and-stop",
    "connect-nao",
    "connect-watch",
    "two-robots",
    "museum",
    "cue-panel",
    "teach-gestures",
    "write-a-node",
    "python",
    "keyboard",
    "problems",
    "words",
)


def defined_blocks() -> list[str]:
    """The blocks of every file of definitions, read without the program."""
    found = []
    for path in sorted((paths.resources() / "blocks").glob("*.toml")):
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        found += [f"{data['category']['id']}.{name}" for name in data["blocks"]]
    return found


def anchors_of(html: str) -> set[str]:
    return set(re.findall(r'<a name="([^"]+)"', html))


def test_every_block_has_a_page_with_picture_words_example_and_python(book):
    blocks = defined_blocks()

    pages = {block: book.page(BLOCK + block) for block in blocks}

    assert len(blocks) >= 159
    for block, page in pages.items():
        assert page.name == BLOCK + block
        assert f'src="picture:{block}"' in page.html
        assert page.example is not None and 'src="example:' in page.html, block
        assert "<pre" in page.html, block
        assert page.html.count("<a href=") >= 2, block


def test_every_block_has_words_that_people_wrote_and_no_text_is_of_a_block_that_is_gone():
    texts = block_texts("en")

    assert set(defined_blocks()) == set(texts) - {EVERY_BLOCK}
    for block, told in texts.items():
        if block != EVERY_BLOCK:
            assert told.about.endswith("."), block
            assert not told.tip or told.tip[-1] in ".”", block
            assert "!" not in told.about + told.tip, block


def test_every_slot_is_explained():
    texts = block_texts("en")
    common = texts[EVERY_BLOCK].slots
    for definition in LANGUAGE.definitions.values():
        told = texts[definition.id].slots
        assert set(told) <= set(definition.slots), definition.id
        assert set(definition.slots) <= set(told) | set(common), definition.id


def test_every_category_is_explained():
    assert {category.id for category in LANGUAGE.categories} == set(category_texts("en"))


def test_the_how_to_pages_are_there(book):
    titles = {name for name in book.titles if name.startswith(HOW_TO)}

    assert {HOW_TO + name for name in HOW_TOS} <= titles


def test_every_link_leads_to_a_page_and_to_a_place_in_it(book):
    html = {name: book.page(name).html for name in book.titles}

    links = [
        (name, link) for name, text in html.items() for link in re.findall('help:([^"]+)', text)
    ]

    assert len(links) > 700
    for name, link in links:
        page, anchor = split(link)
        assert page in html, f"{name} leads to {link}"
        assert not anchor or anchor in anchors_of(html[page]), f"{name} leads to {link}"


def test_what_a_block_says_to_see_is_there():
    for block, told in block_texts("en").items():
        for name in told.see:
            is_there = name in LANGUAGE.definitions if "." in name else name in page_texts("en")
            assert is_there, f"{block}: {name}"


def test_every_page_in_the_contents_can_be_opened(book):
    def names(contents):
        for content in contents:
            yield content.page
            yield from names(content.inside)

    listed = set(names(book.contents()))

    assert listed == set(book.titles)


def test_every_node_has_a_page_with_all_its_settings(book):
    for path in NodeCatalog(node_folders()).paths():
        manifest = read_manifest(path)

        page = book.page(manifest.help)

        assert page.name == NODE + manifest.id
        for parameter in manifest.parameters:
            assert f"setting-{parameter}" in page.html
        for topic in (*manifest.hears, *manifest.says):
            assert topic in page.html

    for definition in LANGUAGE.definitions.values():
        assert book.resolve(definition.help).startswith(BLOCK)


def test_own_blocks_have_one_page():
    for block in ("my.define.p1", "my.call.p1", "my.parameter.p1.a1"):
        assert block_page(block) == OWN_BLOCKS
    assert block_page("robot.say", "text") == "block/robot.say#slot-text"


def test_a_name_that_there_is_not_leads_to_the_first_page(book):
    assert book.resolve("block/not.there") == HOME
    assert book.page("nodes/not_there").name == HOME
    assert book.resolve("window#code") == "howto/window#code"


def titles_of(error: type) -> set[str]:
    return {error.title}.union(*(titles_of(each) for each in error.__subclasses__()))


def test_every_message_has_its_place_among_what_can_go_wrong(book):
    import nodes.cognitive.failures  # noqa: F401  they define more errors

    titles = {t for kind in (NepError, BlocksError) for t in titles_of(kind)}
    titles = {t for t in titles if t}
    html = book.page("howto/problems").html

    assert len(titles) > 20
    for title in titles:
        assert f'name="{error_anchor(title)}"' in html, title
    for title, told in error_texts("en").items():
        assert told["about"].endswith(".") and len(told["try"]) >= 2, title


@pytest.mark.parametrize("code", ["de", "ja", "qps-rtl"])
def test_pages_are_there_in_other_languages_with_english_texts_until_they_are_translated(code):
    use_language(code)
    try:
        book = Book(studio_language(code))

        pages = [book.page(name) for name in book.titles]

        assert len(pages) >= 190
        assert all(len(page.html) > 60 for page in pages)
    finally:
        use_language("en")


def test_a_translated_text_takes_the_place_of_the_english_one(tmp_path, monkeypatch):
    folder = tmp_path / "help"
    (folder / "en").mkdir(parents=True)
    (folder / "de").mkdir()
    (folder / "en" / "blocks.toml").write_text('["a.b"]\nabout = "English."\ntip = "A tip."\n')
    (folder / "de" / "blocks_x.toml").write_text('["a.b"]\nabout = "Deutsch."\n')
    (folder / "en" / "one.md").write_text("# One\n")
    monkeypatch.setattr("nep_studio.help.texts.help_folder", lambda: folder)
    block_texts.cache_clear()
    page_texts.cache_clear()
    try:
        told = block_texts("de")["a.b"]

        assert (told.about, told.tip) == ("Deutsch.", "A tip.")
        assert page_texts("de") == {"one": "# One\n"}
    finally:
        block_texts.cache_clear()
        page_texts.cache_clear()


def test_pages_use_only_what_our_markdown_knows():
    for name, text in page_texts("en").items():
        document = markdown.read(text)

        assert document.title and document.about.get("order"), name
        plain = re.sub(r"<pre.*?</pre>|<code>.*?</code>", "", document.html, flags=re.S)
        assert "**" not in plain and "](" not in plain and "`" not in plain, name
        assert "!" not in re.sub(r"<[^>]+>", "", plain), name
