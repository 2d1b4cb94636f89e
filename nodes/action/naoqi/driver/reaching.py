"""Reaches a robot and looks around: its services, its events. Runs in a thread of its own."""

from __future__ import annotations

import logging
import queue
from collections.abc import Callable
from typing import Any

from nodes.action.naoqi.client import (
    Login,
    LoginRefused,
    NaoqiError,
    RemoteObject,
    Session,
    StrangeCertificate,
)
from nodes.action.naoqi.driver.address import NAOQI_PORT, TLS_PORT, Address, plain_address
from nodes.action.naoqi.driver.link import Reached
from nodes.action.naoqi.driver.noticing import EVENTS, EXTRACTORS
from nodes.action.naoqi.logins import saved_login

log = logging.getLogger(__name__)

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
