"""Finds NAOqi robots on the network: they announce themselves by zeroconf as ``_naoqi._tcp``."""

from __future__ import annotations

import ipaddress
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from nodes.action.naoqi.driver.address import NAOQI_PORT, plain_address

SERVICE = "_naoqi._tcp.local."
SEARCH_S = 4.0
ASK_S = 1.5
LOOK_EVERY_S = 0.05


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
    """
    from zeroconf import InterfaceChoice, ServiceBrowser, Zeroconf

    robots: dict[str, FoundRobot] = {}
    names: list[str] = []

    def on_change(name: str, **_news: object) -> None:
        if name not in names:  # called by a thread of zeroconf, which must not wait
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
    info = network.get_service_info(SERVICE, name, timeout=round(ASK_S * 1000))
    host = _host(info) if info is not None else ""
    if info is None or not host:
        return None
    return FoundRobot(name.removesuffix(f".{SERVICE}"), host, info.port or NAOQI_PORT)


def _host(info: Any) -> str:
    """The address to reach a robot at, out of its ServiceInfo: a short, usual one if it can."""
    addresses = [ipaddress.ip_address(text) for text in _without_zones(info.parsed_addresses())]
    usual = [one for one in addresses if one.version == 4]
    if usual:
        return str(usual[0])
    return (info.server or "").rstrip(".")


def _without_zones(addresses: Sequence[str]) -> list[str]:
    return [text.partition("%")[0] for text in addresses]
