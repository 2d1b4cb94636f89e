"""The gesture node in a process of its own: it hears samples and tells gestures."""

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from nep_core.messages import HUMAN_BEHAVIOR, IMU, NODE_STATE, HumanBehavior, Imu, NodeState
from nep_core.pubsub import Publisher, Subscriber
from nodes.perceptual.recognition.model_file import write_model
from nodes.perceptual.recognition.passages import takes_of

MANIFEST = Path(__file__).resolve().parents[3] / "nodes" / "perceptual" / "gesture.toml"
START = """
import ast, sys
from pathlib import Path
from nep_core.manifest import read_manifest
from nep_core.run_node import run_node
sys.exit(run_node(read_manifest(Path(sys.argv[1])), sys.argv[2], ast.literal_eval(sys.argv[3])))
"""
WAIT_S = 20.0


class Program:
    """Starts gesture nodes, sends them samples and hears what they tell."""

    def __init__(self, network):
        self.network = network
        self.states = Subscriber(NODE_STATE, NodeState, network=network)
        self.behaviors = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
        self.nodes = []

    def start(self, name="gesture", **parameters):
        node = subprocess.Popen(
            [sys.executable, "-c", START, str(MANIFEST), name, repr(parameters)],
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.nodes.append(node)
        return node

    def state(self, event, node="gesture"):
        """The next state of this kind."""
        end_s = time.monotonic() + WAIT_S
        while (left_s := end_s - time.monotonic()) > 0:
            state = self.states.receive(left_s)
            if state and (state.event, state.node) == (event, node):
                return state
        pytest.fail(f"{node} did not tell {event}")

    def told(self, count):
        """The next human states."""
        found = [self.behaviors.receive(WAIT_S) for _ in range(count)]
        assert None not in found
        return found

    def send(self, recording, listeners=1, **changes):
        """All samples of a recording, in batches of 30 ms."""
        publisher = Publisher(IMU, network=self.network)
        assert publisher.wait_for_subscribers(listeners, WAIT_S)
        for part in np.array_split(np.arange(len(recording.t)), len(recording.t) // 2):
            message = {
                "source": "watch",
                "rate_hz": recording.rate_hz,
                "t": recording.t[part].tolist(),
                "acc": [tuple(row) for row in recording.acc[part].tolist()],
                "gyr": [tuple(row) for row in recording.gyr[part].tolist()],
            }
            publisher.send(Imu(**message | changes))
        return publisher

    def close(self):
        for node in self.nodes:
            node.terminate()
        for node in self.nodes:
            node.communicate(timeout=5)


@pytest.fixture
def program(join):
    program = Program(join("program"))
    yield program
    program.close()


@pytest.fixture
def file(tmp_path, model):
    path = tmp_path / "two.gestures"
    write_model(path, model)
    return str(path)


def made_in(recording):
    return [f"gesture_{take.gesture}" for take in takes_of(recording)]


def test_each_gesture_made_is_told_once_with_its_certainty(program, file, stranger):
    program.start(model=file)

    assert program.state("ready").description == "recognises hand_up, karate"
    program.send(stranger)
    told = program.told(len(takes_of(stranger)))

    assert [one.human_state for one in told] == made_in(stranger)
    assert {one.source for one in told} == {"gesture"}
    assert all(0.75 <= one.certainty <= 1 for one in told)


def test_a_process_for_each_gesture_tells_that_gesture_only(program, file, stranger):
    for name in ("hand_up", "karate"):
        program.start(name, model=file, gesture=name)
    assert program.state("ready", "hand_up").description == "recognises hand_up"
    program.start("third", model=file, gesture="karate", method="gmr", certainty=1.0)
    program.state("ready", "third")

    program.send(stranger, listeners=3)
    told = program.told(len(takes_of(stranger)))

    sources = {(one.source, one.human_state) for one in told if one.source != "third"}
    assert sources == {("hand_up", "gesture_hand_up"), ("karate", "gesture_karate")}


def test_without_a_model_of_its_own_it_knows_the_five_of_the_paper(program):
    program.start()

    names = program.state("ready").description.removeprefix("recognises ").split(", ")
    assert names == ["batting", "hand_up", "karate", "katana", "strech_up"]


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"gesture": "jump"}, 'The gesture model does not know "jump".'),
        ({"model": "nowhere.gestures"}, "There is no gesture model nowhere.gestures."),
    ],
)
def test_what_it_cannot_do_is_told_at_the_start(program, file, parameters, sentence):
    node = program.start(**{"model": file} | parameters)

    assert program.state("crashed").description == sentence
    _, told = node.communicate(timeout=5)
    assert node.returncode == 1
    assert sentence in told
    assert "Traceback" not in told


def test_a_sensor_that_lacks_something_is_told_and_another_is_still_heard(program, file, stranger):
    program.start(model=file)
    program.state("ready")

    program.send(stranger, source="phone", gravity_included=False)
    assert "needs acceleration with gravity" in program.state("warning").description
    program.send(stranger, source="torn", t=[0.0])
    assert "torn sends times and samples" in program.state("warning").description
    program.send(stranger, gyr=None)
    assert program.state("running").description == "hears watch without rotation"

    assert {one.human_state for one in program.told(4)} == {"gesture_hand_up", "gesture_karate"}
