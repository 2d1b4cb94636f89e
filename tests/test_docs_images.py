"""The pictures of the documentation show the program as it is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QColor, QImage

import dev

pytestmark = pytest.mark.long

DOCS = Path(dev.__file__).parent / "docs"
IMAGES = DOCS / "images"
LARGEST_MB = 3.0
SMALL = ("field-colour", "outline")

only_on_linux = pytest.mark.skipif(
    sys.platform != "linux", reason="other systems draw letters in another way"
)


def make_images(*arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, str(DOCS.parent / "tools" / "make_images.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)


@only_on_linux
def test_two_small_pictures_show_the_program_as_it_is() -> None:
    done = make_images("--check", *SMALL)

    assert done.returncode == 0, done.stdout + done.stderr


@only_on_linux
def test_a_picture_that_shows_something_else_is_found(tmp_path: Path) -> None:
    old = QImage(str(IMAGES / "outline.png")).convertToFormat(QImage.Format.Format_RGB32)
    for x in range(40, 140):
        for y in range(40, 80):
            old.setPixelColor(x, y, QColor("red"))
    old.save(str(tmp_path / "outline.png"))

    done = make_images("--check", "--folder", str(tmp_path), "outline")

    assert done.returncode == 1
    assert "out of date" in done.stdout


def test_a_picture_that_nobody_draws_is_refused() -> None:
    done = make_images("no-such-picture")

    assert done.returncode == 2
    assert "There is no picture no-such-picture" in done.stdout


def test_all_pictures_of_the_documentation_are_there_and_small() -> None:
    texts = [DOCS.parent / "README.md", *DOCS.glob("*.md")]
    named = {
        name.partition(".png")[0]
        for text in texts
        for name in text.read_text(encoding="utf-8").split("images/")[1:]
    }

    kept = {path.stem for path in IMAGES.glob("*.png")}

    assert named <= kept
    assert sum(path.stat().st_size for path in IMAGES.glob("*.png")) < LARGEST_MB * 1e6
