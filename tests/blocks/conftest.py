"""The language of the product, and small programs made with the editor."""

from __future__ import annotations

from pathlib import Path

import pytest

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
