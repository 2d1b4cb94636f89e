"""Which nodes a project needs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from nep_studio.blocks.files import from_bytes
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.run.plan import Choices, PlannedNode, plan


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


def project(
    language: Language,
    *,
    rules: tuple[str, ...] = (),
    states: tuple[str, ...] = (),
    speaks_to: str = "NAO",
    robots: tuple[dict[str, Any], ...] = (),
    nodes: tuple[dict[str, Any], ...] = (),
) -> Project:
    """A project with a rule for each gesture and human state, in which a robot says hello."""
    blocks: list[dict[str, Any]] = []
    pages: dict[str, list[dict[str, Any]]] = {"behaviour": [], "robots": [], "nodes": []}

    def stack(page: str, *chain: dict[str, Any]) -> None:
        ids = []
        for block in chain:
            blocks.append({"id": f"b{len(blocks)}", **block})
            ids.append(blocks[-1]["id"])
        pages[page].append({"id": f"s{len(blocks)}", "x": 0, "y": 0, "body": ids})

    say = {"type": "robot.say", "fields": {"robot": speaks_to, "text": "Hello"}}
    for gesture in rules:
        stack("behaviour", {"type": "event.gesture", "fields": {"gesture": gesture}}, say)
    for state in states:
        stack("behaviour", {"type": "event.human_state", "fields": {"state": state}}, say)
    for fields in robots:
        stack("robots", {"type": "robots.robot", "fields": fields})
    for fields in nodes:
        stack("nodes", {"type": "nodes.launch", "fields": fields})
    whole = {
        "format": "nep-studio-project",
        "version": 2,
        "name": "Test",
        "variables": [],
        "blocks": blocks,
        "pages": pages,
    }
    return from_bytes(msgspec.json.encode(whole), "test.nep", language)


def planned(
    project: Project, language: Language, folder: Path = Path(), choices: Choices | None = None
) -> dict[str, PlannedNode]:
    return {node.name: node for node in plan(project, language, choices or Choices(), folder)}


def test_what_rules_need_is_added_and_says_why(language: Language) -> None:
    robots = ({"name": "NAO", "driver": "virtual", "address": ""},)
    nodes = planned(project(language, rules=("karate",), robots=robots), language)

    assert {name: node.node for name, node in nodes.items()} == {
        "NAO": "action/nao",
        "karate": "perceptual/gesture",
        "virtual_watch": "sensory/virtual_watch",
    }
    assert nodes["NAO"].parameters["driver"] == "virtual"
    assert nodes["karate"].parameters == {"gesture": "karate"}
    assert nodes["virtual_watch"].parameters == {}
    assert {name for name, node in nodes.items() if node.reason} == {"karate", "virtual_watch"}


def test_a_virtual_watch_moves_by_itself_where_nobody_can_ask_it(language: Language) -> None:
    nodes = planned(project(language, rules=("karate",)), language, choices=Choices(by_itself=True))

    assert nodes["virtual_watch"].parameters == {"gestures": "karate"}


def test_a_rule_that_waits_for_how_an_arm_is_held_gets_the_node_that_tells(
    language: Language,
) -> None:
    states = ("arm_raised", "arm_lowered", "touched_head", "arm_of_mine")
    nodes = planned(project(language, states=states), language)
    alone = planned(
        project(language, rules=("karate",), states=states[:1]),
        language,
        choices=Choices(by_itself=True),
    )

    assert {name: node.node for name, node in nodes.items()} == {
        "arm": "perceptual/posture",
        "virtual_watch": "sensory/virtual_watch",
    }
    assert nodes["arm"].parameters == {} and nodes["arm"].reason
    assert alone["virtual_watch"].parameters == {"gestures": "karate, arm_raised"}


@pytest.mark.parametrize("state", ["arm_of_mine", "arm_", "touched_head"])
def test_no_other_state_needs_a_watch(language: Language, state: str) -> None:
    assert planned(project(language, states=(state,)), language) == {}


def test_a_posture_node_of_the_page_is_the_one_that_tells(language: Language) -> None:
    settings = {"worn": "left wrist"}
    node = ({"node": "perceptual/posture", "name": "mine", "parameters": settings},)

    nodes = planned(project(language, states=("arm_level",), nodes=node), language)

    assert set(nodes) == {"mine", "virtual_watch"}
    assert nodes["mine"].parameters == settings


def test_a_robot_may_have_the_name_of_the_posture_node(language: Language) -> None:
    robots = ({"name": "arm", "driver": "virtual", "address": ""},)

    nodes = planned(project(language, states=("arm_level",), robots=robots), language)

    assert len(nodes) == 3 and nodes["arm"].node == "action/nao"


@pytest.mark.parametrize("gestures", ["", "3 katana"])
def test_a_virtual_watch_of_the_page_moves_by_itself_when_it_is_to(
    language: Language, gestures: str
) -> None:
    settings = {"by_itself": True, "person": 107} | ({"gestures": gestures} if gestures else {})
    watch = ({"node": "sensory/virtual_watch", "name": "watch", "parameters": settings},)

    nodes = planned(project(language, rules=("karate",), nodes=watch), language)

    assert nodes["watch"].parameters == {"person": 107, "gestures": gestures or "karate"}


@pytest.mark.parametrize("node", ["sensory/virtual_watch", "sensory/smartwatch"])
def test_a_watch_that_was_left_running_is_the_one_that_is_used(
    language: Language, node: str
) -> None:
    left = PlannedNode(node, "mine", {}, "it was asked for")

    nodes = planned(project(language, rules=("karate",)), language, choices=Choices(watch=left))

    assert [one for one in nodes.values() if one.is_sensory] == [left]


def test_what_the_pages_name_is_not_added_again(language: Language) -> None:
    given = project(
        language,
        rules=("karate",),
        robots=({"name": "NAO", "driver": "virtual", "address": ""},),
        nodes=(
            {"node": "sensory/smartwatch", "name": "watch", "parameters": {}},
            {"node": "perceptual/gesture", "name": "mine", "parameters": {"gesture": "karate"}},
        ),
    )

    nodes = planned(given, language)

    assert set(nodes) == {"NAO", "watch", "mine"}
    assert not any(node.reason for node in nodes.values())


def test_a_node_for_a_whole_set_of_gestures_is_enough(language: Language) -> None:
    whole = ({"node": "perceptual/gesture", "name": "all", "parameters": {}},)

    nodes = planned(project(language, rules=("karate", "katana"), nodes=whole), language)

    assert [name for name, node in nodes.items() if node.node == "perceptual/gesture"] == ["all"]


def test_a_recording_takes_the_place_of_all_sensors(language: Language) -> None:
    watch = ({"node": "sensory/smartwatch", "name": "watch", "parameters": {}},)
    given = project(language, rules=("karate",), nodes=watch)

    nodes = planned(given, language, choices=Choices(Path("mine.csv"), 2.0))

    sensors = [node for node in nodes.values() if node.is_sensory]
    assert [node.node for node in sensors] == ["sensory/replay"]
    assert sensors[0].parameters["recording"] == "mine.csv"
    assert sensors[0].parameters["speed"] == 2.0


def test_a_speed_hurries_what_is_virtual_and_nothing_else(language: Language) -> None:
    robots = tuple(
        {"name": name, "driver": driver, "address": ""}
        for name, driver in (("NAO", "virtual"), ("Real", "naoqi"))
    )
    watches = (
        {"node": "sensory/virtual_watch", "name": "watch", "parameters": {"speed": 20.0}},
        {"node": "sensory/smartwatch", "name": "mine", "parameters": {}},
    )
    given = project(language, rules=("karate",), robots=robots, nodes=watches)

    nodes = planned(given, language, choices=Choices(speed=3.0))

    speeds = {name: node.parameters.get("speed") for name, node in nodes.items()}
    assert speeds == {"NAO": 3.0, "Real": None, "watch": 50.0, "mine": None, "karate": None}


def test_an_address_makes_a_robot_real(language: Language) -> None:
    robots = ({"name": "NAO", "driver": "virtual", "address": ""},)
    given = project(language, rules=("karate",), robots=robots)

    nodes = planned(given, language, choices=Choices(addresses={"NAO": "10.0.0.7"}))

    assert nodes["NAO"].parameters == {"robot": "NAO", "driver": "naoqi", "address": "10.0.0.7"}


def test_files_of_nodes_are_found_beside_the_project(language: Language, tmp_path: Path) -> None:
    (tmp_path / "mine.gestures").touch()
    settings = {"model": "mine.gestures", "gesture": "jump"}
    own = ({"node": "perceptual/gesture", "name": "jump", "parameters": settings},)

    nodes = planned(project(language, nodes=own), language, tmp_path)

    assert nodes["jump"].parameters["model"] == str(tmp_path / "mine.gestures")
    assert nodes["jump"].parameters["gesture"] == "jump"
