"""``nep kill NODE``: ask a node to stop, see that it is gone, and with --force end it."""

from __future__ import annotations

import argparse
import contextlib
import os
import socket
import time

import psutil

from nep_core.errors import NodeNotFound, NodeStopError
from nep_core.networks.registry import Registration
from nep_core.networks.transports import ask_to_stop
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher

from .console import join, near, registrations, say, seconds

STOP_S = 3.0
LOOK_S = 0.05
KILLED_S = 2.0


def add_arguments(_name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    parser.add_argument("node", metavar="NODE", help="its name, as `nep nodes` shows it")
    parser.add_argument(
        "--seconds",
        type=seconds,
        default=STOP_S,
        metavar="S",
        help="how long it may take to stop (default %(default)s)",
    )
    parser.add_argument(
        "--force", action="store_true", help="end its process when it does not stop in time"
    )


def run(options: argparse.Namespace) -> int:
    """Ask, wait, and end it if that was asked for; raises NodeNotFound, NodeStopError."""
    told = _find(options)
    process = process_of(told)
    ask_to_stop(told.node, options.master)
    if _wait(options, told, process):
        say(f"{told.node} has stopped.")
        return 0
    if not options.force:
        raise NodeStopError(
            "{node} did not stop within {seconds} s.",
            checklist=(
                "Wait longer: nep kill {node} --seconds 30",
                "End its process: nep kill {node} --force",
            ),
            node=told.node,
            seconds=f"{options.seconds:g}",
        )
    _end(options, told, process)
    say(f"{told.node} did not stop; its process {told.pid} was ended.")
    return 0


def process_of(told: Registration) -> psutil.Process | None:
    """The process that a registration tells of: on this computer, and listening where it says.

    None when that cannot be seen: a number that another process has got by now is never touched.
    """
    if told.host != socket.gethostname() or told.pid == os.getpid():
        return None
    with contextlib.suppress(psutil.Error):
        process = psutil.Process(told.pid)
        return process if _listens(process, told) else None
    return None


def _listens(process: psutil.Process, told: Registration) -> bool:
    """Whether the node is still there: its program may go on when it has left the network."""
    port = told.endpoint.rpartition(":")[2]
    with contextlib.suppress(psutil.Error, OSError):
        return any(
            one.status == psutil.CONN_LISTEN and str(one.laddr.port) == port
            for one in process.net_connections("tcp")
        )
    return False


def _find(options: argparse.Namespace) -> Registration:
    there = {told.node: told for told in registrations(options)}
    if options.node not in there:
        others = near(options.node, there) or sorted(there)
        raise NodeNotFound(
            'No node "{node}" is running.',
            checklist=("These are: {others}.", "See them all: nep nodes"),
            node=options.node,
            others=", ".join(others) or "none",
        )
    return there[options.node]


def _wait(options: argparse.Namespace, told: Registration, process: psutil.Process | None) -> bool:
    """Wait until its name is gone at the master, and it no longer listens where we see that.

    The master drops a frozen node too, which is not gone at all.
    """
    end_s = time.monotonic() + options.seconds
    while True:
        there = {one.instance for one in registrations(options)}
        if told.instance not in there and not (process and _listens(process, told)):
            return True
        if time.monotonic() >= end_s:
            return False
        time.sleep(LOOK_S)


def _end(options: argparse.Namespace, told: Registration, process: psutil.Process | None) -> None:
    if process is None:
        raise NodeStopError(
            "{node} did not stop, and its process {pid} on {host} cannot be ended from here.",
            checklist=(
                "Run nep kill on {host}, as the user who started it.",
                "Is it gone by now? See: nep nodes",
            ),
            node=told.node,
            pid=told.pid,
            host=told.host,
        )
    _tell_launcher(options, told)
    try:
        process.kill()
        process.wait(KILLED_S)
    except psutil.NoSuchProcess:
        pass
    except psutil.Error as error:
        raise NodeStopError(
            "The process {pid} of {node} could not be ended.",
            checklist=("Run nep kill as the user who started it.",),
            details=str(error),
            pid=told.pid,
            node=told.node,
        ) from error


def _tell_launcher(options: argparse.Namespace, told: Registration) -> None:
    """Say that the node is ended on purpose: else who launched it starts it again."""
    with join(options) as network:
        Publisher(NODE_STATE, network=network).send(
            NodeState(
                node=told.node,
                type="cognitive",  # which of the four it is cannot be seen from here
                event="stopped",
                description="It was ended by nep kill.",
                pid=told.pid,
                host=told.host,
            )
        )
