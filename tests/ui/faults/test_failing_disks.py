"""A disk that is full or cannot be written to: nothing is lost, and the person is told in words."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_studio import settings
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.files import load
from nep_studio.project.journal import recover
from tests.ui.faults.conftest import Scene

FIRST = "Show me a karate chop!"
SMALL = "size=256k"

Mount = Callable[[Path, str], None]


@pytest.fixture
def mount() -> Iterator[Mount]:
    """Puts a small disk of its own on a folder."""
    mounted: list[Path] = []

    def put(folder: Path, options: str = SMALL) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        command = ["mount", "-t", "tmpfs", "-o", options, "nep-test", str(folder)]
        try:
            subprocess.run(command, check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError) as error:
            pytest.skip(f"disks can only be mounted by the administrator: {error}")
        mounted.append(folder)

    yield put
    for folder in mounted:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def fill(folder: Path) -> Path:
    """Leave no room on the disk of a folder; the file to remove for room."""
    file = folder / "filled"
    handle = os.open(file, os.O_WRONLY | os.O_CREAT)
    try:
        while True:
            os.write(handle, bytes(4096))
    except OSError:
        os.close(handle)
    return file


def rename(stage: Scene, name: str) -> None:
    stage.window.files.document.editor.apply(RenameProject(name))


def test_work_is_kept_again_when_a_full_disk_has_room(
    scene: Scene, home: Path, mount: Mount
) -> None:
    mount(home)
    scene.window.files.new()
    filler = fill(home)

    for number in range(200):  # until the last block of the disk that it has is full
        rename(scene, f"Name {number} {'x' * 50}")
    scene.until(lambda: "Save often" in scene.shown)

    [alarm] = scene.alarms
    assert "Is there room on the disk?" in tuple(map(str, alarm.checklist))
    filler.unlink()
    scene.until(lambda: "Save often" not in scene.shown)
    document, scene.window.files.document = scene.window.files.document, None
    document.close(keep=True)  # as if the computer had stopped now
    [work] = recover(settings.journal_folder(), scene.window.studio.language)
    assert work.project.name == f"Name 199 {'x' * 50}"


def test_the_warning_of_a_full_disk_has_a_button_that_saves(
    scene: Scene, home: Path, chooser, tmp_path: Path, mount: Mount
) -> None:
    mount(home)
    scene.window.files.new()
    fill(home)
    for number in range(200):
        rename(scene, f"Name {number} {'x' * 50}")
    scene.until(lambda: "Save often" in scene.shown)
    chooser.path = tmp_path / "elsewhere.nep"

    scene.press_answer("Save often", "Save")

    saved = load(chooser.path, scene.window.studio.language)
    assert saved.name.startswith("Name 199")


def test_without_room_for_the_program_it_does_not_run_without_room_for_logs_it_does(
    stage: Scene, tmp_path: Path, mount: Mount, monkeypatch: pytest.MonkeyPatch
) -> None:
    full, title = tmp_path / "full", "The program could not be written"
    mount(full)
    stage.local.logs = full / "logs"
    stage.local.logs.mkdir()
    fill(full)
    with monkeypatch.context() as no_room:
        no_room.setattr(tempfile, "tempdir", str(full))
        stage.press("run")
        stage.until(lambda: title in stage.shown)
    assert "Is there room on the disk?" in tuple(map(str, stage.alarms[0].checklist))
    stage.state_is("idle")

    stage.press_answer(title, "Run again")
    stage.until(lambda: FIRST in stage.said)

    assert [alarm.title for alarm in stage.alarms] == [title]
    assert not any(file.stat().st_size for file in stage.local.logs.iterdir())


def test_a_project_in_a_folder_that_cannot_be_written_runs_and_is_saved_elsewhere(
    stage: Scene, chooser, tmp_path: Path, mount: Mount
) -> None:
    folder = tmp_path / "locked"
    mount(folder)
    chooser.path = folder / "karate.nep"
    stage.window.files.save_as()
    subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
    before = chooser.path.read_bytes()
    rename(stage, "Changed")

    stage.window.actions_by_name["save"].trigger()
    stage.until(lambda: "The project is not saved" in stage.shown)

    assert len(stage.alarms) == 1
    assert stage.alarms[0].checklist
    assert (folder / "karate.nep").read_bytes() == before
    chooser.path = tmp_path / "elsewhere.nep"
    stage.press_answer("The project is not saved", "Save somewhere else…")
    assert load(chooser.path, stage.window.studio.language).name == "Changed"
    stage.run()
    stage.until(lambda: FIRST in stage.said)
