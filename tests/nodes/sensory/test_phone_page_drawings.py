"""The pictures of the warning that comes before the phone page."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtSvg import QSvgRenderer

import dev

ROOT = Path(dev.__file__).parent
NAMES = [f"warning_{phone}_{theme}" for phone in ("android", "ios") for theme in ("light", "dark")]


def test_the_drawings_are_those_of_their_script() -> None:
    command = [sys.executable, str(ROOT / "tools" / "phone_page_images.py"), "--check"]

    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)

    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_each_drawing_can_be_shown(qapp: object, name: str) -> None:
    renderer = QSvgRenderer(str(ROOT / "resources" / "phone_page" / f"{name}.svg"))

    image = QImage(renderer.defaultSize(), QImage.Format.Format_RGB32)
    image.fill(QColor("magenta"))
    with QPainter(image) as painter:
        renderer.render(painter)

    assert renderer.isValid()
    seen = {image.pixel(x, image.height() // 2) for x in range(image.width())}
    assert len(seen) > 4
