"""Lines that watches and phones send over TCP connections."""

from __future__ import annotations

import selectors
import socket
import time
from dataclasses import dataclass
from typing import ClassVar

from faults import Text, text_of
from nodes.sensory.line_reader import LineSenders, own_columns

from .connector import Arrived, Settings
from .servers import missing_words, open_tcp, open_udp

_MOST_CLIENTS = 16
_GONE_S = 10.0  # a connection that was silent for so long makes room: its device may be gone
_LONGEST_LINE = 8_192
_READ_BYTES = 8_192  # so few lines that a flood does not hold the node up
_MOST_READS = 200  # in one batch; a flood beyond that waits on the sender's side


@dataclass
class Client:
    """A connection: the beginning of a line that has not ended yet."""

    sender: str
    rest: bytes = b""
    is_endless: bool = False  # its line grew too long: all up to the next line break is left out
    heard_s: float = 0.0

    def lines(self, data: bytes) -> list[bytes]:
        """The lines that ``data`` ends."""
        *whole, self.rest = (self.rest + data).split(b"\n")
        if whole and self.is_endless:
            whole, self.is_endless = whole[1:], False
        if len(self.rest) > _LONGEST_LINE:
            self.rest, self.is_endless = b"", True
        return whole


class LineConnector:
    """What both servers for lines are: a door of this computer, and readers of their lines."""

    waits_for: ClassVar[Text]

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._door: socket.socket | None = None
        self._senders = LineSenders(settings.columns)

    @property
    def where(self) -> Text:
        """What the node is ready for."""
        return text_of(self.waits_for.text, port=self._settings.port, where=self._settings.where)

    @property
    def missing(self) -> Text:
        """What to check when nothing has arrived."""
        return missing_words(self._settings, "the app")


class TcpConnector(LineConnector):
    """A server for lines: many may connect, the node follows one of them.

    The watch and phone apps of the NEP paper connect to it too, at port 8080.
    """

    waits_for = Text("waits for a watch on TCP port {port} ({where})")

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._selector: selectors.BaseSelector | None = None
        self._clients: dict[socket.socket, Client] = {}

    def open(self) -> None:
        """Open the port; raises PortTaken, and ParameterError for columns that are none."""
        own_columns(self._settings.columns)
        self._door = open_tcp(self._settings)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._door, selectors.EVENT_READ)

    def readings(self, until_s: float) -> list[Arrived]:
        """What the connections bring until then."""
        found: list[Arrived] = []
        reads = 0
        while (left_s := until_s - time.monotonic()) > 0 and reads < _MOST_READS:
            for key, _events in self._selector.select(left_s) if self._selector else ():
                reads += 1
                ready = key.fileobj
                if ready is self._door:
                    found += self._let_in()
                elif isinstance(ready, socket.socket):
                    found += self._read(ready)
        return found

    def close(self) -> None:
        """Close the port and all connections."""
        for client in list(self._clients):
            self._leave(client)
        if self._selector is not None:
            self._selector.close()
        if self._door is not None:
            self._door.close()
        self._selector = self._door = None

    def _let_in(self) -> list[Arrived]:
        assert self._door is not None and self._selector is not None
        try:
            connection, (sender, _port) = self._door.accept()
        except OSError:  # it left before it was taken
            return []
        now_s = time.monotonic()
        self._make_room(now_s)
        if len(self._clients) >= _MOST_CLIENTS:
            connection.close()
            told = text_of(
                "More than {most_clients} devices connect at once; {sender} is turned away.",
                most_clients=_MOST_CLIENTS,
                sender=sender,
            )
            return [Arrived(sender, arrived_s=now_s, trouble=told)]
        connection.setblocking(False)
        self._clients[connection] = Client(sender, heard_s=now_s)
        self._selector.register(connection, selectors.EVENT_READ)
        return [Arrived(sender, arrived_s=now_s)]

    def _make_room(self, now_s: float) -> None:
        """Where all places are taken, leave the one that was silent longest if that is long."""
        if len(self._clients) < _MOST_CLIENTS:
            return
        silent = min(self._clients, key=lambda one: self._clients[one].heard_s)
        if now_s - self._clients[silent].heard_s > _GONE_S:
            self._leave(silent)

    def _read(self, connection: socket.socket) -> list[Arrived]:
        client = self._clients[connection]
        try:
            data = connection.recv(_READ_BYTES)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        now_s = time.monotonic()
        if not data:  # a line that had not ended is not whole: it is left out
            self._leave(connection)
            return []
        client.heard_s = now_s
        was_endless = client.is_endless
        arrived = self._senders.arrived(client.sender, client.lines(data), now_s)
        if client.is_endless and not was_endless:
            told = text_of(
                "{sender} sends a line that does not end; it is left out.", sender=client.sender
            )
            return [arrived, Arrived(client.sender, arrived_s=now_s, trouble=told)]
        return [arrived]

    def _leave(self, connection: socket.socket) -> None:
        del self._clients[connection]
        assert self._selector is not None
        self._selector.unregister(connection)
        connection.close()


# Lines that a watch or phone sends in UDP packets.

_MOST_PACKETS = 500  # in one batch; a flood beyond that is left to the system, which drops it
_PACKET_BYTES = 65_536


class UdpConnector(LineConnector):
    """Packets of one or more lines each; every address is a sender."""

    waits_for = Text("waits for a watch on UDP port {port} ({where})")

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
