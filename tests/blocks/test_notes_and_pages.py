"""Notes, pages and sizes of comments; and project files of the first version."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from block_building import B, build, karate
from sound_programs import kinds

from nep_studio.blocks.edits.content import AddNote, ChangeNote, SetCommentSize
from nep_studio.blocks.edits.project import AddPage, MovePage, RemovePage, RenamePage
from nep_studio.blocks.errors import EditRefused, ProjectFileError
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.program import Note

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "resources" / "examples").glob("*.nep"))
WITHOUT_OWN_BLOCKS = [path for path in EXAMPLES if not json.loads(path.read_bytes())["procedures"]]
NOTE = Note("n50", "behaviour", 10, 20, 200, 100, "Remember the milk")


def saved_and_read(editor, language):
    loaded = from_bytes(to_bytes(editor.project), "x.nep", language)
    assert to_bytes(loaded) == to_bytes(editor.project)
    return loaded


def test_a_note_is_put_moved_written_in_and_saved(language):
    editor = karate(language)
    before = to_bytes(editor.project)
    heard = []
    editor.history.listen(heard.append)

    editor.apply(AddNote(NOTE))
    for text in ("R", "Re"):
        editor.apply(ChangeNote(Note("n50", "nodes", 0, 0, 50, 50, text)))

    assert saved_and_read(editor, language).notes["n50"].text == "Re"
    assert heard[0].notes == {"n50"} and not heard[0].whole
    for _ in range(3):
        editor.history.undo()
    assert to_bytes(editor.project) == before


def test_typing_in_a_note_is_one_step(language):
    editor = karate(language)
    editor.apply(AddNote(NOTE))
    for text in ("R", "Re", "Rem"):
        editor.apply(ChangeNote(Note("n50", "behaviour", 10, 20, 200, 100, text)))

    editor.history.undo()

    assert editor.project.notes["n50"].text == "Remember the milk"


@pytest.mark.parametrize(
    ("note", "reason"),
    [
        (Note("n1", "attic", 0, 0, 1, 1), "page is not there"),
        (Note("n1", "behaviour", 1e9, 0, 1, 1), "too far"),
        (Note("n1", "behaviour", 0, 0, 1e9, 1), "at most"),
        (Note("n1", "behaviour", 0, 0, float("nan"), 1), "at most"),
        (Note("n1", "behaviour", 0, 0, 1, 1, "\ud800"), "surrogate"),
    ],
)
def test_a_note_that_cannot_be_is_refused(language, note, reason):
    with pytest.raises(EditRefused, match=reason):
        karate(language).apply(AddNote(note))


def test_the_size_of_a_comment_is_saved_only_where_it_was_chosen(language):
    editor = karate(language)
    first = next(iter(editor.project.blocks))
    before = to_bytes(editor.project)

    editor.apply(SetCommentSize(first, 120, 0))

    assert saved_and_read(editor, language).blocks[first].comment_width == 120
    editor.apply(SetCommentSize(first, 0, 0))
    assert to_bytes(editor.project) == before


def test_rules_on_an_added_page_are_part_of_the_program(language):
    editor = karate(language)
    editor.apply(AddPage("page9", "Dance", 1))
    build(language, [B("event.human_state"), B("robot.stop")], page="page9", editor=editor)

    loaded = saved_and_read(editor, language)

    assert list(loaded.pages) == ["behaviour", "page9", "robots", "nodes"]
    assert loaded.page_titles == {"page9": "Dance"} and loaded.kind_of_page("page9") == "behaviour"
    assert "nao.stop()" in generate_program(loaded, language).text
    assert "wrong_page" not in kinds(editor, language)


def test_pages_are_renamed_moved_and_deleted_with_what_is_on_them(language):
    editor = karate(language)
    editor.apply(AddPage("page9", "Dance", 1))
    build(language, [B("robot.stop")], page="page9", editor=editor)
    editor.apply(AddNote(Note("n51", "page9", 0, 0, 9, 9)))
    editor.apply(RenamePage("page9", "Sing"))
    editor.apply(MovePage("page9", 3))
    before = to_bytes(editor.project)
    assert list(saved_and_read(editor, language).pages)[3] == "page9"

    with pytest.raises(EditRefused, match="empty it first"):
        editor.apply(RemovePage("page9"))
    editor.delete_page("page9")
    assert "page9" not in editor.project.pages and "n51" not in editor.project.notes
    editor.history.undo()

    assert to_bytes(editor.project) == before
    with pytest.raises(EditRefused, match="belongs to every project"):
        editor.apply(RemovePage("robots"))


def test_robots_do_not_go_onto_an_added_page(language):
    editor = karate(language)
    editor.apply(AddPage("page9", "", 1))

    with pytest.raises(EditRefused, match="on the page Robots"):
        editor.create("robots.robot", NewStack("page9", "s90", 0, 0, 0))


def test_what_a_later_version_adds_to_the_file_is_kept(language):
    data = json.loads(to_bytes(karate(language).project))
    data["stickers"] = [{"x": 1}]

    project = from_bytes(json.dumps(data).encode(), "x.nep", language)

    assert json.loads(to_bytes(project))["stickers"] == [{"x": 1}]


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("notes", [{"id": "n1"}], "at notes number 1: “page” is missing"),
        (
            "notes",
            [{**json.loads('{"x":0,"y":0,"width":1,"height":1}'), "id": "n1", "page": "q"}],
            "page is not there",
        ),
        ("page_order", [{"id": "p 1"}], "is not an id"),
        ("page_order", [{"id": "a", "title": "x\ny"}], "one line"),
        ("procedures", [{"id": "p1", "parts": []}], "1 to 40"),
        ("procedures", [{"id": "p.1", "parts": ["x"]}], "small letters"),
        ("procedures", [{"id": "p1", "parts": [{"id": "a1", "name": "n"}]}], "at least one word"),
        (
            "procedures",
            [{"id": "p1", "parts": ["x", {"id": "a1", "name": "n", "kind": "state"}]}],
            "is one of",
        ),
        ("procedures", [{"id": "p1", "parts": ["x"]}] * 2, "twice"),
        ("procedures", [{"id": "p1", "parts": ["x\ny"]}], "one line"),
    ],
)
def test_wrong_notes_pages_and_own_blocks_are_told(language, key, value, told):
    data = json.loads(to_bytes(karate(language).project))
    data[key] = value

    with pytest.raises(ProjectFileError) as refused:
        from_bytes(json.dumps(data).encode(), "x.nep", language)

    assert told in str(refused.value.sentence)
