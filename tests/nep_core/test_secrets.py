"""What is secret is in no list of processes, and what starts from a strange folder reads ours."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import psutil
import pytest

from faults import fault_of
from nep_core.networks.master import Master
from nep_core.places import node_folders, own_folder, private_folder
from nep_core.processes import handover
from nep_core.processes.handover import SECRETS_VARIABLE, hand_over
from nep_core.processes.launcher import Launcher
from nep_core.processes.manifest import NodeCatalog
from nep_core.processes.node_log import NodeLog
from nep_core.processes.process import program_command
from nep_studio.support.safe_mode import StartNote
from nodes.perceptual.recognition import worker
from nodes.sensory.phone_page.server import own_certificate
from robots.body.camera import write_picture
from robots.naoqi.discovery import SavedLogin, logins_file, save_login

pytestmark = pytest.mark.long

SECRET = "open-sesame-4711"
NODE = """
import os
from pathlib import Path

def run(node, *, folder, token):
    Path(folder, "got").write_text(token)
    Path(folder, "left").write_text("".join(os.environ.values()))
    node.ready()
    while not node.wait(60):
        pass
"""
MANIFEST = """
type = "sensory"
name = "locked"
title = "Locked"
description = "Knows a secret."
[parameters.folder]
type = "text"
[parameters.token]
type = "text"
default = ""
secret = true
"""
COMMAND = """
command = ["{python}", "-c", '''
import os, sys, json, time
folder = [w for w in sys.argv if w.startswith("folder=")][0][7:]
told = json.loads(os.environ["NEP_SECRET_SETTINGS"])
open(os.path.join(folder, "got"), "w").write(told["token"])
time.sleep(600)
''']
"""


@pytest.mark.parametrize("is_python", [True, False])
def test_a_secret_setting_is_in_no_list_of_processes(
    launcher: Launcher, tmp_path: Path, is_python: bool
) -> None:
    folder = tmp_path / "nodes" / "sensory"
    command = "" if is_python else COMMAND.replace("{python}", sys.executable)
    (folder / "locked.toml").write_text(command + MANIFEST, encoding="utf-8")
    (folder / "locked.py").write_text(NODE, encoding="utf-8")

    launched = launcher.start("sensory/locked", folder=str(tmp_path), token=SECRET)
    while not (tmp_path / "got").is_file() or not (tmp_path / "got").read_text():
        assert not launched.ended.wait(0.05), launched.process.last_lines
    words = [
        word
        for process in psutil.Process(os.getpid()).children(recursive=True)
        for word in process.cmdline()
    ]
    launcher.close()

    assert (tmp_path / "got").read_text() == SECRET
    assert not [word for word in words if SECRET in word]
    assert SECRET not in repr(launched)
    assert SECRET not in (tmp_path / "logs" / "locked.log").read_text()
    if is_python:  # nor does what it starts itself get it
        assert SECRET not in (tmp_path / "left").read_text()


def test_the_token_of_the_phone_page_is_secret() -> None:
    parameters = NodeCatalog(node_folders()).find("sensory/smartwatch").parameters

    assert parameters["token"].secret
    assert SECRETS_VARIABLE == "NEP_SECRET_SETTINGS"  # docs/wire.md names it


@pytest.mark.parametrize("command", [program_command("node", "no/such"), worker.command_line()])
def test_a_file_beside_a_project_is_not_taken_for_a_library(
    tmp_path: Path, command: list[str]
) -> None:
    libraries = ("nep_core", "nep_studio", "nodes", "msgspec", "random", "sitecustomize", "numpy")
    for name in libraries:
        (tmp_path / f"{name}.py").write_text("open('marker', 'w').close()", encoding="utf-8")

    nobody = subprocess.DEVNULL
    subprocess.run(command, cwd=tmp_path, stdin=nobody, capture_output=True, check=False)

    assert not (tmp_path / "marker").exists()


@pytest.mark.parametrize("name", ["photo.png", "program.py", "program.pyc", "program"])
def test_a_file_that_is_packed_is_no_program(master: Master, tmp_path: Path, name: str) -> None:
    file, marker = tmp_path / name, tmp_path / "marker"
    file.write_bytes(b"\x89PNG\r\n\x1a\n")
    with zipfile.ZipFile(file, "a") as packed:
        packed.writestr("__main__.py", f"open({str(marker)!r}, 'w').close()")

    command = program_command("node", "cognitive/program", f"file={file}")
    done = subprocess.run(command, capture_output=True, text=True, check=False)

    assert done.returncode == 1
    assert "is no text in Python" in done.stderr
    assert not marker.exists()


@pytest.mark.skipif(os.name != "posix", reason="modes say nothing there")
def test_what_is_kept_is_for_its_owner_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NEP_STUDIO_FOLDER", str(tmp_path / "logins"))
    monkeypatch.setenv(handover.VARIABLE, str(tmp_path / "fault"))
    old = tmp_path / "old"
    old.mkdir(mode=0o755)

    umask = os.umask(0)
    try:
        made = [private_folder(old), private_folder(tmp_path / "new" / "inner")]
        with NodeLog(tmp_path / "logs" / "a.log") as log:
            log.write(b"secret")
        own_certificate((), tmp_path / "keys")
        save_login("nao.local", SavedLogin("nao", SECRET))
        write_picture(tmp_path / "robots" / "NAO" / "a.png", np.zeros((2, 2, 3), np.uint8))
        StartNote(tmp_path / "settings").succeeded()
        hand_over(fault_of("NAO at {place} does not answer.", place="203.0.113.7"))
    finally:
        os.umask(umask)

    made += [tmp_path / name for name in ("new", "logs", "keys", "logins", "settings")]
    made += [tmp_path / name for name in ("logs/a.log", "keys/phone_page.pem", "fault")]
    made += [tmp_path / name for name in ("robots", "robots/NAO")]
    made += [logins_file(), tmp_path / "robots/NAO/a.png"]
    assert not [f"{one}: {one.stat().st_mode:o}" for one in made if one.stat().st_mode & 0o077]
    assert own_folder("config")
