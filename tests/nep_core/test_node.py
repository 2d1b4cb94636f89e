"""A node: its states, its stop, its name."""

from __future__ import annotations

import math
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from nep_core.errors import NameTaken, NetworkError, ParameterError
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.node import Node
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]


def test_a_node_tells_how_it_is_doing_and_that_it_lives(join: Join) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    with Node("lamp", "sensory") as node:
        node.ready("sees light")
        heard = [states.receive(5) for _ in range(3)]
    heard.append(states.receive(5))

    assert [state.event for state in heard if state] == ["starting", "ready", "alive", "stopped"]
    assert heard[1] is not None
    assert (heard[1].node, heard[1].type, heard[1].description) == ("lamp", "sensory", "sees light")


def test_a_node_that_fails_tells_so(join: Join) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    with pytest.raises(ValueError, match="broken"), Node("lamp", "sensory"):
        raise ValueError("the lamp is broken")

    heard = [state for state in iter(lambda: states.receive(0.5), None) if state]
    assert (heard[-1].event, heard[-1].description) == ("crashed", "the lamp is broken")


def test_what_fails_because_a_node_stops_is_no_crash(join: Join) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    with pytest.raises(NetworkError), Node("lamp", "sensory") as node:
        node.stop()
        raise NetworkError("The network of lamp is closed.")

    heard = [state for state in iter(lambda: states.receive(0.5), None) if state]
    assert heard[-1].event == "stopped"


def test_measures_of_the_same_state_go_out_as_a_heartbeat_at_most_twice_a_second(
    join: Join,
) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    with Node("watch", "sensory") as node:
        node.state("running", "listens", measures={"rate_hz": 50.0, "drift_ppm": float("nan")})
        for rate_hz in range(100):
            node.state("running", "listens", measures={"rate_hz": rate_hz})
        node.state("running", "listens to two", measures={"rate_hz": 100.0})

    heard = [state for state in iter(lambda: states.receive(0.2), None) if state]
    told = [(one.event, one.description, one.measures) for one in heard]
    assert told == [
        ("starting", "", {}),
        ("running", "listens", {"rate_hz": 50.0}),
        ("alive", "", {"rate_hz": 0.0}),
        ("running", "listens to two", {"rate_hz": 100.0}),
        ("stopped", "", {}),
    ]


def test_a_late_joiner_hears_the_state_and_not_the_last_measures(join: Join) -> None:
    with Node("watch", "sensory", network=join("watch")) as node:
        node.ready("at port 8085")
        node.state("alive", measures={"rate_hz": 50.0})

        late = Subscriber(NODE_STATE, NodeState, network=join("late"))
        heard = late.receive(5)

    assert heard is not None
    assert heard.event == "ready"


def test_stopping_ends_every_wait(join: Join) -> None:
    node = Node("lamp", "sensory", network=join("lamp"))
    silence = node.subscriber("/silence")

    node.stop()

    assert node.stopping
    assert node.wait(60)
    assert silence.receive() is None
    node.close()


def test_a_name_that_was_refused_is_free_again_when_its_owner_leaves(master: Master) -> None:
    with Node("lamp", "sensory"), pytest.raises(NameTaken):
        Node("lamp", "sensory")

    with Node("lamp", "sensory") as again:
        assert again.name == "lamp"


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@pytest.mark.parametrize(
    "text",
    [
        "import time\nprint('there', flush=True)\nwhile True: time.sleep(0.1)",
        "from nep_core.paper import *\nsub = subscriber('/x')\nprint('there', flush=True)\n"
        "while True: success, msg = sub.listen_info()",
        "from nep_core.paper import *\nsub = subscriber('/x')\nprint('there', flush=True)\n"
        "while True: success, msg = sub.listen_info(block=False)",
    ],
)
def test_ctrl_c_ends_a_program_whatever_it_does(master: Master, tmp_path: Path, text: str) -> None:
    program = tmp_path / "mine.py"
    program.write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "nep_studio", "exec", str(program)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "there\n"

    child.send_signal(signal.SIGINT)

    _, errors = child.communicate(timeout=10)
    assert (child.returncode, errors) == (0, "")


def test_words_that_nobody_would_understand_are_told_at_once(join: Join) -> None:
    network = join("watch")

    with pytest.raises(ParameterError, match="is no type of a node") as error:
        Node("watch", "sensor", network=network)
    with pytest.raises(ParameterError, match="A node has no name"):
        Node("", "sensory", network=network)
    with Node("watch", "sensory", network=network) as node:
        with pytest.raises(ParameterError, match="is no state of a node"):
            node.state("working")
        threading.Timer(0.05, node.stop).start()

        assert node.wait(math.inf)
    assert "sensory, perceptual" in str(error.value.checklist[0])


def test_late_joiners_hear_that_a_node_is_ready(join: Join) -> None:
    node = Node("lamp", "sensory", network=join("lamp"))
    node.ready("sees light")

    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    state = states.receive(5)
    assert state is not None
    assert state.event == "ready"
    node.close()


def test_publishers_of_a_node_speak_in_its_name(join: Join) -> None:
    subscriber = Subscriber[str]("/x", network=join("observer"))
    node = Node("lamp", "sensory", network=join("lamp"))

    publisher: Publisher = node.publisher("/x")
    publisher.send("hello")

    assert subscriber.receive(5) == "hello"
    assert subscriber.header is not None
    assert subscriber.header.node == "lamp"
    assert abs(subscriber.header.time_ns / 1e9 - time.time()) < 60
    node.close()
