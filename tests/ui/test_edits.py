"""Edits are told one by one, and together once the person pauses."""

from __future__ import annotations

import gc
import weakref

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.program import Changes, Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.edits import LATEST_MS, Edits, edits_of


@pytest.fixture
def editor() -> Editor:
    return Editor(Project("One"), studio_language())


def type_names(editor: Editor, *names: str) -> None:
    for name in names:
        editor.apply(RenameProject(name))


def test_each_edit_is_told_at_once_and_all_together_after_a_pause(
    editor: Editor, qtbot: QtBot
) -> None:
    edits, told, settled = edits_of(editor), list[Changes](), list[Changes]()
    edits.edited.connect(told.append)
    edits.settled.connect(settled.append)

    type_names(editor, "Two", "Three", "Four")

    assert (len(told), settled) == (3, [])
    qtbot.waitUntil(lambda: bool(settled))
    assert [changes.whole for changes in settled] == [True]
    assert edits.is_settled


def test_who_edits_without_a_pause_is_followed_all_the_same(editor: Editor, qtbot: QtBot) -> None:
    edits, settled = edits_of(editor), list[Changes]()
    edits.settled.connect(settled.append)

    def still_typing() -> bool:
        type_names(editor, f"Name {len(editor.project.name)}{editor.history.steps}")
        return bool(settled)

    qtbot.waitUntil(still_typing)

    assert not edits.is_settled  # it was told while the typing went on
    assert LATEST_MS > 0


def test_changes_that_are_gathered_lose_nothing() -> None:
    gathered = Changes({"s1"}, {"b1"}, set(), False, {"cues"})

    gathered.add(Changes({"s2"}, {"b2"}, {"n1"}, True, set()))

    assert gathered == Changes({"s1", "s2"}, {"b1", "b2"}, {"n1"}, True, {"cues"})


def test_everybody_shares_the_edits_of_a_program(editor: Editor) -> None:
    assert edits_of(editor) is edits_of(editor)
    assert isinstance(edits_of(editor), Edits)


def test_edits_do_not_keep_their_program(qtbot: QtBot) -> None:
    editor = Editor(Project("Gone"), studio_language())
    edits_of(editor)
    gone = weakref.ref(editor)

    del editor
    gc.collect()

    assert gone() is None
