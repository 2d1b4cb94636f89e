"""The ways that a watch or phone can reach the node: what each needs, and how one is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .connector import Connector, Settings


@dataclass(frozen=True)
class WayKind:
    """One way, as a person chooses it; ``port`` is its usual one.

    ``needs_address``: the phone is the server, and its address must be given.
    """

    title: str
    port: int
    needs_address: bool
    make: Callable[[Settings], Connector]


def _phone_page(settings: Settings) -> Connector:
    from nodes.sensory.phone_page.server import PhonePage

    return PhonePage(settings)


def _sensor_logger(settings: Settings) -> Connector:
    from .sensor_logger import SensorLoggerConnector

    return SensorLoggerConnector(settings)


def _udp(settings: Settings) -> Connector:
    from .lines import UdpConnector

    return UdpConnector(settings)


def _tcp(settings: Settings) -> Connector:
    from .lines import TcpConnector

    return TcpConnector(settings)


def _paper_watch(settings: Settings) -> Connector:
    from .lines import PaperWatchConnector

    return PaperWatchConnector(settings)


def _phyphox(settings: Settings) -> Connector:
    from .phyphox import PhyphoxConnector

    return PhyphoxConnector(settings)


def _sensor_server(settings: Settings) -> Connector:
    from .sensor_server import SensorServerConnector

    return SensorServerConnector(settings)


def _bluetooth(settings: Settings) -> Connector:
    from .bluetooth import BluetoothConnector

    return BluetoothConnector(settings)


CONNECTORS: dict[str, WayKind] = {
    "phone_page": WayKind("A page in the phone's browser", 8443, False, _phone_page),
    "sensor_logger": WayKind("The app Sensor Logger", 8000, False, _sensor_logger),
    "phyphox": WayKind("The app phyphox", 8080, True, _phyphox),
    "sensor_server": WayKind("The app SensorServer", 8080, True, _sensor_server),
    "udp": WayKind("Lines by UDP", 8085, False, _udp),
    "tcp": WayKind("Lines by TCP", 8086, False, _tcp),
    "paper_watch": WayKind("The watch of the NEP paper", 8080, False, _paper_watch),
    "bluetooth": WayKind("A sensor with Bluetooth", 0, True, _bluetooth),
}
"""The easiest for a novice first."""
