"""A canvas that nobody holds any more goes quietly, whatever was open on it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[3]

USE = """
import gc
from itertools import product
from PySide6.QtGui import QAccessible, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.accessibility import make_accessible
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build
app, language, theme = QApplication([]), studio_language(), load_theme("light")

def use():
    editor = build(language, [B("robot.do"), B("robot.say")])
    canvas = Canvas(editor, theme)
    canvas.show()
    block = next(iter(editor.project.blocks))
    QAccessible.setActive(is_accessible)
    make_accessible(canvas)
    canvas.selection.set([block])
    assert canvas.fields.open(block, "posture"), "it has this field"
    if not is_left_open:
        canvas.fields.close()
    canvas.close()

for is_left_open, is_accessible in product([True, False], repeat=2):
    print(f"{is_left_open=} {is_accessible=}", flush=True)
    for _ in range(12):
        use()
        app.processEvents()
        gc.collect()
assert QGuiApplication.primaryScreen() is not None
"""


def test_canvases_can_be_collected_as_garbage() -> None:
    child = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", USE],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert child.returncode == 0, child.stdout + child.stderr


def test_nobody_asks_a_widget_for_its_screen() -> None:
    """Only ``room_around`` knows how to do that without deleting the screen later."""
    asking = [
        path.name
        for path in (ROOT / "nep_studio").rglob("*.py")
        if re.search(r"\w\.screen\(\)", path.read_text().replace("QWidget.screen()", ""))
    ]

    assert asking == []
