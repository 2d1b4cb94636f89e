"""Portable mode: what belongs to the person is beside the program, nothing is left elsewhere."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_core import places
from nep_core.places import PORTABLE_VARIABLE, ROBOT_FILES_VARIABLE
from nep_studio.settings import Settings, log_file, usual_folder
from nep_studio.support import portable
from nodes.sensory.phone_page.server import certificate_folder
from robots.naoqi.discovery import logins_file

PROJECT = Path(portable.__file__).parents[2]
VARIABLES = (PORTABLE_VARIABLE, ROBOT_FILES_VARIABLE, portable.SETTINGS_VARIABLE)

USE = """
import runpy, sys
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from nep_studio.ui.shell import app

make, timers = app.make_application, []

def make_and_close():
    application = make()
    timers.append(QTimer(application, interval=50))
    timers[0].timeout.connect(close)
    timers[0].start()
    return application

def close():
    for window in QApplication.topLevelWidgets():
        if window.inherits("QMainWindow") and window.isVisible() and window.lazy.is_done:
            window.files.new()
            window.settings.add_recent(window.settings.last_folder / "first.nep")
            timers.pop().stop()
            window.close()

app.make_application = make_and_close
sys.argv = ["nep-studio", "--portable"]
runpy.run_module("nep_studio", run_name="__main__")
"""


@pytest.fixture(autouse=True)
def not_portable(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """What a test sets is taken back, also in the environment."""
    for name in VARIABLES:
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)
    yield


@pytest.fixture
def stick(tmp_path: Path) -> Path:
    """A folder with a program of its own."""
    folder = tmp_path / "stick"
    (folder / "nep_studio").mkdir(parents=True)
    for path in (PROJECT / "nep_studio").iterdir():
        if path.is_file():
            shutil.copy2(path, folder / "nep_studio")
        elif path.name == "support":  # it finds the stick by where it is itself
            shutil.copytree(path, folder / "nep_studio" / path.name)
        elif path.name != "__pycache__":
            (folder / "nep_studio" / path.name).symlink_to(path)
    for name in ("faults", "nep_core", "nodes", "robots", "resources"):
        (folder / name).symlink_to(PROJECT / name)
    return folder


def test_a_program_on_a_stick_leaves_nothing_on_the_computer(stick: Path, tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    environment = {name: value for name, value in os.environ.items() if not name.startswith("XDG")}
    environment |= {"HOME": str(home), "USERPROFILE": str(home), "QT_QPA_PLATFORM": "offscreen"}
    environment.pop(ROBOT_FILES_VARIABLE, None)

    used = subprocess.run(
        [sys.executable, "-c", USE],
        cwd=stick,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert used.returncode == 0, used.stderr
    data = stick / portable.NAME
    assert "./NEP%20Studio%20data/projects/first.nep" in (
        data / "settings" / "settings.ini"
    ).read_text("utf-8").replace(" ", "%20")
    assert (data / "settings" / "journals").is_dir()
    assert [path for path in home.rglob("*") if path.is_file()] == []


def test_everything_is_kept_in_the_folder_beside_the_program(tmp_path: Path) -> None:
    folder = tmp_path / portable.NAME
    folder.mkdir()

    portable.begin(beside=tmp_path)

    kept = (
        *(log_file(), usual_folder("projects"), usual_folder("recordings"), usual_folder("logs")),
        *(places.log_folder(), places.cache_folder(), places.key_file()),
        *(places.robot_folder("NAO"), logins_file(), certificate_folder(), Settings().folder),
    )
    assert [path for path in kept if not path.is_relative_to(folder)] == []
    assert portable.not_kept() is None


def test_without_the_folder_it_is_not_portable_until_somebody_asks(tmp_path: Path) -> None:
    portable.begin(beside=tmp_path)
    before = places.portable_folder()

    portable.begin(is_asked=True, beside=tmp_path)

    assert before is None
    assert places.portable_folder() == tmp_path / portable.NAME


def test_projects_on_the_stick_are_found_under_another_drive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "E", tmp_path / "F"
    for drive in (first, second):
        (drive / portable.NAME).mkdir(parents=True)
    portable.begin(beside=first)
    settings = Settings(tmp_path / "settings")
    settings.add_recent(tmp_path / "elsewhere.nep")
    settings.add_recent(first / "class" / "dance.nep")
    settings.set_folder("recordings", first / "recordings")

    monkeypatch.setenv(PORTABLE_VARIABLE, str(second / portable.NAME))

    assert settings.recent_files == [second / "class" / "dance.nep", tmp_path / "elsewhere.nep"]
    assert settings.folder_for("recordings") == second / "recordings"


def test_a_write_protected_stick_is_used_with_its_settings_and_left_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / portable.NAME
    (folder / "settings" / "journals" / "one").mkdir(parents=True)
    (folder / "settings" / "settings.ini").write_text("[look]\ntheme=dark\n", encoding="utf-8")
    monkeypatch.setattr(portable, "_can_write", lambda folder: False)

    portable.begin(beside=tmp_path)

    passing = places.portable_folder()
    assert passing is not None and not passing.is_relative_to(tmp_path)
    assert portable.not_kept() == folder
    assert Settings().theme == "dark"
    assert not (Settings().folder / "journals").exists()
    assert not usual_folder("projects").is_relative_to(passing)  # what is saved must stay
    shutil.rmtree(passing)


def test_where_the_folder_cannot_be_made_nothing_is_kept_and_nothing_is_left(
    tmp_path: Path,
) -> None:
    (tmp_path / portable.NAME).write_text("a file is in the way")
    script = (
        "from nep_studio.support import portable; from nep_core.places import log_folder; "
        "from pathlib import Path; import sys; "
        "portable.begin(is_asked=True, beside=Path(sys.argv[1])); "
        "log_folder().mkdir(parents=True); print(log_folder().parent); print(portable.not_kept())"
    )

    done = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, timeout=30
    )

    passing, missed = done.stdout.splitlines()
    assert missed == str(tmp_path / portable.NAME)
    assert not Path(passing).exists()


@pytest.mark.parametrize(
    ("program", "beside"),
    [
        ("stick/NEP Studio.app/Contents/MacOS/nep-studio", "stick"),
        ("stick/nep-studio/nep-studio", "stick/nep-studio"),
    ],
)
def test_a_frozen_program_looks_where_the_person_sees_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: str, beside: str
) -> None:
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(sys, "executable", str(tmp_path / program))
    monkeypatch.delenv("APPIMAGE", raising=False)

    assert portable.program_folder() == (tmp_path / beside).resolve()

    monkeypatch.setenv("APPIMAGE", str(tmp_path / "tools" / "nep-studio.AppImage"))
    assert portable.program_folder() == tmp_path / "tools"
