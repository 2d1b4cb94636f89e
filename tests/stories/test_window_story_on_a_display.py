"""The newcomer's story on a real X display, with a picture of each step."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import dev
from benchmarks.virtual_display import missing_programs

pytestmark = pytest.mark.long

STORY_IMAGES = Path(dev.__file__).parent / "tools" / "story_images.py"
STEPS = ["welcome", "example", "impressive", "stopped", "own-rule", "what-is-missing", "fixed"]


@pytest.mark.skipif(bool(missing_programs()), reason="Xvfb or xauth is not installed")
def test_the_newcomers_story_runs_under_xvfb(tmp_path: Path) -> None:
    command = [sys.executable, str(STORY_IMAGES), str(tmp_path)]

    done = subprocess.run(command, capture_output=True, text=True, timeout=110, check=False)

    assert done.returncode == 0, done.stdout + done.stderr
    kept = sorted(path.stem for path in tmp_path.glob("*.png"))
    assert kept == [f"story-{number}-{step}" for number, step in enumerate(STEPS, start=1)]
