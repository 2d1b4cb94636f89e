"""Where the master and the broker are found: an environment variable, else a fixed port."""

from __future__ import annotations

import os
import re

from nep_core.errors import NetworkError

MASTER_VARIABLE = "NEP_MASTER"
BROKER_VARIABLE = "NEP_BROKER"
DEFAULT_MASTER = "tcp://127.0.0.1:7100"
DEFAULT_BROKER = "tcp://127.0.0.1:7110"
"""Publishers connect here; subscribers to the next port."""

_ENDPOINT = re.compile(r"tcp://(?P<host>[\w.\-]+|\[[0-9a-fA-F:]+\]):(?P<port>\d{1,5}|\*)")


def check_endpoint(endpoint: str) -> str:
    """Give back ``endpoint``, or raise NetworkError that shows what one looks like."""
    match = _ENDPOINT.fullmatch(endpoint)
    if match is None or (match["port"] != "*" and not 0 < int(match["port"]) < 65536):
        raise NetworkError(
            f"{endpoint!r} is not an endpoint.",
            checklist=('Write it as "tcp://127.0.0.1:7100": tcp, an address, a port to 65535.',),
        )
    return endpoint


def master_endpoint() -> str:
    """The master's endpoint: the variable NEP_MASTER, else port 7100 of this computer."""
    return check_endpoint(os.environ.get(MASTER_VARIABLE) or DEFAULT_MASTER)


def broker_endpoints(first: str | None = None) -> tuple[str, str]:
    """The broker's two endpoints: publishers' and subscribers', one port apart."""
    endpoint = check_endpoint(first or os.environ.get(BROKER_VARIABLE) or DEFAULT_BROKER)
    host, _, port = endpoint.rpartition(":")
    return endpoint, f"{host}:{int(port) + 1}"
