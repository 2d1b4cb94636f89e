"""What is told while editing of rules that run at once: goals, torn values, lists that grow."""

from __future__ import annotations

from block_building import B, build

from nep_studio.blocks.checks import check
from nep_studio.blocks.operations.fixes import apply_fix


def get(variable="v1"):
    return B("variable.get", {"variable": variable})


def found(editor, kind):
    return [one for one in check(editor.project, editor.language) if one.kind == kind]


def goal(name):
    return [B("goal.goal", {"name": name})]


def of_goal(name):
    return [B("goal.when_goal", {"name": name})]


def test_a_goal_that_is_not_there_is_told_and_the_near_one_offered(language):
    editor = build(language, goal("greet visitors"), goal("dance"), of_goal("Greet visitor"))

    (problem,) = found(editor, "unknown_goal")
    assert "Greet visitor" in str(problem.sentence)
    apply_fix(editor, problem)

    assert not found(editor, "unknown_goal")
    assert editor.project.blocks[problem.block].fields["name"] == "greet visitors"


def test_a_goal_that_is_like_no_other_is_told_without_a_choice(language):
    editor = build(language, goal("greet"), goal("dance"), of_goal("xyz"))

    (problem,) = found(editor, "unknown_goal")
    assert problem.fix is None


def test_two_goals_of_one_name_are_told_and_can_be_told_apart(language):
    editor = build(language, goal("greet"), goal("greet"), goal("greet 2"), of_goal("greet"))

    (problem,) = found(editor, "same_goal")
    assert problem.severity == "error"
    apply_fix(editor, problem)

    assert not found(editor, "same_goal")
    assert not found(editor, "unknown_goal")


def test_goals_that_are_right_are_not_told(language):
    editor = build(language, goal("greet"), of_goal("greet"))

    assert not found(editor, "same_goal") + found(editor, "unknown_goal")


def asking(variable="v1"):
    asked = B("text.number", inputs={"text": B("robot_speech.ask_for")})
    total = B("math.arithmetic", {"operation": "add"}, {"a": get(), "b": asked})
    return [B("event.started"), B("variable.set", {"variable": variable}, {"value": total})]


def test_a_value_that_waits_between_reading_and_setting_is_told(language):
    other = [B("event.human_state"), B("variable.change", {"variable": "v1"})]
    editor = build(language, asking(), other, variables=("total", "copy"))

    (problem,) = found(editor, "torn_apart")
    assert "total" in str(problem.sentence)


def test_a_value_that_waits_is_fine_where_nobody_else_sets_it(language):
    alone = build(language, asking(), variables=("total", "copy"))
    elsewhere = build(language, asking("v2"), asking("v2"), variables=("total", "copy"))

    assert not found(alone, "torn_apart")
    assert not found(elsewhere, "torn_apart")


def test_what_is_put_into_a_list_or_table_while_others_change_it_is_not_lost(language):
    answer = {"value": B("robot_speech.ask_for"), "list": get()}
    fills = [B("event.started"), B("list.add", {}, answer)]
    shorter = [B("event.human_state"), B("list.remove", {}, {"list": get()})]
    votes = {"key": B("robot_speech.ask_for"), "table": get("v2")}
    counts = [B("event.gesture"), B("table.change", {}, votes)]
    empties = [
        B("event.human_state", {"state": "seen_face"}),
        B("table.take", {}, {"table": get("v2")}),
    ]
    editor = build(language, fills, shorter, counts, empties, variables=("list", "votes"))

    assert not found(editor, "torn_apart")


def test_a_value_of_a_table_that_is_read_before_a_wait_is_told(language):
    held = B("table.get", {}, {"table": get()})
    total = B("math.arithmetic", {}, {"a": held, "b": B("robot_speech.ask_number")})
    sets = [B("event.started"), B("table.set", {}, {"table": get(), "value": total})]
    other = [B("event.human_state"), B("table.change", {}, {"table": get()})]
    editor = build(language, sets, other, variables=("votes",))

    assert len(found(editor, "torn_apart")) == 1


def test_a_list_that_grows_in_its_own_loop_is_told(language):
    def loop(grown):
        adds = B("list.add", inputs={"list": get(grown)})
        each = B("control.for_each", {"variable": "v1"}, {"list": get("v2")}, {"do": [adds]})
        return build(language, [B("event.started"), each], variables=("n", "items", "others"))

    assert [one.severity for one in found(loop("v2"), "grows_in_loop")] == ["info"]
    assert not found(loop("v3"), "grows_in_loop")
