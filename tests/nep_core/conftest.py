"""A launcher with a node to start, and what it tells of nodes that ended."""

from __future__ import annotations

import queue
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from nep_core.program import tasks
from tests.nep_core.launching import WAIT, Ends
from tests.nep_core.node_making import write_node
from tests.nep_core.outside import Outside


@pytest.fixture
def ends() -> Ends:
    return queue.Queue()


@pytest.fixture
def launcher(network: PeerNetwork, tmp_path: Path, ends: Ends) -> Iterator[Launcher]:
    with Launcher(
        folders=(tmp_path / "nodes",),
        logs=tmp_path / "logs",
        master=network.master,
        on_end=lambda *end: ends.put(end),
    ) as launcher:
        launcher.hear(network)
        write_node(tmp_path / "nodes", "waiter", WAIT)
        yield launcher


@pytest.fixture(autouse=True)
def _own_program() -> Iterator[None]:
    """A program of its own for each test: PROGRAM is one a process."""
    _begin_program()
    yield
    tasks.PROGRAM.cancel()
    _begin_program()  # for the tests of other folders


@pytest.fixture
def outside(network: PeerNetwork, join: Callable[[str], PeerNetwork]) -> Outside:
    """What is around a program: its robot and its person, on a network of their own."""
    return Outside(network, join("outside"))


def _begin_program() -> None:
    tasks.PROGRAM.cancelled.clear()
    tasks.PROGRAM._children.clear()
    tasks.PROGRAM.undo.clear()
