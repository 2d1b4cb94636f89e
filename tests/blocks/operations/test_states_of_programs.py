"""The states of a program are read, added, renamed and deleted, each as one step."""

from __future__ import annotations

import pytest
from block_building import B, build
from operating import one_step, say

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.states import (
    add_arrow,
    add_state,
    add_tree,
    delete_arrow,
    delete_state,
    free_state_name,
    rename_state,
)
from nep_studio.blocks.states import ANY, Machine, machines_of


def begins(state: str, *body: B, first: bool = False) -> list[B]:
    return [B("state.begins", {"state": state}, groups={"first": int(first)}), *body]


def done(start: str, end: str, machine: str = "") -> list[B]:
    groups = {"machine": 1} if machine else {}
    fields = {"state": start, "target": end, **({"machine.1": machine} if machine else {})}
    return [B("state.done", fields, groups=groups)]


@pytest.fixture
def visit(language) -> Editor:
    """Waiting, talking, and a state without blocks of its own."""
    return build(
        language,
        begins("waiting", say("Hello"), first=True),
        begins("talking", B("state.go", {"state": "waiting"})),
        [*done("waiting", "talking"), say("Here I come")],
        done("talking", "resting"),
        done("lost", "waiting"),
        [B("event.started"), B("state.go", {"state": "talking"})],
        done("red", "green", "lamp"),
    )


def machines(editor: Editor) -> tuple[Machine, ...]:
    return machines_of(editor.project, editor.language)


def ways(machine: Machine) -> list[tuple[str, str, bool]]:
    return [(arrow.start, arrow.end, arrow.is_transition) for arrow in machine.arrows]


def test_the_machines_of_a_program_are_read_with_all_that_leads_anywhere(visit: Editor) -> None:
    main, lamp = machines(visit)

    assert list(main.states) == ["waiting", "talking", "resting", "lost"]
    assert [bool(block) for block in main.states.values()] == [True, True, False, False]
    assert main.first == "waiting"
    assert ways(main) == [
        ("talking", "waiting", False),
        ("waiting", "talking", True),
        ("talking", "resting", True),
        ("lost", "waiting", True),
        (ANY, "talking", False),
    ]
    assert main.reached == {"waiting", "talking", "resting"}
    assert (lamp.name, ways(lamp)) == ("lamp", [("red", "green", True)])


def test_what_is_switched_off_or_worked_out_is_no_state(language) -> None:
    go = B("state.go", inputs={"state": B("text.join", {"item.1": "a", "item.2": "b"})})
    editor = build(language, [B("event.started"), go], begins("waiting"))
    editor.project.blocks[editor.project.pages["behaviour"][1].body[0]].disabled = True

    assert machines(editor) == ()


def test_a_state_is_added_and_the_first_one_is_where_the_program_begins(language) -> None:
    editor = build(language)

    with one_step(editor):
        add_state(editor, " waiting ", "", "behaviour", (40.0, 40.0))
    with one_step(editor):
        add_state(editor, "talking", "", "behaviour", (40.0, 200.0))

    [machine] = machines(editor)
    assert list(machine.states) == ["waiting", "talking"]
    assert machine.first == "waiting"
    assert free_state_name(editor, "") == "waiting 2"


def test_a_state_is_added_to_the_machine_that_is_meant(visit: Editor) -> None:
    block = add_state(visit, "red", "lamp", "behaviour", (0.0, 900.0))

    assert machines(visit)[1].states["red"] == block
    assert machines(visit)[1].first == "red"


@pytest.mark.parametrize("name", ["", "  ", "talking"])
def test_a_state_without_a_name_of_its_own_is_refused(visit: Editor, name: str) -> None:
    count = len(visit.project.blocks)

    with pytest.raises(EditRefused):
        add_state(visit, name, "", "behaviour", (0.0, 900.0))

    assert len(visit.project.blocks) == count


def test_a_state_that_is_only_named_gets_blocks(visit: Editor) -> None:
    block = add_state(visit, "resting", "", "behaviour", (0.0, 900.0))

    assert machines(visit)[0].states["resting"] == block


def test_an_arrow_is_added_and_is_a_program_still(visit: Editor) -> None:
    with one_step(visit):
        add_arrow(visit, "green", "red", "lamp", "behaviour", (0.0, 900.0))

    assert ways(machines(visit)[1]) == [("red", "green", True), ("green", "red", True)]
    code = generate_program(visit.project, visit.language).text
    assert '@behavior.transition("green", "red", done=True, machine="lamp")' in code


def test_a_state_gets_another_name_in_all_blocks_of_its_machine(visit: Editor) -> None:
    add_state(visit, "waiting", "lamp", "behaviour", (0.0, 900.0))

    with one_step(visit):
        rename_state(visit, "", "waiting", "looking around")

    main, lamp = machines(visit)
    assert main.first == "looking around"
    assert ("talking", "looking around", False) in ways(main)
    assert "waiting" not in main.states
    assert "waiting" in lamp.states


@pytest.mark.parametrize("name", ["", "talking", "lost"])
def test_a_name_that_another_state_has_is_refused(visit: Editor, name: str) -> None:
    with pytest.raises(EditRefused):
        rename_state(visit, "", "waiting", name)

    assert "waiting" in machines(visit)[0].states


def test_a_state_that_keeps_its_name_changes_nothing(visit: Editor) -> None:
    position = visit.history.position

    rename_state(visit, "", "waiting", " waiting ")

    assert visit.history.position == position


def test_an_arrow_goes_with_the_blocks_of_its_rule(visit: Editor) -> None:
    arrow = next(one for one in machines(visit)[0].arrows if one.end == "talking")

    with one_step(visit):
        delete_arrow(visit, arrow.block)

    assert ("waiting", "talking", True) not in ways(machines(visit)[0])
    assert "Here I come" not in generate_program(visit.project, visit.language).text


def test_going_to_a_state_is_deleted_without_the_rule_that_does_it(visit: Editor) -> None:
    arrow = next(one for one in machines(visit)[0].arrows if one.start == ANY)

    with one_step(visit):
        delete_arrow(visit, arrow.block)

    assert (ANY, "talking", False) not in ways(machines(visit)[0])
    assert "event.started" in {block.type for block in visit.project.blocks.values()}
    with pytest.raises(EditRefused):
        delete_arrow(visit, arrow.block)


def test_a_state_goes_with_all_transitions_from_and_to_it(visit: Editor) -> None:
    with one_step(visit):
        delete_state(visit, "", "waiting")

    assert ways(machines(visit)[0]) == [
        ("talking", "waiting", False),  # what other blocks do is left to the person
        ("talking", "resting", True),
        (ANY, "talking", False),
    ]


def test_a_tree_is_begun(language) -> None:
    editor = build(language)

    with one_step(editor):
        add_tree(editor, "behaviour", (40.0, 40.0))

    [stack] = editor.project.pages["behaviour"]
    assert [editor.project.blocks[one].type for one in stack.body] == ["tree.tree", "tree.sequence"]
