"""Asking a master who is there, from a tool that does not join the network itself."""

from __future__ import annotations

import msgspec
import zmq

from nep_core import master_messages as says
from nep_core.endpoints import fixed_endpoint
from nep_core.errors import MasterNotFound


def ask_master(endpoint: str, timeout_s: float = 2.0) -> says.Listing | None:
    """What the master at ``endpoint`` has registered; None when no NEP master answers.

    Raises NetworkError when ``endpoint`` is not one.
    """
    fixed_endpoint(endpoint)
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    socket = context.socket(zmq.DEALER)
    try:
        socket.setsockopt(zmq.IPV6, int("[" in endpoint))
        socket.connect(endpoint)
        socket.send(says.encode(says.List()))
        if not socket.poll(int(timeout_s * 1000)):
            return None
        answer = says.decode_answer(socket.recv())
        return answer if isinstance(answer, says.Listing) else None
    except msgspec.MsgspecError:
        return None  # something else answers there
    finally:
        context.destroy(linger=0)


def no_master(endpoint: str) -> MasterNotFound:
    """The error to raise when nobody answers at ``endpoint``."""
    return MasterNotFound(
        f"No NEP master answers at {endpoint}.",
        checklist=(
            "Start one in another terminal: nep master",
            "Is it at another place? Set NEP_MASTER to its endpoint.",
        ),
    )
