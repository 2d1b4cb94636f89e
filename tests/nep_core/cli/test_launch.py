"""``nep launch`` and ``nep master``: how a node went, and signals at the worst moment."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import NODES_VARIABLE
from tests.nep_core.cli.conftest import Call
from tests.nep_core.node_making import write_node

pytestmark = pytest.mark.long

SIGNAL_IN_SIGNAL = """
import signal, sys
from nep_core.cli import main

set_handler = signal.signal

def plant(number, handler):
    def interrupted(*words):
        if sys.getprofile() is None:  # at each call that the first one makes, a second comes
            sys.setprofile(lambda *_: signal.raise_signal(signal.SIGTERM))
            handler(*words)
            sys.setprofile(None)
        else:
            handler(*words)
    set_handler(number, interrupted)

signal.signal = plant
sys.exit(main(["master", "--no-original", "--endpoint", "tcp://127.0.0.1:*"]))
"""


@pytest.mark.parametrize(
    ("code", "exit_code", "told"),
    [
        ('raise NepError("The lamp broke.")', 1, "The lamp broke"),
        ("pass", 0, "lamp ended by itself."),
    ],
)
def test_launch_shows_how_a_node_is_doing_and_how_it_ended(
    network: PeerNetwork,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    call: Call,
    code: str,
    exit_code: int,
    told: str,
) -> None:
    monkeypatch.setattr("nep_core.processes.launcher.MOST_RESTARTS", 0)
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    states = 'node.state("connecting", "to the lamp")\nnode.ready("")\nnode.wait(0.2)'
    write_node(tmp_path, "lamp", f"{states}\n{code}")

    answer = call("nep launch sensory lamp")

    assert answer.code == exit_code, answer.err
    assert "lamp is connecting: to the lamp\n" in answer.out
    assert "lamp is ready. Ctrl-C stops it.\n" in answer.out
    assert answer.out.count(told) == 1
    assert ("Its log: " in answer.out) == (exit_code != 0)


def test_launch_says_where_the_log_of_a_node_is_that_did_not_start(
    network: PeerNetwork, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: Call
) -> None:
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    write_node(tmp_path, "lamp", 'raise NepError("There is no lamp.")')

    answer = call("nep launch sensory lamp")

    assert answer.code == 1
    assert (answer.out + answer.err).count("There is no lamp") == 1
    assert "[ ] Its log: " in answer.err


def test_launch_names_what_is_missing_and_where_nodes_of_ones_own_are_looked_for(
    network: PeerNetwork, call: Call
) -> None:
    missing, unknown = call("nep launch sensory"), call("nep launch sensory lamp --name red")

    assert "required: NODE.\n" in missing.err
    assert f"Set {NODES_VARIABLE} to the folder in which sensory/ lies." in unknown.err


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_a_second_signal_while_the_first_is_answered_does_not_hang_the_master() -> None:
    command = [sys.executable, "-c", SIGNAL_IN_SIGNAL]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as service:
        assert service.stdout is not None
        limit = threading.Timer(20, service.kill)  # also where it does not begin to serve
        limit.start()
        try:
            assert b"serves" in service.stdout.readline()

            service.terminate()

            assert service.wait(20) == 0
        finally:
            service.kill()
            limit.cancel()
