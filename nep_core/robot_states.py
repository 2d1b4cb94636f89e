"""Where the robots of a program are, and what their sensors measure, as last heard."""

from __future__ import annotations

import threading
from typing import cast

from nep_core.default_network import default_network
from nep_core.messages import ROBOT_STATE, RobotState
from nep_core.network import Network
from nep_core.pubsub import Subscriber
from nep_core.tasks import POLL_S, current_task

FIRST_STATE_S = 5.0
"""A robot that says nothing about itself for so long does not answer."""
FRESH_STATE_S = 1.0


class RobotListener:
    """Hears ``/robot_state`` for a whole program."""

    def __init__(self, network: Network) -> None:
        self._states: dict[str, RobotState] = {}
        self._news = threading.Condition()
        self._subscriber = Subscriber(
            ROBOT_STATE, RobotState, network=network, callback=self._on_state
        )

    def newest(self, robot: str, since: float = 0.0) -> RobotState | None:
        """The newest state of a robot, None when it does not tell any for 5 s.

        Waits up to a second for one that was told after the time ``since``.
        """
        waited_s = 0.0
        with self._news:
            while not self._is_new(robot, since):
                if waited_s >= (FRESH_STATE_S if robot in self._states else FIRST_STATE_S):
                    break
                current_task().check()
                self._news.wait(POLL_S)
                waited_s += POLL_S
            return self._states.get(robot)

    def _is_new(self, robot: str, since: float) -> bool:
        return robot in self._states and self._states[robot].time >= since

    def _on_state(self, state: RobotState) -> None:
        with self._news:
            self._states[state.robot] = state
            self._news.notify_all()


def robot_listener(network: Network | None = None) -> RobotListener:
    """The listener of this program's network."""
    place = network or default_network()
    return cast(RobotListener, place.shared("robots", lambda: RobotListener(place)))
