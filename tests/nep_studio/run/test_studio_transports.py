"""A session takes part in the network that NEP_NETWORK names, with all the nodes it starts."""

from __future__ import annotations

import queue
from pathlib import Path

import msgspec
import pytest

from nep_core.errors import MasterNotFound
from nep_core.networks import transports
from nep_core.places import NODES_VARIABLE
from nep_core.wire.messages import NodeState
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import MASTER, STUDIO
from tests.nep_core.launching import WAIT
from tests.nep_core.node_making import write_node
from tests.nep_core.worlds import WITH_ZENOH, a_world


@pytest.mark.parametrize("kind", ["broker", WITH_ZENOH])
def test_a_session_joins_the_central_service_and_starts_no_master(
    kind: str, free_port: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_node(tmp_path / "nodes", "waiter", WAIT)
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path / "nodes"))
    heard: queue.Queue[msgspec.Struct] = queue.Queue()
    local = LocalNetwork(logs=tmp_path)
    local.listen(lambda topic, message: heard.put(message))
    with a_world(kind, free_port) as world:
        for variable, value in world.environment.items():
            monkeypatch.setenv(variable, value)

        local.open()
        try:
            local.launcher.start("sensory/waiter", "watch").wait_ready()
            names = {told.node for told in transports.registrations()}
        finally:
            local.close()

    assert names == {STUDIO, "watch"}
    assert MASTER not in local.launcher.nodes
    states = [state for state in heard.queue if isinstance(state, NodeState)]
    assert "ready" in [state.event for state in states if state.node == "watch"]


def test_a_session_without_its_central_service_says_how_to_start_it(
    free_port: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.networks.master_client.ANSWER_S", 0.1)
    monkeypatch.setenv("NEP_NETWORK", "broker")
    monkeypatch.setenv("NEP_BROKER", f"tcp://127.0.0.1:{free_port}")

    with pytest.raises(MasterNotFound) as raised:
        LocalNetwork(logs=tmp_path).open()

    assert str(raised.value.checklist[0]).endswith("nep broker")
