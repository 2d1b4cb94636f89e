"""The link to a robot: made in a thread of its own, made anew when it breaks, told in sentences.

offline -> connecting -> ready -> lost -> connecting ...; a try that fails is followed by the next
one after a pause that grows.
"""

from __future__ import annotations

import itertools
import logging
import queue
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

from msgspec.structs import replace

from faults import Fault, fault_of, text_of
from robots.body.driver import Connection
from robots.naoqi.client.session import Session
from robots.naoqi.discovery import NAOQI_PORT, TLS_PORT, Address, plain_address, saved_login
from robots.naoqi.wire.errors import (
    LoginRefused,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NotNaoqi,
    Refused,
    StrangeCertificate,
    UnknownAddress,
)
from robots.naoqi.wire.line import Login
from robots.naoqi.wire.remote import RemoteObject

from .watching import EVENTS, EXTRACTORS

log = logging.getLogger(__name__)


# How the link to a NAOqi robot is, in sentences, with a checklist of what to try.

LOWEST_BATTERY = 0.15
HOTTEST_C = 75.0
"""Motors of NAO slow down from about here on, and stop not much later."""

no_answer = partial(
    fault_of,
    "{robot} does not answer: the program could not reach it at {place}.",
    code="no_answer",
    checklist=(
        "Is {robot} switched on? Its chest button should glow.",
        "Is this computer on the same network as {robot}?",
        "Press {robot}'s chest button once: it says its address. Is it {place}?",
        "Try the program on the robot on your screen first.",
    ),
)
"""Nobody answers at the address."""


def unknown_address(*, robot: str, place: str) -> Fault:
    """Nothing in this network has this name."""
    return fault_of(
        "Nobody in this network knows the address {host}.",
        code="unknown_address",
        checklist=(
            "Is the name written right? Press the robot's chest button once: it says its address.",
            text_of("Is this computer on the same network as {robot}?", robot=robot),
        ),
        host=place,
    )


not_naoqi = partial(
    fault_of,
    "What answers at {place} is not a NAOqi robot.",
    code="not_naoqi",
    checklist=(
        "Press {robot}'s chest button once: it says its address. Is it {place}?",
        "Leave the port out of the address: 9559 is the usual one.",
        "Has the robot just been switched on? It needs about two minutes to wake up.",
    ),
)
"""Something answers, but not as a NAO does."""

login_refused = partial(
    fault_of,
    "{robot} at {place} does not let this program in: user and password do not fit.",
    code="login_refused",
    checklist=(
        'Open "Connect a robot" on the Robots page and write user and password anew.',
        "The user is mostly nao. The password is the one of the robot's own web page.",
    ),
)
"""User or password are wrong, or there are none."""

needs_tls = partial(
    fault_of,
    "{robot} at {place} asks for a secure connection, with user and password.",
    code="needs_tls",
    checklist=(
        'Open "Connect a robot" on the Robots page and write user and password.',
        "Write the address without a port: the secure one, 9503, is tried by itself.",
    ),
)
"""The robot talks only over a secure connection."""

frozen = partial(
    fault_of,
    "{robot} does not answer any more: nothing has come from {place} for a while.",
    code="frozen",
    checklist=(
        "Is {robot} still switched on, and in reach of the network?",
        "The program looks for it again by itself.",
        "If that goes on, switch the robot off and on again.",
    ),
)
"""The link is there, but nothing comes over it."""

lost = partial(
    fault_of,
    "The connection to {robot} at {place} has ended.",
    code="lost",
    checklist=(
        "Is {robot} still switched on, and in reach of the network?",
        "The program looks for it again by itself.",
    ),
)
"""The link has ended."""

low_battery = partial(
    fault_of,
    "{robot}'s battery is nearly empty: {battery} %.",
    code="low_battery",
    checklist=("Plug {robot} in. It should sit or rest meanwhile.",),
)
"""The battery will soon be empty."""

too_hot = partial(
    fault_of,
    "{robot} is hot: the motor of {joint} has {celsius} °C.",
    code="too_hot",
    checklist=("Let {robot} rest for some minutes.", "Let it sit between what it does standing."),
)
"""A motor is hot; it will soon have no strength."""

