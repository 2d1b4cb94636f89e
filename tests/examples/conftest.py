"""The example nodes of each language, built, and a launcher that finds them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from tests.examples.building import build
from tests.node_running import NODES


@pytest.fixture(params=["cpp", "javascript"])
def nodes(request: pytest.FixtureRequest) -> Path:
    """The folder with the nodes of a language; it is for NEP_NODES."""
    return build(request.param)


@pytest.fixture
def launcher(nodes: Path, network: PeerNetwork, tmp_path: Path) -> Iterator[Launcher]:
    """Starts the nodes of the language, and ours."""
    with Launcher(folders=(nodes, NODES), logs=tmp_path, master=network.master) as launcher:
        launcher.hear(network)
        yield launcher
