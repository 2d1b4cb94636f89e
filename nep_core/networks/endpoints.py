"""Where the master and the broker are found: an environment variable, else a fixed port."""

from __future__ import annotations

import os
import re

from nep_core.errors import NetworkError

from . import security

MASTER_VARIABLE = "NEP_MASTER"
BROKER_VARIABLE = "NEP_BROKER"
DEFAULT_MASTER = "tcp://127.0.0.1:7100"
DEFAULT_BROKER = "tcp://127.0.0.1:7110"
"""Publishers connect here, subscribers to the next port; the registry is at the one after it."""
NETWORK_VARIABLE = "NEP_NETWORK"
LAST_PORT = 65535

_ENDPOINT = re.compile(
    r"tcp://([a-z0-9][\w.\-]*|\[[0-9a-f:]+\]):(?P<port>\d{1,5}|\*)", re.ASCII | re.IGNORECASE
)


def check_endpoint(endpoint: str) -> str:
    """Give back ``endpoint``, or raise NetworkError that shows what one looks like."""
    match = _ENDPOINT.fullmatch(endpoint)
    if match is None or (match["port"] != "*" and not 0 < int(match["port"]) <= LAST_PORT):
        raise NetworkError(
            "{endpoint} is not an endpoint.",
            checklist=('Write it as "tcp://127.0.0.1:7100": tcp, an address, a port to 65535.',),
            endpoint=repr(endpoint),
        )
    return endpoint


def fixed_endpoint(endpoint: str) -> str:
    """Give back an endpoint that others can find, or raise NetworkError: "*" is no port to find."""
    if check_endpoint(endpoint).endswith(":*"):
        raise NetworkError(
            "{endpoint} does not say at which port.",
            checklist=('Write a number for the "*", as in "tcp://127.0.0.1:7100".',),
            endpoint=repr(endpoint),
        )
    return endpoint


def master_endpoint() -> str:
    """The master's endpoint: NEP_MASTER, else the key file's, else port 7100 of this computer.

    In a broker network (NEP_NETWORK) it is the registry of the broker.
    """
    if os.environ.get(NETWORK_VARIABLE) == "broker":
        return broker_registry()
    told = os.environ.get(MASTER_VARIABLE)
    if not told and (keys := security.key_file_path()) is not None:
        from .security.keys import KeyFile

        told = KeyFile(keys).keys.master
    return fixed_endpoint(told or DEFAULT_MASTER)


def broker_endpoints(first: str | None = None) -> tuple[str, str]:
    """The broker's endpoints for messages: publishers' and subscribers', one port apart."""
    endpoint = fixed_endpoint(first or os.environ.get(BROKER_VARIABLE) or DEFAULT_BROKER)
    return endpoint, _after(endpoint, 1)


def broker_registry(first: str | None = None) -> str:
    """Where the broker keeps who is there: two ports after its first one."""
    return _after(broker_endpoints(first)[0], 2)


def _after(endpoint: str, ports: int) -> str:
    host, _, port = endpoint.rpartition(":")
    if int(port) > LAST_PORT - 2:
        raise NetworkError(
            "The broker needs {port} and the two ports after it, which there are not.",
            checklist=("Choose a port to {last_port}.",),
            port=port,
            last_port=LAST_PORT - 2,
        )
    return f"{host}:{int(port) + ports}"