asleep = partial(
    fault_of,
    "{robot} is asleep: its motors are off, it can speak but not move.",
    code="asleep",
    checklist=(
        'Put the block "{robot} wakes up" before what moves it.',
        "Or press its chest button twice.",
    ),
)
"""The motors are off."""

strange_answer = partial(
    fault_of,
    "{robot} gave an answer that this program does not understand. Try it again; if that goes "
    "on, switch the robot off and on.",
    code="strange_answer",
)
"""The robot has answered something that nobody understands."""


FAULTS: dict[type[NaoqiError], Callable[..., Fault]] = {
    NotNaoqi: not_naoqi,
    LoginRefused: login_refused,
    NeedsTls: needs_tls,
    NoAnswer: no_answer,
    UnknownAddress: unknown_address,
    Refused: no_answer,
}
"""What is told instead of these; all others have their own sentence."""

State = Literal["offline", "connecting", "ready", "lost"]
TRY_S = 2.6
"""Who has not answered by then is told as not answering; a late answer still counts."""
FIRST_PAUSE_S = 1.0
LONGEST_PAUSE_S = 15.0


@dataclass
class Reached:
    """What a try that has succeeded brings: the session, and what was asked in its thread."""

    session: Session
    services: dict[str, RemoteObject]
    found: dict[str, Any] = field(default_factory=dict)


Connect = Callable[[Callable[[str], None]], Reached]
"""Connects and looks around; may wait. Its argument is to be called when the link is lost."""


class Link:
    """Keeps the link to one robot; ``step`` never waits."""

    def __init__(self, robot: str, address: Address, connect: Connect) -> None:
        self.robot = robot
        self.place = plain_address(address)
        self.state: State = "offline"
        self.connection = Connection("disconnected")
        self.reached: Reached | None = None
        self._connect = connect
        self._news: queue.SimpleQueue[tuple[int, Reached | NaoqiError | str]] = queue.SimpleQueue()
        self._numbers = itertools.count(1)
        self._try = 0
        self._try_until_s = 0.0
        self._next_s = 0.0
        self._pause_s = FIRST_PAUSE_S

    def connect(self) -> None:
        """Begin to look for the robot."""
        looking = fault_of("Looking for {robot} at {place}.", robot=self.robot, place=self.place)
        self.connection = Connection("connecting", looking)
        self._begin()

    def disconnect(self) -> None:
        """Give the robot up; a try that is under way ends by itself."""
        self._drop()
        self.state = "offline"
        self.connection = Connection("disconnected")

    def step(self) -> Reached | None:
        """Take in what has happened; return the link when it has just been made."""
        while not self._news.empty():
            number, what = self._news.get()
            if number != self._try:  # an older try: what it brings is not wanted any more
                _close(what)
            elif isinstance(what, Reached):
                self.state, self.reached = "ready", what
                self._pause_s = FIRST_PAUSE_S
                return what
            elif isinstance(what, NaoqiError):
                self.connection = Connection("connection_failed", self._told(what))
                self._wait()
            else:
                self._lose(lost)
        now_s = time.monotonic()
        if self.state == "connecting" and now_s > self._try_until_s:
            self._try_until_s = float("inf")
            self.connection = Connection("connection_failed", self._fault(no_answer))
        elif self.state == "lost" and now_s >= self._next_s:
            self._begin()
        return None

    def freeze(self) -> None:
        """Nothing comes over the link any more."""
        self._lose(frozen)

    def _lose(self, why: Callable[..., Fault]) -> None:
        """The link is gone, or no use any more; look for the robot again soon."""
        self._drop()
        self.connection = Connection("disconnected", self._fault(why))
        self._pause_s = FIRST_PAUSE_S
        self._wait()

    def _begin(self) -> None:
        self.state = "connecting"
        self._try = next(self._numbers)
        self._try_until_s = time.monotonic() + TRY_S
        threading.Thread(target=self._run, args=(self._try,), daemon=True).start()

    def _run(self, number: int) -> None:
        """One try, in a thread of its own."""
        try:
            self._news.put((number, self._connect(lambda why: self._news.put((number, why)))))
        except NaoqiError as problem:
            self._news.put((number, problem))
        except Exception as error:  # a fault of this program must not end the tries
            log.exception("connecting to %s", self.robot)
            self._news.put((number, NaoqiError(str(error))))

    def _wait(self) -> None:
        self.state = "lost"
        self._next_s = time.monotonic() + self._pause_s
        self._pause_s = min(2.0 * self._pause_s, LONGEST_PAUSE_S)

    def _drop(self) -> None:
        self._try = next(self._numbers)
        if self.reached is not None:
            _close(self.reached)
        self.reached = None

    def _told(self, problem: NaoqiError) -> Fault:
        if known := FAULTS.get(type(problem)):
            return self._fault(known)
        usual = self._fault(no_answer)
        steps = problem.checklist or usual.checklist
        return replace(problem.fault, sentence=problem.sentence or usual.sentence, checklist=steps)

    def _fault(self, kind: Callable[..., Fault]) -> Fault:
        return kind(robot=self.robot, place=self.place)


