"""The master of a session: one that is there for all programs, or one that it starts for itself."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterable

from nep_core.cli.arguments import OWN
from nep_core.endpoints import master_endpoint
from nep_core.errors import NodeStartError
from nep_core.launcher import LaunchedNode, Launcher
from nep_core.master_probe import ask_master
from nep_core.process import ON_WINDOWS, program_command
from nep_studio.signals import postponed

MASTER = "master"
READY_S = 10.0
TRIES = 5
LOOK_S = 0.5
"""How long a master may take that is there for all programs."""


def start_master(launcher: Launcher, wanted: str | None = None, options: Iterable[str] = ()) -> str:
    """Start a master at ``wanted``, or where there is room, with these options; its endpoint.

    Another program may take the port at the same moment, so several are tried. Raises
    NodeStartError.
    """
    endpoint, lines = "", list[str]()
    for _ in range(1 if wanted else TRIES):
        endpoint = wanted or free_endpoint(master_endpoint())
        command = program_command(MASTER, "--endpoint", endpoint, OWN, *options)
        with postponed():
            launched = launcher.start_command(MASTER, command)
        if is_up(launched, endpoint):
            return endpoint
        launcher.stop(MASTER)
        lines = launched.process.last_lines if launched.process else []
    raise NodeStartError(
        f"The NEP master did not start at {endpoint}.",
        checklist=("Is another program using that port?", "Try again."),
        details="\n".join(lines),
    )


def shared_master(studio: str) -> str:
    """The endpoint of a master that somebody runs for all programs of this computer, else "".

    Nor is one joined that has a session already (a program named ``studio``): two sessions at once
    do not disturb each other.
    """
    endpoint = master_endpoint()
    if free_endpoint(endpoint) == endpoint:
        return ""
    listing = ask_master(endpoint, timeout_s=LOOK_S)
    if listing is None or any(told.node == studio for told in listing.registrations):
        return ""
    return endpoint if listing.shared else ""


def is_up(launched: LaunchedNode, endpoint: str) -> bool:
    """Whether the master that answers is ours: another session may have been quicker."""
    deadline = time.monotonic() + READY_S
    while time.monotonic() < deadline and not launched.ended.is_set():
        listing = ask_master(endpoint, timeout_s=0.1)
        if listing is not None and launched.owns(listing.pid):
            return True
    return False


def free_endpoint(wanted: str) -> str:
    """``wanted`` if it is free, else a free port: of its address, or of this computer."""
    host, _, port = wanted.removeprefix("tcp://").rpartition(":")
    with socket.socket() as probe:
        if not ON_WINDOWS:  # there it would let two programs have one port
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        for place in ((host, int(port)), (host, 0)):
            with contextlib.suppress(OSError):  # in use, or no address of this computer
                probe.bind(place)
                break
        else:
            probe.bind(("127.0.0.1", 0))
        address, free_port = probe.getsockname()
    return f"tcp://{address}:{free_port}"
