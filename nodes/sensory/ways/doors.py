"""Ports of this computer that senders come in by, and sentences about them."""

from __future__ import annotations

import socket

from nep_core.errors import PortTaken
from nodes.sensory.addresses import lan_addresses
from nodes.sensory.ways.way import Settings

LOOPBACK = "127.0.0.1"
_WAITING = 64  # callers that are not taken yet


def open_udp(settings: Settings) -> socket.socket:
    """A door for packets; raises PortTaken."""
    return _bound(socket.socket(socket.AF_INET, socket.SOCK_DGRAM), settings, "UDP")


def open_tcp(settings: Settings) -> socket.socket:
    """A door that connections come in by, not waiting; raises PortTaken."""
    door = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if hasattr(socket, "SO_EXCLUSIVEADDRUSE"):  # Windows lets two programs share a port otherwise
        door.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
    else:  # else the port would stay taken for a minute after the node ended
        door.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    _bound(door, settings, "TCP")
    door.listen(_WAITING)
    door.setblocking(False)
    return door


def own_addresses(settings: Settings) -> list[str]:
    """Where senders find this computer, the most likely address first."""
    if settings.listen_on == "this computer":
        return [LOOPBACK]
    return lan_addresses()[:3] or [LOOPBACK]


def missing_words(settings: Settings, app: str) -> str:
    """What to check when nothing came to a door of this computer."""
    where = f"{' / '.join(own_addresses(settings))}, port {settings.port}"
    if settings.listen_on == "this computer":
        return (
            f"Nothing has arrived for 10 seconds. Only this computer is let in, at {where}: "
            "for a watch or phone, set “listen on” to network."
        )
    return (
        f"Nothing has arrived for 10 seconds. Does {app} send to {where}, is it in the same "
        "network, and does this computer's firewall let it in?"
    )


def _bound(door: socket.socket, settings: Settings, kind: str) -> socket.socket:
    try:
        door.bind((settings.own_address, settings.port))
    except OSError as error:
        door.close()
        raise PortTaken(
            f"{kind} port {settings.port} cannot be opened: "
            f"{(error.strerror or str(error)).lower()}.",
            checklist=(
                "Does another program, or a second node like this one, use it? Stop that one.",
                f"Choose another port than {settings.port} here, and the same one in the watch.",
            ),
        ) from error
    return door
