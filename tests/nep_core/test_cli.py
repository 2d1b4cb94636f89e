"""The command ``nep``: wrong times, nodes that fail, and signals at the worst moment."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from nep_core.cli import main
from nep_core.cli.arguments import seconds
from nep_core.p2p import PeerNetwork
from nep_core.places import NODES_VARIABLE
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
sys.exit(main(["master", "--endpoint", "tcp://127.0.0.1:*"]))
"""


@pytest.mark.parametrize("command", ["echo", "hz"])
@pytest.mark.parametrize("text", ["nan", "inf", "1e9", "-1", "soon"])
def test_a_time_that_nobody_can_wait_is_told(
    command: str, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main([command, "/imu", "--seconds", text])

    assert f'"{text}" is not a number from 0 to 1000000' in capsys.readouterr().err


@pytest.mark.parametrize(("text", "time_s"), [("0", 0.0), ("0.5", 0.5), ("1e6", 1e6)])
def test_a_time_to_wait_is_a_number(text: str, time_s: float) -> None:
    assert seconds(text) == time_s


@pytest.mark.parametrize(
    ("code", "exit_code"), [('raise NepError("The lamp broke.")', 1), ("pass", 0)]
)
def test_launch_tells_by_its_exit_code_how_the_node_ended(
    network: PeerNetwork,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    code: str,
    exit_code: int,
) -> None:
    monkeypatch.setattr("nep_core.launcher.MOST_RESTARTS", 0)
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    write_node(tmp_path, "lamp", f'node.ready("")\nnode.wait(0.5)\n{code}')

    assert main(["launch", "sensory", "lamp"]) == exit_code


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
