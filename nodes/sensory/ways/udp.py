"""Lines that a watch or phone sends in UDP packets."""

from __future__ import annotations

import socket
import time

from nodes.sensory.line_reader import own_columns
from nodes.sensory.line_senders import LineSenders
from nodes.sensory.ways.doors import missing_words, open_udp
from nodes.sensory.ways.way import Arrived, Settings

_MOST_PACKETS = 500  # in one batch; a flood beyond that is left to the system, which drops it
_PACKET_BYTES = 65_536


class UdpWay:
    """Packets of one or more lines each; every address is a sender."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._door: socket.socket | None = None
        self._senders = LineSenders(settings.columns)

    @property
    def where(self) -> str:
        """What the node is ready for."""
        port, who = self._settings.port, self._settings.who
        return f"waits for a watch on UDP port {port} ({who})"

    @property
    def missing(self) -> str:
        """What to check when nothing has arrived."""
        return missing_words(self._settings, "the app")

    def open(self) -> None:
        """Open the port; raises PortTaken, and ParameterError for columns that are none."""
        own_columns(self._settings.columns)
        self._door = open_udp(self._settings)

    def readings(self, until_s: float) -> list[Arrived]:
        """The packets that come until then."""
        found: list[Arrived] = []
        while len(found) < _MOST_PACKETS and (left_s := until_s - time.monotonic()) > 0:
            arrived = self._packet(left_s)
            if arrived is not None:
                found.append(arrived)
        return found

    def close(self) -> None:
        """Close the port."""
        if self._door is not None:
            self._door.close()
            self._door = None

    def _packet(self, left_s: float) -> Arrived | None:
        if self._door is None:
            return None
        self._door.settimeout(left_s)
        try:
            data, (sender, _port) = self._door.recvfrom(_PACKET_BYTES)
        except (TimeoutError, ConnectionResetError):  # the latter: Windows, a sender that left
            return None
        return self._senders.arrived(sender, data.splitlines(), time.monotonic())
