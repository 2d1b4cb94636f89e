"""``nep kill``: nodes that stop, that do not, that are others by now."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_core.cli.kill import process_of
from nep_core.networks.master import Master
from nep_core.networks.master_messages import ask_master
from nep_core.networks.registry import Registration
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.recordings.file import overview
from tests.nep_core.cli.conftest import Call, nep

DEAF = """
import sys, time
from nep_core.networks.zmq_networks import PeerNetwork
network = PeerNetwork("deaf")
network.join()
print("joined", flush=True)
time.sleep(60)
"""


@pytest.fixture
def deaf(master: Master) -> Iterator[subprocess.Popen[bytes]]:
    """A program of its own that does not stop when it is asked."""
    with subprocess.Popen([sys.executable, "-c", DEAF], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"joined\n"
        yield process
        process.kill()


def test_a_node_that_is_asked_stops(
    join: Callable[[str], PeerNetwork], call: Call, master: Master
) -> None:
    asked = join("lamp")
    asked.on_stop = threading.Thread(target=asked.close).start
    asked.join()

    answer = call("nep kill lamp")

    listing = ask_master(master.endpoint)
    assert listing is not None and listing.registrations == []
    assert answer.out == "lamp has stopped.\n"


def test_an_unknown_node_is_told_with_near_names(
    join: Callable[[str], PeerNetwork], call: Call
) -> None:
    join("virtual_watch").join()

    answer = call("nep kill virtual_wtach")

    assert answer.code == 1
    assert "These are: virtual_watch." in answer.err


def test_a_node_that_does_not_stop_is_told_and_ended_only_by_force(
    deaf: subprocess.Popen[bytes], call: Call
) -> None:
    polite = call("nep kill deaf --seconds 0.2")
    was_running = deaf.poll() is None
    forced = call("nep kill deaf --seconds 0.2 --force")

    assert polite.code == 1
    assert "deaf did not stop within 0.2 s." in polite.err
    assert "nep kill deaf --force" in polite.err
    assert was_running
    assert forced.code == 0
    assert "was ended" in forced.out
    deaf.wait(5)


def test_a_process_that_only_has_the_number_is_never_ended() -> None:
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as other:
        told = Registration(
            instance="i",
            node="lamp",
            pid=other.pid,
            host=socket.gethostname(),
            endpoint="tcp://127.0.0.1:7",
        )

        found = process_of(told)

        assert found is None
        other.communicate(b"\n")


def test_a_node_of_another_computer_is_not_looked_for_here() -> None:
    told = Registration(
        instance="i", node="n", pid=os.getpid(), host="far", endpoint="tcp://127.0.0.1:7"
    )

    assert process_of(told) is None


def test_a_recording_that_is_asked_to_stop_is_finished(
    busy: PeerNetwork, call: Call, tmp_path: Path
) -> None:
    path = tmp_path / "asked.mcap"
    with nep("record", str(path), "/imu", stdout=subprocess.PIPE, stderr=subprocess.PIPE) as one:
        assert one.stderr is not None
        assert "Recording to" in one.stderr.readline()

        answer = call(f"nep kill nep-record-{one.pid}")
        out, _ = one.communicate(timeout=30)

    assert answer.code == 0, answer.err
    assert out.startswith("Recorded ")
    assert overview(path).is_whole
