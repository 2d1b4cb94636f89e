"""Where services are: which of the addresses that a robot tells can be reached from here."""

from __future__ import annotations

import os
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

MACHINE = uuid.uuid4()
LOOPBACK = ("127.", "localhost", "[::1]", "::1")


@dataclass(frozen=True)
class Place:
    """The number of a service, the machine it is on, and the addresses that lead there."""

    number: int
    machine: str
    endpoints: tuple[str, ...]

    @classmethod
    def of(cls, information: Sequence[Any]) -> Place:
        """Return what a robot's ServiceInfo says."""
        _, number, machine, _, endpoints, *_ = information
        return cls(number, machine, tuple(endpoints))


def best_place(place: Place, here: Place, address: tuple[str, int]) -> tuple[str, int, bool] | None:
    """Return host, port and TLS of a service; None when the open connection leads there.

    Loopback addresses of a robot are its own; they lead there only from the same machine.
    """
    if not place.endpoints or set(place.endpoints) & set(here.endpoints):
        return None
    is_near = address[0].startswith(LOOPBACK)
    found = [parsed for one in place.endpoints if (parsed := _parsed(one))]
    if any(one[1] == address[1] and (one[0] == address[0] or is_near) for one in found):
        return None
    same_host = [one for one in found if one[0] == address[0]]
    reachable = [one for one in found if is_near or not one[0].startswith(LOOPBACK)]
    return next(iter(same_host or reachable), None)


def _parsed(endpoint: str) -> tuple[str, int, bool] | None:
    """Read ``tcp://host:port`` or ``tcps://host:port``."""
    scheme, mark, rest = endpoint.partition("://")
    host, _, port = rest.rpartition(":")
    if not mark or scheme not in ("tcp", "tcps") or not port.isdigit() or not host:
        return None
    return host.strip("[]"), int(port), scheme == "tcps"


def own_information(name: str) -> dict[str, Any]:
    """Return what this program tells a robot of a service that it offers."""
    return {
        "name": name,
        "serviceId": 0,
        "machineId": str(MACHINE),
        "processId": os.getpid(),
        "endpoints": [],
        "sessionId": str(MACHINE),
        "objectUid": "",
    }
