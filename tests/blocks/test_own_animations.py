"""A project's own animations: kept in its file, offered by its blocks, renamed with their uses."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import EditRefused, ProjectFileError
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.animations import (
    animation_uses,
    delete_animation,
    keep_animation,
    rename_animation,
)
from nep_studio.blocks.operations.copying import copy, from_text, paste, to_text
from nep_studio.blocks.own_animations import (
    JointKeys,
    OwnAnimation,
    free_name,
    own_animations,
    why_not_animation,
)
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from tests.blocks.block_building import B, build

HOP = OwnAnimation("Big hop", {"HeadPitch": JointKeys((0.5, 1.0), (0.3, 0.0))})
PLAYS = [B("event.started"), B("robot.play")]


def offered(editor: Editor, table: str) -> list[str]:
    return list(editor.language.choices[table])


def playing(language: Language, name: str) -> tuple[Editor, str]:
    editor = build(language, PLAYS)
    keep_animation(editor, HOP)
    block = next(b.id for b in editor.project.blocks.values() if b.type == "robot.play")
    editor.apply(SetField(block, "animation", name))
    return editor, block


def test_a_kept_animation_is_offered_at_once_and_no_more_after_undo(language: Language) -> None:
    editor = build(language, PLAYS)
    shipped = offered(editor, "animations")

    name = keep_animation(editor, HOP)

    assert name == "big_hop"
    assert offered(editor, "animations") == [*shipped, "big_hop"]
    assert editor.language.choices["animations"]["big_hop"] == "Big hop"
    assert editor.history.undo()
    assert offered(editor, "animations") == shipped


@pytest.mark.parametrize(("kind", "table"), [("animal", "animals"), ("gesture", "say_gestures")])
def test_each_kind_is_offered_where_it_belongs_and_all_can_be_played(
    language: Language, kind: str, table: str
) -> None:
    editor = build(language, PLAYS)

    keep_animation(editor, msgspec.structs.replace(HOP, kind=kind))

    assert "big_hop" in offered(editor, table)
    assert "big_hop" in offered(editor, "animations")


def test_other_projects_do_not_offer_it(language: Language) -> None:
    editor, other = build(language, PLAYS), build(language, PLAYS)

    keep_animation(editor, HOP)

    assert "big_hop" not in offered(other, "animations")
    assert "big_hop" not in language.choices["animations"]


def test_a_block_that_plays_it_says_and_does_so(language: Language) -> None:
    editor, block = playing(language, "big_hop")

    code = generate_program(editor.project, editor.language)

    assert "Big hop" in sentence(editor.project, editor.language, block)
    assert 'play("big_hop")' in code.text


def test_it_is_there_again_when_the_file_is_read(language: Language) -> None:
    editor, _ = playing(language, "big_hop")
    saved = to_bytes(editor.project)

    project = from_bytes(saved, "test.nep", language)

    assert own_animations(project) == {"big_hop": HOP}
    assert "big_hop" in language.of(project).choices["animations"]
    assert to_bytes(project) == saved


def test_a_new_title_takes_its_uses_along_in_one_step(language: Language) -> None:
    editor, block = playing(language, "big_hop")
    before = to_bytes(editor.project)

    name = rename_animation(editor, "big_hop", "Small jump")

    assert name == "small_jump"
    assert own_animations(editor.project).keys() == {"small_jump"}
    assert [use.block for use in animation_uses(editor, "small_jump")] == [block]
    assert editor.history.undo()
    assert to_bytes(editor.project) == before


def test_a_check_tells_of_the_blocks_whose_animation_was_deleted(language: Language) -> None:
    editor, block = playing(language, "big_hop")

    delete_animation(editor, "big_hop")

    problems = check(editor.project, editor.language)
    assert ("unknown_choice", block) in [(one.kind, one.block) for one in problems]


def test_two_of_the_same_title_get_different_names(language: Language) -> None:
    editor = build(language, PLAYS)

    names = [keep_animation(editor, HOP) for _ in range(2)]

    assert names == ["big_hop", "big_hop_2"]


def test_the_name_of_a_shipped_animation_is_taken(language: Language) -> None:
    editor = build(language, PLAYS)

    assert keep_animation(editor, msgspec.structs.replace(HOP, title="Wave")) == "wave_2"


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ({"title": "", "joints": {"A": {"times": [1], "keys": [0]}}}, "title"),
        ({"title": "A", "joints": {}}, "1 to"),
        ({"title": "A", "joints": {"A": {"times": [1, 2], "keys": [0]}}}, "2 times"),
        ({"title": "A", "joints": {"A": {"times": [1, 1], "keys": [0, 0]}}}, "later"),
        ({"title": "A", "joints": {"A": {"times": [0], "keys": [0]}}}, "later"),
        ({"title": "A", "joints": {"A": {"times": [1], "keys": [99]}}}, "rad"),
        ({"title": "A", "joints": {"A": {"times": [], "keys": []}}}, "1 to"),
        ({"title": "A", "joints": 3}, "joints"),
        ("hop", ""),
    ],
)
def test_a_file_with_a_wrong_animation_says_what_is_wrong(
    language: Language, value: object, reason: str
) -> None:
    project = Project("Test")
    project.extra["animation_hop"] = value

    with pytest.raises(ProjectFileError) as caught:
        from_bytes(to_bytes(project), "test.nep", language)

    assert "hop" in str(caught.value)
    assert reason in str(caught.value)


def test_an_animation_without_a_title_is_refused_with_a_reason(language: Language) -> None:
    editor = build(language, PLAYS)

    with pytest.raises(EditRefused, match="title"):
        keep_animation(editor, msgspec.structs.replace(HOP, title="  "))


@given(st.text(max_size=60), st.sets(st.sampled_from(["a", "hop", "motion", "hop_2"])))
def test_every_title_gives_a_name_that_can_be_kept(title: str, taken: set[str]) -> None:
    name = free_name(title, taken)

    assert name not in taken
    assert why_not_animation(name, HOP) is None


@pytest.mark.parametrize("title", ["1" * 40, "Con", "COM1", "9"])
def test_ten_motions_of_one_title_all_get_a_name_that_can_be_kept(title: str) -> None:
    taken: set[str] = set()

    for _ in range(10):
        taken.add(free_name(title, taken))

    assert len(taken) == 10
    assert [why_not_animation(name, HOP) for name in taken] == [None] * 10


def test_a_copied_block_takes_its_animation_along_to_another_project(language: Language) -> None:
    editor, block = playing(language, "big_hop")
    other = build(language, PLAYS)
    text = to_text(copy(editor.project, editor.language, [block]))

    paste(other, from_text(text, language), "behaviour", 400, 400)

    assert own_animations(other.project) == {"big_hop": HOP}
    assert "unknown_choice" not in [one.kind for one in check(other.project, other.language)]
    assert other.history.undo()
    assert own_animations(other.project) == {}


def test_a_copied_block_that_plays_a_shipped_animation_takes_nothing_along(
    language: Language,
) -> None:
    editor, block = playing(language, "wave")

    assert own_animations(copy(editor.project, editor.language, [block]).project) == {}
