"""The example nodes in C++ and JavaScript: started, heard, stopped and refused like ours."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import psutil
import pytest

from nep_core.networks.master import Master
from nep_core.networks.master_messages import ask_master, ask_to_stop
from nep_core.networks.zmq_networks import Broker, BrokerNetwork, PeerNetwork
from nep_core.places import NODES_VARIABLE
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.processes.manifest import NodeCatalog, Value
from nep_core.processes.process import ASKED
from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, NODE_STATE, HumanBehavior, Imu, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import until

pytestmark = pytest.mark.long

WAIT_S = 20.0
PROGRAM = Path(__file__).parent / "shaken.nep"
RUN_LAUNCHER = """
import sys
from pathlib import Path
from nep_core.processes.launcher import Launcher
launcher = Launcher(folders=(Path(sys.argv[1]),), logs=Path(sys.argv[2]))
launcher.start("sensory/board", "orphan").wait_ready(20)
input()
"""
STRONG = Imu(source="somebody", rate_hz=50, t=[0.0], acc=[(40.0, 0.0, 0.0)])


@pytest.fixture
def states(network: PeerNetwork) -> Subscriber[NodeState]:
    return Subscriber(NODE_STATE, NodeState, network=network)


def start(launcher: Launcher, node: str, name: str = "", **settings: Value) -> LaunchedNode:
    launched = launcher.start(node, name, **settings)
    launched.wait_ready(WAIT_S)
    return launched


def command(nodes: Path, node: str) -> list[str]:
    manifest = NodeCatalog((nodes,)).find(node)
    return [part.format(folder=Path(manifest.path).parent) for part in manifest.command]


def test_a_sensory_node_is_heard_from_its_first_message_on(
    launcher: Launcher, network: PeerNetwork, states: Subscriber[NodeState]
) -> None:
    imu = Subscriber(IMU, Imu, network=network)
    board = start(launcher, "sensory/board", rate_hz=1000)

    batches = until(imu, lambda batch: batch.t[-1] > 0.3)
    launcher.stop("board")

    assert [batches[0].t[0], batches[0].acc[0], batches[0].rate_hz] == [0.0, (0, 0, 9.81), 1000]
    assert imu.lost == 0 and imu.header is not None and imu.header.sequence == len(batches)
    told = [state.event for state in until(states, lambda state: state.event == "stopped")]
    assert [event for event in told if event != "alive"] == ["starting", "ready", "stopped"]
    assert board.end_reported.wait(WAIT_S) and board.outcome is not None and board.outcome.code == 0


def test_a_perceptual_node_hears_our_watch_and_tells_what_the_person_does(
    launcher: Launcher, network: PeerNetwork
) -> None:
    behavior = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
    start(launcher, "perceptual/shake", strength_m_s2=2.5)

    start(launcher, "sensory/virtual_watch", gestures="0.2 karate", speed=4)
    told = until(behavior, lambda told: True)[0]

    assert (told.human_state, told.source) == ("shaken", "simulated person 100")
    assert 0.5 <= told.certainty <= 1


def test_a_flood_of_messages_in_shared_frames_is_heard_without_a_loss(
    launcher: Launcher, network: PeerNetwork, states: Subscriber[NodeState]
) -> None:
    behavior = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
    imu = Publisher(IMU, network=network)
    start(launcher, "perceptual/shake")
    still = Imu(source="flood", rate_hz=1000, t=[0.0], acc=[(0.0, 0.0, 9.81)])

    for _ in range(3000):
        imu.send(still)
    for _ in range(60):
        imu.send(STRONG)

    assert until(behavior, lambda told: True)[0].source == "somebody"
    heard = until(states, lambda state: state.node == "shake" and state.event == "alive")
    assert not [state for state in heard if state.event == "warning"]


def test_after_a_restart_of_the_master_it_is_there_again(
    launcher: Launcher, network: PeerNetwork, master: Master, join: Callable[[str], PeerNetwork]
) -> None:
    start(launcher, "sensory/board")
    imu = Subscriber(IMU, Imu, network=network)
    imu.receive(WAIT_S)
    master.close()

    with_new = Master(master.endpoint)

    try:
        assert_registered(master.endpoint, "board")
        late = Subscriber(IMU, Imu, network=join("late"))
        assert late.receive(WAIT_S) is not None
        assert imu.receive(WAIT_S) is not None and imu.lost == 0
    finally:
        with_new.close()


def test_it_stops_when_somebody_asks_the_master(
    launcher: Launcher, network: PeerNetwork, states: Subscriber[NodeState]
) -> None:
    shake = start(launcher, "perceptual/shake")

    asked = ask_to_stop(network.master, "shake")

    assert asked
    until(states, lambda state: state.node == "shake" and state.event == "stopped")
    assert shake.ended.wait(WAIT_S) and shake.outcome is not None and shake.outcome.code == ASKED


def test_a_second_node_of_the_same_name_is_refused_with_a_sentence(
    nodes: Path, join: Callable[[str], PeerNetwork]
) -> None:
    join("twin").join()

    second = subprocess.run(
        [*command(nodes, "perceptual/shake"), "--name", "twin"],
        capture_output=True,
        text=True,
        timeout=WAIT_S,
    )

    assert second.returncode == 1
    assert second.stderr.startswith('A node named "twin" is already running')
    assert "\n  [ ] Give the new node another name.\n" in second.stderr


def test_it_ends_with_a_launcher_that_is_killed(
    nodes: Path, network: PeerNetwork, states: Subscriber[NodeState], tmp_path: Path
) -> None:
    words = [sys.executable, "-c", RUN_LAUNCHER, str(nodes), str(tmp_path)]
    with subprocess.Popen(words, stdin=subprocess.PIPE) as launching:
        orphan = until(states, lambda s: s.node == "orphan" and s.event == "ready")[-1]
        process = psutil.Process(orphan.pid)

        launching.kill()

        assert psutil.wait_procs([process], timeout=WAIT_S)[1] == []


def test_a_rule_of_a_block_program_waits_for_what_it_tells(
    nodes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(NODES_VARIABLE, str(nodes))

    played = subprocess.run(
        [sys.executable, "-m", "nep_studio", "run", str(PROGRAM), "--trust"],
        capture_output=True,
        text=True,
        timeout=WAIT_S,
    )

    assert "board            sees shaken" in played.stdout
    assert "the rule “when shaken” begins" in played.stdout  # it ends the program
    assert played.returncode == 0


def test_it_hears_and_speaks_through_a_broker_as_well(
    nodes: Path, monkeypatch: pytest.MonkeyPatch, free_port: int
) -> None:
    monkeypatch.setenv("NEP_NETWORK", "broker")
    monkeypatch.setenv("NEP_BROKER", f"tcp://127.0.0.1:{free_port}")
    with closing(Broker()), BrokerNetwork(node="test") as network:
        behavior = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
        imu = Publisher(IMU, network=network)
        words = [*command(nodes, "perceptual/shake"), "strength_m_s2=3"]
        with subprocess.Popen(words) as shake:
            heard = imu.wait_for_subscribers(1, WAIT_S)
            for _ in range(60):
                imu.send(STRONG)
            told = until(behavior, lambda told: True)[0]
            shake.terminate()

    assert heard and told.human_state == "shaken" and shake.returncode == 0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--name", "board", "rate_hz=fast"], "The setting rate_hz is no number: fast.\n  [ ] "),
        (["--name", ""], "A registration names its instance and its node."),
    ],
)
def test_what_it_cannot_do_it_says(
    nodes: Path, master: Master, words: list[str], sentence: str
) -> None:
    ended = subprocess.run(
        [*command(nodes, "sensory/board"), *words], capture_output=True, text=True, timeout=WAIT_S
    )

    assert ended.returncode == 1
    assert ended.stderr.startswith(sentence)


def test_an_opened_network_is_not_entered_in_the_clear(nodes: Path, master: Master) -> None:
    ended = subprocess.run(
        command(nodes, "sensory/board"),
        capture_output=True,
        text=True,
        timeout=WAIT_S,
        env={**os.environ, "NEP_KEYS": "somewhere.keys"},
    )

    assert ended.returncode == 1
    assert "not open to others" in ended.stderr and "  [ ] " in ended.stderr


def assert_registered(endpoint: str, node: str) -> None:
    deadline = time.monotonic() + WAIT_S
    while time.monotonic() < deadline:
        listing = ask_master(endpoint, timeout_s=1.0)
        if listing is not None and node in {told.node for told in listing.registrations}:
            return
    pytest.fail(f"{node} is not registered: {json.dumps(str(listing))}")
