"""A virtual NAO in a process of its own, and programs of blocks that run in this one."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.human import human_listener
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    HUMAN_BEHAVIOR,
    ROBOT_STATE,
    SENSE_REQUEST,
    ActionRequest,
    ActionResult,
    HumanBehavior,
    RobotState,
    SenseRequest,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.run.installation import studio_language
from tests.node_running import NodeRunner

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blocks"))
from block_building import B, build

__all__ = ["B", "RobotTheatre"]

SPEED = 50


class RobotTheatre(NodeRunner):
    """Runs programs, answers questions of the robot, and notes what it did."""

    def __init__(self, network: PeerNetwork, outside: PeerNetwork) -> None:
        super().__init__(network)
        tasks.PROGRAM.cancelled.clear()
        tasks.PROGRAM._children.clear()
        human_listener(network)
        self.language: Language = studio_language()
        self.answers = ["yes"]
        self.requests: dict[str, ActionRequest] = {}
        self.results: list[ActionResult] = []
        self.told: list[RobotState] = []
        self._senses = Publisher(SENSE_REQUEST, network=outside)
        self._person = Publisher(HUMAN_BEHAVIOR, network=outside)
        Subscriber(ACTION_RESULT, ActionResult, network=outside, callback=self.results.append)
        Subscriber(ACTION_REQUEST, ActionRequest, network=outside, callback=self._on_request)
        Subscriber(ROBOT_STATE, RobotState, network=outside, callback=self._on_state)
        self.start_node("action/nao", "NAO", robot="NAO", speed=SPEED)
        self.state("ready")
        assert self._senses.wait_for_subscribers(1, 10)

    def play(self, *stacks: list[B], variables: tuple[str, ...] = ("x",)) -> None:
        """Run a program until it ends; raises what it raises."""
        editor = build(self.language, *stacks, variables=variables)
        code = generate_program(editor.project, self.language).text
        exec(compile(code, "program.py", "exec"), {"__name__": "__main__"})

    def play_along(self, *stacks: list[B]) -> threading.Thread:
        """Run a program beside the test, until ``end_program``."""
        playing = threading.Thread(target=self.play, args=stacks)
        playing.start()
        return playing

    def end_program(self, playing: threading.Thread) -> None:
        tasks.PROGRAM.cancel()
        playing.join(10)
        assert not playing.is_alive()
        tasks.PROGRAM.cancelled.clear()

    def sense(self, what: str, value: float = 1.0, **more: object) -> None:
        self._senses.send(SenseRequest(robot="NAO", sense=what, value=value, **more))

    def person_is(self, state: str) -> None:
        self._person.send(HumanBehavior(human_state=state))

    def ended(self, action: str) -> list[str]:
        """How the requests of an action ended."""
        return [state for request, state in self._ends() if request.action == action]

    def said(self) -> set[str]:
        """What the robot has said to the end."""
        return {
            str(request.args["text"])
            for request, state in self._ends()
            if request.action == "say" and state == "done"
        }

    def _ends(self) -> list[tuple[ActionRequest, str]]:
        return [
            (self.requests[result.id], result.state)
            for result in list(self.results)
            if result.state in ("done", "failed") and result.id in self.requests
        ]

    def _on_request(self, request: ActionRequest) -> None:
        self.requests[request.id] = request

    def _on_state(self, state: RobotState) -> None:
        self.told.append(state)
        if state.listening and self.answers:
            self.sense("word", name=self.answers[0])
