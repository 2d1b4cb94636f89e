"""``nep launch`` and ``nep master``: how a node went, and signals at the worst moment."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from nep_core.p2p import PeerNetwork
from nep_core.places import NODES_VARIABLE
from tests.nep_core.cli.conftest import Call
from tests.nep_core.node_making import write_node

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
    monkeypatch.setattr("nep_core.launched.MOST_RESTARTS", 0)
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    states = 'node.state("connecting", "to the lamp")\nnode.ready("")\nnode.wait(0.2)'
    write_node(tmp_path, "lamp", f"{states}\n{code}")

    answer = call("nep launch sensory lamp")

    assert answer.code == exit_code, answer.err
    assert "lamp is connecting: to the lamp\n" in answer.out
    assert "lamp is ready. Ctrl-C stops it.\n" in answer.out
    assert told in answer.out


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_a_second_signal_while_the_first_is_answered_does_not_hang_the_master() -> None:
    command = [sys.executable, "-c", SIGNAL_IN_SIGNAL]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as service:
        assert service.stdout is not None
        assert b"serves" in service.stdout.readline()

        service.terminate()

        try:
            assert service.wait(5) == 0
        finally:
            service.kill()
