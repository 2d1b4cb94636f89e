"""``nep send`` and ``nep launch``: take part in a network."""

from __future__ import annotations

import argparse
from queue import SimpleQueue

import msgspec

from nep_core.cli.node import settings
from nep_core.errors import BadMessage
from nep_core.launcher import LaunchedNode, Launcher
from nep_core.outcome import Outcome
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher

FIRST_SUBSCRIBER_S = 0.5


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    if name == "send":
        parser.add_argument("topic", help="such as /human_behavior")
        parser.add_argument("json", help="""such as '{"human_state": "happy"}'""")
    else:
        parser.add_argument("type", help="sensory, perceptual, cognitive or action")
        parser.add_argument("name", help="the node, such as virtual_watch")
        parser.add_argument("settings", nargs="*", metavar="setting=value")


def run(options: argparse.Namespace) -> int:
    """Do what was asked for."""
    return _send(options) if options.command == "send" else _launch(options)


def _send(options: argparse.Namespace) -> int:
    try:
        message = msgspec.json.decode(options.json)
    except msgspec.MsgspecError as error:
        raise BadMessage(
            f"This is not JSON: {error}.", checklist=("""Write '{"key": "value"}'.""",)
        ) from error
    with PeerNetwork(master=options.master) as network:
        publisher = Publisher(options.topic, network=network)
        publisher.wait_for_subscribers(1, FIRST_SUBSCRIBER_S)
        publisher.send(message)
        print(f"Sent to {publisher.subscribers()} subscribers.")
    return 0


def _launch(options: argparse.Namespace) -> int:
    endings: SimpleQueue[Outcome] = SimpleQueue()

    def told(_launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        print(f"{outcome}{'; it is started again' if again else ''}.", flush=True)
        if not again:
            endings.put(outcome)

    with (
        PeerNetwork(master=options.master) as network,
        Launcher(master=network.master, on_end=told) as launcher,
    ):
        launcher.hear(network)
        launched = launcher.launch(
            f"{options.type}/{options.name}", parameters=settings(options.settings)
        )
        launched.wait_ready()
        if launched.ready.is_set():
            print(f"{launched.name} is ready. Ctrl-C stops it.", flush=True)
        return 0 if endings.get().was_successful else 1
