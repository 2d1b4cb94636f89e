"""Whatever others send, ``nep`` writes nothing that steers the reader's terminal."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable

import msgspec
import pytest
import zmq

from nep_core.cli.console import visible
from nep_core.errors import NetworkError
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher

EVIL = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202egnp\x7f\r"
"""Sets the title, clears, colours, turns letters around, goes to the start of the line."""
STEERING = ("\x1b", "\x07", "\x9b", "\u202e", "\x7f", "\x00")


@pytest.fixture
def hostile(join: Callable[[str], PeerNetwork]) -> PeerNetwork:
    """A node that sends control characters wherever the master lets it."""
    network = join("talker")
    publisher = Publisher("/evil", network=network, latched=True)
    publisher.send({"text": EVIL, EVIL: [EVIL]})
    text = Publisher("/text", network=network, encoding="text", latched=True)
    text.send(f"{EVIL}\nnep: all is well")
    states = Publisher(NODE_STATE, network=network)
    states.send(NodeState(node="talker", type=EVIL, event="ready", description=EVIL, host=EVIL))
    return network


def on_a_terminal(*words: str) -> str:
    """What a command writes to a terminal."""
    import pty

    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "nep_core.cli", *words]
    told = b""
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs) as running:
        os.close(theirs)
        try:
            while piece := os.read(ours, 65536):
                told += piece
        except OSError:  # Linux's way to say that the other end is closed
            pass
        running.wait(timeout=30)
    os.close(ours)
    return told.decode("utf-8", "replace").replace("\r\n", "\n")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo terminals")
@pytest.mark.parametrize(
    "line",
    [
        *("echo /evil --count 1", "echo /evil --count 1 --pretty", "echo /evil --count 1 --json"),
        *("echo /text --count 1", "echo /evil --count 1 --field " + EVIL, "nodes", "topics"),
        "echo /node_state --count 1 --seconds 3",
    ],
)
def test_nothing_steers_the_terminal(hostile: PeerNetwork, line: str) -> None:
    told = on_a_terminal(*line.split(" "))

    assert told.strip()
    assert not [sign for sign in STEERING if sign in told]
    assert "\r" not in told
    assert "\nnep: all is well" not in told


@pytest.mark.parametrize("name", [EVIL, "a\nb", "a\x85b", "a\u2028b", "\x1b[2J"])
@pytest.mark.parametrize("where", ["node", "host", "publishes", "subscribes"])
def test_the_master_refuses_names_with_control_characters(
    master: Master, name: str, where: str
) -> None:
    told: dict[str, object] = {"instance": "i", "node": "n", "pid": 1, "host": "h", "endpoint": ""}
    told |= {"publishes": [name], "endpoint": "tcp://127.0.0.1:5"} if where == "publishes" else {}
    told |= {"subscribes": {"s": name}} if where == "subscribes" else {}
    told |= {where: name} if where in ("node", "host") else {}
    request = {"do": "register", "version": 1, "registration": told}
    with zmq.Context() as context, context.socket(zmq.DEALER) as asking:
        asking.linger = 0
        asking.connect(master.endpoint)
        asking.send(msgspec.json.encode(request))
        assert asking.poll(10_000)
        answer = msgspec.json.decode(asking.recv())

    assert answer["do"] == "error"
    assert "control characters" in answer["sentence"]


def test_a_program_that_publishes_on_such_a_topic_is_told(
    join: Callable[[str], PeerNetwork],
) -> None:
    with pytest.raises(NetworkError, match="no control characters"):
        Publisher("/a\x1b[2J", network=join("talker"))


def test_json_in_which_letters_are_written_out_says_the_same() -> None:
    text = f"{EVIL} \U0001f3f4\U000e0067\U000e0062\U000e0077\U000e006c\U000e0073\U000e007f"

    told = visible(msgspec.json.encode(text).decode())

    assert not [sign for sign in STEERING if sign in told]
    assert msgspec.json.decode(told) == text


def test_letters_of_all_languages_stay_as_they_are() -> None:
    text = "Grüße, 日本, نیم‌فاصله, 👩‍👧, ½ ° µ"

    assert visible(text) == text
