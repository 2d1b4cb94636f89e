"""Letting a watch give the movements: its block on the Nodes page, in one step."""

from __future__ import annotations

from pathlib import Path

import pytest
from block_building import B, build
from operating import one_step

from nep_studio.blocks.deployment import NODE_BLOCK, node_entries
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.fixes import USUAL_NAME, WATCH, free_name, use_watch
from nep_studio.run.installation import load_language

RESOURCES = Path(__file__).resolve().parents[3] / "resources"
NODES = ("perceptual/gesture", "sensory/smartwatch", "sensory/virtual_watch", "sensory/replay")
PHONE = {"through": "phone_page", "port": 8443, "token": "abc"}


@pytest.fixture(scope="module")
def language() -> Language:
    """The language with the nodes that give movements."""
    robot = RESOURCES / "robots/nao/robot.toml"
    return load_language(RESOURCES / "blocks", robot, nodes={node: node for node in NODES})


def launch(node: str, name: str, **parameters) -> B:
    return B(NODE_BLOCK, {"node": node, "name": name, "parameters": parameters})


def entries(editor):
    return [
        (one.node, one.name, dict(one.parameters))
        for one in node_entries(editor.project, editor.language)
    ]


def with_nodes(language, *blocks: B):
    return build(language, [*blocks], page="nodes") if blocks else build(language)


def test_a_project_without_a_watch_gets_a_block_on_the_nodes_page(language) -> None:
    editor = with_nodes(language)

    with one_step(editor):
        block = use_watch(editor, PHONE, "connect a watch")

    assert entries(editor) == [(WATCH, "watch", PHONE)]
    assert editor.project.page_of(block) == "nodes"


def test_the_block_of_the_watch_is_changed_and_keeps_its_name(language) -> None:
    editor = with_nodes(language, launch(WATCH, "Anna's watch", through="udp", columns="t,x,y,z"))

    with one_step(editor):
        use_watch(editor, PHONE, "connect a watch")

    assert entries(editor) == [(WATCH, "Anna's watch", PHONE)]


def test_a_virtual_watch_gives_way_and_nothing_else_does(language) -> None:
    editor = with_nodes(
        language,
        launch("perceptual/gesture", "karate", gesture="karate"),
        launch("sensory/virtual_watch", "virtual_watch", gestures="karate"),
        launch("sensory/replay", "old", recording="a.csv"),
    )

    with one_step(editor):
        use_watch(editor, PHONE, "connect a watch", name="watch")

    assert entries(editor) == [
        ("perceptual/gesture", "karate", {"gesture": "karate"}),
        (WATCH, "watch", PHONE),
    ]


def test_another_watch_comes_beside_the_first(language) -> None:
    editor = with_nodes(language, launch(WATCH, "watch", through="udp"))
    name = free_name(editor, USUAL_NAME)

    with one_step(editor):
        use_watch(editor, PHONE, "connect a watch", name=name)

    assert entries(editor) == [(WATCH, "watch", {"through": "udp"}), (WATCH, "watch 2", PHONE)]


def test_a_simulated_person_can_take_the_place_of_a_watch(language) -> None:
    editor = with_nodes(language, launch(WATCH, "watch", through="udp"))
    settings = {"gestures": "karate", "repeat": True}

    with one_step(editor):
        use_watch(editor, settings, "connect", node="sensory/virtual_watch", name="watch")

    assert entries(editor) == [("sensory/virtual_watch", "watch", settings)]
