"""A client of the official package at our server: it finds a NAOqi robot."""

import json
import subprocess
import sys
from typing import Any

import pytest
from naoqi_lamp import CERTIFICATE, HERE, KEY, CallingLamp, lamp_server, needs_oracle

from robots.naoqi.server import server as serving
from robots.naoqi.wire.line import Login, TlsFiles

pytestmark = needs_oracle
LOGIN = Login("nao", "secret")
FILES = TlsFiles(CERTIFICATE, KEY)
EXPECTED: dict[str, Any] = {
    "say": ["s a", "ss a English", "s{sm} a ['speed']"],
    "angles": [[0.25] * 26, [0.25]],
    "echo": [True, -3, 2**40, 0.1, "é", [], [1, "a", [2.5]], {"a": [1], "b": None}, None],
    "counts": {"a": [1, 2]},
    "raw": [99, 98, 97],
    "waits": 7,
    "properties": [0.5, None, 0.75],
    "module": [True, True, "MainBroker"],
    "cancel": True,
    "now": True,
    "events": [[1, "a"], [1, "a"]],
    "signal": [["Other", 0.5]],
    "posted": ["mine"],
    "told level": [0.25],
    "own object": 42,
    "called back": [True, ["key", 1.5, "message"]],
    "services": ["ServiceDirectory", "Lamp", "Caller"],
}


def use(scheme: str, port: int, *login: str) -> dict[str, Any]:
    """Let the official client do all it can; return what it found."""
    child = subprocess.run(
        [
            sys.executable,
            str(HERE / "naoqi_oracle_client.py"),
            f"{scheme}://127.0.0.1:{port}",
            *login,
        ],
        stdout=subprocess.PIPE,
        text=True,
        timeout=60,
    )
    assert child.returncode == 0
    found: dict[str, Any] = json.loads(child.stdout)
    return found


@pytest.fixture(scope="module")
def found() -> tuple[dict[str, Any], CallingLamp]:
    with lamp_server() as (lamp, server):
        return use("tcp", server.port), lamp


@pytest.mark.parametrize("what", EXPECTED)
def test_the_official_client_gets_what_a_robot_would_give(
    found: tuple[dict[str, Any], CallingLamp], what: str
) -> None:
    assert found[0].get(what) == EXPECTED[what], found[0].get("broken")


def test_the_values_that_the_official_client_sends_arrive(
    found: tuple[dict[str, Any], CallingLamp],
) -> None:
    assert found[1].angles == (["HeadYaw", "HeadPitch"], [0.5, -0.25], 0.125)


def test_failures_are_told_in_their_own_words(found: tuple[dict[str, Any], CallingLamp]) -> None:
    fails, breaks, nothing, *mismatches, nobody = found[0]["failures"]

    assert fails == "RuntimeError: The lamp is too hot."
    assert breaks == "RuntimeError: 'inner'"
    assert nothing.startswith("AttributeError")
    assert all("Arguments types did not match for say" in it for it in mismatches)
    assert nobody == "RuntimeError: Cannot find service 'Nobody' in index"


def test_the_official_client_logs_in_encrypted() -> None:
    with lamp_server(login=LOGIN, tls_files=FILES) as (_, server):
        found = use("tcps", server.port, "nao", "secret")

    assert {key: found.get(key) for key in EXPECTED} == EXPECTED


@pytest.mark.parametrize(
    ("scheme", "login"),
    [
        ("tcps", ("nao", "wrong")),
        ("tcps", ("other", "secret")),
        ("tcps", ()),
        ("tcp", ("nao", "secret")),
    ],
)
def test_the_official_client_is_refused(scheme: str, login: tuple[str, ...]) -> None:
    with lamp_server(login=LOGIN, tls_files=FILES) as (lamp, server):
        found = use(scheme, server.port, *login)

    assert list(found) == ["refused"]
    assert lamp.said == []


@pytest.mark.parametrize("scheme", ["tcp", "tcps"])
def test_an_official_client_too_many_is_told_why(
    monkeypatch: pytest.MonkeyPatch, scheme: str
) -> None:
    monkeypatch.setattr(serving, "MOST_CLIENTS", 0)

    with lamp_server(tls_files=FILES if scheme == "tcps" else None) as (_, server):
        found = use(scheme, server.port)

    assert found["refused"].startswith("There is no room for another program: 0 are connected")
