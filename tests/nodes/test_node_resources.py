from __future__ import annotations

import sys
from pathlib import Path

import pytest

from nep_core.errors import NodeStartError
from nodes.resources import OVERRIDE, resource_folder


def test_a_checkout_has_its_resources_beside_the_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(OVERRIDE, raising=False)

    assert (resource_folder() / "robots" / "nao" / "body.json").is_file()


def test_a_wheel_has_them_in_the_package_of_the_studio(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(OVERRIDE, raising=False)
    installed = tmp_path / "nep_studio" / "resources"
    installed.mkdir(parents=True)
    (tmp_path / "resources").mkdir()  # somebody else's
    monkeypatch.setattr("nep_core.places.__file__", str(tmp_path / "nep_core" / "places.py"))

    assert resource_folder() == installed


def test_a_frozen_program_has_them_where_it_was_unpacked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(OVERRIDE, raising=False)
    (tmp_path / "resources").mkdir()
    monkeypatch.setattr(sys, "_MEIPASS", str(tmp_path), raising=False)

    assert resource_folder() == tmp_path / "resources"


def test_the_variable_goes_first_and_a_wrong_one_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(OVERRIDE, str(tmp_path))
    found = resource_folder()
    monkeypatch.setenv(OVERRIDE, str(tmp_path / "nowhere"))

    assert found == tmp_path
    with pytest.raises(NodeStartError, match="resources folder") as told:
        resource_folder()
    assert OVERRIDE in str(told.value.checklist[1])
