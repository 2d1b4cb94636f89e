"""Endpoints: which are refused, and how that is told."""

from __future__ import annotations

import pytest

from nep_core.cli import main
from nep_core.errors import NetworkError
from nep_core.networks.endpoints import (
    BROKER_VARIABLE,
    MASTER_VARIABLE,
    NETWORK_VARIABLE,
    broker_endpoints,
    broker_registry,
    check_endpoint,
    fixed_endpoint,
    master_endpoint,
)
from nep_core.networks.master_messages import ask_master
from nep_core.networks.zmq_networks import Broker

GOOD = ("tcp://127.0.0.1:7100", "tcp://robot-1.local:1", "tcp://[::1]:65535", "tcp://127.0.0.1:*")
WRONG = (
    "rubbish",
    "",
    "tcp://127.0.0.1",
    "tcp://127.0.0.1:0",
    "tcp://127.0.0.1:65536",
    "tcp://*:7100",
    "tcp://-:7100",
    "tcp://ü:7100",
    "ipc://master",
)


@pytest.mark.parametrize("endpoint", GOOD)
def test_an_endpoint_is_given_back_as_it_is(endpoint: str) -> None:
    assert check_endpoint(endpoint) == endpoint


@pytest.mark.parametrize("endpoint", WRONG)
def test_what_is_no_endpoint_is_told_with_an_example(endpoint: str) -> None:
    for check in (check_endpoint, fixed_endpoint, ask_master):
        with pytest.raises(NetworkError, match="is not an endpoint") as raised:
            check(endpoint)
        assert "tcp://127.0.0.1:7100" in str(raised.value.checklist[0])


def test_a_master_that_is_looked_for_needs_a_port(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MASTER_VARIABLE, "tcp://127.0.0.1:*")

    for look_for in (master_endpoint, lambda: ask_master("tcp://127.0.0.1:*")):
        with pytest.raises(NetworkError, match="does not say at which port"):
            look_for()


def test_a_broker_has_three_ports_in_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(BROKER_VARIABLE, "tcp://127.0.0.1:65533")

    assert broker_endpoints() == ("tcp://127.0.0.1:65533", "tcp://127.0.0.1:65534")
    assert broker_registry() == "tcp://127.0.0.1:65535"


def test_in_a_broker_network_its_registry_is_the_master(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NETWORK_VARIABLE, "broker")
    monkeypatch.setenv(BROKER_VARIABLE, "tcp://127.0.0.1:7000")

    assert master_endpoint() == "tcp://127.0.0.1:7002"


@pytest.mark.parametrize("port", ["65534", "*"])
def test_a_broker_without_two_ports_after_its_own_is_refused(port: str) -> None:
    with pytest.raises(NetworkError, match="port"):
        Broker(f"tcp://127.0.0.1:{port}")


@pytest.mark.parametrize("command", ["topics", "nodes", "doctor"])
def test_a_tool_with_a_wrong_master_says_what_an_endpoint_is(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--master", "rubbish", command]) == 1
    assert "'rubbish' is not an endpoint." in "".join(capsys.readouterr())
