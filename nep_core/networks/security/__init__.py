"""Who may take part in a network: without a key file only programs of this computer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import zmq

    from .curve import Security

KEYS_VARIABLE = "NEP_KEYS"
"""The key file of an opened network; without it programs talk on this computer only."""


def key_file_path() -> Path | None:
    """The key file that this program was told to use; None: it stays on this computer."""
    told = os.environ.get(KEYS_VARIABLE)
    return Path(told) if told else None


def from_environment(context: zmq.Context[zmq.Socket[bytes]]) -> Security | None:
    """What guards the sockets of a new ``context``, by the key file in NEP_KEYS; None without one.

    It ends with the context, which must not be destroyed but closed socket by socket, then by
    term(). Raises KeyFileError; the context is closed then.
    """
    path = key_file_path()
    if path is None:
        return None
    from .curve import Security
    from .keys import KeyFile

    try:
        return Security(KeyFile(path), context)
    except BaseException:
        context.destroy(linger=0)
        raise


def connect_to_master(socket: zmq.Socket[bytes], endpoint: str) -> None:
    """Connect a socket to a master, by our keys if we were told any; raises KeyFileError."""
    path = key_file_path()
    if path is not None:
        from .curve import expect_key, show_keys
        from .keys import KeyFile

        keys = KeyFile(path).keys
        show_keys(socket, keys)
        expect_key(socket, keys.master_key)
    connect(socket, endpoint)


BEAT_MS = 1_000
"""Each end of a connection asks so often whether the other is there (ZMTP 3.1, PING) ..."""
SILENT_MS = 4_000
"""... and after so long without any sign it ends the connection, and makes a new one."""
CONNECT_MS = 2_000
"""An attempt to connect is given up after so long: the system would wait twice as long each time,
and a cut of eight seconds would cost fifteen."""


def watch_over(socket: zmq.Socket[bytes]) -> None:
    """Let a socket see when a connection is cut without a word; before it binds or connects."""
    socket.heartbeat_ivl = BEAT_MS
    socket.heartbeat_timeout = socket.heartbeat_ttl = SILENT_MS
    socket.connect_timeout = CONNECT_MS


def connect(socket: zmq.Socket[bytes], endpoint: str) -> None:
    """Connect a socket to an endpoint, which may have an address of IPv6."""
    watch_over(socket)
    socket.ipv6 = "[" in endpoint
    socket.connect(endpoint)
