"""A project may have robots of other models than NAO."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.generate.program import generate_launch
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.paths import resources
from nep_studio.run.installation import load_language, studio_language
from nep_studio.run.plan import Choices, plan
from tests.blocks.block_building import B, build


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


def project(language: Language, driver: str) -> Project:
    fields = {"name": "Lisa", "driver": driver, "address": ""}
    return build(language, [B("robots.robot", fields)], page="robots").project


def test_a_pepper_on_this_screen_can_be_chosen_and_is_planned(language: Language) -> None:
    (node,) = plan(project(language, "virtual_pepper"), language, Choices(), Path())

    assert language.choices["drivers"]["virtual_pepper"] == "a Pepper on this screen"
    assert next(iter(language.choices["drivers"])) == "virtual"
    assert node.parameters["driver"] == "virtual" and node.parameters["model"] == "pepper"


def test_a_nao_is_planned_as_ever(language: Language) -> None:
    (node,) = plan(project(language, "virtual"), language, Choices(), Path())

    assert "model" not in node.parameters
    assert robot_entries(project(language, "virtual"), language)[0].model == ""


def test_the_launcher_of_a_pepper_names_its_model(language: Language) -> None:
    code = generate_launch(project(language, "virtual_pepper"), language).text

    assert 'driver="virtual"' in code and 'model="pepper"' in code


def test_a_new_robot_folder_brings_its_own_entry(tmp_path: Path) -> None:
    robots = tmp_path / "robots"
    shutil.copytree(resources() / "robots", robots, ignore=shutil.ignore_patterns("animations"))
    own = robots / "zora" / "robot.toml"
    own.parent.mkdir()
    head = 'name = "zora"\ntitle = "Zora"\nnode = "action/nao"\n'
    own.write_text(head + '[choices.drivers]\nvirtual_zora = "a Zora on this screen"\n')

    language = load_language(resources() / "blocks", robots / "nao" / "robot.toml")

    assert language.choices["drivers"]["virtual_zora"] == "a Zora on this screen"
    assert "virtual_pepper" in language.choices["drivers"]
