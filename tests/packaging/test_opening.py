"""What installed programs rely on: the window draws itself, and opens what the system asks for."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtGui import QImage

pytestmark = pytest.mark.long

ASKED = """
import sys
from PySide6.QtCore import QUrl
from PySide6.QtGui import QFileOpenEvent
from nep_studio.ui.shell.app import Application

app = Application(sys.argv)
app.file_asked_for.connect(print)
app.sendEvent(app, QFileOpenEvent(QUrl.fromLocalFile(sys.argv[1])))
"""


def run(*words: str | Path, settings: Path) -> str:
    offscreen = {"QT_QPA_PLATFORM": "offscreen", "NEP_STUDIO_FOLDER": str(settings)}
    command = [sys.executable, *words]
    return subprocess.check_output(command, env=os.environ | offscreen, text=True)


def test_a_file_that_the_system_asks_for_is_told(tmp_path: Path) -> None:
    asked = tmp_path / "Dance é.nep"

    told = run("-X", "utf8", "-c", ASKED, asked, settings=tmp_path)

    assert Path(told.strip()) == asked


def test_the_window_draws_itself_into_a_file_and_tells_how_soon_it_was_there(
    tmp_path: Path,
) -> None:
    picture = tmp_path / "window.png"

    started_at = time.time()
    told = json.loads(run("-m", "nep_studio", "picture", picture, settings=tmp_path))

    drawn = QImage(str(picture))
    assert (drawn.width(), drawn.height()) == (1280, 800)
    assert told["drawn"] is True and told["platform"] == "offscreen"
    assert started_at < told["painted_at"] < time.time()
