"""The pictures and tables about gestures show what the benchmark measured."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import dev

pytestmark = pytest.mark.long

DOCS = Path(dev.__file__).parent / "docs"


def make_figures(*arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, str(DOCS.parent / "tools" / "gesture_figures.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems draw letters in another way")
def test_the_page_about_gestures_shows_the_figures_that_are_kept() -> None:
    done = make_figures("--check")

    assert done.returncode == 0, done.stdout + done.stderr


def test_a_table_that_shows_something_else_is_found(tmp_path: Path) -> None:
    text = (DOCS / "gestures.md").read_text(encoding="utf-8")
    page = tmp_path / "gestures.md"
    page.write_text(text.replace("| trees | 0.", "| trees | 1."), encoding="utf-8")

    done = make_figures("--check", "--page", str(page))

    assert done.returncode == 1
    assert "gestures.md" in done.stdout
    assert "out of date" in done.stdout
    assert "| trees | 1." in page.read_text(encoding="utf-8")
