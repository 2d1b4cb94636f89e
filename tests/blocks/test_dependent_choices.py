"""Slot kinds with something in parentheses: sliders, and choices that depend on another slot."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.definitions import SentenceError, parse, slots_of
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import DefinitionError, EditRefused
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.program import Project
from nep_studio.blocks.slots import KINDS, RESULT_SHAPES, RESULTS
from nep_studio.run.installation import load_language

ROBOT = Path(__file__).resolve().parents[2] / "resources" / "robots" / "nao" / "robot.toml"
BEND = """
[category]
id = "my"
title = "My"
colour = "my"
order = 1
[choices.part]
arm = "the arm"
leg = "the leg"
[choices.joint.arm]
elbow = "elbow"
wrist = "wrist"
[choices.joint.leg]
knee = "knee"
wrist = "no wrist, but so called"
[blocks.bend]
sentence = "{robot:robot} {joint:choice(joint/part)} of {part:choice(part)}: {by:slider(0..90)}"
shape = "statement"
defaults = { robot = "NAO", joint = "elbow", part = "arm", by = 30 }
call = { on = "robot", method = "do", arguments = ["part", "joint", "by"] }
"""


@pytest.fixture
def bend(tmp_path) -> tuple[Editor, str]:
    (tmp_path / "my.toml").write_text(BEND)
    editor = Editor(Project(), load_language(tmp_path, ROBOT))
    return editor, editor.create("my.bend", editor.new_stack("behaviour", 0, 0))


def test_a_slot_offers_the_table_of_what_its_master_holds(bend):
    editor, block_id = bend
    block = editor.project.blocks[block_id]
    slot = editor.language.definitions["my.bend"].slots["joint"]

    assert list(editor.language.choices_of(slot, block)) == ["elbow", "wrist"]
    with pytest.raises(EditRefused, match="not one of: elbow, wrist"):
        editor.apply(SetField(block_id, "joint", "knee"))


def test_a_choice_that_is_not_offered_any_more_is_made_again_in_the_same_step(bend):
    editor, block_id = bend
    fields = editor.project.blocks[block_id].fields
    before = to_bytes(editor.project)

    editor.apply(SetField(block_id, "part", "leg"))

    assert fields["joint"] == "knee"
    editor.history.undo()
    assert to_bytes(editor.project) == before
    editor.apply(SetField(block_id, "joint", "wrist"))
    editor.apply(SetField(block_id, "part", "leg"))
    assert fields["joint"] == "wrist"


def test_a_choice_from_a_file_that_its_master_does_not_offer_is_told(bend):
    editor, block_id = bend
    editor.project.blocks[block_id].fields["joint"] = "knee"

    assert "unknown_choice" in [p.kind for p in check(editor.project, editor.language)]


def test_a_slider_stays_between_its_ends(bend):
    editor, block_id = bend

    editor.apply(SetField(block_id, "by", "2*45"))
    with pytest.raises(EditRefused, match="from 0 to 90"):
        editor.apply(SetField(block_id, "by", 91))


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ("{a:slider}", "has its ends"),
        ("{a:slider(9..1)}", "has its ends"),
        ("{a:number(1)}", "nothing in parentheses"),
        ("{a:choice(b/c)}", "is no choice"),
        ("{c:text} {a:choice(b/c)}", "is no choice"),
        ("[g: {c:choice(b)}]* {a:choice(b/c)}", "is no choice"),
    ],
)
def test_wrong_parentheses_are_told(sentence, reason):
    with pytest.raises(SentenceError, match=reason):
        slots_of(parse(sentence))


def test_a_slot_for_a_variable_has_its_name(tmp_path):
    (tmp_path / "my.toml").write_text(BEND.replace("{robot:robot}", "{it:variable} {robot:robot}"))

    with pytest.raises(DefinitionError, match="is called “variable”"):
        load_language(tmp_path, ROBOT)


def test_what_fits_into_a_slot_has_its_shape_or_the_slot_takes_all():
    for kind in KINDS.values():
        shapes = {RESULT_SHAPES[result] for result in kind.fits - {"any"}}
        is_round = kind.shape == "pill"  # a place for a word, a switch, a robot: as it is typed
        assert is_round or shapes in (set(), {kind.shape}) or kind.fits == set(RESULTS)
