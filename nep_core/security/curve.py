"""CURVE on the sockets of one program: encryption, and keys that say who may talk."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from weakref import WeakSet

import zmq

from nep_core.errors import NetworkError
from nep_core.security.addresses import host_of, is_ours
from nep_core.security.keys import KeyFile, Keys
from nep_core.security.refusals import Refusals
from nep_core.security.zap import DOMAIN, Doorkeeper

HANDSHAKE_MS = 5_000
"""A peer that has not shown its key for so long is disconnected."""

LARGEST_SUBSCRIPTION = 65_536
"""How many bytes an XPUB takes at once: it hears subscriptions only."""


class Security:
    """What guards the sockets of one context; any thread."""

    def __init__(self, file: KeyFile, context: zmq.Context[zmq.Socket[bytes]]) -> None:
        self.file = file
        self._told: frozenset[str] = frozenset()
        self._refusals = Refusals(str(file.path))
        self._doorkeeper = Doorkeeper(context, self.allows, self._refusals)
        self._trusting: WeakSet[zmq.Socket[bytes]] = WeakSet()

    @property
    def key(self) -> str:
        """This program's public key: the one of its computer."""
        return self.file.keys.public

    @property
    def master_key(self) -> str:
        """The public key of the computer where the master is."""
        return self.file.keys.master_key

    def guard(self, socket: zmq.Socket[bytes]) -> None:
        """Let only known keys come to ``socket``; before it is bound."""
        show_keys(socket, self.file.keys)
        socket.curve_server = True
        socket.zap_domain = DOMAIN
        socket.handshake_ivl = HANDSHAKE_MS
        if socket.type == zmq.XPUB:
            socket.maxmsgsize = LARGEST_SUBSCRIPTION
        with contextlib.suppress(AttributeError, zmq.ZMQError):  # older ZeroMQ: as it was
            socket.setsockopt(zmq.ZAP_ENFORCE_DOMAIN, 1)  # nobody comes in without our answer
        self._doorkeeper.watch(socket)

    def trust(self, socket: zmq.Socket[bytes], server_key: str) -> None:
        """Talk only to a server with this key; before each connect.

        Raises NetworkError when it is no key: the program there was started without.
        """
        expect_key(socket, server_key)
        show_keys(socket, self.file.keys)
        if socket not in self._trusting:
            self._trusting.add(socket)
            self._doorkeeper.watch(socket)

    def key_at(self, endpoint: str) -> str:
        """The key of the computer at a fixed endpoint; raises NetworkError when none is known."""
        host, keys = host_of(endpoint), self.file.keys
        if is_ours(host):
            return keys.public
        by_address = {computer.address: computer.key for computer in keys.computers}
        if host in by_address:
            return by_address[host]
        if not keys.is_owner:
            return keys.master_key
        if len(keys.computers) == 1:
            return keys.computers[0].key
        raise NetworkError(
            f"The computer at {host} has not been paired with this one.",
            checklist=("Pair it: nep pair.", "Was it paired at another address? Pair it again."),
        )

    def allows(self, key: str) -> bool:
        """Whether a program with this public key may talk with us."""
        return key in self._told or key in self.file.keys.allowed

    def allow(self, keys: Iterable[str]) -> None:
        """Let in these keys from now on: the master tells which computers there are."""
        self._told = frozenset(keys)

    def take_warning(self) -> str:
        """Who was refused since the last time, and what to do; "" when nobody was."""
        return self._refusals.take()


def show_keys(socket: zmq.Socket[bytes], keys: Keys) -> None:
    """Let a socket prove that it is this computer's."""
    socket.curve_publickey = keys.public.encode()
    socket.curve_secretkey = keys.secret.encode()


def expect_key(socket: zmq.Socket[bytes], server_key: str) -> None:
    """Talk only to a server with this key; raises NetworkError when it is none."""
    try:
        socket.curve_serverkey = server_key.encode()
    except (zmq.ZMQError, ValueError) as error:
        raise NetworkError(
            "A program of this network has no key.",
            checklist=("Start it again with NEP_KEYS set to the key file.",),
        ) from error
