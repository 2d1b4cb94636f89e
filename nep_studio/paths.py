"""Where the studio's own files are: in a checkout, in an installed wheel, or frozen."""

from __future__ import annotations

import sys
from pathlib import Path


def _root() -> Path:
    frozen = getattr(sys, "_MEIPASS", None)
    return Path(frozen) if frozen else Path(__file__).resolve().parent.parent


def resources() -> Path:
    """Blocks, robots, gestures, examples."""
    beside = _root() / "resources"
    return beside if beside.is_dir() else Path(__file__).resolve().parent / "resources"


def examples() -> Path:
    """The example projects."""
    return resources() / "examples"
