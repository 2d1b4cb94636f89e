"""Hears a watch or phone that sends its sensors by UDP."""

from __future__ import annotations

import socket
import time
from dataclasses import dataclass

from nep_core.errors import PortTaken
from nep_core.messages import IMU, Imu
from nep_core.node import Node
from nodes.sensory.lines import read_datagram
from nodes.sensory.sample_stream import Sample, SampleStream

ADDRESSES = {"this computer": "127.0.0.1", "network": "0.0.0.0"}  # the user's explicit choice

_BATCH_S = 0.03
_SILENT_S = 3.0
_WARN_EVERY_S = 5.0
_MOST_DATAGRAMS = 500  # in one batch; a flood beyond that is left to the system, which drops it
_DATAGRAM_BYTES = 65_536


def run(node: Node, *, port: int, listen_on: str) -> None:
    """Publish ``/imu`` from the lines that one sender sends; PortTaken when the port is."""
    publisher = node.publisher(IMU)
    with _open(port, ADDRESSES[listen_on]) as door:
        where = _where(listen_on)
        node.ready(f"waits for a watch on UDP port {port} ({where})")
        ear = _Ear(node)
        while not node.stopping:
            if batch := ear.hear(_datagrams(door)):
                publisher.send(batch)


def _open(port: int, address: str) -> socket.socket:
    door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        door.bind((address, port))
    except OSError as error:
        door.close()
        raise PortTaken(
            f"UDP port {port} cannot be opened: {(error.strerror or str(error)).lower()}.",
            checklist=(
                "Does another program, or a second node like this one, use it? Stop that one.",
                f"Choose another port than {port} here, and the same one in the watch.",
            ),
        ) from error
    return door


def _where(listen_on: str) -> str:
    return "from this computer only" if listen_on == "this computer" else "from the network"


@dataclass(frozen=True)
class Datagram:
    """A packet, the address that it came from, and when (``time.monotonic()``)."""

    sender: str
    data: bytes
    arrived_s: float


def _datagrams(door: socket.socket) -> list[Datagram]:
    """What arrives in the time of one batch."""
    until_s = time.monotonic() + _BATCH_S
    found: list[Datagram] = []
    while len(found) < _MOST_DATAGRAMS and (left_s := until_s - time.monotonic()) > 0:
        door.settimeout(left_s)
        try:
            data, (sender, _port) = door.recvfrom(_DATAGRAM_BYTES)
        except (TimeoutError, ConnectionResetError):  # the latter: Windows, a sender that left
            continue
        found.append(Datagram(sender, data, time.monotonic()))
    return found


class _Ear:
    """Follows one sender until it falls silent; tells who it is and what cannot be read."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._sender = ""
        self._heard_s = 0.0
        self._warned_s = -_WARN_EVERY_S
        self._stream = SampleStream()
        self._is_connected = False

    def hear(self, datagrams: list[Datagram]) -> Imu | None:
        """The samples of these packets as a message, None where there are none."""
        samples: list[Sample] = []
        for datagram in datagrams:
            if self._is_followed(datagram.sender, datagram.arrived_s):
                samples.extend(self._read(datagram))
        self._tell(time.monotonic(), has_samples=bool(samples))
        return self._message(samples) if samples and self._is_connected else None

    def _is_followed(self, sender: str, now_s: float) -> bool:
        if sender != self._sender and now_s - self._heard_s < _SILENT_S:
            self._warn(now_s, f"A second watch sends from {sender}; {self._sender} is followed.")
            return False
        if sender != self._sender:
            self._sender, self._stream, self._is_connected = sender, SampleStream(), False
        return True

    def _read(self, datagram: Datagram) -> list[Sample]:
        readings, unreadable = read_datagram(datagram.data)
        if unreadable:
            told = f'{self._sender} sends a line that cannot be read: "{unreadable}"'
            self._warn(datagram.arrived_s, told)
        if readings:
            self._heard_s = datagram.arrived_s
        return self._stream.samples(readings, datagram.arrived_s)

    def _warn(self, now_s: float, description: str) -> None:
        if now_s - self._warned_s >= _WARN_EVERY_S:
            self._warned_s = now_s
            self._node.warn(description)

    def _tell(self, now_s: float, *, has_samples: bool) -> None:
        if has_samples and not self._is_connected and self._stream.rate_hz:
            self._is_connected = True
            rate_hz = self._stream.rate_hz
            self._node.state("connected", f"{self._sender} sends {rate_hz:.0f} samples a second")
        elif self._is_connected and now_s - self._heard_s >= _SILENT_S:
            self._is_connected = False
            self._node.state("disconnected", f"{self._sender} has sent nothing for 3 seconds")

    def _message(self, samples: list[Sample]) -> Imu:
        gyr = [sample.gyr for sample in samples if sample.gyr is not None]
        return Imu(
            source=self._sender,
            rate_hz=self._stream.rate_hz,
            t=[sample.t for sample in samples],
            acc=[sample.acc for sample in samples],
            gyr=gyr if len(gyr) == len(samples) else None,
            gravity_included=self._stream.gravity_included,
        )
