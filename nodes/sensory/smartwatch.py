"""Hears a watch or phone, by whichever way its sensors come in."""

from __future__ import annotations

import time

from nep_core.processes.node import Node
from nep_core.wire.messages import IMU, Wrist
from nodes.sensory.hearing import Hearing

from .connectors import WAYS
from .connectors.connector import Settings

_BATCH_S = 0.03


def run(
    node: Node,
    *,
    through: str,
    port: int,
    address: str,
    listen_on: str,
    wrist: Wrist,
    token: str,
    columns: str,
    units: str,
) -> None:
    """Publish ``/imu`` from what one sender sends; PortTaken or ParameterError when it cannot."""
    kind = WAYS[through]
    way = kind.make(Settings(port or kind.port, address, listen_on, token, columns, units))
    publisher = node.publisher(IMU)
    try:
        way.open()
        node.ready(way.where)
        hearing = Hearing(node, way.missing)
        while not node.stopping:
            arrivals = way.readings(time.monotonic() + _BATCH_S)
            hearing.wrist = wrist or getattr(way, "hand", "")  # a phone's page asks for it
            if batch := hearing.hear(arrivals, time.monotonic()):
                publisher.send(batch)
    finally:
        way.close()
