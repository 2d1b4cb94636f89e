"""What the launcher tells of nodes that ended, whom it starts again, and that it never hangs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil
import pytest

from nep_core.errors import NodeStartError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.processes.process import ASKED, Outcome
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Subscriber
from tests.nep_core.launching import WAIT, Ends
from tests.nep_core.node_making import write_node

WELL, FAILED, KILLED = 0, 1, -signal.SIGKILL


def state_after(states: Subscriber[NodeState], event: str) -> NodeState:
    """The next state of a kind."""
    until_s = time.monotonic() + 10
    while time.monotonic() < until_s:
        state = states.receive(10)
        if state is not None and state.event == event:
            return state
    raise AssertionError(f"nobody said {event}")


@pytest.fixture
def states(network: PeerNetwork) -> Subscriber[NodeState]:
    return Subscriber(NODE_STATE, NodeState, network=network)


def test_that_a_node_was_killed_is_told_on_the_network(
    launcher: Launcher, states: Subscriber[NodeState]
) -> None:
    launched = launcher.start("sensory/waiter", "watch")
    launched.wait_ready()

    os.kill(launched.pid, signal.SIGKILL)

    told = state_after(states, "crashed")
    assert (told.node, told.type, told.pid) == ("watch", "sensory", launched.pid)
    assert told.description == "watch was killed; it is started again"


def test_the_end_of_a_node_of_another_language_is_told_for_it(
    launcher: Launcher, states: Subscriber[NodeState], tmp_path: Path
) -> None:
    manifest = 'command = ["sh", "-c", "echo no lamp; exit 3"]\n'
    write_node(tmp_path / "nodes", "shell", "pass", manifest=manifest)

    launcher.start("sensory/shell")

    told = state_after(states, "crashed")
    assert told.description == "shell ended with an error: no lamp"


def test_a_node_that_somebody_in_the_network_stopped_is_not_started_again(
    launcher: Launcher, ends: Ends, states: Subscriber[NodeState], tmp_path: Path
) -> None:
    code = f"node.ready()\nnode.network.on_stop()\n{WAIT}"
    write_node(tmp_path / "nodes", "asked", code, manifest='restart = "always"\n')

    launcher.start("sensory/asked")

    _, outcome, again = ends.get(timeout=10)
    assert (str(outcome), again) == ("asked was asked to stop", False)
    assert state_after(states, "stopped").description == "It was asked to stop."


@pytest.mark.skipif(sys.platform == "win32", reason="freezes with SIGSTOP")
def test_a_frozen_node_that_nep_kill_ends_by_force_is_not_started_again(
    launcher: Launcher, ends: Ends, network: PeerNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NEP_MASTER", network.master)
    waiter = launcher.start("sensory/waiter")
    waiter.wait_ready()
    os.kill(waiter.pid, signal.SIGSTOP)

    words = ["kill", "waiter", "--force", "--seconds", "0.1"]
    subprocess.run([sys.executable, "-m", "nep_core.cli", *words], check=True)

    _, outcome, again = ends.get(timeout=5)
    assert (str(outcome), again) == ("waiter was stopped", False)


@pytest.mark.parametrize(
    ("restart", "was_ready", "again"),
    [
        ("on-crash", True, {FAILED, KILLED}),
        ("on-crash", False, {KILLED}),
        ("always", False, {WELL, FAILED, KILLED}),
        ("on-kill", True, {KILLED}),
        ("never", True, set()),
    ],
)
def test_a_node_is_started_again_as_its_manifest_wants(restart, was_ready, again) -> None:
    launched = LaunchedNode("watch", None, [], restart, started_s=time.monotonic())
    if was_ready:
        launched.ready.set()
    ends = [Outcome("watch", code) for code in (WELL, FAILED, KILLED, ASKED)]

    assert {end.code for end in ends if launched.deserves_another(end)} == again
    assert not launched.deserves_another(Outcome("watch", KILLED, asked=True))


def test_after_five_lives_a_node_is_given_up_unless_it_was_well_for_a_while() -> None:
    launched = LaunchedNode("watch", None, [], restarts=5, started_s=time.monotonic())
    assert not launched.deserves_another(Outcome("watch", KILLED))

    launched.started_s -= 11

    assert launched.deserves_another(Outcome("watch", KILLED))
    assert launched.restarts == 0


def test_a_node_has_as_long_to_be_ready_as_its_manifest_says(
    launcher: Launcher, tmp_path: Path
) -> None:
    code = "while not node.wait(1): pass"
    write_node(tmp_path / "nodes", "slow", code, manifest="ready_s = 0.2\n")

    with pytest.raises(NodeStartError, match=r"ready within 0\.2 s"):
        launcher.start("sensory/slow").wait_ready()


@pytest.mark.parametrize(("seconds", "is_in_time"), [(1.5, True), (60.0, False)])
def test_a_node_that_loads_all_the_while_has_longer_to_be_ready(
    launcher: Launcher, tmp_path: Path, seconds: float, is_in_time: bool
) -> None:
    code = f"end = time.monotonic() + {seconds}\nwhile time.monotonic() < end: pass\n"
    code += "node.ready()\nnode.wait(60)"
    write_node(tmp_path / "nodes", "slow", code, manifest="ready_s = 1\n")

    launched = launcher.start("sensory/slow")

    if is_in_time:
        launched.wait_ready()
        return
    start_s = time.monotonic()
    with pytest.raises(NodeStartError, match="ready within 1 s"):
        launched.wait_ready()
    assert 2.9 < time.monotonic() - start_s < 20.0


def test_a_node_that_is_stopped_before_its_next_life_stays_stopped_at_once(
    launcher: Launcher, ends: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.processes.launcher.FIRST_PAUSE_S", 60.0)
    launched = launcher.start("sensory/waiter", "watch")
    launched.wait_ready()
    os.kill(launched.pid, signal.SIGKILL)
    assert ends.get(timeout=5)[2]

    launcher.stop("watch")

    _, outcome, again = ends.get(timeout=5)
    assert (str(outcome), again) == ("watch was stopped", False)


@pytest.mark.parametrize(
    "code",
    [
        pytest.param("node.ready()\nwhile not node.stopping: print('x' * 1000)", id="floods"),
        pytest.param(f"os.close(1)\nos.close(2)\n{WAIT}", id="closes its output"),
        pytest.param(
            f"node.ready()\nnode.wait(0.3)\nos.kill(os.getpid(), {int(signal.SIGSTOP)})",
            id="frozen",
        ),
    ],
)
def test_an_odd_node_is_stopped_by_several_at_once(
    launcher: Launcher, ends: Ends, tmp_path: Path, code: str
) -> None:
    write_node(tmp_path / "nodes", "odd", code)
    launched = launcher.start("sensory/odd")
    launched.wait_ready()
    stops = [threading.Thread(target=launcher.stop, args=("odd",)) for _ in range(3)]

    for stop in stops:
        stop.start()
    for stop in stops:
        stop.join(5)

    assert not any(stop.is_alive() for stop in stops)
    assert not psutil.pid_exists(launched.pid)
    assert ends.get(timeout=5)[1].asked
    launcher.close()
    launcher.close()


@pytest.mark.skipif(sys.platform == "win32", reason="counts the files of Unix")
def test_many_lives_leave_neither_threads_nor_files(
    launcher: Launcher, ends: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.processes.launcher.FIRST_PAUSE_S", 0.0)
    program = psutil.Process()

    def live(count: int) -> None:
        for _ in range(count):
            launcher.start_command("brief", ["sh", "-c", "kill -9 $$"])
            while ends.get(timeout=5)[2]:
                pass

    live(1)
    before = program.num_fds() + threading.active_count()
    live(8)  # 48 lives

    until_s = time.monotonic() + 5
    while program.num_fds() + threading.active_count() > before:
        assert time.monotonic() < until_s
        threading.Event().wait(0.01)
