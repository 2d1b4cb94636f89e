"""Asking a master from a tool that does not join the network itself."""

from __future__ import annotations

import contextlib
from typing import Self, TypeVar

import msgspec
import zmq

from nep_core import master_messages as says
from nep_core import security
from nep_core.endpoints import fixed_endpoint
from nep_core.errors import MasterNotFound

A = TypeVar("A", bound=says.Answer)


class MasterProbe:
    """A connection for questions; raises NetworkError when ``endpoint`` is not one."""

    def __init__(self, endpoint: str) -> None:
        fixed_endpoint(endpoint)
        trust = security.trust_in_master()
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.setsockopt(zmq.IPV6, int("[" in endpoint))
        trust(self._socket)
        self._socket.connect(endpoint)

    def ask(self, request: says.Request, kind: type[A], timeout_s: float = 2.0) -> A | None:
        """The answer; None when no NEP master gives one of this kind."""
        self._socket.send(says.encode(request))
        if not self._socket.poll(int(timeout_s * 1000)):
            return None
        answer = None
        with contextlib.suppress(msgspec.MsgspecError):  # something else answers there
            answer = says.decode_answer(self._socket.recv())
        return answer if isinstance(answer, kind) else None

    def close(self) -> None:
        """Ask no more."""
        self._context.destroy(linger=0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


def ask_master(endpoint: str, timeout_s: float = 2.0) -> says.Listing | None:
    """What the master at ``endpoint`` has registered; None when no NEP master answers.

    Raises NetworkError when ``endpoint`` is not one.
    """
    with MasterProbe(endpoint) as probe:
        return probe.ask(says.List(), says.Listing, timeout_s)


def find_topic(endpoint: str, topic: str, timeout_s: float = 2.0) -> says.Found | None:
    """Who publishes and who hears ``topic``; None when no NEP master answers."""
    with MasterProbe(endpoint) as probe:
        return probe.ask(says.Find(topic=topic), says.Found, timeout_s)


def ask_to_stop(endpoint: str, node: str, timeout_s: float = 2.0) -> bool | None:
    """Ask a node to stop; whether there is one, None when no NEP master answers."""
    with MasterProbe(endpoint) as probe:
        answer = probe.ask(says.Stop(node=node), says.Passed, timeout_s)
    return None if answer is None else answer.known


def no_master(endpoint: str) -> MasterNotFound:
    """The error to raise when nobody answers at ``endpoint``: it may be one that wants keys."""
    from nep_core.security.greeting import not_let_in

    return not_let_in(endpoint) or MasterNotFound(
        f"No NEP master answers at {endpoint}.",
        checklist=(
            "Start one in another terminal: nep master",
            "Is it at another place? Set NEP_MASTER to its endpoint.",
        ),
    )
