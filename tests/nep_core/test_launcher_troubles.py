"""The launcher when something is wrong: commands, names, moments and children that go astray."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import psutil
import pytest

from nep_core.errors import NodeStartError, ParameterError
from nep_core.processes.launcher import Launcher
from nep_core.processes.process import ChildProcess
from tests.nep_core.launching import WAIT, Ends, first_line
from tests.nep_core.node_making import write_node

pytestmark = pytest.mark.long

SCRIPT = """
import sys
from nep_core import Node
with Node(sys.argv[sys.argv.index("--name") + 1], "sensory") as node:
    node.stop_on_signals()
    node.ready()
    while not node.wait(1):
        pass
"""


def test_a_node_that_cannot_be_started_leaves_its_name_free(launcher: Launcher) -> None:
    for _ in range(2):
        with pytest.raises(NodeStartError):
            launcher.start_command("ghost", ["nothing-of-that-name"])


def test_a_command_with_a_letter_that_no_command_can_have_is_told(launcher: Launcher) -> None:
    with pytest.raises(NodeStartError, match="cannot be started"):
        launcher.start_command("ghost", [sys.executable, "a\0b"])


def test_a_node_that_cannot_be_started_again_is_told(
    launcher: Launcher, ends: Ends, tmp_path: Path
) -> None:
    python = tmp_path / "python"
    python.symlink_to(sys.executable)
    launched = launcher.start_command("ghost", [str(python), "-c", "input()"])
    python.unlink()

    os.kill(launched.pid, signal.SIGKILL)

    assert ends.get(timeout=5)[2]
    _, outcome, again = ends.get(timeout=5)
    assert not again
    assert "no such file" in str(outcome)
    assert launched.ended.is_set()
    with pytest.raises(NodeStartError, match="no such file"):
        launched.wait_ready()


@pytest.mark.parametrize("close_all", [False, True])
def test_a_node_stopped_in_the_middle_of_a_restart_stays_stopped(
    launcher: Launcher, monkeypatch: pytest.MonkeyPatch, close_all: bool
) -> None:
    launched = launcher.start("sensory/waiter", "watch")
    launched.wait_ready()
    restarting, go_on = threading.Event(), threading.Event()

    def slow(*words: Any, **options: Any) -> ChildProcess:
        restarting.set()
        go_on.wait(5)
        return ChildProcess(*words, **options)

    monkeypatch.setattr("nep_core.processes.launcher.ChildProcess", slow)
    os.kill(launched.pid, signal.SIGKILL)
    assert restarting.wait(5)

    stopping = threading.Thread(
        target=launcher.close if close_all else lambda: launcher.stop("watch")
    )
    stopping.start()
    stopping.join(0.2)  # one that does not wait for the restart has missed the new process now
    go_on.set()
    stopping.join()

    with launcher._lock:  # the restart is over
        assert launched.process is not None
        assert launched.process.poll() is not None


def test_the_children_of_a_node_that_crashed_are_ended(launcher: Launcher, tmp_path: Path) -> None:
    code = "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
    write_node(tmp_path / "nodes", "parent", f"{code}print(child.pid, flush=True)\n{WAIT}")
    launched = launcher.start("sensory/parent")
    launched.wait_ready()
    grandchild = psutil.Process(int(first_line(launched)))

    os.kill(launched.pid, signal.SIGKILL)

    assert not psutil.wait_procs([grandchild], timeout=5)[1]


def test_a_node_behind_a_wrapper_becomes_ready(launcher: Launcher, tmp_path: Path) -> None:
    command = ["sh", "-c", f'"{sys.executable}" "$@"; exit 0', "sh", "{folder}/wrapped.script"]
    write_node(tmp_path / "nodes", "wrapped", "pass", manifest=f"command = {command!r}\n")
    (tmp_path / "nodes" / "sensory" / "wrapped.script").write_text(SCRIPT)

    launched = launcher.start("sensory/wrapped")

    launched.wait_ready(5)
    assert not launched.owns(os.getpid())
    assert not launched.owns(-1)


def test_a_node_that_ends_well_at_once_has_started(launcher: Launcher, tmp_path: Path) -> None:
    write_node(tmp_path / "nodes", "brief", "pass")

    launched = launcher.start("sensory/brief")

    launched.wait_ready()
    assert launched.ended.is_set()


@pytest.mark.parametrize("name", ["-x", "two words", "ü" * 100])
def test_an_unusual_name_is_a_name(launcher: Launcher, name: str) -> None:
    launcher.start("sensory/waiter", name).wait_ready()


@pytest.mark.parametrize("name", ["  ", "a\0b", "a\nb", "\ud800", "n" * 101])
def test_a_name_that_cannot_be_used_is_told_before_anything_is_started(
    launcher: Launcher, name: str
) -> None:
    with pytest.raises(ParameterError, match="name"):
        launcher.start("sensory/waiter", name)

    assert launcher.nodes == {}


def test_a_node_may_have_the_name_of_a_library_and_files_beside_it(
    launcher: Launcher, tmp_path: Path
) -> None:
    write_node(tmp_path / "nodes", "socket", f"import lamp_driver\nlamp_driver.light()\n{WAIT}")
    (tmp_path / "nodes" / "sensory" / "lamp_driver.py").write_text(
        "import socket\ndef light(): socket.socket().close()\n"
    )

    launcher.start("sensory/socket").wait_ready()


def test_a_log_that_cannot_be_written_does_not_hurt_the_node(
    launcher: Launcher, tmp_path: Path
) -> None:
    launcher.logs = Path(os.devnull) / "logs"
    write_node(tmp_path / "nodes", "talker", f"print('x' * 100_000, flush=True)\n{WAIT}")

    launcher.start("sensory/talker").wait_ready()


SLOW_END = """
while not node.wait(1):
    pass
time.sleep(5)
print("finished", flush=True)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="there are no such signals here")
@pytest.mark.parametrize("stands_still", [False, True])
def test_only_a_node_that_lives_gets_the_time_that_its_manifest_asks_for(
    launcher: Launcher, tmp_path: Path, stands_still: bool
) -> None:
    code = "node.ready('waits')" + SLOW_END
    write_node(tmp_path / "nodes", "slow", code, manifest="stop_s = 60")
    launched = launcher.start("sensory/slow")
    launched.wait_ready()
    process = launched.process
    assert process is not None
    if stands_still:
        os.kill(launched.pid, signal.SIGSTOP)

    asked_s = time.monotonic()
    launcher.stop("slow")

    assert time.monotonic() - asked_s < 30.0
    assert ("finished" in process.last_lines) is not stands_still
    assert process.poll() is not None
