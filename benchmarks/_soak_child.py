"""A program of the soak: ``publisher|subscriber NAME RUN MASTER FOLDER TOPIC...``.

It writes down all that it does, line by line and before it does it, so that nothing of that is
lost when it is killed. _soak_account.py reads it.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import msgspec

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber

TICK_S = 0.02
BURST_TICKS, BURST = 50, 50
"""Once a second a flood, whose messages share frames."""
DEAF_TO = 200
"""A deaf subscriber, the planted fault, misses every so many-th message."""


class Numbered(msgspec.Struct):
    """A message: which publisher of which run sent it, and its number."""

    source: str
    number: int


def main(role: str, name: str, run: str, master: str, folder: str, *topics: str) -> None:
    """Work until SIGTERM."""
    ending = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ending.set())
    with PeerNetwork(name, master=master) as network:
        write = [diary(Path(folder), role, f"{name}.{run}.{i}") for i in range(len(topics))]
        if role == "publisher":
            publish(network, topics, f"{name}.{run}", write, ending)
        else:
            hear(network, topics, write, ending, is_deaf=role == "deaf")


def diary(folder: Path, role: str, name: str) -> Callable[[str], object]:
    """A function that writes a line, which outlives this process."""
    kind = "sent" if role == "publisher" else "heard"
    file = os.open(folder / f"{name}.{kind}", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    return lambda line: os.write(file, f"{line}\n".encode())


def publish(
    network: PeerNetwork,
    topics: tuple[str, ...],
    source: str,
    write: list[Callable[[str], object]],
    ending: threading.Event,
) -> None:
    """Send numbered messages; write down each, and who heard the topic when it was sent."""
    publishers = [Publisher(topic, network=network) for topic in topics]
    numbers = [0] * len(topics)
    heard: list[set[str]] = [set() for _ in topics]
    for i, topic in enumerate(topics):
        write[i](f"topic {topic} {source}.{i}")
    print("ready", flush=True)
    tick = 0
    while not ending.wait(TICK_S):
        tick += 1
        for i, publisher in enumerate(publishers):
            for _ in range(BURST if tick % BURST_TICKS == 0 else 1):
                now = network.outbox.subscribers(publisher.topic)
                if now != heard[i]:
                    heard[i] = now
                    write[i](f"heard {' '.join(sorted(now))}")
                numbers[i] += 1
                write[i](f"send {numbers[i]} {time.monotonic():.4f}")
                publisher.send(Numbered(f"{source}.{i}", numbers[i]))


def hear(
    network: PeerNetwork,
    topics: tuple[str, ...],
    write: list[Callable[[str], object]],
    ending: threading.Event,
    *,
    is_deaf: bool,
) -> None:
    """Write down what comes, each subscriber in a thread of its own."""
    for i, topic in enumerate(topics):
        subscriber = Subscriber(topic, Numbered, network=network)
        write[i](f"id {subscriber._id} {topic}")
        work = (subscriber, write[i], is_deaf)
        threading.Thread(target=write_down, args=work, daemon=True).start()
    print("ready", flush=True)
    ending.wait()
    for one in write:
        one(f"end {time.monotonic():.4f}")


def write_down(
    subscriber: Subscriber[Numbered], write: Callable[[str], object], is_deaf: bool
) -> None:
    """One line a message."""
    for message in subscriber:
        if not (is_deaf and message.number % DEAF_TO == 0):
            write(f"got {message.source} {message.number}")


if __name__ == "__main__":
    main(*sys.argv[1:])
