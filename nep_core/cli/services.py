"""``nep master`` and ``nep broker``: the services of a network, in this process."""

from __future__ import annotations

import argparse
import select
import signal

from nep_core import lifeline
from nep_core.broker import Broker
from nep_core.io_thread import Wake
from nep_core.master import Master
from nep_core.node import STOP_SIGNALS

SIGNAL_S = 1.0
"""Windows runs a signal's handler between two waits only."""


def add_arguments(_name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    parser.add_argument("--endpoint", help="where, such as tcp://127.0.0.1:7100")


def run(options: argparse.Namespace) -> int:
    """Serve until stopped."""
    endpoint = options.endpoint or options.master
    stop = Wake()  # an Event could deadlock in a signal handler
    for number in STOP_SIGNALS:
        signal.signal(number, lambda *_: stop())
    lifeline.on_parent_end(stop)
    service = Master(endpoint) if options.command == "master" else Broker(options.endpoint)
    print(f"The NEP {options.command} serves at {service.endpoint}. Ctrl-C stops it.", flush=True)
    while not select.select([stop], [], [], SIGNAL_S)[0]:
        pass
    service.close()
    return 0


def run_master(arguments: list[str]) -> int:
    """``nep-studio master``: what a session starts, also when there is no ``nep`` command."""
    from nep_core.cli import main

    return main(["master", *arguments])