def _close(what: object) -> None:
    """Close a session without waiting for it."""
    if isinstance(what, Reached):
        threading.Thread(target=what.session.close, daemon=True).start()


# Reaches a robot and looks around: its services, its events. Runs in a thread of its own.

NAME = "NEP_Studio"
CONNECT_S = 2.5
NEEDED = ("ALMotion", "ALMemory", "ALRobotPosture", "ALTextToSpeech", "ALLeds")
OTHERS = (
    "ALAnimatedSpeech",
    "ALAudioDevice",
    "ALAudioPlayer",
    "ALAutonomousLife",
    "ALBasicAwareness",
    "ALPhotoCapture",
    "ALSpeechRecognition",
    "ALSystem",
    "ALTracker",
    "ALVideoRecorder",
)
TELLING = (LoginRefused, StrangeCertificate)
Heard = queue.SimpleQueue[tuple[str, Any]]


def reach(address: Address, heard: Heard, on_lost: Callable[[str], None]) -> Reached:
    """Connect, get the services, subscribe to the events. Raises NaoqiError."""
    session = open_session(address, *saved(address))
    session.on_lost = on_lost
    try:
        services = {name: session.service(name) for name in NEEDED}
        for name in (*OTHERS, *EXTRACTORS):
            remote = _service(session, name)
            if remote is not None:
                services[name] = remote
        memory = services["ALMemory"]
        subscribers = [_subscribe(memory, event, heard) for event in EVENTS]
        for name in EXTRACTORS:
            _wake(services.get(name))
    except NaoqiError:
        session.close()
        raise
    return Reached(session, services, {"subscribers": subscribers})


def saved(address: Address) -> tuple[Login | None, str]:
    """Return the login that a person has given for an address, and who was trusted there."""
    known = saved_login(plain_address(address))
    return (None, "") if known is None else (Login(known.user, known.password), known.fingerprint)


def open_session(address: Address, login: Login | None, trusted: str = "") -> Session:
    """Connect: openly, or with a login at the secure port first. Raises NaoqiError.

    ``trusted``: the fingerprint of the certificate that the robot must have, "" for any.
    """
    places = [address]
    if login is not None and address[1] == NAOQI_PORT:
        places = [(address[0], TLS_PORT), address]
    problem: NaoqiError | None = None
    for place in places:
        session = Session(place, login=login, timeout_s=CONNECT_S, trusted=trusted or None)
        try:
            session.connect()
        except NaoqiError as error:
            # who answers has more to say than who is not there
            problem = problem if isinstance(problem, TELLING) else error
            session.close()
            continue
        return session
    assert problem is not None
    raise problem


def _service(session: Session, name: str) -> RemoteObject | None:
    try:
        return session.service(name)
    except NaoqiError:
        log.info("the robot has no %s", name)
        return None


def _subscribe(memory: RemoteObject, event: str, heard: Heard) -> RemoteObject | None:
    """Let an event of NAOqi's memory come into a queue; the object must be kept meanwhile."""
    try:
        subscriber: RemoteObject = memory.call("subscriber", event)
        subscriber.connect("signal", lambda value=None: heard.put((event, value)))
    except NaoqiError:
        log.info("the robot does not tell %s", event)
        return None
    return subscriber


def _wake(extractor: RemoteObject | None) -> None:
    """Let a service look or listen; it does so only for those who have subscribed."""
    if extractor is None:
        return
    try:
        extractor.call("subscribe", NAME)
    except NaoqiError as problem:
        log.info("a service does not look or listen: %s", problem)
