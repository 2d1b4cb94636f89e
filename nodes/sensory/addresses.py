"""The addresses under which other devices of the network reach this computer."""

from __future__ import annotations

import ipaddress
import socket

import psutil

_ANYWHERE = ("192.0.2.1", 9)  # nobody's (RFC 5737): nothing is sent, the system only chooses a way
_VIRTUAL = ("docker", "br-", "veth", "virbr", "vmnet", "vboxnet", "lxc", "tailscale", "utun", "wg")


def lan_addresses() -> list[str]:
    """The IPv4 addresses of this computer in its networks, the most likely one first.

    That is the one of the default route; then come home networks, then the rest. Addresses that
    only this computer has, and those of networks without a router, are left out.
    """
    statistics = psutil.net_if_stats()
    found = [
        (address.address, name)
        for name, addresses in psutil.net_if_addrs().items()
        if name not in statistics or statistics[name].isup
        for address in addresses
        if address.family == socket.AF_INET and _is_reachable(address.address)
    ]
    main = _main_address()
    return [address for address, _ in sorted(found, key=lambda it: (it[0] != main, *_rank(*it)))]


def _rank(address: str, interface: str) -> tuple[bool, bool]:
    is_virtual = interface.lower().startswith(_VIRTUAL)
    return is_virtual, not ipaddress.ip_address(address).is_private


def _is_reachable(address: str) -> bool:
    parsed = ipaddress.ip_address(address)
    return not (parsed.is_loopback or parsed.is_link_local or parsed.is_unspecified)


def _main_address() -> str:
    """Our address on the default route, empty where there is none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_ANYWHERE)
            return str(probe.getsockname()[0])
        except OSError:
            return ""
