"""How a command finds the network, and takes part in it."""

from __future__ import annotations

import _thread
import argparse
import difflib
import os
import signal
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from nep_core import transports
from nep_core.endpoints import master_endpoint
from nep_core.network import Network
from nep_core.registry import Registration
from nep_core.topics import topics_of


def endpoint_of(options: argparse.Namespace) -> str:
    """Where the master is: --master, else NEP_MASTER, else port 7100. NetworkError."""
    return options.master or master_endpoint()


def join(options: argparse.Namespace, name: str = "") -> Network:
    """Take part in the network as ``name`` (default: the command and its process)."""
    name = name or f"nep-{options.command}-{os.getpid()}"
    network = transports.network_for(name, master=options.master)
    network.on_stop = _end_as_by_ctrl_c
    return network


def _end_as_by_ctrl_c() -> None:
    """``nep kill`` ends a command too, also one that waits: a recording is finished."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:
        _thread.interrupt_main()


@contextmanager
def end_undisturbed() -> Iterator[None]:
    """Last in a ``with``: a second Ctrl-C does not interrupt how the others are closed.

    The interrupt would leave a socket open for which ZeroMQ waits; run_command() takes it back.
    """
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.SIG_IGN)


def registrations(options: argparse.Namespace) -> list[Registration]:
    """Who is there; raises MasterNotFound."""
    return transports.registrations(options.master)


def near(word: str, known: Iterable[str]) -> list[str]:
    """The known words that a person may have meant, the nearest first."""
    names = {name.strip("/").casefold(): name for name in sorted(known)}
    found = difflib.get_close_matches(word.strip("/").casefold(), names, n=3, cutoff=0.6)
    return [names[name] for name in found]


def about_nobody(topic: str, told: list[Registration]) -> str:
    """A sentence when nobody publishes ``topic``, with names that are near; "" when one does."""
    published = {ends.topic for ends in topics_of(told) if ends.publishers}
    if topic in published:
        return ""
    others = near(topic, published)
    meant = f" Did you mean {' or '.join(others)}?" if others else ""
    return f"Nobody publishes {topic} yet; it is waited for. Ctrl-C ends.{meant}"
