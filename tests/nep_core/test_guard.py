"""The guard of a node in another language: it passes signals on, and ends with its node."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import psutil
import pytest

from nep_core.processes import lifeline
from nep_core.processes.process import program_command

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix"),
    pytest.mark.long,
]

GONE_S = 20
STUBBORN = """
import os, signal, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print(os.getpid(), flush=True)
time.sleep(600)
"""


@pytest.fixture
def guarded() -> Iterator[subprocess.Popen[str]]:
    """A guard whose node does not let itself be asked to stop, and tells its number."""
    command = program_command("guard", sys.executable, "-c", STUBBORN)
    environment = {**os.environ, lifeline.VARIABLE: "1"}
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, stdin=pipe, stdout=pipe, text=True, env=environment, start_new_session=True
    ) as guard:
        yield guard
        if guard.poll() is None:
            os.killpg(guard.pid, signal.SIGKILL)


def node_of(guard: subprocess.Popen[str]) -> psutil.Process:
    assert guard.stdout is not None
    return psutil.Process(int(guard.stdout.readline()))


def test_a_node_that_knows_no_life_line_ends_with_whoever_started_it(guarded) -> None:
    node = node_of(guarded)

    guarded.stdin.close()

    assert psutil.wait_procs([node], timeout=GONE_S)[1] == []
    guarded.wait(GONE_S)


def test_the_guard_ends_as_its_node_did(guarded) -> None:
    node_of(guarded).kill()

    assert guarded.wait(GONE_S) == -signal.SIGKILL


def test_a_node_is_asked_to_stop_when_its_guard_is() -> None:
    code = "import time; print('here', flush=True); time.sleep(600)"
    command = program_command("guard", sys.executable, "-c", code)
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as guard:
        assert guard.stdout is not None
        guard.stdout.readline()

        guard.terminate()

        assert guard.wait(GONE_S) == -signal.SIGTERM


@pytest.mark.parametrize("code", [0, 3])
def test_the_exit_code_is_that_of_the_node(code: int) -> None:
    command = program_command("guard", sys.executable, "-c", f"raise SystemExit({code})")

    assert subprocess.run(command, stdin=subprocess.DEVNULL).returncode == code
