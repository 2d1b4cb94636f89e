"""The options of ``nep broker``, which is a zenoh router if that is asked for."""

from __future__ import annotations

import argparse

from nep_core.broker import Broker
from nep_core.errors import NetworkError
from nep_core.over_zenoh.router import ZenohRouter


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
