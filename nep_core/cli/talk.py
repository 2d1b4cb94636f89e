"""``nep send`` and ``nep launch``: take part in a network."""

from __future__ import annotations

import argparse
import contextlib
import itertools
import sys
import time
from collections.abc import Iterable, Iterator
from functools import partial
from queue import SimpleQueue
from typing import Any

import msgspec

from nep_core.cli.node import settings
from nep_core.errors import BadMessage, NodeNotFound, NodeStartError
from nep_core.places import NODES_VARIABLE
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.processes.manifest import Manifest
from nep_core.processes.node_log import log_file_name
from nep_core.processes.process import Outcome
from nep_core.wire.frames import CANNOT_DECODE
from nep_core.wire.messages import BY_TOPIC, NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber

from .console import count, end_undisturbed, join, many, number, remark, say, seconds, visible

FIRST_SUBSCRIBER_S = 0.5
FROM_INPUT = "-"
TOLD_OTHERWISE = ("alive", "ready", "stopped", "crashed")
"""States of which `nep launch` tells in its own words, or that come too often."""


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    add = parser.add_argument
    if name == "send":
        add("topic", metavar="TOPIC", help="such as /human_behavior")
        add("message", metavar="MESSAGE", help="""JSON; "-": each line of the standard input""")
        add("--text", action="store_true", help="send it as plain text, not as JSON")
        add("--unchecked", action="store_true", help="send it whatever NEP knows of the topic")
        rate = partial(number, least=0.001, most=10_000.0)
        add("--rate", type=rate, metavar="HZ", help="send it again and again, so often a second")
        add("--count", type=count, default=0, metavar="N", help="end after N messages")
        add(
            "--wait",
            type=seconds,
            default=FIRST_SUBSCRIBER_S,
            metavar="S",
            help="wait for a subscriber, S seconds at most (default %(default)s)",
        )
    else:
        add("type", metavar="TYPE", help="sensory, perceptual, cognitive or action")
        add("node", metavar="NODE", help="such as virtual_watch")
        add(
            "settings",
            nargs="*",
            default=[],  # else it would count among the arguments that are required
            metavar="setting=value",
            help="parameters of its manifest",
        )
        add("--name", default="", help="the node's name in the network (default: NODE)")


def run(options: argparse.Namespace) -> int:
    """Do what was asked for."""
    return _send(options) if options.command == "send" else _launch(options)


def _send(options: argparse.Namespace) -> int:
    messages = _messages(options)
    first = next(messages, None)  # a wrong one is told before the network is joined
    if first is None:
        remark("There was no message to send.")
        return 1
    with join(options) as network:
        publisher = Publisher(options.topic, network=network)
        publisher.wait_for_subscribers(1, options.wait)
        begin_s, sent = time.monotonic(), 0
        with contextlib.suppress(KeyboardInterrupt):
            for message in itertools.chain([first], messages):
                if options.rate:
                    time.sleep(max(0.0, begin_s + sent / options.rate - time.monotonic()))
                publisher.send(message)
                sent += 1
        say(f"Sent {many(sent, 'message')} to {many(publisher.subscribers(), 'subscriber')}.")
    return 0


def _messages(options: argparse.Namespace) -> Iterator[Any]:
    """The messages to send, as many as were asked for."""
    ready: Iterable[Any]
    if options.message == FROM_INPUT:
        ready = (_read(line.rstrip("\r\n"), options) for line in sys.stdin if line.strip())
    else:
        message = _read(options.message, options)
        ready = itertools.repeat(message) if options.rate or options.count else [message]
    return itertools.islice(ready, min(options.count, sys.maxsize) or None)


def _read(text: str, options: argparse.Namespace) -> Any:
    """A message as it will be sent; raises BadMessage that names what is wrong."""
    if options.text:
        return text
    try:
        message = msgspec.json.decode(text)
    except CANNOT_DECODE as error:
        raise BadMessage(
            "This is not JSON: {error}.",
            checklist=(
                """Write '{"key": "value"}', with the single quotes in this place.""",
                "Is it a plain text? Add --text.",
            ),
            error=error,
        ) from error
    kind = BY_TOPIC.get(options.topic)
    if kind is not None and not options.unchecked:
        _check(message, kind, options.topic)
    return msgspec.Raw(msgspec.json.encode(message))  # JSON also when it is a text in quotes


def _check(message: Any, kind: type[msgspec.Struct], topic: str) -> None:
    try:
        msgspec.convert(message, kind)
    except msgspec.ValidationError as error:
        fields = msgspec.structs.fields(kind)
        needed = [one.encode_name for one in fields if one.required]
        others = [one.encode_name for one in fields if not one.required]
        raise BadMessage(
            "This is no {name}, which {topic} carries: {error}.",
            checklist=(
                "It needs: {needed}.",
                "It may have: {others}.",
                "Send it all the same: add --unchecked.",
            ),
            name=kind.__name__,
            topic=topic,
            error=error,
            needed=", ".join(needed) or "nothing",
            others=", ".join(others) or "nothing more",
        ) from error
    if isinstance(message, dict):
        unknown = sorted(set(message) - {one.encode_name for one in msgspec.structs.fields(kind)})
        if unknown:
            remark(f"A {kind.__name__} has no {', '.join(unknown)}: receivers pass over it.")


def _launch(options: argparse.Namespace) -> int:
    endings: SimpleQueue[Outcome] = SimpleQueue()

    def on_end(launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if outcome.was_successful or launched.ready.is_set() or again:  # else wait_ready() tells
            log_file = launcher.logs / log_file_name(launched.name)
            log = "" if outcome.was_successful else f" Its log: {log_file}"
            say(f"{str(outcome.fault(again=again)).rstrip('.')}.{log}")
        if not again:
            endings.put(outcome)

    with (
        join(options) as network,
        Launcher(master=options.master, on_end=on_end) as launcher,
        end_undisturbed(),
    ):
        launcher.hear(network)
        manifest = _found(launcher, options)
        name = options.name or manifest.name
        tell = partial(_tell_state, name)
        Subscriber(NODE_STATE, NodeState, network=network, callback=tell)
        node = f"{options.type}/{options.node}"
        launched = launcher.launch(node, name, settings(options.settings))
        try:
            launched.wait_ready()
        except NodeStartError as error:
            log_file = launcher.logs / log_file_name(name)
            error.advise("Its log: {log_file}", log_file=str(log_file))
            raise
        if launched.ready.is_set():
            say(f"{launched.name} is ready. Ctrl-C stops it.")
        return 0 if endings.get().was_successful else 1


def _found(launcher: Launcher, options: argparse.Namespace) -> Manifest:
    try:
        return launcher.catalog.find(f"{options.type}/{options.node}")
    except NodeNotFound as error:
        error.advise(
            "Is it your own? Set {variable} to the folder in which {type}/ lies.",
            variable=NODES_VARIABLE,
            type=options.type,
        )
        raise


def _tell_state(name: str, state: NodeState) -> None:
    """Show a state of the node ``name``."""
    if state.node == name and state.event not in TOLD_OTHERWISE:
        told = visible(str(state.fault))
        about = f": {told}" if told else ""
        say(f"{visible(state.node)} is {state.event.replace('_', ' ')}{about}")
