"""Whatever a node does, nothing of it outlives a launcher that was killed, nor its guard."""

from __future__ import annotations

import ctypes
import json
import os
import queue
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil
import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes import lifeline
from nep_core.processes import process as process_tree
from nep_core.processes.process import ChildProcess, ExtendedLimits, Job, program_command
from tests.nep_core.launching import WAIT
from tests.nep_core.node_making import write_node

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such signal")
pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="kills with SIGKILL"),
    pytest.mark.long,
]

GONE_S = 10
CHILD = "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
HOLDS_THE_LOCK = "import itertools\nnode.ready()\nsum(itertools.repeat(0))"
DEAF = """
import os, signal, subprocess, sys, time
for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
subprocess.Popen(["sleep", "60"])
while True: time.sleep(60)
"""

PARENT = """
import sys, threading, time
from pathlib import Path
from nep_core import Launcher
launcher = Launcher(folders=(Path({folder!r}),), logs=Path({folder!r}))
def start():
    global node
    node = launcher.start('sensory/{node}')
thread = threading.Thread(target=start)
thread.start()
thread.join()
if {waits}:
    node.wait_ready(20)
print(node.pid, flush=True)
time.sleep(60)
"""


def started(node: psutil.Process, count: int) -> set[psutil.Process]:
    """A node with its descendants, when there are so many."""
    while len(found := {node, *process_tree.descendants(node.pid)}) < count:
        assert node.is_running() and node.status() != psutil.STATUS_ZOMBIE
    return found


def left_of(family: set[psutil.Process]) -> set[psutil.Process]:
    """Who still works after a while; nobody has to take note of the end of the others by then."""
    until_s = time.monotonic() + GONE_S
    while (left := {one for one in family if works(one)}) and time.monotonic() < until_s:
        psutil.wait_procs(left, timeout=0.05)
    return left


def works(process: psutil.Process) -> bool:
    try:
        return bool(process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


def family_of_killed_launcher(folder: Path, node: str, count: int) -> set[psutil.Process]:
    """Start a launcher with a node, kill it; the processes that the node was."""
    waits = node != "deaf"
    code = PARENT.format(folder=str(folder / "nodes"), node=node, waits=waits)
    parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert parent.stdout is not None
    try:
        return started(psutil.Process(int(parent.stdout.readline())), count)
    finally:
        parent.kill()
        parent.communicate()


@pytest.mark.parametrize(
    ("code", "count"),
    [
        pytest.param("node.ready()\nwhile True: pass", 1, id="busy"),
        pytest.param(CHILD + WAIT, 2, id="grandchild"),
        pytest.param(HOLDS_THE_LOCK, 1, id="holds the interpreter's lock", marks=LINUX),
    ],
)
def test_no_node_outlives_a_killed_launcher(
    network: PeerNetwork, tmp_path: Path, code: str, count: int
) -> None:
    write_node(tmp_path / "nodes", "busy", code)

    family = family_of_killed_launcher(tmp_path, "busy", count)

    assert not left_of(family)


def test_a_deaf_node_of_another_language_does_not_outlive_a_killed_launcher(
    network: PeerNetwork, tmp_path: Path
) -> None:
    manifest = f"command = {json.dumps([sys.executable, '-c', DEAF])}\n"
    write_node(tmp_path / "nodes", "deaf", "pass", manifest=manifest)

    family = family_of_killed_launcher(tmp_path, "deaf", 3)

    assert len(family) == 3  # the guard, the node, and what it started
    assert not left_of(family)


@LINUX
def test_a_deaf_node_does_not_outlive_its_killed_guard() -> None:
    command = program_command("guard", "sleep", "60")
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True) as guard:
        family = started(psutil.Process(guard.pid), 2)

        guard.kill()

        assert not left_of(family)


@LINUX
def test_a_child_outlives_the_thread_that_asked_for_it(tmp_path: Path) -> None:
    outcomes: queue.Queue[object] = queue.Queue()
    code = (
        "from nep_core.processes import lifeline\nlifeline.end_with_parent()\nprint(1, flush=True)"
    )
    command = [sys.executable, "-c", f"{code}\ninput()"]
    log_file = tmp_path / "child.log"
    children: list[ChildProcess] = []

    def begin() -> None:
        environment = dict(os.environ)
        child = ChildProcess(
            "child", command, environment=environment, log_file=log_file, on_end=outcomes.put
        )
        children.append(child)
        while not child.last_lines:
            assert child.wait(0.02) is None

    thread = threading.Thread(target=begin)
    thread.start()
    thread.join()

    assert children[0].wait(0.2) is None
    children[0].stop()
    outcomes.get(timeout=5)


@pytest.mark.parametrize(("grace_s", "last"), [(20.0, "bye\n"), (0.1, "")])
def test_an_orphan_has_time_for_a_last_word_but_no_longer(grace_s: float, last: str) -> None:
    end = "(time.sleep(2.0 / grace_s), print('bye', flush=True), os._exit(0))"
    child_code = f"import os, threading, time\ngrace_s = {grace_s}\n"
    child_code += "from nep_core.processes import lifeline\n"
    child_code += f"leave = threading.Thread(target=lambda: {end}, daemon=True)\n"
    child_code += "lifeline.on_parent_end(leave.start, grace_s=grace_s)\n"
    child_code += "print(os.getpid(), flush=True)\ntime.sleep(60)"
    code = "import subprocess as s, sys\n"
    code += f"s.Popen([sys.executable, '-c', {child_code!r}], stdin=s.PIPE).wait()"
    environment = {**os.environ, lifeline.VARIABLE: "1"}
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment
    ) as parent:
        assert parent.stdout is not None
        child = psutil.Process(int(parent.stdout.readline()))

        parent.kill()

        assert parent.stdout.readline() == last
        assert not psutil.wait_procs([child], timeout=GONE_S)[1]


class Kernel:
    """Notes what would be asked of Windows; the call of ``fails`` is refused."""

    def __init__(self, fails: str = "") -> None:
        self.calls: list[str] = []
        self._fails = fails

    def __getattr__(self, name: str):
        def call(*_words: object) -> int:
            self.calls.append(name)
            return 0 if name == self._fails else 5

        return call


def test_a_windows_job_is_made_filled_and_closed_once() -> None:
    kernel = Kernel()
    calls = ["CreateJobObjectW", "SetInformationJobObject", "AssignProcessToJobObject"]

    job = Job(7, kernel)
    job.end()
    job.end()

    assert kernel.calls == [*calls, "CloseHandle"]
    assert ctypes.sizeof(ExtendedLimits) == (144 if sys.maxsize > 2**32 else 112)  # as in winnt.h


def test_a_windows_job_that_takes_no_process_is_given_up() -> None:
    kernel = Kernel("AssignProcessToJobObject")

    with pytest.raises(OSError, match="Windows error 5"):
        Job(7, kernel)

    assert kernel.calls[-1] == "CloseHandle"
