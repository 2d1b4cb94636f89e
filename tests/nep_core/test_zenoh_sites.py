"""Several sites, each with a zenoh router of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from nep_core.cli import main
from nep_core.errors import NameTaken, NetworkError, PortTaken, RouterNotFound
from nep_core.networks.zenoh_network import ZenohNetwork, zenoh_registrations
from nep_core.networks.zenoh_session import (
    ZenohRouter,
    frames_key,
    hears_token,
    node_token,
    registrations_of,
    says_token,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.certificates import make_certificates
from tests.nep_core.relay import Relay

pytest.importorskip("zenoh")

FROZEN = """
import os, signal, sys
from nep_core.wire.pubsub import Subscriber
from nep_core.networks.zenoh_network import ZenohNetwork
subscriber = Subscriber("/x", network=ZenohNetwork("frozen", connect=[sys.argv[1]]))
os.kill(os.getpid(), signal.SIGSTOP)
"""


@pytest.fixture
def leaving() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def here(free_port: int) -> str:
    """An endpoint of the first site; the next port is free too."""
    return f"tcp/127.0.0.1:{free_port}"


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 8
    while not condition():
        assert time.monotonic() < deadline
        threading.Event().wait(0.01)


def test_sites_are_one_network_and_find_each_other_again(
    leaving: ExitStack, here: str, free_port: int
) -> None:
    there = f"tcp/127.0.0.1:{free_port + 1}"
    link = Relay(free_port)
    leaving.callback(link.close)
    leaving.callback(ZenohRouter([here]).close)
    second = ZenohRouter([there], [f"tcp/127.0.0.1:{link.port}"])
    leaving.callback(second.close)
    until(lambda: second.sites() == 1)
    talker = leaving.enter_context(ZenohNetwork("talker", connect=[here]))
    hearer = leaving.enter_context(ZenohNetwork("hearer", connect=[there]))
    near = leaving.enter_context(ZenohNetwork("near", connect=[here]))
    subscriber = Subscriber[Any]("/x", network=hearer)
    neighbour = Subscriber[Any]("/x", network=near)

    publisher = Publisher("/x", network=talker, latched=True, wait_for_subscribers=2)
    publisher.send("across")

    assert subscriber.receive(5) == neighbour.receive(5) == "across"
    names = {told.node for told in zenoh_registrations([there])}
    assert names == {"talker", "hearer", "near"}
    with ZenohNetwork("talker", connect=[there]) as twin, pytest.raises(NameTaken):
        twin.join()

    link.cut()
    until(lambda: publisher.subscribers() == 1)
    publisher.send("within the site")
    assert neighbour.receive(5) == "within the site"
    assert subscriber.receive(0) is None
    link.mend()
    assert publisher.wait_for_subscribers(2, 8)
    # the line is back before all routes are: what is sent meanwhile may be lost, and is counted
    until(lambda: publisher.send("across again") or subscriber.receive(0.5) == "across again")


def test_a_frozen_subscriber_takes_nothing_from_the_others(leaving: ExitStack, here: str) -> None:
    leaving.callback(ZenohRouter([here]).close)
    frozen = subprocess.Popen([sys.executable, "-c", FROZEN, here])
    leaving.callback(frozen.wait)
    leaving.callback(frozen.kill)
    subscriber = Subscriber[Any](
        "/x", network=leaving.enter_context(ZenohNetwork("hearer", connect=[here]))
    )
    publisher = Publisher("/x", network=leaving.enter_context(ZenohNetwork("t", connect=[here])))
    assert publisher.wait_for_subscribers(2, 8)
    os.waitid(os.P_PID, frozen.pid, os.WSTOPPED)

    for number in range(600):  # more than all buffers on the way hold
        publisher.send(number.to_bytes(2, "big") + bytes(20_000))

    heard = [int.from_bytes(subscriber.receive(5)[:2], "big") for _ in range(600)]
    assert heard == list(range(600))
    frozen.kill()
    until(lambda: publisher.subscribers() == 1)


def test_encrypted_sites_let_in_only_who_has_a_certificate_of_their_authority(
    leaving: ExitStack, free_port: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.networks.zenoh_session.CONNECT_MS", 300)
    ours, theirs = (make_certificates(tmp_path / name) for name in ("ours", "theirs"))
    place = f"tls/127.0.0.1:{free_port}"
    monkeypatch.setenv("NEP_ZENOH_KEYS", str(ours))
    leaving.callback(ZenohRouter([place]).close)
    hearer = leaving.enter_context(ZenohNetwork("hearer", connect=[place]))
    subscriber = Subscriber[Any]("/x", network=hearer)
    with ZenohNetwork("talker", connect=[place]) as talker:
        Publisher("/x", network=talker).send("secret")

    assert subscriber.receive(5) == "secret"
    monkeypatch.setenv("NEP_ZENOH_KEYS", str(theirs))
    with pytest.raises(RouterNotFound):
        ZenohNetwork("stranger", connect=[place])
    with pytest.raises(RouterNotFound):
        ZenohNetwork("stranger", connect=[place.replace("tls", "tcp")])
    monkeypatch.setenv("NEP_ZENOH_KEYS", str(tmp_path))
    with pytest.raises(NetworkError, match=r"ca\.pem"):
        ZenohNetwork("without", connect=[place])


def test_the_router_is_a_command_that_ends_when_asked(here: str) -> None:
    command = [sys.executable, "-c", "import sys; from nep_core.cli import main; sys.exit(main())"]
    router = subprocess.Popen(
        [*command, "broker", "--zenoh", "--listen", here], stdout=subprocess.PIPE, text=True
    )
    assert router.stdout is not None
    with router, router.stdout as output:
        assert output.readline().startswith(f"The zenoh router serves at {here}.")
        with ZenohNetwork("watch", connect=[here]) as network:
            network.join()
            assert [told.node for told in zenoh_registrations([here])] == ["watch"]

        router.send_signal(signal.SIGTERM)

        assert router.wait(5) == 0


@pytest.mark.parametrize("place", ["tcp/0.0.0.0:7447", "tcp/robot.local:7447", "tcp/[::]:7447"])
def test_a_router_that_everybody_could_read_is_refused(
    place: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["broker", "--zenoh", "--listen", place]) == 1

    told = capsys.readouterr().err
    assert "everybody on the network" in told
    assert "--private" in told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--listen", "tcp/127.0.0.1:7447"], "Add --zenoh"),
        (["--zenoh", "--endpoint", "tcp://127.0.0.1:7110"], "--listen"),
        (["--zenoh", "--listen", "127.0.0.1"], "not a zenoh endpoint"),
    ],
)
def test_options_that_do_not_fit_are_told(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["broker", *words]) == 1
    assert told in capsys.readouterr().err


def test_a_second_router_at_the_same_port_is_told(leaving: ExitStack, here: str) -> None:
    leaving.callback(ZenohRouter([here], is_private=True).close)

    with pytest.raises(PortTaken, match="cannot be used"):
        ZenohRouter([here])


CARELESS = """
import threading
from nep_core.wire.pubsub import Publisher, Subscriber
heard = threading.Event()
subscriber = Subscriber("/x", callback=lambda message: heard.set())
Publisher("/x").send("hello")
assert heard.wait(5)
"""


def test_a_program_that_closes_nothing_ends_all_the_same(
    leaving: ExitStack, here: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    leaving.callback(ZenohRouter([here]).close)
    monkeypatch.setenv("NEP_NETWORK", "zenoh")
    monkeypatch.setenv("NEP_ZENOH", here)

    program = subprocess.run([sys.executable, "-c", CARELESS], timeout=20, capture_output=True)

    assert (program.returncode, program.stderr) == (0, b"")


def test_leaving_without_a_router_hangs_nowhere(leaving: ExitStack, here: str) -> None:
    router = ZenohRouter([here])
    network = ZenohNetwork("watch", connect=[here])
    subscriber = Subscriber[Any]("/x", network=network)
    publisher = Publisher("/x", network=network)

    router.close()
    publisher.send("to myself")
    network.close()

    assert subscriber.receive() in ("to myself", None)


def test_tokens_tell_any_name_and_topic_and_strange_ones_tell_nothing() -> None:
    tokens = [
        says_token("/a*b?", "1"),
        hears_token("/ü/", "1", "s"),
        node_token("näo/$*", "1", 7, "a host"),
        "nep/alive",
        "nep/alive/node/x/y/pid/host",
        says_token("/x", "nobody"),
    ]

    [told] = registrations_of(tokens, "here")

    assert (told.node, told.pid, told.host) == ("näo/$*", 7, "a host")
    assert told.publishes == ["/a*b?"]
    assert told.subscribes == {"s": "/ü/"}


def test_bytes_of_other_zenoh_programs_do_no_harm(leaving: ExitStack, here: str) -> None:
    leaving.callback(ZenohRouter([here]).close)
    network = leaving.enter_context(ZenohNetwork("watch", connect=[here]))
    subscriber = Subscriber[Any]("/x", network=network)
    stranger = leaving.enter_context(ZenohNetwork("stranger", connect=[here]))

    for rubbish in (b"", b"\0", b"\xff", b"\xffs/x\0", b"no header", b"/x\0[]\0{}", b"/x\0\0"):
        stranger.session.put(frames_key("/x"), rubbish)
    Publisher("/x", network=stranger).send("sense")

    assert subscriber.receive(5) == "sense"
