"""``nep master`` and ``nep broker``: the services of a network, in this process."""

from __future__ import annotations

import argparse
import os
import select
import signal
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from nep_core.errors import NetworkError
from nep_core.networks.endpoints import NETWORK_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.security import KEYS_VARIABLE
from nep_core.networks.security.opening import ServiceVoice
from nep_core.networks.transports import transport
from nep_core.networks.zenoh_session import ZenohRouter
from nep_core.networks.zmq_networks import Broker, BrokerNetwork, PeerNetwork
from nep_core.places import cache_folder
from nep_core.processes import lifeline
from nep_core.processes.node import STOP_SIGNALS
from nep_core.wire.io_thread import Wake

from .console import OWN

if TYPE_CHECKING:
    from nep_core.networks.gateway.gateway import Gateway


# The options of ``nep broker``, which is a zenoh router if that is asked for.


def add_router_arguments(parser: argparse.ArgumentParser) -> None:
    """Say which options the router has."""
    parser.add_argument(
        "--zenoh", action="store_true", help="run a zenoh router instead (for NEP_NETWORK=zenoh)"
    )
    parser.add_argument(
        "--listen",
        action="append",
        default=[],
        metavar="ENDPOINT",
        help="with --zenoh: where, such as tcp/127.0.0.1:7447 or tls/0.0.0.0:7447",
    )
    parser.add_argument(
        "--connect",
        action="append",
        default=[],
        metavar="ENDPOINT",
        help="with --zenoh: the router of another site, such as tls/site.example:7447",
    )
    parser.add_argument(
        "--private",
        action="store_true",
        help="with --zenoh: --listen is in a network that only your own computers can read",
    )


def broker_for(options: argparse.Namespace) -> Broker | ZenohRouter:
    """The service that the options ask for; raises NetworkError when they do not fit together."""
    if not options.zenoh and (options.listen or options.connect or options.private):
        raise NetworkError(
            "--listen, --connect and --private are for a zenoh router.",
            checklist=("Add --zenoh.", "Or say where the broker serves: --endpoint"),
        )
    if not options.zenoh:
        return Broker(options.endpoint)
    if options.endpoint or options.keys:
        raise NetworkError(
            "--endpoint and --keys are for a NEP broker, not for a zenoh router.",
            checklist=("Say where it serves: --listen tcp/127.0.0.1:7447",),
        )
    return ZenohRouter(options.listen, options.connect, is_private=options.private)


SIGNAL_S = 1.0
"""Windows runs a signal's handler between two waits only."""
ORIGINAL_VARIABLE = "NEP_ORIGINAL"
"""1: a session's master lets programs of the original NEP join too; 0: ``nep master`` does not."""


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    port = 7100 if name == "master" else 7110
    parser.add_argument("--endpoint", help=f"where, such as tcp://127.0.0.1:{port}")
    parser.add_argument(
        "--keys",
        type=Path,
        metavar="FILE",
        help="the key file of a network that is open to other computers (see: nep open)",
    )
    if name == "master":
        parser.add_argument(
            "--original",
            action=argparse.BooleanOptionalAction,
            default=os.environ.get(ORIGINAL_VARIABLE) != "0",
            help="let programs of the original NEP on this computer join (ports 7000 and 50000)",
        )
        parser.add_argument(OWN, action="store_true", help=argparse.SUPPRESS)
    else:
        add_router_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Serve until stopped."""
    is_master = options.command == "master"
    if is_master:
        _require_p2p()
    endpoint = options.endpoint or (options.master if is_master else None)
    if options.keys is not None:
        os.environ[KEYS_VARIABLE] = str(options.keys.absolute())
    service = Master(endpoint, is_shared=not options.own) if is_master else broker_for(options)
    name = "zenoh router" if isinstance(service, ZenohRouter) else f"NEP {options.command}"
    gateway = _gateway(service.endpoint) if is_master and options.original else None
    try:
        return serve(
            service,
            lambda: print(f"The {name} serves at {service.endpoint}. Ctrl-C stops it.", flush=True),
            gateway.close if gateway else lambda: None,
        )
    finally:
        service.close()


def _require_p2p() -> None:
    """Raise NetworkError when programs that are started here would not ask a master."""
    if (kind := transport()) != "p2p":
        service = "nep broker" if kind == "broker" else "nep broker --zenoh"
        raise NetworkError(
            "{network_variable} is {kind}: programs of that network ask no NEP master.",
            checklist=(
                "Run the service of that network: {service}",
                "Or take the variable {network_variable} away, here and for all programs.",
            ),
            network_variable=NETWORK_VARIABLE,
            kind=kind,
            service=service,
        )


def serve(
    service: Master | Broker | ZenohRouter,
    begin: Callable[[], None],
    end: Callable[[], None] = lambda: None,
) -> int:
    """Wait for Ctrl-C, SIGTERM or the parent's end, and tell of peers that are refused meanwhile.

    ``begin`` is called when these are heard, ``end`` while the service is still there.
    """
    stop = Wake()  # an Event could deadlock in a signal handler
    for number in STOP_SIGNALS:
        signal.signal(number, lambda *_: stop())
    lifeline.on_parent_end(stop)
    place = service.endpoint
    if isinstance(service, Master):
        voice = ServiceVoice("master", lambda: PeerNetwork("master", master=place))
    else:
        voice = ServiceVoice("broker", lambda: BrokerNetwork(place, node="broker"))
    begin()
    while not select.select([stop], [], [], SIGNAL_S)[0]:
        if warning := service.take_warning():
            voice.warn(warning)
    end()
    voice.close()
    return 0


def run_master(arguments: list[str]) -> int:
    """``nep-studio master``: what a session starts, also when there is no ``nep`` command."""
    from nep_core.cli import main

    is_wanted = os.environ.get(ORIGINAL_VARIABLE) == "1"
    return main(["master", "--original" if is_wanted else "--no-original", *arguments])


def _gateway(master: str) -> Gateway | None:
    """What lets programs of the original NEP join; the master goes on without it too."""
    from nep_core.networks.gateway.gateway import Gateway

    try:
        gateway = Gateway(master, memory=cache_folder() / "original-nep.json")
    except NetworkError as error:
        print(f"Programs of the original NEP cannot join. {error.sentence}", flush=True)
        return None
    for trouble in gateway.troubles:
        print(trouble, flush=True)
    return gateway
