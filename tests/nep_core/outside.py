"""The world outside a program: a person who does things, and a robot that tells about itself."""

from __future__ import annotations

from collections.abc import Callable

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.human import human_listener, times_seen
from nep_core.program.robot import Robot
from nep_core.program.tasks import wait_until
from nep_core.wire.messages import HUMAN_BEHAVIOR, ROBOT_STATE, HumanBehavior, RobotState
from nep_core.wire.pubsub import Publisher
from tests.nep_core.robot_playing import PlayedRobot

Join = Callable[[str], PeerNetwork]


class Outside:
    """A person and a robot as the program meets them."""

    def __init__(self, network: PeerNetwork, own: PeerNetwork) -> None:
        self.network = network
        human_listener(network)
        self._states = Publisher(HUMAN_BEHAVIOR, network=own)
        self._bodies = Publisher(ROBOT_STATE, network=own)
        self.nao = PlayedRobot(own)
        self.robot = Robot("NAO", network=network)

    def does(self, *states: str, source: str = "") -> None:
        for state in states:
            self._states.send(HumanBehavior(human_state=state, source=source))

    def robot_is(self, name: str = "NAO", **state: object) -> None:
        self._bodies.send(RobotState(robot=name, joints={}, **state))


def seen(state: str, times: int = 1) -> None:
    """Wait until the program has heard a state so often."""
    wait_until(lambda: times_seen(state) >= times)
