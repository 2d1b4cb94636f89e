"""Opens ways on real sockets, and collects what arrives by them."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise

import numpy as np
import pytest

from nodes.recordings import Recording
from nodes.sensory.connectors import CONNECTORS
from nodes.sensory.connectors.connector import Arrived, Connector, Settings

WAIT_S = 8.0
G = 9.80665


def turned(seconds: float = 1.0, rate_hz: float = 100.0) -> Recording:
    """A sensor that is turned to and fro."""
    t = np.arange(int(seconds * rate_hz)) / rate_hz
    tilt = 0.75 * (1 - np.cos(2 * t))
    acc = np.column_stack([0 * t, G * np.sin(tilt), G * np.cos(tilt)])
    gyr = np.column_stack([1.5 * np.sin(2 * t), 0 * t, 0 * t])
    return Recording("turned", t, acc, gyr, None, gravity_included=True)


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Collected:
    """All that has arrived by a way."""

    def __init__(self, connector: Connector, port: int) -> None:
        self.connector, self.port = connector, port
        self.arrivals: list[Arrived] = []

    @property
    def readings(self) -> list:
        return [reading for arrived in self.arrivals for reading in arrived.readings]

    @property
    def troubles(self) -> str:
        return " ".join(str(arrived.trouble) for arrived in self.arrivals if arrived.trouble)

    @property
    def columns(self) -> str:
        return next((one.columns for one in reversed(self.arrivals) if one.columns), "")

    def until(self, wanted: Callable[[], object]) -> None:
        """Listen until something is so; fails when it does not become so."""
        end_s = time.monotonic() + WAIT_S
        while not wanted():
            if time.monotonic() > end_s:
                pytest.fail(f"what was wanted did not come, but {self.arrivals[-3:]}")
            self.arrivals += self.connector.readings(time.monotonic() + 0.02)


@contextmanager
def opened(through: str, **settings: object) -> Iterator[Collected]:
    """A way that is open, on a port of its own unless one is given."""
    kind = socket.SOCK_DGRAM if through == "udp" else socket.SOCK_STREAM
    given = Settings(**({"port": free_port(kind)} | settings))
    connector = CONNECTORS[through].make(given)
    try:
        connector.open()
        yield Collected(connector, given.port)
    finally:
        began_s = time.monotonic()
        connector.close()
        assert time.monotonic() - began_s < 1.5


def assert_same(readings: list, recording: Recording, *, rel: float = 1e-3) -> None:
    """What was heard is what was recorded, from its beginning, at an even rate."""
    count = len(readings)
    assert [one.acc for one in readings] == pytest.approx(
        [pytest.approx(row, abs=0.01) for row in recording.acc[:count].tolist()]
    )
    steps = [
        (after.stamp - before.stamp) * before.stamp_unit_s for before, after in pairwise(readings)
    ]
    assert steps == pytest.approx([1 / recording.rate_hz] * (count - 1), rel=rel)
    if recording.gyr is not None:
        heard = [one.gyr for one in readings]
        assert np.allclose(heard, recording.gyr[:count], atol=0.02)
