"""A launcher with a node to start, and what it tells of nodes that ended."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_core.launcher import Launcher
from nep_core.p2p import PeerNetwork
from tests.nep_core.launching import WAIT, Ends
from tests.nep_core.node_making import write_node


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
