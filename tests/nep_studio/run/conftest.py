"""What the tests of strangers' projects share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from nep_core.places import NODES_VARIABLE
from nep_studio.run.installation import studio_language
from nep_studio.support.portable import SETTINGS_VARIABLE
from tests.nep_studio.run.hostile_projects import Maker, own_nodes


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Maker]:
    monkeypatch.setenv(SETTINGS_VARIABLE, str(tmp_path / "home"))
    monkeypatch.setenv(NODES_VARIABLE, str(own_nodes(tmp_path)))
    folder = tmp_path / "from a stranger"
    folder.mkdir()
    with ExitStack() as ending:
        yield Maker(folder, studio_language(), ending)
