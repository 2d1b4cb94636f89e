"""Safe mode: offered after a start that failed, and nothing of the person's is read or changed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from nep_core.places import NODES_VARIABLE, node_folders
from nep_studio import paths
from nep_studio.__main__ import main
from nep_studio.support import safe_mode
from nep_studio.support.report import crash_part
from nep_studio.support.safe_mode import NOTE, StartNote

pytestmark = pytest.mark.long

CRASH = """
import ctypes, sys
from nep_studio.ui.shell import app
from nep_studio.ui.shell.main_window import MainWindow

MainWindow.start = lambda window, path: ctypes.string_at(0)
app.main([])
"""

CHOOSE = """
import os, sys
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from nep_studio.ui.shell import app

make, timers = app.make_application, []

def look():
    for window in QApplication.topLevelWidgets():
        if window.inherits("QMessageBox") and window.isVisible():
            window.safe_button.click()
        elif window.inherits("QMainWindow") and window.messages.history:
            timers.pop().stop()
            print(window.messages.history[0].message.title, window.settings.theme, flush=True)
            window.settings.theme = "dark"
            window.close()

def make_and_look():
    application = make()
    timers.append(QTimer(application, interval=50))
    timers[0].timeout.connect(look)
    timers[0].start()
    return application

app.make_application = make_and_look
sys.exit(app.main([]))
"""

LOG_OUT = """
import os, signal, sys
from PySide6.QtCore import QTimer
from nep_studio.ui.shell import app
from nep_studio.ui.shell.main_window import MainWindow

class Window(MainWindow):
    def start(self, path):
        super().start(path)
        self.lazy.completed.connect(lambda: QTimer.singleShot(0, self.work))

    def work(self):
        self.files.new()
        self.files.document.editor.add_variable("kept")
        QTimer.singleShot(0, self, lambda: os.kill(os.getpid(), signal.SIGTERM))

import nep_studio.ui.shell.main_window
nep_studio.ui.shell.main_window.MainWindow = Window
sys.exit(app.main([]))
"""


def run(script: str, home: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "NEP_STUDIO_FOLDER": str(home), "QT_QPA_PLATFORM": "offscreen"}
    return subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=60
    )


def test_after_a_crash_at_the_start_safe_mode_is_offered_and_leaves_the_settings_alone(
    tmp_path: Path,
) -> None:
    settings = tmp_path / "settings.ini"
    settings.write_text("[look]\ntheme=high_contrast\nlanguage=en\n", encoding="utf-8")
    before = settings.read_bytes()

    crashed = run(CRASH, tmp_path)
    is_noted = (tmp_path / NOTE).exists()
    chosen = run(CHOOSE, tmp_path)

    assert crashed.returncode != 0
    assert is_noted
    assert chosen.stdout == "This is safe mode system\n", chosen.stderr
    assert chosen.returncode == 0
    assert settings.read_bytes() == before
    assert not (tmp_path / NOTE).exists()
    if hasattr(signal, "SIGSEGV") and sys.platform != "win32":
        part = crash_part(tmp_path)
        assert part.lines[0].startswith("Fatal Python error: Segmentation fault")
        assert part.findings[0].state == "note"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows ends sessions without signals")
def test_logging_out_soon_after_the_start_is_no_crash_and_keeps_the_work(tmp_path: Path) -> None:
    done = run(LOG_OUT, tmp_path)

    assert done.returncode == 128 + signal.SIGTERM, done.stderr
    assert not (tmp_path / NOTE).exists()
    [edits] = (tmp_path / "journals").rglob("*.edits")
    assert b"kept" in edits.read_bytes()


def test_a_start_that_still_goes_on_is_no_failed_one(tmp_path: Path) -> None:
    first = StartNote(tmp_path)
    second = StartNote(tmp_path)
    second.succeeded()
    is_there = (tmp_path / NOTE).exists()
    first.succeeded()

    assert (first.last_failed, second.last_failed, is_there) == (False, False, True)
    assert not StartNote(tmp_path).last_failed


def test_a_start_into_a_folder_that_cannot_be_written_goes_on(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")

    note = StartNote(blocked / "folder")
    note.succeeded()
    safe_mode.keep_crashes(blocked / "folder")

    assert not note.last_failed


def test_the_option_leaves_out_what_others_made(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(safe_mode.VARIABLE, "")
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    monkeypatch.setenv("QT_STYLE_OVERRIDE", "strange")

    code = main(["--safe-mode", "check", str(paths.examples() / "dance.nep")])

    assert code == 0, capsys.readouterr().err
    assert safe_mode.is_on()
    assert tmp_path not in node_folders()
    assert "QT_STYLE_OVERRIDE" not in os.environ


def test_settings_set_aside_stay_beside(tmp_path: Path) -> None:
    (tmp_path / "settings.ini").write_text("[look]\n")

    done = safe_mode.set_settings_aside(tmp_path), safe_mode.set_settings_aside(tmp_path)

    assert done == (True, False)
    assert (tmp_path / "settings.old.ini").read_text() == "[look]\n"


def test_safe_settings_go_with_the_program(tmp_path: Path) -> None:
    script = (
        "from nep_studio.support import safe_mode; s = safe_mode.passing_settings(); "
        "s.theme = 'dark'; s.write(); print(s.folder, s.tour_done)"
    )

    folder, tour_done = run(script, tmp_path).stdout.split()

    assert tour_done == "True"
    assert not Path(folder).exists()
    assert list(tmp_path.iterdir()) == []
