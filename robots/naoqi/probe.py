"""Tests the way to a robot step by step: each step says in words what is there, or what failed."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

from faults import Fault, Text, Words, text_of
from robots.errors import WrongAddress

from .client.session import Session, numeric_hosts
from .discovery import Address, plain_address, read_address
from .driver import link
from .driver.link import NEEDED, open_session
from .wire.errors import LoginRefused, NaoqiError, NeedsTls, UnknownAddress
from .wire.line import Login

StepName = Literal["name", "port", "naoqi", "login", "services", "robot"]
STEPS: tuple[StepName, ...] = ("name", "port", "naoqi", "login", "services", "robot")

LIMIT_S = 2.5
ASK_S = 2.0
ROBOT = "NAO"


@dataclass(frozen=True)
class AboutRobot:
    """What a robot says of itself; what it does not tell is empty, a battery of -1 unknown."""

    name: str = ""
    version: str = ""
    battery: float = -1.0
    body: str = ""
    fingerprint: str = ""


@dataclass(frozen=True)
class Check:
    """How one step went; ``about`` comes with the last one."""

    step: StepName
    is_ok: bool
    sentence: Words
    checklist: tuple[Words, ...] = ()
    about: AboutRobot | None = None


IS_NAOQI = Check("naoqi", True, "It is a NAOqi robot.")


class _Failed(Exception):
    """A step has failed; the later ones are not tried."""

    def __init__(self, check: Check) -> None:
        super().__init__(str(check.sentence))
        self.check = check


def probe(address: str, login: Login | None, robot: str = ROBOT) -> Iterator[Check]:
    """Try each step on the way to a robot, and give how it went; ends at the first that fails.

    Each step takes at most about 3 s. Call it in a thread of its own.
    """
    try:
        yield from _steps(address, login, robot)
    except _Failed as failed:
        if failed.check.step == "login":  # who asks for a password has said what it is
            yield IS_NAOQI
        yield failed.check


def _steps(text: str, login: Login | None, robot: str) -> Iterator[Check]:
    address = _read(text)
    place = plain_address(address)
    host = _resolve(address, robot)
    yield Check("name", True, text_of("The address {place} is known in this network.", place=place))
    try:
        socket.create_connection((host, address[1]), timeout=LIMIT_S).close()
    except OSError as error:
        raise _failed("port", link.no_answer(robot=robot, place=place)) from error
    yield Check("port", True, text_of("A program answers at {place}.", place=place))
    session = _connect(address, login, robot)
    try:
        yield IS_NAOQI
        words = "It let us in." if login else "It asks for no password."
        yield Check("login", True, words)
        missing = [name for name in NEEDED if not _has(session, name)]
        if missing:
            raise _Failed(_missing(missing, robot))
        yield Check("services", True, "All that moves it and lets it speak is there.")
        battery = _asked(session, "ALBattery", "getBatteryCharge")
        about = AboutRobot(
            name=str(_asked(session, "ALSystem", "robotName") or ""),
            version=str(_asked(session, "ALSystem", "systemVersion") or ""),
            battery=float(battery) / 100.0 if isinstance(battery, int | float) else -1.0,
            body=str(_asked(session, "ALMemory", "getData", "RobotConfig/Body/BaseVersion") or ""),
            fingerprint=session.fingerprint,
        )
        yield Check("robot", True, _introduction(about), about=about)
    finally:
        session.close()


def _read(text: str) -> Address:
    try:
        return read_address(text)
    except WrongAddress as problem:
        raise _failed("name", problem.fault) from problem


def _resolve(address: Address, robot: str) -> str:
    """Look the name up, and return the first address that it stands for."""
    host, _ = address
    try:
        return numeric_hosts(host, time.monotonic() + LIMIT_S)[0]
    except UnknownAddress as error:
        raise _failed("name", link.unknown_address(robot=robot, place=host)) from error


def _connect(address: Address, login: Login | None, robot: str) -> Session:
    place = plain_address(address)
    try:
        return open_session(address, login)
    except LoginRefused as error:
        raise _failed("login", link.login_refused(robot=robot, place=place)) from error
    except NeedsTls as error:
        raise _failed("login", link.needs_tls(robot=robot, place=place)) from error
    except NaoqiError as error:
        raise _failed("naoqi", link.not_naoqi(robot=robot, place=place)) from error


def _failed(step: StepName, fault: Fault) -> _Failed:
    return _Failed(Check(step, False, fault.sentence, fault.checklist))


def _has(session: Session, service: str) -> bool:
    try:
        session.service(service)
    except NaoqiError:
        return False
    return True


def _missing(services: list[str], robot: str) -> Check:
    sentence = text_of(
        "The robot has no {services}: it cannot do what the blocks ask for.",
        services=", ".join(services),
    )
    steps = (
        "Has the robot just been switched on? It needs about two minutes to wake up.",
        text_of("Switch {robot} off and on again.", robot=robot),
    )
    return Check("services", False, sentence, steps)


def _asked(session: Session, service: str, method: str, *args: Any) -> Any:
    """What the robot says, None when it does not know."""
    try:
        return session.service(service).call(method, *args, timeout_s=ASK_S)
    except NaoqiError:
        return None


def _introduction(about: AboutRobot) -> Text:
    name = about.name or Text("The robot")
    if about.battery < 0:
        return text_of("{name} is ready.", name=name)
    return text_of(
        "{name} is ready. Its battery is {battery} % full.",
        name=name,
        battery=f"{about.battery * 100:.0f}",
    )
