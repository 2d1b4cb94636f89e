"""The ways that a watch or phone can reach the node: what each needs, and how one is made."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module

from .connector import Connector, Settings


@dataclass(frozen=True)
class WayKind:
    """One way, as a person chooses it; ``port`` is its usual one, ``place`` its module and class.

    ``needs_address``: the phone is the server, and its address must be given.
    """

    title: str
    port: int
    needs_address: bool
    place: str

    def make(self, settings: Settings) -> Connector:
        """The connector; only its module is loaded, for some take long."""
        module, _, name = self.place.partition(":")
        connector: Connector = getattr(import_module(module, __name__), name)(settings)
        return connector


CONNECTORS: dict[str, WayKind] = {
    "phone_page": WayKind(
        "A page in the phone's browser", 8443, False, "nodes.sensory.phone_page.server:PhonePage"
    ),
    "sensor_logger": WayKind(
        "The app Sensor Logger", 8000, False, ".sensor_logger:SensorLoggerConnector"
    ),
    "phyphox": WayKind("The app phyphox", 8080, True, ".phyphox:PhyphoxConnector"),
    "sensor_server": WayKind(
        "The app SensorServer", 8080, True, ".sensor_server:SensorServerConnector"
    ),
    "udp": WayKind("Lines by UDP", 8085, False, ".lines:UdpConnector"),
    "tcp": WayKind("Lines by TCP", 8086, False, ".lines:TcpConnector"),
    "paper_watch": WayKind("The watch of the NEP paper", 8080, False, ".lines:TcpConnector"),
    "bluetooth": WayKind("A sensor with Bluetooth", 0, True, ".bluetooth:BluetoothConnector"),
}
"""The easiest for a novice first."""
