"""Addresses of this computer, and which endpoints only this computer can reach."""

from __future__ import annotations

import os
import socket

from nep_core.errors import NetworkError

HOST_VARIABLE = "NEP_HOST"
"""The address at which this computer is reached, when the way to the master does not tell."""

NOWHERE = "192.0.2.1"
"""An address of documentation (RFC 5737); the way to it is the way to the network."""


def host_of(endpoint: str) -> str:
    """The address in an endpoint, without the brackets of IPv6."""
    return endpoint.removeprefix("tcp://").rpartition(":")[0].strip("[]")


def endpoint_at(host: str, port: int | str) -> str:
    """The endpoint of a port at an address."""
    return f"tcp://[{host}]:{port}" if ":" in host else f"tcp://{host}:{port}"


def is_loopback(host: str) -> bool:
    """Whether only this computer reaches ``host``."""
    if host in ("127.0.0.1", "::1"):
        return True
    import ipaddress  # here: the start of a node need not wait for it

    try:
        return host.lower() == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def is_ours(host: str) -> bool:
    """Whether ``host`` is an address of this computer."""
    return is_loopback(host) or host in own_addresses()


def own_addresses() -> list[str]:
    """The addresses of this computer that others may reach, IPv4 first."""
    import psutil

    up = {name for name, state in psutil.net_if_stats().items() if state.isup}
    found = [
        (address.family != socket.AF_INET, address.address.partition("%")[0])
        for name, addresses in psutil.net_if_addrs().items()
        for address in addresses
        if name in up and address.family in (socket.AF_INET, socket.AF_INET6)
    ]
    return [address for _, address in sorted(found) if not is_loopback(address)]


def require_loopback(endpoint: str) -> None:
    """Raise NetworkError when a program without keys would let other computers in."""
    if not is_loopback(host_of(endpoint)):
        raise NetworkError(
            "{endpoint} can be reached from other computers, and this network has no keys.",
            checklist=(
                "For programs of this computer use 127.0.0.1 instead.",
                "To let other computers in, open the network: nep open. "
                "Then set NEP_KEYS to its key file.",
            ),
            endpoint=endpoint,
        )


def own_address(master: str) -> str:
    """The address at which others reach this computer: NEP_HOST, or by the way to the master.

    Raises NetworkError when this computer has no address in a network.
    """
    if told := os.environ.get(HOST_VARIABLE):
        return told.strip("[]")
    by_master = _way_to(host_of(master))
    return by_master if by_master and not is_loopback(by_master) else lan_address()


def lan_address() -> str:
    """The address of this computer in its network; raises NetworkError when it has none."""
    address = _way_to(NOWHERE) or next(iter(own_addresses()), "")
    if not address or is_loopback(address):
        raise NetworkError(
            "This computer is in no network.",
            checklist=(
                "Connect it to the Wi-Fi or the cable that the other computers use.",
                "Or say its address: set NEP_HOST.",
            ),
        )
    return address


def _way_to(host: str) -> str:
    """From which of our addresses ``host`` is reached; sends nothing. "" when there is no way."""
    try:
        family = socket.getaddrinfo(host, 9, type=socket.SOCK_DGRAM)[0][0]
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((host, 9))
            return str(probe.getsockname()[0])
    except (OSError, UnicodeError):  # UnicodeError: no name of a computer is like that
        return ""
