"""A NAO that acts on requests: the one on the screen, or one in the room."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Protocol

from nep_core.places import robot_folder
from nep_core.processes.node import Node
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    EXPECTED_WORDS,
    HUMAN_BEHAVIOR,
    ROBOT_STATE,
    SENSE_REQUEST,
    SURROUNDINGS,
    ActionResult,
    ExpectedWords,
    HumanBehavior,
    described,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from nodes.resources import model_folder, model_of
from robots.body.actor import FINAL, Actor
from robots.body.animations import load_animations, with_own
from robots.body.body import load_body
from robots.body.camera import safe_name
from robots.body.driver import ActionRequest, Driver, SenseRequest, Surroundings
from robots.body.driver import ActionResult as Result
from robots.body.pose import VirtualRobot
from robots.body.speech import load_gesture_words
from robots.body.virtual import VirtualDriver

# What a node tells its robot's offering, where NAOqi programs may ask it too.


class Offering(Protocol):
    """What the node's loop tells an offered robot, and one that is not offered."""

    is_on: bool
    """Whether programs may ask the robot at any time."""
    lock: contextlib.AbstractContextManager[object]
    """To be held while the robot is touched."""
    description: str
    """Where programs reach it, in words."""

    def hear(self, told: Iterable[Result], felt: Sequence[SenseRequest]) -> list[Result]:
        """Take in what happened; return the results that are to be sent on."""

    def close(self) -> None:
        """Offer it no more."""


class NotOffered:
    """A robot that only its node asks."""

    is_on = False
    description = ""

    def __init__(self) -> None:
        self.lock: contextlib.AbstractContextManager[object] = contextlib.nullcontext()

    def hear(self, told: Iterable[Result], felt: Sequence[SenseRequest]) -> list[Result]:
        """Return all results."""
        return list(told)

    def close(self) -> None:
        """There is nothing to end."""


MOVING_LOOP_S = 0.01
RESTING_LOOP_S = 0.1
QUICK_LOOP_S = 0.02
"""NAOqi programs that ask, and what a real robot notices, are heard within this time."""
REAL_STATE_S = 0.2
"""A real robot's sensors change while it rests."""
MOVING_STATE_S = 1.0 / 30.0
RESTING_STATE_S = 1.0
FIRST_TRY_S = 6.0
"""A real robot may take so long to answer before programs begin to ask it."""


