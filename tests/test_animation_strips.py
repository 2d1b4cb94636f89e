"""The film strips of the documentation are made from what the virtual robot does."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QColor, QImage

import dev

pytestmark = pytest.mark.long

SCRIPT = Path(dev.__file__).parent / "tools" / "animation_strips.py"


def make_strips(*arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, str(SCRIPT), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("strips")
    done = make_strips("--folder", str(made), "nod", "wave")
    assert done.returncode == 0, done.stderr
    return made


def test_there_is_a_strip_in_light_and_one_in_dark(folder: Path) -> None:
    light, dark = (QImage(str(folder / f"animations-{theme}.png")) for theme in ("light", "dark"))

    assert light.size() == dark.size() and light.width() > 1000
    assert light.pixelColor(2, 2).lightness() > 200 > 60 > dark.pixelColor(2, 2).lightness()


def test_strips_that_were_made_just_now_are_not_out_of_date(folder: Path) -> None:
    done = make_strips("--check", "--folder", str(folder), "nod", "wave")

    assert done.returncode == 0, done.stdout + done.stderr


def test_a_strip_that_shows_something_else_is_found(folder: Path, tmp_path: Path) -> None:
    old = QImage(str(folder / "animations-light.png")).convertToFormat(QImage.Format.Format_RGB32)
    for x in range(40, 240):
        for y in range(40, 140):
            old.setPixelColor(x, y, QColor("red"))
    old.save(str(tmp_path / "animations-light.png"))

    done = make_strips("--check", "--folder", str(tmp_path), "nod", "wave")

    assert done.returncode == 1 and "out of date" in done.stdout
