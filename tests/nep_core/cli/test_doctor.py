"""``nep doctor``: real faults are found and told with what to do, and a sound computer passes."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from nep_core.cli import doctor as network
from nep_core.cli import doctor as system
from nep_core.networks.endpoints import BROKER_VARIABLE, MASTER_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import Broker
from nep_core.places import NODES_VARIABLE
from tests.nep_core.cli.conftest import Call


@pytest.fixture
def taken_port() -> Iterator[int]:
    """A port at which something listens that is no NEP master."""
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        yield int(other.getsockname()[1])


def test_a_sound_computer_has_nothing_wrong(master: Master, call: Call) -> None:
    answer = call("nep doctor")

    assert answer.code == 0, answer.out
    assert "Nothing is wrong." in answer.out
    assert f"0 programs at {master.endpoint}" in answer.out


def test_a_machine_gets_the_same_findings(
    master: Master, call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path / "missing"))
    monkeypatch.setenv(BROKER_VARIABLE, "nowhere")

    answer = call("nep doctor --json")

    findings = {one["about"]: one for one in msgspec.json.decode(answer.out)}
    assert answer.code == 1
    assert findings["ZeroMQ"]["state"] == "ok"
    assert findings[NODES_VARIABLE]["state"] == "look"
    assert findings[NODES_VARIABLE]["steps"]
    assert "nowhere" in findings[BROKER_VARIABLE]["told"]  # as programs know it
    assert all(isinstance(step, str) for step in findings[BROKER_VARIABLE]["steps"])


def test_a_port_that_another_program_has_is_told_with_its_name(taken_port: int) -> None:
    found = network.master(f"tcp://127.0.0.1:{taken_port}")
    [original] = network.original_ports((taken_port,))

    assert found.state == "look"
    assert f"(process {os.getpid()}), which is no NEP master" in found.sentence
    assert original.state == "note"


def test_a_port_of_the_original_that_our_own_master_has_is_right(master: Master) -> None:
    port = int(master.endpoint.rpartition(":")[2])

    [found] = network.original_ports((port,))

    assert found.state == "ok"


def test_no_master_is_only_noted(free_port: int) -> None:
    found = network.master(f"tcp://127.0.0.1:{free_port}")

    assert found.state == "note"
    assert "nep master" in found.sentence


@pytest.mark.parametrize(
    ("name", "value", "hint"),
    [
        (MASTER_VARIABLE, "7100", "is not an endpoint"),
        ("NEP_MASTR", "tcp://127.0.0.1:7100", "Did you mean NEP_MASTER?"),
        ("NEP_NETWORK", "ros", "there is no network ros"),
    ],
)
def test_a_wrong_variable_is_told(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str, hint: str
) -> None:
    monkeypatch.setenv(name, value)

    [found] = [one for one in network.variables() if one.about == name]

    assert found.state == "look"
    assert hint in " ".join((found.sentence, *found.steps))


def test_a_password_is_never_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NEP_ROBOT_PASSWORD", "topsecret")

    assert "topsecret" not in str(network.variables())


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")

    found = system.folder("logs", tmp_path / "file" / "logs")

    assert found.state == "look"
    assert "not a folder" in found.sentence


def test_a_folder_that_is_not_there_yet_is_no_fault(tmp_path: Path) -> None:
    assert system.folder("logs", tmp_path / "some" / "logs").state == "ok"


@pytest.mark.skipif(sys.platform == "win32", reason="has no such permissions")
def test_a_key_file_that_others_may_read_is_told(tmp_path: Path) -> None:
    keys = tmp_path / "keys"
    keys.write_text("secret")
    keys.chmod(0o644)

    open_to_all = system.key_file(str(keys))
    keys.chmod(0o600)
    private = system.key_file(str(keys))
    missing = system.key_file(str(tmp_path / "none"))

    assert open_to_all.steps == (f"Keep it to yourself: chmod 600 {keys}",)
    assert private.state == "ok"
    assert missing.state == "look"


def test_a_wrong_manifest_is_told_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "sensory").mkdir()
    (tmp_path / "sensory" / "lamp.toml").write_text("type = 1")
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))

    found = system.manifests()

    assert found.state == "look"
    assert "sensory/lamp.toml cannot be used" in found.sentence


@pytest.mark.parametrize(
    ("content", "programs", "told"),
    [
        ("ENABLED=yes\n", frozenset(), "ufw is on"),
        ("ENABLED=no\n", frozenset(), "ufw is off"),
        (None, frozenset({"firewalld"}), "firewalld is on"),
    ],
)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="is about Linux")
def test_a_firewall_is_told_as_far_as_it_can_be_known(
    tmp_path: Path, content: str | None, programs: frozenset[str], told: str
) -> None:
    ufw = tmp_path / "ufw.conf"
    if content:
        ufw.write_text(content)

    found = system.firewalls(ufw, programs)

    assert told in found[0].sentence
    assert found[0].state == "note"


def test_a_clock_that_was_lost_is_told() -> None:
    assert system.clock(0.0).state == "look"
    assert system.clock().state in ("ok", "note", "unknown")


@pytest.mark.parametrize(("age_s", "state"), [(0.01, "ok"), (-0.2, "ok"), (3.0, "look")])
def test_a_clock_of_another_computer_is_compared(age_s: float, state: str) -> None:
    found = network.difference("lab2", [age_s, age_s, 100.0])

    assert found.state == state
    assert found.about == "clock of lab2"


def test_a_full_disk_is_told() -> None:
    assert {one.state for one in system.disk_space(least=10**18)} == {"look"}
    assert {one.state for one in system.disk_space(least=0)} == {"ok"}


def test_a_robot_that_does_not_answer_is_told(taken_port: int, free_port: int) -> None:
    assert network.check_robot("127.0.0.1", taken_port).state == "ok"
    assert network.check_robot("127.0.0.1", free_port).state == "look"


def test_the_service_of_another_network_is_looked_for(
    free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NEP_NETWORK", "broker")
    monkeypatch.setenv("NEP_BROKER", f"tcp://127.0.0.1:{free_port}")

    none = network.service()
    broker = Broker()
    found = network.service()
    broker.close()

    assert (none.state, none.steps[0]) == ("look", "Start one in another terminal: nep broker")
    assert (found.state, found.sentence) == ("ok", "0 programs over broker")


@pytest.mark.parametrize("kind", ["broker", "zenoh"])
def test_a_master_that_nobody_would_ask_is_not_started(
    call: Call, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.setenv("NEP_NETWORK", kind)

    answer = call("nep master --endpoint tcp://127.0.0.1:*")

    assert answer.code == 1
    assert f"NEP_NETWORK is {kind}" in answer.err
    assert "nep broker" in answer.err
