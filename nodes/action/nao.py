"""A NAO that acts on requests: the one on the screen, or one in the room."""

from __future__ import annotations

import time
from collections.abc import Sequence

from nep_core.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    HUMAN_BEHAVIOR,
    ROBOT_STATE,
    SENSE_REQUEST,
    ActionRequest,
    ActionResult,
    HumanBehavior,
    SenseRequest,
)
from nep_core.node import Node
from nep_core.pubsub import Publisher, Subscriber
from nodes.action.naobody.actor import FINAL, Actor
from nodes.action.naobody.animations import load_animations
from nodes.action.naobody.body import load_body
from nodes.action.naobody.driver import Driver
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.unreached import UnreachedNao
from nodes.action.naobody.virtual import VirtualDriver
from nodes.resources import resource_folder

MOVING_LOOP_S = 0.01
RESTING_LOOP_S = 0.1
MOVING_STATE_S = 1.0 / 30.0
RESTING_STATE_S = 1.0


def run(node: Node, *, robot: str, driver: str, address: str, speed: float) -> None:
    """Play ``/action_request`` on one robot until the node stops.

    ``speed``: how many times faster than real time the virtual robot lives.
    """
    link = _driver(robot, driver, address)
    actor = Actor(robot, link)
    results = node.publisher(ACTION_RESULT)
    requests = node.subscriber(ACTION_REQUEST, ActionRequest)
    senses = node.subscriber(SENSE_REQUEST, SenseRequest)
    states = node.publisher(HUMAN_BEHAVIOR)
    report = _StateReport(node, link)
    link.connect()
    report.send_news()
    node.ready(link.connection.description)
    start_s = time.monotonic()
    while not node.stopping:
        heard = _heard(requests, MOVING_LOOP_S if link.moving else RESTING_LOOP_S)
        now_s = (time.monotonic() - start_s) * speed
        told = actor.step(now_s)  # up to now, so that what is asked now begins now
        for request in filter(actor.is_asked, heard):
            told += actor.request(request)
        told += actor.step(now_s)
        felt = [sense for sense in senses.pending() if actor.is_meant(sense)]
        human = [state for sense in felt for state in actor.sense(sense)]
        # how the robot is goes first: what a message sets off may ask about it at once
        report.send_news(at_once=bool(felt) or any(result.state in FINAL for result in told))
        _send(states, human)
        _send(results, told)
    _send(results, actor.stop())


def _driver(robot: str, driver: str, address: str) -> Driver:
    if driver == "naoqi":
        return UnreachedNao(robot, address)
    folder = resource_folder() / "robots" / "nao"
    body = load_body(folder)
    animations = load_animations(folder / "animations", body)
    return VirtualDriver(VirtualRobot(robot, body, animations))


def _heard(requests: Subscriber[ActionRequest], timeout_s: float) -> list[ActionRequest]:
    first = requests.receive(timeout_s=timeout_s)
    return [first, *requests.pending()] if first else []


def _send(publisher: Publisher, what: Sequence[ActionResult | HumanBehavior]) -> None:
    for message in what:
        publisher.send(message)


class _StateReport:
    """Tells how the link to the robot is, and where its body is: often while it moves."""

    def __init__(self, node: Node, link: Driver) -> None:
        self._node = node
        self._link = link
        self._states = node.publisher(ROBOT_STATE)
        self._told = link.connection
        self._next_s = time.monotonic()
        self._was_moving = False

    def send_news(self, *, at_once: bool = False) -> None:
        """Send what has changed, or what is due; ``at_once``: where the body is, in any case."""
        if self._link.connection != self._told:
            self._told = self._link.connection
            self._node.state(*self._told)
        now_s = time.monotonic()
        moving = self._link.moving
        if at_once or moving != self._was_moving:
            self._was_moving = moving
            self._next_s = now_s
        if now_s >= self._next_s:
            period_s = MOVING_STATE_S if moving else RESTING_STATE_S
            # From when it was due, not from now: else the loop's own time would lower the rate.
            self._next_s = max(self._next_s + period_s, now_s)
            if state := self._link.state():
                self._states.send(state)
