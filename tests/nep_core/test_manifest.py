"""Manifests: right ones are read, wrong ones are told with file and place."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import ManifestError, NodeNotFound, ParameterError
from nep_core.places import node_folders
from nep_core.processes.manifest import Manifest, NodeCatalog, Parameter, read_manifest

GOOD = """
type = "sensory"
name = "lamp"
title = "Lamp"
description = "Sees how bright it is."
aliases = ["light"]
[parameters.rate_hz]
type = "number"
default = 10
minimum = 1
maximum = 100
[parameters.place]
type = "choice"
choices = ["left", "right"]
default = "left"
[parameters.port]
type = "integer"
default = 80
[parameters.loud]
type = "boolean"
default = false
[parameters.file]
type = "file"
required = true
help = "what to read"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(tmp_path, GOOD)
    return tmp_path


def write(folder: Path, text: str, type_: str = "sensory", name: str = "lamp") -> Path:
    path = folder / type_ / f"{name}.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.with_suffix(".py").write_text("def run(node): pass\n", encoding="utf-8")
    return path


def lamp(folder: Path) -> Manifest:
    return NodeCatalog((folder,)).find("sensory/lamp")


def test_parameters_are_typed_and_defaults_filled_in(folder: Path) -> None:
    given = {"rate_hz": "25", "loud": "yes", "port": "8080", "file": "a.csv"}

    assert lamp(folder).read_parameters(given) == {
        "rate_hz": 25.0,
        "place": "left",
        "port": 8080,
        "loud": True,
        "file": "a.csv",
    }


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"file": "a", "rate_hz": "fast"}, "a number"),
        ({"file": "a", "rate_hz": 1000}, "it takes a number from 1 to 100"),
        ({"file": "a", "rate_hz": "nan"}, "a number"),
        ({"file": "a", "rate_hz": True}, "a number"),
        ({"file": "a", "port": 1.5}, "a whole number"),
        ({"file": "a", "place": "middle"}, "one of left, right"),
        ({"file": "a", "loud": "perhaps"}, "true or false"),
        ({"file": "a", "volume": 3}, 'no setting "volume"'),
        ({"file": 5}, "the name of a file"),
        ({}, 'needs the setting "file": what to read'),
    ],
)
def test_a_wrong_parameter_is_told_with_what_it_takes(
    folder: Path, given: dict[str, object], words: str
) -> None:
    with pytest.raises(ParameterError, match=words):
        lamp(folder).read_parameters(given)


@given(value=st.text() | st.floats() | st.integers() | st.booleans() | st.none() | st.binary())
def test_any_value_is_read_or_refused(value: object) -> None:
    for kind in ("text", "number", "integer", "boolean", "choice", "file"):
        try:
            Parameter(type=kind, choices=["a"]).read("p", value)
        except ParameterError as error:
            assert '"p"' in str(error.sentence)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("not toml [", "lamp.toml"),
        ("", "missing required field"),
        (GOOD.replace('"sensory"', '"magic"'), "magic"),
        (GOOD + "colour = 5\n", "colour"),
        (GOOD.replace('name = "lamp"', 'name = "other"'), "its place says otherwise"),
        (GOOD.replace("default = 10", "default = 5000"), "to 100"),
        (GOOD.replace('type = "number"', 'type = "tiny"'), "tiny"),
        (GOOD.replace("[parameters.port]", '[parameters."a b"]'), "cannot name a setting"),
        (GOOD.replace("[parameters.port]", "[parameters.class]"), "cannot name a setting"),
        (GOOD.replace("[parameters.port]", "[parameters.node]"), "cannot name a setting"),
        (GOOD.replace("minimum = 1", "minimum = 101"), "a minimum above its maximum"),
        (GOOD.replace('"file"', '"file"\nminimum = 1'), "is no number"),
        (GOOD.replace('choices = ["left", "right"]\ndefault = "left"', ""), "has no choices"),
        ("ready_s = 0\n" + GOOD, "ready_s is 0"),
        ("ready_s = nan\n" + GOOD, "ready_s is nan"),
        ('restart = "perhaps"\n' + GOOD, "perhaps"),
        ('command = ["sh", ""]\n' + GOOD, "empty word"),
        ('says = ["lamp"]\n' + GOOD, "does not begin with /"),
    ],
)
def test_a_wrong_manifest_is_told_with_its_file_and_place(
    folder: Path, text: str, words: str
) -> None:
    write(folder, text)

    with pytest.raises(ManifestError, match=words) as raised:
        lamp(folder)

    assert "lamp.toml" in str(raised.value.sentence)
    assert raised.value.checklist


def test_a_manifest_says_when_a_node_is_started_again_and_how_long_it_may_take(
    folder: Path,
) -> None:
    assert (lamp(folder).restart, lamp(folder).ready_s) == ("on-crash", 10)

    write(folder, 'restart = "always"\nready_s = 60\n' + GOOD)

    assert (lamp(folder).restart, lamp(folder).ready_s) == ("always", 60)


def test_a_manifest_without_code_is_told(folder: Path) -> None:
    (folder / "sensory" / "lamp.py").unlink()

    with pytest.raises(ManifestError, match=r"no lamp\.py beside it"):
        lamp(folder)


def test_a_node_is_found_by_its_alias(folder: Path) -> None:
    assert NodeCatalog((folder,)).find("sensory/light").name == "lamp"


@pytest.mark.parametrize("node", ["sensory/nothing", "lamp", "", "sensory/../lamp", "a/b/c"])
def test_a_node_that_is_not_there_is_told_with_those_that_are(folder: Path, node: str) -> None:
    with pytest.raises(NodeNotFound) as raised:
        NodeCatalog((folder,)).find(node)

    assert "sensory/lamp" in str(raised.value.checklist[0])


def test_every_shipped_manifest_is_right() -> None:
    paths = NodeCatalog(node_folders()).paths()

    assert [read_manifest(path).id for path in paths]
