"""The problems of programs, each told on its block, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest
from block_building import B, build
from sound_programs import WAIT, block_of, kinds, only, sound

from nep_studio.blocks.checks import check
from nep_studio.blocks.deployment import (
    NodeEntry,
    RobotEntry,
    names_used,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.edits.project import RemoveVariable
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.run.installation import load_language

RESOURCES = Path(__file__).resolve().parents[2] / "resources"


def test_a_sound_program_has_no_problems(language):
    editor = sound(
        language,
        [
            B("event.started"),
            B("robot.do"),
            B("robot.walk"),
            B("control.forever", bodies={"do": [WAIT]}),
        ],
        [B("event.gesture"), B("robot.say"), B("control.stop_program")],
    )

    assert check(editor.project, language) == []


def test_an_empty_page_says_how_to_begin(language):
    problem = only(build(language), language)

    assert problem.severity == "error" and problem.kind == "no_rule" and not problem.block
    assert "Drag a “when” block" in str(problem.checklist[0])


def test_an_empty_question_is_told_where_it_is_missing(language):
    editor = sound(language, [B("event.started"), B("control.wait_until")])

    problem = only(editor, language)

    assert problem.kind == "empty_slot" and problem.block == block_of(editor, "control.wait_until")
    assert str(problem.sentence) == "“wait until …”: a question is missing."


def test_a_slot_whose_block_is_disabled_counts_as_empty(language):
    truth = B("logic.truth")
    editor = sound(
        language, [B("event.started"), B("control.wait_until", inputs={"condition": truth})]
    )
    assert kinds(editor, language) == []

    editor.apply(SetFlag(block_of(editor, "logic.truth"), "disabled", True))

    assert kinds(editor, language) == ["empty_slot"]


def test_a_variable_that_was_deleted_is_told_where_it_is_used(language):
    change = B("variable.change", {"variable": "v1"})
    editor = sound(language, [B("event.started"), change])
    assert kinds(editor, language) == []

    editor.apply(RemoveVariable("v1"))

    assert only(editor, language).kind == "no_variable"


def test_a_choice_that_the_robot_does_not_have_is_told(language):
    editor = sound(language, [B("event.started"), B("robot.do")])
    editor.project.blocks[block_of(editor, "robot.do")].fields["posture"] = "posture_fly"

    problem = only(editor, language)

    assert problem.kind == "unknown_choice" and "“posture_fly” is not one of" in str(
        problem.sentence
    )
    with pytest.raises(CodeRefused, match="posture_fly"):
        generate_program(editor.project, language)


def test_a_gesture_that_nothing_knows_is_told_of(language):
    editor = sound(language, [B("event.gesture", {"gesture": "juggle"}), WAIT])

    problem = only(editor, language)

    assert problem.severity == "warning" and problem.kind == "gesture_unrecognised"
    assert problem.fix is None


def test_a_gesture_for_which_run_adds_what_recognises_it_is_no_problem(language):
    editor = sound(language, [B("event.gesture", {"gesture": "katana"}), WAIT])

    assert check(editor.project, language) == []


def test_a_question_about_a_gesture_needs_somebody_who_knows_it_too(language):
    asked = B("sensing.human_state_is", {"state": "gesture_juggle"})
    until = B("control.wait_until", inputs={"condition": asked})
    editor = sound(language, [B("event.started"), until])

    assert only(editor, language).kind == "gesture_unrecognised"
    assert names_used(editor.project, language, "gesture") == {
        "juggle": block_of(editor, "sensing.human_state_is")
    }


def test_a_robot_that_is_not_on_the_robots_page_can_be_added(language):
    editor = sound(language, [B("event.started"), B("robot.say", {"robot": "Pepper"})])

    problem = only(editor, language)

    assert str(problem.sentence) == "Pepper is not on the Robots page."
    assert problem.fix.name == "add_robot" and problem.fix.data == {"name": "Pepper"}
    assert names_used(editor.project, language, "robot") == {"Pepper": problem.block}


def test_all_robots_need_at_least_one(language):
    editor = build(language, [B("event.started"), B("robot.say", {"robot": "*"})])

    problem = only(editor, language)

    assert (
        str(problem.sentence) == "There is no robot on the Robots page."
        and problem.fix.data["name"]
    )


def test_two_rules_for_one_gesture_are_told_however_they_name_it(language):
    editor = sound(
        language,
        [B("event.gesture"), WAIT],
        [B("event.human_state", {"state": "gesture_karate"}), WAIT],
    )

    problem = only(editor, language)

    assert problem.kind == "same_trigger" and problem.block == block_of(editor, "event.human_state")


def test_two_states_may_be_left_for_the_same_thing_and_two_rules_hear_a_message(language):
    there = B("state.person", {"state": "open", "trigger": "touched_head", "target": "closed"})
    back = B("state.person", {"state": "closed", "trigger": "touched_head", "target": "open"})
    hears = B("event.told", {"message": "work"})
    tells = B("event.tell", {"message": "work"})
    begins = B("state.begins", {"state": "open"}, groups={"first": 1})
    editor = sound(language, [begins, tells], [there], [back], [hears, WAIT], [hears, WAIT])

    assert "same_trigger" not in kinds(editor, language)


def test_two_ways_out_of_one_state_for_the_same_thing_are_told(language):
    there = B("state.person", {"state": "open", "trigger": "touched_head", "target": "closed"})
    begins = B("state.begins", {"state": "open"}, groups={"first": 1})
    editor = sound(language, [begins, WAIT], [there], [there])

    assert "same_trigger" in kinds(editor, language)


def test_loose_blocks_are_only_worth_knowing(language):
    editor = sound(language, [B("event.started"), WAIT], [B("robot.say", {"robot": "Pepper"})])

    problem = only(editor, language)

    assert problem.severity == "info" and problem.kind == "loose_block"


def test_robots_and_nodes_need_names_of_their_own(language):
    editor = sound(language, [B("event.started"), WAIT])
    robot, node = block_of(editor, "robots.robot"), block_of(editor, "nodes.launch")
    editor.apply(SetField(node, "name", "NAO"))
    assert only(editor, language).kind == "same_name" and only(editor, language).block == node
    editor.apply(SetField(robot, "name", " "))
    assert only(editor, language).kind == "bad_name" and only(editor, language).block == robot
    editor.apply(SetField(robot, "name", "*"))
    assert "stands for all robots" in str(only(editor, language).sentence)

    editor.apply(DeleteBlocks(robot))
    assert kinds(editor, language) == []


def test_the_pages_are_read_as_robots_and_nodes(language):
    editor = sound(language, [B("event.started"), WAIT])
    robot, node = block_of(editor, "robots.robot"), block_of(editor, "nodes.launch")

    assert robot_entries(editor.project, language) == (RobotEntry("NAO", "virtual", "", robot),)
    assert node_entries(editor.project, language) == (
        NodeEntry("perceptual/gesture", "karate", {"gesture": "karate"}, node),
    )

    editor.apply(SetFlag(node, "disabled", True))
    assert node_entries(editor.project, language) == ()


def test_what_is_not_known_here_is_not_called_wrong(language):
    without_nodes = load_language(RESOURCES / "blocks", RESOURCES / "robots/nao/robot.toml")
    editor = sound(without_nodes, [B("event.started"), WAIT])
    build(
        without_nodes,
        [B("nodes.launch", {"node": "sensory/anything"})],
        page="nodes",
        editor=editor,
    )

    assert [p.kind for p in check(editor.project, without_nodes)] == ["same_name"]
