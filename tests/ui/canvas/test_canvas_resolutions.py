"""The picture of the canvas is as right on screens with finer pixels."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import a_part_of

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize("ratio", a_part_of(["1.25", "1.5", "2"]))
def test_a_repaired_picture_is_right_at_this_resolution(ratio) -> None:
    environment = os.environ | {"QT_SCALE_FACTOR": ratio, "QT_QPA_PLATFORM": "offscreen"}
    chosen = "repaired and (0 or 3) or zooming or left_over and 1.0"
    tests = [f"tests/ui/canvas/test_canvas_{name}.py" for name in ("layers", "leftovers")]

    child = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", chosen, *tests],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )

    assert child.returncode == 0, child.stdout
