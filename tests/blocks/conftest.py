"""The language of the product, and small programs made with the editor."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_core.program import tasks
from nep_studio.blocks.language import Language
from nep_studio.run.installation import load_language

RESOURCES = Path(__file__).resolve().parents[2] / "resources"


@pytest.fixture(scope="session")
def language() -> Language:
    gestures = {name: name for name in ("karate", "katana", "batting", "clap", "wave")}
    nodes = {"perceptual/gesture": "gesture", "sensory/virtual_watch": "virtual watch"}
    return load_language(
        RESOURCES / "blocks", RESOURCES / "robots/nao/robot.toml", gestures=gestures, nodes=nodes
    )


@pytest.fixture(autouse=True)
def _own_program() -> None:
    """A program of its own for each test: PROGRAM is one a process, and another may have ended."""
    tasks.PROGRAM.cancelled.clear()
    tasks.PROGRAM._children.clear()
    tasks.PROGRAM.undo.clear()
