"""The posture node in a process of its own: it hears watches and tells how arms are held."""

from __future__ import annotations

import math

import pytest

from nep_core.wire.messages import (
    GESTURE_REQUEST,
    HUMAN_BEHAVIOR,
    IMU,
    GestureRequest,
    HumanBehavior,
    Imu,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import WAIT_S, NodeRunner, until

pytestmark = pytest.mark.long

UP, BETWEEN, LEVEL, DOWN = 80.0, 38.0, 0.0, -80.0


class Program(NodeRunner):
    """Starts posture nodes, sends them samples and hears what they tell."""

    def __init__(self, network):
        super().__init__(network)
        self.behaviors = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
        self.now_s = 0.0

    def start(self, **parameters):
        self.start_node("perceptual/posture", "arm", **({"worn": "automatic"} | parameters))
        self.state("ready", "tells how an arm with a watch is held")
        self.movement = Publisher(IMU, network=self.network)
        assert self.movement.wait_for_subscribers(1, WAIT_S)

    def told(self, count):
        found = [self.behaviors.receive(WAIT_S) for _ in range(count)]
        assert None not in found
        return [one.human_state for one in found]

    def hold(self, elevation_deg, seconds=2.0, *, is_hand=True, **changes):
        """A watch whose x axis points to the hand, or to the elbow, held at a slant."""
        slant = math.radians(elevation_deg) * (1 if is_hand else -1)
        felt = (9.81 * math.sin(slant), 0.0, 9.81 * math.cos(slant))
        for _ in range(round(seconds / 0.04)):
            message = {
                "source": "watch",
                "rate_hz": 50.0,
                "t": [self.now_s + 0.02, self.now_s + 0.04],
                "acc": [felt, felt],
                "wrist": "left",
            }
            self.now_s += 0.04
            self.movement.send(Imu(**message | changes))


@pytest.fixture
def program(join):
    program = Program(join("program"))
    yield program
    program.close()


def test_each_posture_is_told_once_each_time_that_it_begins(program):
    program.start()

    for elevation_deg in (DOWN, UP, LEVEL, UP, UP, DOWN):
        program.hold(elevation_deg)

    assert program.state("running").description == "listens to watch"
    assert program.told(5) == [
        "arm_lowered",
        "arm_raised",
        "arm_level",
        "arm_raised",
        "arm_lowered",
    ]
    assert until(program.states, lambda state: state.measures)[-1].measures["elevation_deg"] < 90


@pytest.mark.parametrize(
    ("worn", "wrist", "is_hand"),
    [
        ("automatic", "right", False),
        ("right wrist", "", False),
        ("right wrist, turned", "right", True),
        ("left wrist, turned", "left", False),
        ("left wrist", "right", True),
    ],
)
def test_the_wrist_is_what_the_watch_says_or_a_person_has_set(program, worn, wrist, is_hand):
    program.start(worn=worn)

    program.hold(UP, is_hand=is_hand, wrist=wrist)

    assert program.told(1) == ["arm_raised"]


def test_where_nobody_says_the_wrist_the_arm_that_hangs_shows_it(program):
    program.start()

    program.hold(LEVEL, is_hand=False, wrist="")
    assert "let the arm hang" in program.state("running").description
    program.hold(DOWN, 4.0, is_hand=False, wrist="")
    program.state("running", "watch: the arm that hangs has shown how it is worn.")
    program.hold(UP, is_hand=False, wrist="")

    assert program.told(2) == ["arm_lowered", "arm_raised"]


def test_a_watch_worn_the_other_way_than_it_says_is_told_of(program):
    program.start()

    program.hold(DOWN, 20.0, is_hand=False)

    program.state("running", "watch is worn the other way round")
    assert program.told(2) == ["arm_raised", "arm_lowered"]


def test_without_gravity_it_says_what_to_do_once_and_hears_others(program):
    program.start()

    for _ in range(3):  # an app that changes its mind, and a watch beside it
        program.hold(UP, 0.2, source="phone", gravity_included=False)
        program.hold(BETWEEN, 0.2, source="phone")
        program.hold(UP, 0.2)
    program.hold(UP)

    assert "Choose the acceleration with gravity" in program.state("warning").description
    assert program.told(1) == ["arm_raised"]
    assert not [one for one in program.states.pending() if one.event == "warning"]


def test_a_phone_in_the_hand_tells_nothing_of_the_arm(program):
    program.start()

    program.hold(UP, source="phone", wrist="hand")
    program.hold(UP)

    assert "phone is held in the hand" in program.state("warning").description
    assert program.told(1) == ["arm_raised"]
    assert program.behaviors.receive(0.3) is None


def test_two_people_are_told_of_each_by_their_own_watch(program):
    program.start()

    for _ in range(40):
        program.hold(UP, 0.04, source="Anna")
        program.now_s -= 0.04
        program.hold(DOWN, 0.04, source="Ben")

    assert sorted(program.told(2)) == ["arm_lowered", "arm_raised"]


def test_samples_that_do_not_belong_together_are_told_of_and_others_heard(program):
    program.start()

    program.hold(UP, 0.2, source="broken", t=[1.0])
    program.hold(UP, 0.2, source="empty", t=[], acc=[])
    program.hold(UP, t=[math.nan, math.inf], source="odd")
    program.hold(UP)

    assert "broken sends times and samples" in program.state("warning").description
    assert program.told(1) == ["arm_raised"]


def test_at_most_eight_watches_are_listened_to(program):
    program.start()

    for number in range(9):
        program.hold(UP, 0.04, source=f"watch {number}")

    assert "watch 8 is not heard" in program.state("warning").description


@pytest.mark.parametrize("person", [103, 109])
def test_the_virtual_watch_raises_and_lowers_the_arm_when_asked(program, person):
    program.start()
    program.start_node("sensory/virtual_watch", "watch", person=person)
    program.state("ready", node="watch")
    requests = Publisher(GESTURE_REQUEST, network=program.network, wait_for_subscribers=1)

    for posture, words in (
        ("arm_raised", "holds the arm up"),
        ("arm_lowered", "lets the arm hang"),
    ):
        requests.send(GestureRequest(gesture=posture))
        program.state("running", words, node="watch")
        until(program.behaviors, lambda told, posture=posture: told.human_state == posture)
