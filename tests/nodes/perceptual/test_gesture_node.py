"""The gesture node in a process of its own: it hears samples and tells gestures."""

import numpy as np
import pytest

from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu
from nep_core.wire.pubsub import Publisher, Subscriber
from nodes.perceptual.recognition.model import write_model
from nodes.perceptual.recognition.streams import takes_of
from tests.node_running import WAIT_S, NodeRunner, until

pytestmark = pytest.mark.long


class Program(NodeRunner):
    """Starts gesture nodes, sends them samples and hears what they tell."""

    def __init__(self, network):
        super().__init__(network)
        self.behaviors = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)

    def start(self, name="gesture", **parameters):
        return self.start_node("perceptual/gesture", name, **parameters)

    def told(self, count):
        """The next human states."""
        found = [self.behaviors.receive(WAIT_S) for _ in range(count)]
        assert None not in found
        return found

    def measures(self, name):
        """The next measures that have this one among them."""
        return until(self.states, lambda state: name in state.measures)[-1].measures

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
    assert program.state("running").description == "listens to watch"
    told = program.told(len(takes_of(stranger)))

    assert [one.human_state for one in told] == made_in(stranger)
    assert {one.source for one in told} == {"gesture"}
    assert all(0.75 <= one.certainty <= 1 for one in told)


def test_a_process_for_each_gesture_tells_that_gesture_only(program, file, stranger):
    for name in ("hand_up", "karate"):
        program.start(name, model=file, gesture=name)
    assert program.state("ready", node="hand_up").description == "recognises hand_up"
    program.start("third", model=file, gesture="karate", method="gmr", certainty=1.0)
    program.state("ready", node="third")

    program.send(stranger, listeners=3)
    told = []
    while sum(source != "third" for source, _ in told) < len(takes_of(stranger)):
        told += [(one.source, one.human_state) for one in program.told(1)]

    own = {("hand_up", "gesture_hand_up"), ("karate", "gesture_karate")}
    assert set(told) - {("third", "gesture_karate")} == own


def test_a_process_for_a_set_of_gestures_tells_how_certain_quick_and_busy_it_is(
    program, file, brief
):
    program.start(model=file, gesture="karate, hand_up", certainties="karate 0.6")
    assert program.state("ready").description == "recognises karate, hand_up"

    program.send(brief)
    program.told(len(takes_of(brief)))
    measures = program.measures("latency_ms")

    assert set(measures) == {"certainty.karate", "certainty.hand_up", "latency_ms", "load"}
    assert 0 <= measures["certainty.karate"] <= 1
    assert 0 < measures["latency_ms"] < 5000
    assert 0 < measures["load"] < 8


def test_without_a_model_of_its_own_it_knows_the_five_of_the_paper(program):
    program.start()

    names = program.state("ready").description.removeprefix("recognises ").split(", ")
    assert names == ["batting", "hand_up", "karate", "katana", "strech_up"]


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"gesture": "jump"}, 'The gesture model does not know "jump".'),
        ({"model": "nowhere.gestures"}, "There is no gesture model nowhere.gestures."),
        ({"gesture": "karate, jump"}, 'The gesture model does not know "jump".'),
        ({"certainties": "jump 0.5"}, 'The gesture model does not know "jump".'),
        ({"certainties": "karate"}, 'The certainties have "karate", which is not a gesture and'),
        ({"certainties": "karate 7"}, "The certainty of karate is 7, which is not possible."),
    ],
)
def test_what_it_cannot_do_is_told_at_the_start(program, file, parameters, sentence):
    node = program.start(**{"model": file} | parameters)

    assert sentence in program.state("crashed").description
    _, told = node.communicate(timeout=5)
    assert node.returncode == 1
    assert sentence in told
    assert "Traceback" not in told


def test_of_very_many_sensors_the_first_are_heard_and_that_is_told_once(program, file, brief):
    program.start(model=file)
    program.state("ready")

    publisher = Publisher(IMU, network=program.network)
    assert publisher.wait_for_subscribers(1, WAIT_S)
    rows = {"t": [0.0], "acc": [(0.0, 0.0, 9.8)], "rate_hz": 50.0}
    for number in range(200):
        publisher.send(Imu(source=f"watch {number}", **rows))
    program.state("warning", "watch 8 is not heard: 8 watches and phones send movement already")
    program.send(brief, source="watch 0")

    assert len(program.told(2)) == 2
    warnings = [one for one in iter(lambda: program.states.receive(0), None) if one]
    assert [one for one in warnings if one.event == "warning"] == []


def test_a_sensor_that_lacks_something_is_told_and_another_is_still_heard(program, file, brief):
    program.start(model=file)
    program.state("ready")

    program.send(brief, source="phone", gravity_included=False)
    lacking = program.state("warning").fault
    assert "needs acceleration with gravity" in str(lacking)
    assert "switch on acceleration with gravity" in " ".join(map(str, lacking.checklist))
    program.send(brief, source="torn", t=[0.0])
    assert "torn sends times and samples" in program.state("warning").description
    program.send(brief, gyr=None)
    assert program.state("running").description == "listens to watch, which sends no rotation"

    assert {one.human_state for one in program.told(2)} == {"gesture_hand_up", "gesture_karate"}
