"""The animations of a project as files for the nodes of its robots."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.files import save
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.animations import keep_animation
from nep_studio.blocks.own_animations import JointKeys, OwnAnimation
from nep_studio.project.kept_files import AnimationFiles, animation_files, to_toml
from nep_studio.run.installation import studio_language
from nep_studio.run.plan import Choices, plan
from nodes.resources import resource_folder
from robots.body.animations import load_animation, load_animations, with_own
from robots.body.body import Body, load_body
from tests.blocks.block_building import B, build

pytestmark = pytest.mark.long

NAO = resource_folder() / "robots" / "nao"
HOP = OwnAnimation(
    'A "big" hop',
    {"HeadYaw": JointKeys((0.5, 1.25), (0.3, 0.0), ((0.1, 0.0, 0.1, 0.0), (0.2, 0.1, 0.0, 0.0)))},
    "gesture",
    says="Hop\n\x7f",
)


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.fixture(scope="module")
def body() -> Body:
    return load_body(NAO)


@pytest.fixture
def editor(language: Language) -> Editor:
    editor = build(language, [B("event.started"), B("robot.play")])
    return build(language, [B("robots.robot")], page="robots", editor=editor)


def test_the_text_of_an_animation_is_one_that_the_robot_reads(tmp_path: Path, body: Body) -> None:
    path = tmp_path / "hop.toml"

    path.write_text(to_toml(HOP), encoding="utf-8")

    read = load_animation(path, body)
    assert (read.title, read.kind, read.says) == (HOP.title, HOP.kind, HOP.says)
    assert read.keyframes.tracks["HeadYaw"].times == (0.5, 1.25)
    assert read.keyframes.tracks["HeadYaw"].handles == HOP.joints["HeadYaw"].handles


def test_a_joint_with_an_odd_name_stays_toml() -> None:
    odd = OwnAnimation("Odd", {"a b.c": JointKeys((1.0,), (0.0,))})

    assert tomllib.loads(to_toml(odd))["joints"]["a b.c"] == {"times": [1.0], "keys": [0.0]}


def test_the_robots_of_a_project_are_given_its_animations(
    editor: Editor, language: Language, body: Body
) -> None:
    keep_animation(editor, HOP)

    [robot] = plan(editor.project, language, Choices(), Path())

    assert robot.files is not None
    robot.files.write()
    assert load_animations(Path(str(robot.parameters["animations"])), body).names() == ["a_big_hop"]


def test_a_project_without_animations_needs_no_files(editor: Editor, language: Language) -> None:
    [robot] = plan(editor.project, language, Choices(), Path())

    assert robot.files is None
    assert "animations" not in robot.parameters


def test_the_same_animations_are_in_the_same_folder_and_others_in_another(editor: Editor) -> None:
    keep_animation(editor, HOP)
    first, again = animation_files(editor.project), animation_files(editor.project)
    keep_animation(editor, HOP)

    assert first == again
    assert first.folder != animation_files(editor.project).folder


def test_what_does_not_fit_the_robot_is_left_out_and_told(tmp_path: Path, body: Body) -> None:
    strange = OwnAnimation("Strange", {"Wheel": JointKeys((1.0,), (0.0,))})
    texts = {"hop.toml": to_toml(HOP), "strange.toml": to_toml(strange), "torn.toml": "title ="}
    AnimationFiles(tmp_path, texts).write()
    shipped = load_animations(NAO / "animations", body)

    animations, left_out = with_own(shipped, str(tmp_path), body)

    assert set(animations.names()) == {*shipped.names(), "hop"}
    assert len(left_out) == 2
    assert "Wheel" in str(left_out[0])


def test_without_a_folder_there_are_the_shipped_animations(body: Body) -> None:
    shipped = load_animations(NAO / "animations", body)

    animations, left_out = with_own(shipped, "", body)

    assert animations.names() == shipped.names()
    assert left_out == []


def test_a_project_run_without_a_window_plays_its_own_animation(
    editor: Editor, tmp_path: Path
) -> None:
    name = keep_animation(editor, HOP)
    plays = next(b.id for b in editor.project.blocks.values() if b.type == "robot.play")
    editor.apply(SetField(plays, "animation", name))
    save(editor.project, tmp_path / "hop.nep")
    command = ["run", str(tmp_path / "hop.nep"), "--json", "--speed", "5"]

    done = subprocess.run(
        [sys.executable, "-m", "nep_studio", *command], capture_output=True, text=True, timeout=60
    )

    told = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    results = [one["state"] for one in told if one.get("topic") == "/action_result"]
    assert done.returncode == 0, done.stderr
    assert "done" in results
    assert "failed" not in results
