"""An action node in this process: it notes what it is asked and answers at once."""

from __future__ import annotations

import threading

from nep_core.networks.network import Network
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    ActionRequest,
    ActionResult,
    ActionState,
)
from nep_core.wire.pubsub import Publisher, Subscriber


class PlayedRobot:
    """Plays a robot; ``end`` is how its actions end, None: they never do."""

    def __init__(
        self, network: Network, name: str = "NAO", end: ActionState | None = "done"
    ) -> None:
        self.name = name
        self.end = end
        self.asked: list[tuple[str, dict[str, object]]] = []
        self.times_asked: dict[str, int] = {}
        self.arrived = threading.Semaphore(0)
        self._results = Publisher(ACTION_RESULT, network=network)
        Subscriber(ACTION_REQUEST, ActionRequest, network=network, callback=self._on_request)

    def words(self) -> list[str]:
        """What it was asked to say."""
        return [str(args["text"]) for action, args in self.asked if action == "say"]

    def _on_request(self, request: ActionRequest) -> None:
        if self.name not in request.robots:
            return
        known = request.id in self.times_asked
        self.times_asked[request.id] = self.times_asked.get(request.id, 0) + 1
        if not known:
            self.asked.append((request.action, request.args))
        self._answer(request, "started")
        if self.end is not None and request.action != "stop":
            self._answer(request, self.end)
        self.arrived.release()

    def _answer(self, request: ActionRequest, state: ActionState) -> None:
        description = "its arm is stuck" if state == "failed" else ""
        self._results.send(
            ActionResult(id=request.id, robot=self.name, state=state, description=description)
        )
