"""The window itself is killed while a program runs: no process stays, and the work is offered."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import psutil
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio import settings
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.support import RecoveryDialog
from tests.nep_core.node_making import write_node

GONE_S = 20
"""Two seconds are given to each process; the rest is for a busy computer."""

WORK = """
import json, sys
from PySide6.QtCore import QTimer
from nep_studio import paths
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.shell.app import Studio, make_application
from nep_studio.ui.shell.main_window import MainWindow

app = make_application()
window = MainWindow(Studio(app))
window.show()
window.start(None)
window.files.open_example(paths.examples() / "karate_greeting.nep")
window.files.document.editor.apply(RenameProject("Not saved yet"))
runner = window.running.runner
foreign = PlannedNode("sensory/foreign", "foreign", {})
runner.local.gate.vouch_for(foreign)  # a person has just said yes
runner.start_node(foreign)
runner.run()

def look():
    board = runner.board.nodes
    if runner.state == "running" and "foreign" in board and board["foreign"].health == "ready":
        timer.stop()
        print("running", flush=True)

timer = QTimer(interval=50)
timer.timeout.connect(look)
timer.start()
app.exec()
"""

FOREIGN = """
import signal, sys, time
from nep_core import Node
node = Node(sys.argv[sys.argv.index("--name") + 1], "sensory")
signal.signal(signal.SIGTERM, signal.SIG_IGN)
node.ready()
while True:
    time.sleep(1)
"""
"""Written in a language that knows of no life line, it would go on for ever."""


def test_a_killed_window_leaves_no_process_and_its_work_is_offered(
    window: MainWindow, home: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    command = f"command = {[sys.executable, '{folder}/foreign.script']!r}\n"
    write_node(tmp_path / "nodes", "foreign", "pass", manifest=command)
    (tmp_path / "nodes" / "sensory" / "foreign.script").write_text(FOREIGN)
    environment = {
        **os.environ,
        settings.FOLDER_VARIABLE: str(home),
        "NEP_NODES": str(tmp_path / "nodes"),
        "QT_QPA_PLATFORM": "offscreen",
    }
    with subprocess.Popen(
        [sys.executable, "-c", WORK], env=environment, stdout=subprocess.PIPE, text=True
    ) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "running\n"
        processes = psutil.Process(child.pid).children(recursive=True)
        assert len(processes) >= 6  # master, robot, watch, gesture, program, the foreign one

        child.kill()

        assert psutil.wait_procs(processes, timeout=GONE_S)[1] == []
    window.offer_recovery()
    qtbot.waitUntil(lambda: bool(window.findChildren(RecoveryDialog)))
    dialog = window.findChildren(RecoveryDialog)[0]
    qtbot.mouseClick(dialog.restore_button, Qt.MouseButton.LeftButton)
    assert window.files.document.project.name == "Not saved yet"
