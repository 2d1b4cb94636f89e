"""A project's nodes against their manifests: told before anything starts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from nep_core.places import NODES_VARIABLE
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.run.installation import all_problems, studio_language
from tests.nep_studio.run.test_plan import project


def problems(
    folder: Path, *nodes: dict[str, Any], robots: tuple[Any, ...] = ()
) -> list[Diagnostic]:
    language = studio_language()
    given = project(language, nodes=nodes, robots=robots)
    kinds = ("node_settings", "reserved_name", "robot_address")
    return [one for one in all_problems(given, language, folder) if one.kind in kinds]


@pytest.mark.parametrize(
    ("node", "settings", "words"),
    [
        ("sensory/virtual_watch", {"person": "bob"}, "person"),
        ("sensory/virtual_watch", {"person": -1}, "person"),
        ("sensory/virtual_watch", {"colour": "red"}, "colour"),
        ("sensory/replay", {}, "recording"),
        ("sensory/replay", {"recording": "nowhere.csv"}, "nowhere.csv"),
        ("perceptual/gesture", {"gesture": "flying"}, "flying"),
        ("perceptual/gesture", {"method": "magic"}, "method"),
        ("perceptual/gesture", {"certainty": 7}, "certainty"),
    ],
)
def test_a_wrong_setting_is_told_with_its_node_and_block(
    tmp_path: Path, node: str, settings: dict[str, Any], words: str
) -> None:
    (found,) = problems(tmp_path, {"node": node, "name": "mine", "parameters": settings})

    assert str(found.sentence).startswith("“mine” cannot start.")
    assert words in str(found.sentence)
    assert found.checklist
    assert (found.severity, found.page, found.block) == ("error", "nodes", "b0")


def test_files_beside_the_project_and_gestures_of_its_own_models_are_right(tmp_path: Path) -> None:
    (tmp_path / "mine.gestures").touch()
    settings = {"model": "mine.gestures", "gesture": "flying"}

    node = {"node": "perceptual/gesture", "name": "flying", "parameters": settings}
    assert problems(tmp_path, node) == []


def test_a_wrong_manifest_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "sensory").mkdir()
    (tmp_path / "sensory" / "lamp.toml").write_text("title = [", encoding="utf-8")
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))

    (found,) = problems(tmp_path, {"node": "sensory/lamp", "name": "mine", "parameters": {}})

    assert "lamp.toml" in str(found.sentence)


@pytest.mark.parametrize("name", ["program", "studio", "master"])
def test_names_of_the_session_are_refused(tmp_path: Path, name: str) -> None:
    robot = {"name": name, "driver": "virtual", "address": ""}

    (found,) = problems(tmp_path, robots=(robot,))

    assert name in str(found.sentence)


def test_a_real_robot_needs_an_address(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, robots=({"name": "NAO", "driver": "naoqi", "address": " "},))

    assert "NAO" in str(found.sentence)
