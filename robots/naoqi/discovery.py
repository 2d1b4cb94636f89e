"""Finds NAOqi robots on the network: they announce themselves by zeroconf as ``_naoqi._tcp``."""

from __future__ import annotations

import ipaddress
import logging
import os
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import platformdirs

from faults.files import content, make_privately, whole_file
from robots.errors import WrongAddress

log = logging.getLogger(__name__)

# Where a NAOqi robot is found: the host and port that a person wrote.

NAOQI_PORT = 9559
TLS_PORT = 9503

Address = tuple[str, int]


def read_address(text: str) -> Address:
    """Return host and port of text such as ``192.168.1.10``, ``nao.local`` or ``host:9559``.

    Raises WrongAddress.
    """
    host, colon, port = text.strip().rpartition(":")
    if not colon:
        host, port = text.strip(), str(NAOQI_PORT)
    # int() would also take "1_0" and signs; str.isdigit() alone would take "²".
    is_number = port.isascii() and port.isdigit()
    is_host = host and not any(c.isspace() or c in ":/" for c in host)
    if is_host and is_number and 0 < int(port) < 65536:
        return host, int(port)
    raise WrongAddress(
        '"{text}" is not the address of a robot.',
        checklist=(
            "Press NAO's chest button once: it says its address, such as 192.168.1.10.",
            "Write it in the robot's address.",
            "Or set the robot's driver to virtual: then it needs no address.",
        ),
        text=text,
    )


def plain_address(address: Address) -> str:
    """Return an address as a person writes it: the usual port is left out."""
    host, port = address
    return host if port == NAOQI_PORT else f"{host}:{port}"


SERVICE = "_naoqi._tcp.local."
SEARCH_S = 4.0
ASK_S = 1.5
LOOK_EVERY_S = 0.05
MOST_FOUND = 50


@dataclass(frozen=True)
class FoundRobot:
    """A robot that has announced itself: its name, and where it is."""

    name: str
    host: str
    port: int = NAOQI_PORT

    @property
    def address(self) -> str:
        """The address as a person writes it."""
        return plain_address((self.host, self.port))


def find_robots(
    found: Callable[[FoundRobot], None],
    cancelled: threading.Event,
    *,
    seconds: float = SEARCH_S,
    interfaces: Sequence[str] = (),
) -> list[FoundRobot]:
    """Listen for robots for some seconds; ``found`` is called at once with each, from here.

    Waits: call it in a thread of its own. ``interfaces`` are addresses of this computer; none are
    all of them. Raises OSError where the computer has no network.

    ``cancelled`` ends it early; ``seconds`` is how long it listens.
    """
    from zeroconf import InterfaceChoice, ServiceBrowser, Zeroconf

    robots: dict[str, FoundRobot] = {}
    names: list[str] = []

    def on_change(name: str, **_news: object) -> None:
        # called by a thread of zeroconf, which must not wait
        if name not in names and len(names) < MOST_FOUND:
            names.append(name)

    network = Zeroconf(interfaces=list(interfaces) or InterfaceChoice.All)
    try:
        browser = ServiceBrowser(network, SERVICE, handlers=[on_change])
        end_s, looked_at = time.monotonic() + seconds, 0
        while time.monotonic() < end_s and not cancelled.wait(LOOK_EVERY_S):
            while looked_at < len(names) and not cancelled.is_set():
                robot = _ask(network, names[looked_at])
                looked_at += 1
                if robot is not None and robot.address not in robots:
                    robots[robot.address] = robot
                    found(robot)
        browser.cancel()
    finally:
        network.close()
    return list(robots.values())


def _ask(network: Any, name: str) -> FoundRobot | None:
    """Where a robot is, None when it does not tell it; ``network`` is a Zeroconf."""
    try:
        info = network.get_service_info(SERVICE, name, timeout=round(ASK_S * 1000))
        host = _host(info) if info is not None else ""
    except Exception as error:  # one odd announcement must not hide the others
        log.info("an announcement cannot be asked for: %s", error)
        return None
    if info is None or not host:
        return None
    return FoundRobot(name.removesuffix(f".{SERVICE}"), host, info.port or NAOQI_PORT)


def _host(info: Any) -> str:
    """The address to reach a robot at, out of its ServiceInfo: a short, usual one if it can."""
    without_zones = (text.partition("%")[0] for text in info.parsed_addresses())
    usual = [text for text in without_zones if ipaddress.ip_address(text).version == 4]
    return usual[0] if usual else (info.server or "").rstrip(".")


# User and password of robots that ask for them: in a file of this person's, never in a project.
#
# The file is beside the settings of the studio, and only its owner may read it. Two environment
# variables go before it, for programs that start nodes by themselves.

FOLDER_VARIABLE = "NEP_STUDIO_FOLDER"
USER_VARIABLE, PASSWORD_VARIABLE = "NEP_ROBOT_USER", "NEP_ROBOT_PASSWORD"
FILE = "robots.json"
USUAL_USER = "nao"


class SavedLogin(msgspec.Struct, frozen=True):
    """How to log in at a robot; ``fingerprint`` is that of its certificate, "" for any."""

    user: str
    password: str
    fingerprint: str = ""


def logins_file() -> Path:
    """Where user and password of robots are kept."""
    if named := os.environ.get(FOLDER_VARIABLE):
        return Path(named) / FILE
    try:
        return Path(platformdirs.user_config_dir("nep-studio", appauthor=False)) / FILE
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / "nep-studio" / FILE


def saved_login(place: str) -> SavedLogin | None:
    """Return how to log in at an address (as a person writes it), None when it needs nothing."""
    if password := os.environ.get(PASSWORD_VARIABLE):
        return SavedLogin(os.environ.get(USER_VARIABLE) or USUAL_USER, password)
    return _read().get(_key(place))


def save_login(place: str, login: SavedLogin | None) -> None:
    """Keep user and password of an address; None forgets them. Raises OSError."""
    logins, place = _read(), _key(place)
    if logins.get(place) == login:
        return
    logins.pop(place, None)
    if login is not None:
        logins[place] = login
    _write(logins)


def _key(place: str) -> str:
    """The same robot may be written with the usual port, or without."""
    return place.strip().casefold().removesuffix(":9559")


def _read() -> dict[str, SavedLogin]:
    try:
        return msgspec.json.decode(content(logins_file()), type=dict[str, SavedLogin])
    except (
        OSError,
        ValueError,
        RecursionError,
    ):  # none yet, or of no use: asked for again
        return {}


def _write(logins: dict[str, SavedLogin]) -> None:
    path = logins_file()
    make_privately(path.parent)
    with whole_file(path, is_private=True) as file:
        file.write(msgspec.json.format(msgspec.json.encode(logins), indent=2))
