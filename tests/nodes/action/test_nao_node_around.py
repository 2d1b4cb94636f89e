"""The action node in a process of its own notices what is around its robot, and how it stands."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from nep_core.errors import ActionFailed
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.robot import Robot
from nep_core.wire.messages import (
    HUMAN_BEHAVIOR,
    ROBOT_STATE,
    SURROUNDINGS,
    HumanBehavior,
    RobotState,
    Surroundings,
    Thing,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import NodeRunner, until

pytestmark = pytest.mark.long

ANNA = Thing(
    id="a",
    kind="person",
    place=(1.0, 0.0, 0.0),
    heading=math.pi,
    size=(0.3, 0.2, 0.6),
    name="Anna",
)
WALL = Thing(id="w", kind="wall", place=(0.6, 0.0, 0.0), heading=math.pi, size=(2.0, 0.1, 0.3))


class Floor(NodeRunner):
    """A robot on a floor with things, and what is heard of it."""

    def __init__(self, network: PeerNetwork) -> None:
        super().__init__(network)
        self.robot_states = Subscriber(ROBOT_STATE, RobotState, network=network)
        self.heard = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
        self.around = Publisher(SURROUNDINGS, network=network)
        self.start_node("action/nao", "nao_0", speed=20)
        self.state("ready")
        assert self.around.wait_for_subscribers(1, 10)


@pytest.fixture
def floor(network: PeerNetwork) -> Iterator[Floor]:
    floor = Floor(network)
    yield floor
    floor.close()


def test_a_face_that_is_put_before_it_is_seen_and_told(floor: Floor) -> None:
    floor.around.send(Surroundings(things=[ANNA]))

    heard = until(floor.heard, lambda state: state.human_state == "person_middle")
    seen = until(floor.robot_states, lambda state: "face_anna" in state.sees)[-1]

    assert [state.human_state for state in heard][:2] == ["seen_face_anna", "seen_face"]
    assert {state.source for state in heard} == {"NAO"}
    assert seen.sees["face_anna"][0] == pytest.approx(1.0, abs=0.05)


def test_it_says_how_its_torso_is_over_the_floor(floor: Floor) -> None:
    Robot("NAO").do("posture_lying_back")

    lying = until(floor.robot_states, lambda state: state.posture == "LyingBack")[-1]

    assert lying.torso is not None
    assert lying.torso[2] < 0.1 and lying.torso[4] == pytest.approx(-math.pi / 2, abs=0.1)
    assert not lying.fallen


def test_a_program_is_told_that_its_robot_walked_into_a_wall(floor: Floor) -> None:
    floor.around.send(Surroundings(things=[WALL]))

    with pytest.raises(ActionFailed, match="NAO walked into a wall"):
        Robot("NAO").walk(2.0)


def test_a_program_is_told_that_its_robot_fell_and_can_let_it_get_up(floor: Floor) -> None:
    robot = Robot("NAO")

    with pytest.raises(ActionFailed, match="lost its balance and fell"):
        robot.move_joint("LKneePitch", 100)
    fallen = robot.is_doing("fallen"), robot.sensor("fallen")
    robot.wake_up()

    assert fallen == (True, 1.0)
    assert until(floor.robot_states, lambda state: state.posture == "Stand")[-1].fallen is False
