"""Opening the studio's network: real masters with keys, and other programs that come in, or not."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from faults import fault_of
from nep_core.errors import NepError, PairingError
from nep_core.networks import transports
from nep_core.networks.security import KEYS_VARIABLE
from nep_core.networks.security.addresses import HOST_VARIABLE
from nep_core.networks.security.curve import Refusals
from nep_studio.run.local_network import LocalNetwork, door_at
from nep_studio.run.plan import STUDIO, PlannedNode
from nep_studio.sharing import Sharing, refusals_in

pytestmark = pytest.mark.long

HOST = "127.0.0.1"
WAIT_MS = 20_000
WATCH = PlannedNode("sensory/virtual_watch", "watch", {})


@pytest.fixture
def local(tmp_path: Path) -> Iterator[LocalNetwork]:
    made = LocalNetwork(logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def sharing(
    local: LocalNetwork, tmp_path: Path, free_port: int, qapp: QApplication
) -> Iterator[Sharing]:
    ports = (free_port, free_port + 1)
    made = Sharing(local, keys=tmp_path / "own.keys", ports=ports, is_announced=False)
    yield made
    made.end()


def nep(*words: str, keys: Path | None = None, master: str = "") -> subprocess.Popen[str]:
    """A program as somebody starts it in a terminal, on another computer or on this one."""
    names = (KEYS_VARIABLE, HOST_VARIABLE, "NEP_MASTER")
    environment = {name: value for name, value in os.environ.items() if name not in names}
    environment |= {KEYS_VARIABLE: str(keys), HOST_VARIABLE: HOST} if keys else {}
    return subprocess.Popen(
        [sys.executable, "-m", "nep_core.cli", *words],
        env=environment | ({"NEP_MASTER": master} if master else {}),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def said(process: subprocess.Popen[str], qtbot: QtBot) -> str:
    qtbot.waitUntil(lambda: process.poll() is not None, timeout=WAIT_MS)
    return process.communicate()[0]


def is_now(sharing: Sharing, qtbot: QtBot, state: str) -> None:
    qtbot.waitUntil(lambda: sharing.state == state, timeout=WAIT_MS)


def test_who_types_the_code_comes_in_and_others_are_refused_and_told_of(
    local: LocalNetwork, sharing: Sharing, tmp_path: Path, qtbot: QtBot
) -> None:
    local.open()
    local.start([WATCH])
    sharing.open(HOST)
    is_now(sharing, qtbot, "open")
    code, guest = sharing.code, tmp_path / "guest.keys"

    paired = said(nep("pair", sharing.address, code.text, "--keys", str(guest)), qtbot)
    heard = said(nep("echo", "/imu", "--count", "1", keys=guest), qtbot)
    refused = said(nep("topics", master=local.launcher.master), qtbot)
    qtbot.waitUntil(lambda: bool(sharing.refusals.newest_first), timeout=WAIT_MS)

    assert "Paired with" in paired
    assert '"acc"' in heard
    assert "only to programs that have its keys" in refused
    # "stranger": it had left before the system was asked where it is
    assert sharing.refusals.newest_first[0].kind in ("own_program", "stranger")
    assert [one.address for one in sharing.computers] == [HOST]
    assert sharing.code is None

    sharing.remove(sharing.computers[0].name)
    sharing.close()
    is_now(sharing, qtbot, "closed")

    assert sharing.computers == ()
    assert KEYS_VARIABLE not in os.environ
    assert HOST_VARIABLE not in os.environ
    assert local.running == [WATCH]


def test_a_wrong_code_is_told_and_lets_nobody_in(
    sharing: Sharing, tmp_path: Path, qtbot: QtBot
) -> None:
    sharing.open(HOST)
    is_now(sharing, qtbot, "open")
    wrong = "111 111" if sharing.code.text != "111 111" else "222 222"

    answer = said(nep("pair", sharing.address, wrong, "--keys", str(tmp_path / "g.keys")), qtbot)

    assert "That is not the code." in answer
    qtbot.waitUntil(lambda: bool(sharing.refusals.newest_first), timeout=WAIT_MS)
    assert sharing.refusals.newest_first[0].kind == "wrong_code"
    assert sharing.refusals.newest_first[0].address == HOST
    assert sharing.computers == ()


def test_who_sees_that_it_is_open_has_been_told_so(sharing: Sharing, qtbot: QtBot) -> None:
    told = []
    sharing.settled.connect(told.append)

    sharing.open(HOST)
    is_now(sharing, qtbot, "open")

    assert told == ["open"]


@pytest.mark.parametrize("fault", ["address", "keys", "port"])
def test_when_it_cannot_be_opened_all_runs_on_as_before(
    fault: str, local: LocalNetwork, sharing: Sharing, qtbot: QtBot, monkeypatch
) -> None:
    local.open()
    local.start([WATCH])
    master, failed = local.launcher.master, []
    sharing.failed.connect(failed.append)
    if fault == "keys":
        sharing.key_path.write_text("{}")
        sharing.key_path.chmod(0o600)
    elif fault == "port":  # somebody takes it at the last moment
        monkeypatch.setattr("nep_studio.sharing.free_endpoint", lambda endpoint: master)

    sharing.open("192.0.2.9" if fault == "address" else HOST)
    is_now(sharing, qtbot, "closed")

    qtbot.waitUntil(lambda: bool(failed), timeout=WAIT_MS)
    assert isinstance(failed[0], NepError)
    assert failed[0].checklist
    assert local.running == [WATCH]
    assert KEYS_VARIABLE not in os.environ
    assert {"watch", STUDIO} >= {
        one.node for one in transports.registrations(local.launcher.master)
    }


def test_a_studio_joins_the_network_of_another_computer_and_leaves_it(
    local: LocalNetwork, sharing: Sharing, tmp_path: Path, free_port: int, qtbot: QtBot, monkeypatch
) -> None:
    monkeypatch.setenv(HOST_VARIABLE, HOST)
    place = ("--host", HOST, "--port", str(free_port + 2), "--door", "0", "--no-announce")
    host = nep("open", *place, "--keys", str(tmp_path / "host.keys"))
    lines = iter(host.stdout.readline, "")
    words = next(line for line in lines if f"nep pair {HOST}" in line).split()
    joined_master = f"tcp://{HOST}:{free_port + 2}"

    sharing.join(words[2], " ".join(words[3:]))
    is_now(sharing, qtbot, "joined")
    local.start([WATCH])[0].wait_ready()
    there = {one.node for one in transports.registrations(joined_master)}
    sharing.close()
    is_now(sharing, qtbot, "closed")

    assert "watch" in there
    assert any(name.startswith(STUDIO) for name in there)
    assert local.launcher.master != joined_master
    assert local.running == [WATCH]
    host.terminate()
    host.communicate()


def test_what_guards_tell_of_refused_programs_is_read() -> None:
    refusals = Refusals("own.keys")
    refusals.refuse("192.0.2.7")
    refusals.refuse("127.0.0.1")
    refusals.cannot_join("tcp://192.0.2.8:5000")

    found = [(one.kind, one.address) for one in refusals_in(refusals.take())]

    assert found == [
        ("stranger", "192.0.2.7"),
        ("own_program", ""),
        ("unable", "tcp://192.0.2.8:5000"),
    ]
    assert list(refusals_in(fault_of("NAO is warm."))) == []


def test_an_address_is_read_as_it_is_shown() -> None:
    typed = ["192.168.1.5", " 192.168.1.5:7555 ", "tcp://10.0.0.1:7", "[fe80::1]:9", "lab-pc"]

    assert [door_at(one) for one in typed] == [
        ("192.168.1.5", 7101),
        ("192.168.1.5", 7555),
        ("10.0.0.1", 7),
        ("fe80::1", 9),
        ("lab-pc", 7101),
    ]


@pytest.mark.parametrize("typed", ["", "  ", ":7101", "a b", "192.168.1.5:door", "x:99999"])
def test_what_is_no_address_is_refused(typed: str) -> None:
    with pytest.raises(PairingError, match="is no address"):
        door_at(typed)
