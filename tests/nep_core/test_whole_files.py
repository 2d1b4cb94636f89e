"""Files are written whole: the old one or the new one is there, whatever happens meanwhile."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from faults import files

WRITER = """
import sys
from pathlib import Path
from faults.files import whole_file
path, number = Path(sys.argv[1]), 0
print("begun", flush=True)
while True:
    number += 1
    with whole_file(path) as file:
        for _ in range(50):
            file.write(b"%06d" % number * 2000)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="nothing is killed like this here")
def test_a_program_that_is_killed_leaves_the_old_file_or_the_new_one(tmp_path: Path) -> None:
    path = tmp_path / "work.nep"
    path.write_bytes(b"000000" * 100_000)
    for wait_s in (0.02, 0.05, 0.1, 0.2):
        command = [sys.executable, "-c", WRITER, str(path)]
        writer = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert writer.stdout is not None
        writer.stdout.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            writer.wait(wait_s)
        writer.kill()
        writer.communicate()

        data = path.read_bytes()

        assert len(data) == 600_000
        assert data == data[:6] * 100_000


def test_the_folder_is_brought_to_the_disk_after_the_new_file_has_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps: list[str] = []
    sync, replace = os.fsync, os.replace

    def told_sync(number: int) -> None:
        steps.append("folder" if os.path.isdir(f"/proc/self/fd/{number}") else "file")
        sync(number)

    def told_replace(new: Path, path: Path) -> None:
        steps.append("place")
        replace(new, path)

    monkeypatch.setattr(os, "fsync", told_sync)
    monkeypatch.setattr(os, "replace", told_replace)

    with files.whole_file(tmp_path / "a") as file:
        file.write(b"new")

    if sys.platform == "linux":
        assert steps == ["file", "place", "folder"]


def test_nobody_writes_over_a_file_but_by_the_one_helper() -> None:
    """Any other way leaves half a file, or none, when the disk is full or the computer stops."""
    root = Path(files.__file__).resolve().parents[1]
    rooms = ("faults", "nep_core", "nep_studio", "nodes", "robots")
    found = [
        f"{file.relative_to(root).as_posix()}: {line.strip()}"
        for room in rooms
        for file in sorted((root / room).rglob("*.py"))
        if file.relative_to(root).as_posix() not in OTHERWISE
        for line in file.read_text(encoding="utf-8").splitlines()
        if WRITES.search(line)
    ]

    assert not found


WRITES = re.compile(
    r"\.write_(text|bytes)\(|open\([^)]*[\"'][wax]b?\+?[\"']|copyfile\(|os\.(replace|rename)\("
    r"|pixmap\.save\(str|FileIO\("
)
OTHERWISE = {
    "faults/files.py": "the helper",
    "nep_core/cli/__init__.py": "/dev/null",
    "nep_core/processes/handover.py": "a new file, for a moment",
    "nep_core/processes/node_log.py": "grows line by line",
    "nep_core/recordings/recorder.py": "grows message by message",
    "nep_studio/run/controller.py": "in a folder of its own, for a moment",
    "nep_studio/study/records.py": "grows line by line",
    "nep_studio/support/portable.py": "in a folder of its own, for a moment",
    "nep_studio/support/safe_mode.py": "grows crash by crash",
    "nep_studio/ui/plugins/gestures/results/certainties.py": "in a folder of its own, for a moment",
    "nep_studio/ui/plugins/sensors/recorder.py": "grows sample by sample",
    "nep_studio/ui/theme/look.py": "in a folder of its own, until the program ends",
}


@pytest.mark.skipif(sys.platform == "win32", reason="modes say little there")
def test_a_file_that_is_written_again_is_for_the_same_people(tmp_path: Path) -> None:
    path = tmp_path / "diary.csv"
    path.write_bytes(b"old")
    path.chmod(0o600)

    files.write_whole(path, "new")

    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize(("in_use", "is_saved"), [(3, True), (10**9, False)])
def test_a_file_that_somebody_has_open_is_tried_again_for_a_while(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, in_use: int, is_saved: bool
) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"old")
    tries = 0
    replace = os.replace

    def held(new: Path, to: Path) -> None:
        nonlocal tries
        tries += 1
        if tries <= in_use:
            raise PermissionError(13, "somebody has it open")
        replace(new, to)

    monkeypatch.setattr(os, "replace", held)
    monkeypatch.setattr(files.sys, "platform", "win32")
    monkeypatch.setattr(files, "IN_USE_S", 0.3)

    try:
        with files.whole_file(path) as file:
            file.write(b"new")
    except PermissionError:
        assert not is_saved

    assert path.read_bytes() == (b"new" if is_saved else b"old")
    assert [one.name for one in tmp_path.iterdir()] == ["a"]
