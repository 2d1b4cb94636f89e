"""One sender is followed, and how that goes is told in sentences."""

from itertools import pairwise

import pytest

from faults import plain
from nodes.sensory.connectors.connector import Arrived
from nodes.sensory.reading import Reading
from nodes.sensory.smartwatch import Hearing

ACC, GYR = (0.0, 0.0, 9.81), (0.1, 0.2, 0.3)


class Told:
    """A node that notes the English words of what it tells."""

    def __init__(self):
        self.states, self.measures = [], {}

    def state(self, event, words="", /, *, measures=None, **values):
        self.measures = measures or self.measures
        if event != "alive":
            self.states.append((event, plain(words, **values)))

    def warn(self, words, /, **values):
        self.states.append(("warning", plain(words, **values)))

    @property
    def warnings(self):
        return [words for event, words in self.states if event == "warning"]


class Scene:
    """A hearing, with time that passes in batches of 20 ms."""

    def __init__(self):
        self.node = Told()
        self.hearing = Hearing(self.node, "Is it plugged in?")
        self.hearing.wrist = "left"
        self.now_s = self.hearing._began_s
        self.count = 0
        self.messages = []

    def hear(self, *arrivals):
        self.now_s += 0.02
        if message := self.hearing.hear(arrivals, self.now_s):
            self.messages.append(message)

    def wait(self, seconds, *arrivals):
        for _ in range(int(seconds * 50)):
            self.hear(*arrivals)

    def send(self, seconds, *, sender="a watch", rate_hz=50, skip=0, **about):
        """Samples of a watch with a clock of its own."""
        for _ in range(int(seconds * 50)):
            readings = []
            for _ in range(rate_hz // 50):
                self.count += 1
                if not skip or self.count % skip:
                    stamp = about.get("clock_s", 0) + self.count / rate_hz
                    readings.append(Reading(ACC, GYR, stamp, 1.0))
            told = about.get("columns", "")
            self.hear(Arrived(sender, readings, self.now_s + 0.02, columns=told))


@pytest.fixture
def scene():
    return Scene()


def test_a_watch_is_told_with_its_rate_and_columns_and_becomes_imu(scene):
    scene.send(2, columns="t (ms), ax, ay, az (g)")

    assert scene.node.states == [
        ("connected", "a watch sends 50 samples a second: t (ms), ax, ay, az (g)")
    ]
    batch = scene.messages[-1]
    assert (batch.source, batch.wrist, batch.gravity_included) == ("a watch", "left", True)
    assert batch.acc == [ACC]
    assert batch.gyr == [GYR]
    assert batch.rate_hz == pytest.approx(50)


def test_how_well_it_flows_is_measured(scene):
    scene.send(40)

    assert scene.node.measures["rate_hz"] == pytest.approx(50)
    assert scene.node.measures["loss"] == 0
    assert scene.node.measures["gaps"] == 0
    assert scene.node.measures["drift_ppm"] == pytest.approx(0, abs=1)
    assert scene.node.measures["delay_ms"] < 5


def test_samples_that_get_lost_are_told(scene):
    scene.send(10)
    scene.send(40, skip=5)

    words = [words for event, words in scene.node.states if "get lost" in words]
    assert words
    assert "% get lost" in words[-1]


def test_nothing_for_ten_seconds_is_told_once_with_what_to_check(scene):
    scene.wait(9.9)
    assert scene.node.states == []

    scene.wait(60)

    assert scene.node.warnings == ["Is it plugged in?"]


def test_a_sender_that_is_connected_but_silent_is_told(scene):
    scene.hear(Arrived("a watch", (), scene.now_s))
    scene.wait(30)

    assert scene.node.warnings == [
        "a watch is connected but sends nothing. Start the measuring in its app."
    ]


def test_a_sender_without_acceleration_is_told(scene):
    scene.wait(12, Arrived("a phone", [Reading(None, GYR, 1.0, 1.0)]))

    assert scene.node.warnings == [
        "a phone sends no acceleration. Switch the accelerometer on in its app."
    ]


def test_silence_and_its_end_are_told(scene):
    scene.send(1)
    scene.wait(4)
    scene.send(1)

    assert [event for event, _ in scene.node.states] == ["connected", "disconnected", "connected"]


def test_a_second_sender_is_left_aside_until_the_first_is_silent(scene):
    for _ in range(20):
        scene.send(0.1)
        scene.hear(Arrived("another", [Reading(ACC, None, 5.0, 1.0)], scene.now_s))
    assert {batch.source for batch in scene.messages} == {"a watch"}
    assert scene.node.warnings == ["A second watch sends from another; a watch is followed."]

    scene.wait(4)
    scene.send(1, sender="another")

    assert scene.messages[-1].source == "another"


@pytest.mark.parametrize(
    ("jump_s", "words"), [(-100, "back by 100"), (3600, "ahead by 3600"), (20, "ahead by 20")]
)
def test_a_clock_that_jumps_is_told_and_time_goes_on(scene, jump_s, words):
    scene.send(15)
    scene.send(2, clock_s=jump_s)

    assert words in scene.node.warnings[0]
    assert len(scene.node.warnings) == 1
    t = [one for batch in scene.messages for one in batch.t]
    assert max(after - before for before, after in pairwise(t)) < 0.1


def test_a_pause_is_no_jump_of_the_clock(scene):
    scene.send(5)
    scene.wait(60)
    scene.send(2, clock_s=60)

    assert scene.node.warnings == []


def test_a_flood_is_thinned_and_told(scene):
    scene.send(3, rate_hz=10_000)

    late = scene.messages[-50:]
    assert sum(len(batch.t) for batch in late) == pytest.approx(500, rel=0.05)
    assert late[-1].rate_hz == pytest.approx(500, rel=0.05)
    [warning] = scene.node.warnings
    assert "10000 samples a second" in warning


def test_troubles_are_told_now_and_then_not_each_time(scene):
    scene.wait(12, Arrived("a watch", trouble="It sends rubbish."))

    assert scene.node.warnings == ["It sends rubbish."]


def test_what_was_left_out_is_told(scene):
    scene.send(1)
    scene.hear(Arrived("a watch", [Reading(ACC, None, 1.05, 1.0)], scene.now_s, dropped=70))

    assert "70 values were left out" in scene.node.warnings[0]


def test_a_sender_that_can_only_complain_does_not_push_the_other_aside(scene):
    scene.send(1)
    scene.hear(Arrived("another", trouble="It sends rubbish."))
    scene.send(1)

    assert {batch.source for batch in scene.messages} == {"a watch"}
