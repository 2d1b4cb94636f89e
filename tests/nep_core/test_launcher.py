"""The launcher, with real processes: ready, crashed, restarted, stopped, orphaned."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import psutil
import pytest

from nep_core.errors import NameTaken, NodeStartError, ParameterError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from nep_core.processes.process import Outcome
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Subscriber
from tests.nep_core.launching import WAIT, Ends, first_line
from tests.nep_core.node_making import write_node

pytestmark = pytest.mark.long


def test_a_node_becomes_ready_and_stops_when_asked(launcher: Launcher, ends: Ends) -> None:
    launched = launcher.start("sensory/waiter", "watch")
    launched.wait_ready()

    launcher.stop("watch")

    _, outcome, again = ends.get(timeout=5)
    assert str(outcome) == "watch was stopped"
    assert outcome.code == 0
    assert not again


def test_states_come_in_order(launcher: Launcher, network: PeerNetwork) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=network)
    launcher.start("sensory/waiter", "watch").wait_ready()
    launcher.stop("watch")

    heard = [state.event for state in iter(lambda: states.receive(2), None) if state]

    assert [event for event in heard if event != "alive"] == ["starting", "ready", "stopped"]


def test_a_killed_node_is_told_and_started_again(launcher: Launcher, ends: Ends) -> None:
    launched = launcher.start("sensory/waiter", "watch")
    launched.wait_ready()
    first_pid = launched.pid

    os.kill(first_pid, signal.SIGKILL)

    _, outcome, again = ends.get(timeout=5)
    assert str(outcome) == "watch was killed"
    assert again
    while launched.pid == first_pid:
        launched.ended.wait(0.05)
    launched.wait_ready()


def test_a_node_that_always_crashes_is_given_up(
    launcher: Launcher, ends: Ends, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.processes.launcher.FIRST_PAUSE_S", 0.01)
    write_node(tmp_path / "nodes", "weak", 'node.ready("")\nraise NepError("The lamp broke.")')

    launched = launcher.start("sensory/weak")

    outcomes = [ends.get(timeout=20) for _ in range(6)]
    assert [again for _, _, again in outcomes] == [True] * 5 + [False]
    assert str(outcomes[0][1]) == "weak ended with an error: The lamp broke."
    assert launched.ended.wait(1)


def test_a_node_that_cannot_start_tells_its_last_words_and_is_not_started_again(
    launcher: Launcher, tmp_path: Path
) -> None:
    code = 'raise NepError("There is no lamp.", checklist=("Buy one.",))'
    write_node(tmp_path / "nodes", "dark", code)

    launched = launcher.start("sensory/dark")

    with pytest.raises(NodeStartError, match="There is no lamp"):
        launched.wait_ready()


def test_a_node_that_never_gets_ready_is_told(launcher: Launcher, tmp_path: Path) -> None:
    write_node(tmp_path / "nodes", "slow", "while not node.wait(1): pass")

    launched = launcher.start("sensory/slow")

    with pytest.raises(NodeStartError, match="did not say that it is ready"):
        launched.wait_ready(0.3)


def test_a_wrong_setting_is_told_before_anything_is_started(launcher: Launcher) -> None:
    with pytest.raises(ParameterError):
        launcher.start("sensory/waiter", colour="red")

    assert launcher.nodes == {}


def test_two_nodes_of_one_name_are_refused(launcher: Launcher) -> None:
    launcher.start("sensory/waiter", "watch")

    with pytest.raises(NameTaken, match="watch"):
        launcher.start("sensory/waiter", "watch")


def test_stopping_ends_the_whole_process_tree(launcher: Launcher, tmp_path: Path) -> None:
    code = "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
    code += "print('child', child.pid, flush=True)\n"
    write_node(tmp_path / "nodes", "parent", code + WAIT)
    launched = launcher.start("sensory/parent")
    launched.wait_ready()
    grandchild = psutil.Process(int(first_line(launched).split()[1]))

    launcher.stop("parent")

    assert not psutil.wait_procs([grandchild], timeout=5)[1]


def test_a_node_that_does_not_listen_is_ended(launcher: Launcher, tmp_path: Path) -> None:
    code = "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nnode.ready('')\n"
    write_node(tmp_path / "nodes", "deaf", code + "time.sleep(60)")
    launched = launcher.start("sensory/deaf")
    launched.wait_ready()
    pid = launched.pid

    launcher.stop("deaf")

    assert not psutil.pid_exists(pid)


def test_what_a_node_prints_is_kept_in_its_log(
    launcher: Launcher, tmp_path: Path, ends: Ends
) -> None:
    write_node(tmp_path / "nodes", "talker", "print('hello log', flush=True)\n" + WAIT)
    launcher.start("sensory/talker", "a/../b").wait_ready()
    launcher.stop("a/../b")
    ends.get(timeout=5)

    (log_file,) = (tmp_path / "logs").glob("*.log")
    assert "hello log" in log_file.read_text()


def test_a_node_in_another_language_is_started_by_its_command(
    launcher: Launcher, tmp_path: Path, network: PeerNetwork
) -> None:
    script = tmp_path / "nodes" / "sensory" / "foreign.script"
    script.write_text(
        "import sys, time\nfrom nep_core import Node\n"
        "name = sys.argv[sys.argv.index('--name') + 1]\n"
        "with Node(name, 'sensory') as node:\n"
        "    node.stop_on_signals(); node.ready(' '.join(sys.argv[3:]))\n"
        "    while not node.wait(1): pass\n"
    )
    manifest = f'command = ["{sys.executable}", "{{folder}}/foreign.script"]\n'
    manifest += '[parameters.port]\ntype = "integer"\n'
    manifest += '[parameters.loud]\ntype = "boolean"\ndefault = true\n'
    write_node(tmp_path / "nodes", "foreign", "pass", manifest=manifest)
    states = Subscriber(NODE_STATE, NodeState, network=network)

    launcher.start("sensory/foreign", port=5).wait_ready()

    ready = next(state for state in states if state.event == "ready")
    assert ready.description == "port=5 loud=true"


def test_a_command_that_is_not_there_is_told(launcher: Launcher) -> None:
    with pytest.raises(NodeStartError, match="nothing-of-that-name"):
        launcher.start_command("ghost", ["nothing-of-that-name"])


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (0, "watch ended by itself"),
        (-11, "watch crashed (it used memory that is not its own)"),
        (-64, "watch was ended by SIGRTMAX"),
        (-999, "watch was ended by signal 999"),
        (3, "watch ended with an error: exit code 3"),
        (71, "watch was asked to stop"),
        (70, "watch ended because the program that started it is gone"),
    ],
)
def test_an_outcome_speaks_for_itself(code: int, words: str) -> None:
    assert str(Outcome("watch", code)) == words
