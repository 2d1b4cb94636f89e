"""Fields that are chosen or pressed take blocks as texts do, and come back as they were."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF

from nep_studio.blocks.places import InInput
from nep_studio.blocks.text import sentence
from tests.blocks.block_building import B

FREE = QPointF(620, 480)
PLACES = [
    ("robot.play", "animation", "bow"),
    ("robot.play", "robot", "NAO"),
    ("sensing.remember", "state", "touched_hand"),
    ("robot_camera.learn_face", "name", "Anna"),
    ("robot_moves.awareness", "on", False),
]


def variable() -> B:
    return B("variable.get", {"variable": "v1"})


@pytest.mark.parametrize(("block", "place", "value"), PLACES)
def test_a_variable_dropped_on_a_field_goes_in_and_the_field_comes_back(desk, block, place, value):
    desk = desk([B("event.started"), B(block, {place: value})], [variable()])
    before, owner, [held] = desk.file, desk.body()[1], list(desk.body(1))
    project = desk.editor.project

    desk.put(held, desk.field(owner, place) - QPointF(10, 14))

    assert project.blocks[owner].inputs == {place: held}
    assert "times" in sentence(project, desk.editor.language, owner)
    desk.put(held, FREE)
    assert project.blocks[owner].inputs == {}
    assert project.blocks[owner].fields[place] == value
    keys = [piece.key for piece in desk.canvas.page_layout.placed(owner).box.pieces]
    assert place in keys
    assert desk.editor.history.undo() and desk.editor.history.undo()
    assert desk.file == before


def test_a_field_of_a_trigger_takes_no_block_and_says_so(desk):
    desk = desk([B("robot_events.touched")], [variable()])
    hat, [held] = desk.body()[0], list(desk.body(1))
    place = InInput(hat, "robot")

    desk.carry(held, desk.field(hat, "robot") - QPointF(10, 14))
    desk.mouse.release()

    assert desk.editor.project.blocks[hat].inputs == {}
    assert place not in desk.editor.project.parents.values()
