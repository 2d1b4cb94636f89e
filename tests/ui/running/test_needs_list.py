"""What a program needs: what is missing comes first, each with something to press."""

from __future__ import annotations

import socket

from nep_studio.blocks.checks.diagnostic import Diagnostic, Fix
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.running.needs import Need, answers_at, needs_of

KARATE = PlannedNode("perceptual/gesture", "karate", {}, "a rule waits for this gesture")
REAL = PlannedNode("action/nao", "NAO", {"driver": "naoqi", "address": "10.0.0.9"}, block_id="b1")


def needs(**more) -> list[Need]:
    given = {
        "problems": [],
        "nodes": [],
        "board": {},
        "answers": {},
        "has_rules": True,
        "is_connected": False,
        **more,
    }
    lists = [given.pop(key) for key in ("problems", "nodes", "board", "answers")]
    return needs_of(*lists, **given)


def fixes(need: Need) -> list[str]:
    return [fix.name for fix in need.fixes]


def test_a_program_that_has_all_needs_only_what_run_starts() -> None:
    found = needs(nodes=[KARATE])

    assert [need.state for need in found] == ["automatic", "automatic"]


def test_a_node_says_why_it_is_needed_and_can_be_started_now() -> None:
    node = needs(nodes=[KARATE])[1]

    assert "A rule waits for this gesture" in str(node.sentence)
    assert fixes(node) == ["start_node"]


def test_a_node_that_runs_is_met() -> None:
    status = NodeStatus("karate", "perceptual", health="ready", event="ready")

    found = needs(nodes=[KARATE], board={"karate": status}, is_connected=True)

    assert [need.state for need in found] == ["met", "met"]


def test_a_program_without_a_beginning_can_get_one() -> None:
    first = needs(has_rules=False)[0]

    assert (first.state, fixes(first)) == ("missing", ["add_start"])


def test_an_error_comes_first_with_its_fix_and_its_block() -> None:
    fix = Fix("add_robot", "Add the robot")
    error = Diagnostic(
        "error", "unknown_robot", "behaviour", "b7", "There is no such robot.", (), fix
    )
    warning = Diagnostic("warning", "busy", "behaviour", "b8", "It is odd.")

    first, second = needs(problems=[warning, error])

    assert (first.title, first.block) == ("There is no such robot.", "b7")
    assert fixes(first) == ["fix_problem", "show_block"]
    assert second.state == "automatic"


def test_a_real_robot_is_looked_for_and_then_met_or_missing() -> None:
    assert needs(nodes=[REAL])[0].state == "looking"

    assert [n.state for n in needs(nodes=[REAL], answers={"NAO": True})] == ["automatic", "met"]

    missing = needs(nodes=[REAL], answers={"NAO": False})[0]
    assert (missing.state, missing.block) == ("missing", "b1")
    assert fixes(missing) == ["simulator", "connect", "address"]


def test_an_address_answers_when_somebody_listens_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"127.0.0.1:{server.getsockname()[1]}"

        assert answers_at(address)

    assert not answers_at(address)


def test_an_address_that_is_none_does_not_answer() -> None:
    assert not answers_at("127.0.0.1:karate")
    assert not answers_at("127.0.0.1:99999999")
    assert not answers_at("")
