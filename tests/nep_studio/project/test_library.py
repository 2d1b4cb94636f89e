"""The library of a person: packs as files, kept, taken in, replaced by newer ones, taken out."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import PackError
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import clip_of, paste
from nep_studio.blocks.operations.packing import definitions_in, mark, packed
from nep_studio.blocks.packs import ENDING, About, from_bytes, to_bytes
from nep_studio.blocks.procedures import CALL, DEFINE
from nep_studio.blocks.program import Project
from nep_studio.project.library import Library, read_pack, write_pack
from nep_studio.project.trust import Approvals, Authorship
from nep_studio.run.gate import brought_by, concerns_of
from nep_studio.run.installation import studio_language
from tests.blocks.block_building import B, build

HARM = "import shutil"


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.fixture
def library(tmp_path: Path) -> Library:
    return Library(tmp_path / "library")


@pytest.fixture
def author(language: Language) -> Editor:
    editor = Editor(Project("Mine"), language)
    own = editor.add_procedure(["wave"])
    return build(language, [B(DEFINE + own), B("robot.say", {"text": "Hi"})], editor=editor)


def own_of(editor: Editor) -> str:
    return next(iter(editor.project.procedures))


def keep(library: Library, editor: Editor, pack_id: str = "w1"):
    own = own_of(editor)
    pack = library.keep_block(editor.project, editor.language, own, pack_id)
    mark(editor, pack, [own])
    return pack


def names(library: Library) -> list[str]:
    return sorted(path.name for path in library.folder.iterdir())


def test_a_kept_block_is_a_file_that_can_be_read_again(library, author, language):
    assert not library.are_any

    pack = keep(library, author)

    assert names(library) == [f"wave{ENDING}"]
    [read] = Library(library.folder).packs(language)
    assert to_bytes(read) == to_bytes(pack)
    assert read.title == "wave"


def test_what_is_kept_again_is_the_next_version_of_the_same_pack(library, author, language):
    keep(library, author)
    say = next(b for b in author.project.blocks.values() if b.type == "robot.say")
    author.apply(SetField(say.id, "text", "Hello"))

    second = keep(library, author, "unused")

    assert (second.about.id, second.about.version) == ("w1", 2)
    assert names(library) == [f"wave{ENDING}"]
    assert library.pack("w1", language).about.version == 2


def test_another_block_with_the_same_words_gets_a_file_of_its_own(library, author, language):
    keep(library, author)
    other = Editor(Project("Other"), language)
    own = other.add_procedure(["wave"])
    build(language, [B(DEFINE + own)], editor=other)

    keep(library, other, "w2")

    assert names(library) == [f"wave-2{ENDING}", f"wave{ENDING}"]
    assert {pack.about.id for pack in library.packs(language)} == {"w1", "w2"}


def test_a_pack_comes_in_from_elsewhere_and_a_newer_one_replaces_it(
    library, author, language, tmp_path
):
    first = keep(Library(tmp_path / "theirs"), author)
    write_pack(first, tmp_path / "first.nepblocks")

    assert library.take_in(tmp_path / "first.nepblocks", language).title == "wave"
    library.take_in(tmp_path / "first.nepblocks", language)  # again: it is the same

    assert len(names(library)) == 1
    second = keep(Library(tmp_path / "theirs"), author)
    write_pack(second, tmp_path / "second.nepblocks")
    library.take_in(tmp_path / "second.nepblocks", language)
    assert [pack.about.version for pack in library.packs(language)] == [2]
    with pytest.raises(PackError, match="version 2 of “wave” already"):
        library.take_in(tmp_path / "first.nepblocks", language)


def test_another_pack_with_the_same_version_is_refused(library, author, language):
    pack = keep(library, author)
    before = names(library), to_bytes(pack)
    text = to_bytes(pack).replace(b'"Hi"', b'"Ho"')

    with pytest.raises(PackError, match="same version") as refused:
        library.keep(from_bytes(text, "x", language), language)

    assert refused.value.checklist
    assert (names(library), to_bytes(library.pack("w1", language))) == before


def test_nothing_is_taken_in_of_a_file_that_is_no_pack(library, language, tmp_path):
    (tmp_path / "bad.nepblocks").write_bytes(b"{}")

    for path in (tmp_path / "bad.nepblocks", tmp_path / "nowhere.nepblocks", tmp_path):
        with pytest.raises(PackError):
            library.take_in(path, language)

    assert not library.folder.exists()


def test_a_file_that_cannot_be_read_hides_no_other(library, author, language):
    keep(library, author)
    (library.folder / f"bad{ENDING}").write_bytes(b"[" * 9000)

    assert [pack.title for pack in library.packs(language)] == ["wave"]


def test_a_huge_file_is_refused_by_its_size(library, language, tmp_path):
    huge = tmp_path / "huge.nepblocks"
    with huge.open("wb") as file:
        file.truncate(80_000_000)

    with pytest.raises(PackError, match="too large"):
        read_pack(huge, language)


def test_a_pack_is_taken_out(library, author, language):
    library.remove(keep(library, author), language)

    assert library.packs(language) == []
    assert names(library) == []


def test_a_changed_file_is_read_anew(library, author, language):
    pack = keep(library, author)
    assert len(library.packs(language)) == 1

    write_pack(
        from_bytes(to_bytes(pack).replace(b'"Hi"', b'"Good day"'), "x", language),
        library.folder / f"wave{ENDING}",
    )

    [read] = library.packs(language)
    assert b"Good day" in to_bytes(read)


# Python in a pack is a stranger's


@pytest.mark.strangers
def test_python_of_a_pack_is_asked_about_before_it_runs(language, tmp_path):
    theirs = Editor(Project("Theirs"), language)
    own = theirs.add_procedure(["tidy"])
    build(language, [B(DEFINE + own), B("code.lines", {"code": HARM})], editor=theirs)
    pack = keep(Library(tmp_path), theirs, "t1")
    mine = build(language, [B("event.started")])
    authorship = Authorship(
        mine,
        Approvals(),
        lambda block: brought_by(block, mine.project, mine.language, tmp_path),
    )

    along = definitions_in(pack, mine.language, pack.about.offers)
    clip = clip_of(mine.language.of(along.project), CALL + own)
    clip.project.procedures |= along.project.procedures
    clip.project.touch_procedures()
    paste(mine, type(clip)(clip.project, along), "behaviour", 0, 0)

    authorship.keep()
    concerns = concerns_of(mine.project, mine.language, tmp_path)
    assert [concern.text for concern in concerns] == [HARM]
    assert not Approvals().has(concerns[0].key), "nobody has approved it by using the block"


def test_a_pack_says_its_own_version_and_author(author, language):
    about = About("w1", 3, "Ada", "CC BY 4.0")

    pack = packed(author.project, author.language, [own_of(author)], about, "Waving")

    read = from_bytes(to_bytes(pack), "x", language)
    assert (read.about.version, read.about.author, read.about.licence) == (3, "Ada", "CC BY 4.0")
