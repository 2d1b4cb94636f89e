"""How a Robot asks and looks: requests to all its robots, and the newest state of the first."""

from __future__ import annotations

from typing import Any

from nep_core.actions import action_client, not_answering
from nep_core.errors import RobotError
from nep_core.human import human_listener
from nep_core.messages import RobotState
from nep_core.network import Network
from nep_core.robot_states import robot_listener


class RobotRequests:
    """One robot by name, or several that act at once; what it measures is of the first."""

    def __init__(self, robots: str | list[str], *, network: Network | None = None) -> None:
        self.robots = [robots] if isinstance(robots, str) else list(robots)
        if not self.robots or not all(isinstance(name, str) and name for name in self.robots):
            raise RobotError(
                "A robot needs a name.",
                checklist=('Write Robot("NAO") or Robot(["NAO", "NAO2"]).',),
            )
        self._network = network
        robot_listener(network)  # what robots tell from now on is known when it is asked for

    def _perform(self, action: str, **args: Any) -> None:
        action_client(self._network).perform(self.robots, action, args)

    def _begin(self, action: str, **args: Any) -> str:
        """Ask without waiting; the id of the request, which ends when this part is cancelled."""
        return action_client(self._network).begin(self.robots, action, args)

    def _end(self, action: str, request_id: str) -> None:
        """End an action that was begun."""
        action_client(self._network).end(self.robots, action, request_id)

    def _send(self, action: str, **args: Any) -> None:
        """Ask without waiting, whatever comes."""
        action_client(self._network).send(self.robots, action, args)

    def _state(self) -> RobotState:
        """The newest state, told after all that the robot was seen to do, or told of the person."""
        robot = self.robots[0]
        done = action_client(self._network).last_done.get(robot, 0.0)
        told = human_listener(self._network).told_s(robot)  # a rule may have fired just now
        state = robot_listener(self._network).newest(robot, max(done, told))
        if state is None:
            raise not_answering(robot)
        return state
