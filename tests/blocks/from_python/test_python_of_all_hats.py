"""Python that names joints, robots and human states comes back as the blocks that made it."""

from __future__ import annotations

import pytest
from block_building import B, build
from sound_programs import block_of

from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import ALL_ROBOTS
from tests.blocks.block_building import read_program

HATS = [
    "robot_events.touched",
    "robot_events.sees",
    "robot_events.sees_face_of",
    "robot_events.sees_mark",
    "robot_events.person",
    "robot_events.emotion",
    "robot_events.sensor",
]


def code_of(editor):
    return generate_program(editor.project, editor.language).text


@pytest.mark.parametrize("again", ["", "ignore", "queue"])
@pytest.mark.parametrize("robot", ["NAO", "Zora 2", ALL_ROBOTS])
@pytest.mark.parametrize("hat", HATS)
def test_a_rule_about_any_robot_is_read_back(language, hat, robot, again):
    fields = {"again.1": again} if again else {}
    groups = {"repeated": 1} if again else {}
    if "robot" in language.definitions[hat].slots:
        fields["robot"] = robot
    editor = build(language, [B(hat, fields, groups=groups), B("control.wait")])
    text = code_of(editor)

    read = read_program(text, language)

    assert (f'again="{again}"' in text) is bool(again)
    hats = [
        block for block in read.blocks.values() if language.definitions[block.type].shape == "hat"
    ]
    assert [one.groups for one in hats] == [{"repeated": bool(again)}]
    assert generate_program(read, language).text == text


def test_a_hat_stays_when_a_line_below_it_is_edited(language):
    hat = B("robot_events.touched", {"robot": ALL_ROBOTS})
    editor = build(language, [hat, B("control.wait")])
    touched = block_of(editor, "robot_events.touched")

    update_from_python(editor, code_of(editor).replace("wait(1)", "wait(2)"))

    assert editor.project.blocks[touched].type == "robot_events.touched"
    assert editor.project.blocks[block_of(editor, "control.wait")].fields == {"seconds": 2}


@pytest.mark.parametrize("joint", ["HeadYaw", "LElbowRoll", "RKneePitch"])
def test_the_part_of_the_body_of_a_joint_is_found(language, joint):
    editor = build(language, [B("event.started"), B("robot_moves.move_joint")])
    text = code_of(editor).replace("HeadYaw", joint)

    update_from_python(editor, text)

    moved = editor.project.blocks[block_of(editor, "robot_moves.move_joint")]
    table = language.choices[f"joints.{moved.fields['part']}"]
    assert moved.fields["joint"] == joint and joint in table
    assert code_of(editor) == text


def test_an_angle_of_any_joint_is_read_into_a_new_program(language):
    text = code_of(build(language, [B("event.started"), B("robot_moves.move_joint")]))
    text = text.replace("HeadYaw", "LAnkleRoll")

    read = read_program(text, language)

    assert generate_program(read, language).text == text


def test_robots_in_a_list_come_to_the_robots_page(language):
    said = B("robot.say", {"robot": ALL_ROBOTS})
    editor = build(language, [B("event.started"), said])
    build(
        language,
        [B("robots.robot"), B("robots.robot", {"name": "Zora"})],
        page="robots",
        editor=editor,
    )
    text = code_of(editor)

    read = read_program(text, language)

    assert 'Robot(["NAO", "Zora"])' in text
    assert generate_program(read, language).text == text


def test_a_rule_that_is_not_edited_is_not_read(language):
    editor = build(
        language,
        [B("event.started"), B("control.wait")],
        [B("event.gesture"), B("control.note", {"text": "nothing yet"})],
    )
    before = to_bytes(editor.project)

    update_from_python(editor, code_of(editor))

    assert to_bytes(editor.project) == before
    assert editor.history.undo_label != "change the code"