def run(
    node: Node,
    *,
    robot: str,
    driver: str,
    address: str,
    speed: float,
    animations: str,
    naoqi_port: int,
    model: str,
    take_over: bool,
) -> None:
    """Play ``/action_request`` on one robot until the node stops.

    ``node`` is this node, ``robot`` the robot's name in requests, ``driver`` who plays it
    ("virtual": the one on the screen, "naoqi": a real one), ``address`` a real one's, as a host or
    host:port; ``speed`` how many times faster than real time a virtual one lives (1: as in the
    room); ``animations`` a folder with more of them than every robot knows ("": none);
    ``naoqi_port`` the TCP port at which NAOqi programs reach a virtual one as if it were real (0:
    none); ``model`` the robot's folder, nao or another one; ``take_over``: a real robot that
    another program drives is taken from it. Raises PortTaken.
    """
    folder = model_folder(model)
    known = _known(node, robot, animations, folder)
    link: Driver = VirtualDriver(known)
    if driver == "naoqi":
        from robots.naoqi.driver.driver import NaoqiDriver  # the virtual one needs none of it

        link = NaoqiDriver(known, address, takes_over=take_over)
    is_real = driver == "naoqi"
    pace = 1.0 if is_real else speed
    actor = Actor(robot, link, pace=pace)
    results = node.publisher(ACTION_RESULT)
    requests = node.subscriber(ACTION_REQUEST, ActionRequest)
    senses = node.subscriber(SENSE_REQUEST, SenseRequest)
    expected = node.subscriber(EXPECTED_WORDS, ExpectedWords)
    around = node.subscriber(SURROUNDINGS, Surroundings)
    states = node.publisher(HUMAN_BEHAVIOR)
    report = _StateReport(node, link, REAL_STATE_S if is_real else RESTING_STATE_S)
    offering = _offering(actor, link, naoqi_port, folder)
    link.connect()
    _await_first_answer(node, link)
    links = [one for one in (link.connection.fault.sentence, offering.description) if one]
    node.ready("{links}", links=links)
    report.send_news()
    start_s = time.monotonic()
    while not node.stopping:
        resting_s = QUICK_LOOP_S if offering.is_on or is_real else RESTING_LOOP_S
        heard = _heard(requests, MOVING_LOOP_S if link.moving else resting_s)
        with offering.lock:
            now_s = (time.monotonic() - start_s) * pace
            for news in list(around.pending())[-1:]:
                link.surroundings(news.things)
            for wanted in list(expected.pending())[-1:]:
                link.expect(wanted.words)
            told = actor.step(now_s)  # up to now, so that what is asked now begins now
            for request in filter(actor.is_asked, heard):
                told += actor.request(request)
            told += actor.step(now_s)
            felt = [sense for sense in senses.pending() if actor.is_meant(sense)]
            human = [state for sense in felt for state in actor.sense(sense)] + actor.noticed()
            # how the robot is goes first: what a message sets off may ask about it at once
            is_news = bool(felt or human) or any(result.state in FINAL for result in told)
            report.send_news(at_once=is_news)
        for state in human:
            states.send(HumanBehavior(human_state=state, source=robot))
        _send(results, offering.hear(told, felt))
    offering.close()
    _send(results, actor.stop())
    link.disconnect()
    if link.connection.fault.sentence:  # how the robot is left
        node.close("stopped", link.connection.fault)


def _await_first_answer(node: Node, link: Driver) -> None:
    """Wait until a robot answers or is known not to: what is asked before that would fail."""
    end_s = time.monotonic() + FIRST_TRY_S
    while link.connection.event == "connecting" and time.monotonic() < end_s:
        if node.wait(MOVING_LOOP_S):
            return
        link.step(0.0)


def _offering(actor: Actor, link: Driver, port: int, folder: Path) -> Offering:
    """Offer the robot to NAOqi programs, if it is a virtual one. Raises PortTaken."""
    if port and isinstance(link, VirtualDriver):
        from robots.naoqi.services.all import Offered  # most robots need none of it

        return Offered(actor, link.robot, folder, port)
    return NotOffered()


def _known(node: Node, robot: str, own_animations: str, folder: Path) -> VirtualRobot:
    """Return the robot that is played, or that becomes a picture of a real one."""
    body = load_body(folder)
    shipped = load_animations(folder / "animations", body)
    animations, left_out = with_own(shipped, own_animations, body)
    for problem in left_out:
        node.warn(problem)
    return VirtualRobot(
        robot,
        body,
        animations,
        gesture_words=load_gesture_words(folder),
        model=model_of(folder),
        files=robot_folder(safe_name(robot, "robot")),
    )


def _heard(requests: Subscriber[ActionRequest], timeout_s: float) -> list[ActionRequest]:
    first = requests.receive(timeout_s=timeout_s)
    return [first, *requests.pending()] if first else []


def _send(publisher: Publisher, results: Iterable[Result]) -> None:
    for one in results:
        told = described(one.fault)
        publisher.send(ActionResult(id=one.id, robot=one.robot, state=one.state, **told))


class _StateReport:
    """Tells how the link to the robot is, and where its body is: often while it moves."""

    def __init__(self, node: Node, link: Driver, resting_s: float) -> None:
        self._node = node
        self._link = link
        self._resting_s = resting_s
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
            period_s = MOVING_STATE_S if moving else self._resting_s
            # From when it was due, not from now: else the loop's own time would lower the rate.
            self._next_s = max(self._next_s + period_s, now_s)
            if state := self._link.state():
                self._states.send(state)
