"""A network that zenoh carries, for projects that outgrow one computer or one site.

The frames and the handshake are those of the other networks. Zenoh's liveliness tokens are the
registry: each program tells its name, its topics and its subscribers by tokens, which end with it.
"""

from __future__ import annotations

import atexit
import os
import random
import socket as sockets
import time
from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from nep_core.errors import NameTaken
from nep_core.network import HANDSHAKE_S, Network, Policy
from nep_core.over_zenoh.inbox import ZenohInbox
from nep_core.over_zenoh.keys import (
    ALL_TOKENS,
    hears_token,
    last_part,
    node_token,
    node_tokens,
    registrations_of,
    says_token,
    stop_key,
)
from nep_core.over_zenoh.outbox import ZenohOutbox
from nep_core.over_zenoh.session import open_client, router_endpoints
from nep_core.registry import Registration

if TYPE_CHECKING:
    import zenoh

NAME_TRIES = 4
NAME_PAUSE_S = 0.05


class ZenohNetwork(Network):
    """One program's place in a zenoh network.

    ``connect``: the routers, of which the first that answers is used (default: NEP_ZENOH).
    Raises NetworkError when none answers; joining raises NameTaken as over p2p.
    """

    outbox: ZenohOutbox

    def __init__(self, node: str = "", *, connect: Iterable[str] = ()) -> None:
        # Another site may have a process of the same number.
        super().__init__(node or f"program-{os.getpid()}-{sockets.gethostname()}")
        self.routers = list(connect) or router_endpoints()
        self.session = open_client(self.routers)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does
        self.outbox = ZenohOutbox(
            self.session, self.node, self.instance, hurry=self.io.hurry, wake=self.io.wake
        )
        self._name: zenoh.LivelinessToken | None = None
        self._says: dict[str, zenoh.LivelinessToken] = {}
        self._hears: dict[str, zenoh.LivelinessToken] = {}
        self._publishers: Counter[str] = Counter()
        self._is_asked_to_stop = False
        self.io.tend(self.outbox.tend)
        self.io.tend(self._stop_when_asked)
        self.io.start()

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        with self._lock:
            if self._name is None:
                self._name = self._claim_name()
                self._hear_stop()

    def add_publisher(self, topic: str) -> set[str]:
        """Tell of the topic; the subscribers that are there."""
        self.join()
        self.outbox.watch(topic)
        with self._lock:
            self._publishers[topic] += 1
            if topic not in self._says:
                self._says[topic] = self._declare(says_token(topic, self.instance))
        return {last_part(token) for token in tokens_at(self.session, hears_token(topic))}

    def add_subscriber(self, topic: str, subscriber: str, inbox: Any) -> set[str]:
        """Tell of the subscriber, whose inbox hears already; the publishers that are there."""
        self.join()
        with self._lock:
            self._hears[subscriber] = self._declare(hears_token(topic, self.instance, subscriber))
        return {last_part(token) for token in tokens_at(self.session, says_token(topic))}

    def remove_publisher(self, topic: str) -> None:
        """Tell that the topic's last publisher here is closed."""
        with self._lock:
            self._publishers[topic] -= 1
            if not self._publishers[topic] and topic in self._says:
                self._says.pop(topic).undeclare()

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber and tell so."""
        with self._lock:
            token = self._hears.pop(subscriber, None)
        if token is not None:
            token.undeclare()
        super().remove_subscriber(subscriber)

    def _make_inbox(self, topic: str, subscriber: str, policy: Policy) -> ZenohInbox:
        return ZenohInbox(self.session, topic, subscriber, policy)

    def _end(self) -> None:
        self.session.close()
        atexit.unregister(self.close)

    def _declare(self, token: str) -> zenoh.LivelinessToken:
        return self.session.liveliness().declare_token(token)

    def _claim_name(self) -> zenoh.LivelinessToken:
        """Show the name's token, and withdraw when another has it.

        Of two that come at once both may withdraw, so each tries again a little later.
        """
        others: list[str] = []
        for attempt in range(NAME_TRIES):
            time.sleep(attempt * random.uniform(0.5, 1.0) * NAME_PAUSE_S)
            token = self._declare(
                node_token(self.node, self.instance, os.getpid(), sockets.gethostname())
            )
            tokens = tokens_at(self.session, node_tokens(self.node))
            others = [other for other in tokens if f"/{self.instance}/" not in other]
            if not others:
                return token
            token.undeclare()
        told = registrations_of(others, "")[0]
        raise NameTaken(
            f'A node named "{self.node}" is already running (process {told.pid} on {told.host}).',
            checklist=(
                "Give the new node another name.",
                f'Or stop the running "{self.node}" first.',
            ),
        )

    def _hear_stop(self) -> None:
        import zenoh

        def on_stop(_sample: zenoh.Sample) -> None:
            self._is_asked_to_stop = True
            self.io.wake()

        asked = zenoh.handlers.Callback(on_stop, indirect=False)
        self.session.declare_subscriber(stop_key(self.instance), asked)

    def _stop_when_asked(self) -> None:
        if self._is_asked_to_stop:
            self._is_asked_to_stop = False
            self.on_stop()


def tokens_at(session: zenoh.Session, key: str) -> list[str]:
    """The tokens that fit ``key`` now."""
    replies = session.liveliness().get(key, timeout=HANDSHAKE_S)
    return [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]


def zenoh_registrations(connect: Iterable[str] = ()) -> list[Registration]:
    """Who is there; raises NetworkError when no router answers."""
    routers = list(connect) or router_endpoints()
    with open_client(routers) as session:
        return registrations_of(tokens_at(session, ALL_TOKENS), routers[0])


def zenoh_stop(node: str, connect: Iterable[str] = ()) -> bool:
    """Ask a node to stop; whether there is one. Raises NetworkError when no router answers."""
    with open_client(list(connect) or router_endpoints()) as session:
        told = registrations_of(tokens_at(session, node_tokens(node)), "")
        for registration in told:
            session.put(stop_key(registration.instance), b"")
    return bool(told)
