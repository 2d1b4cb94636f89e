"""Playing a recording: its messages go out again on their topics, in their true timing."""

from __future__ import annotations

import os
import select
import time
from collections.abc import Callable, Collection
from contextlib import ExitStack

import msgspec

from nep_core.errors import RecordingError
from nep_core.networks.network import Network
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.recordings.file import Overview, Recording, overview, read_recording
from nep_core.recordings.raw import RawMessage
from nep_core.wire.frames import Sendable
from nep_core.wire.io_thread import Wake
from nep_core.wire.messages import LATCHED, NODE_STATE
from nep_core.wire.pubsub import Publisher

__all__ = ["Overview", "Player", "Recording", "overview", "read_recording"]

Join = Callable[[str], Network]

LOOK_S = 0.1
"""How often a wait for subscribers looks whether it should end."""
SHORTEST_ROUND_S = 0.1
"""A recording of a single message, played in a loop, must not become a flood."""


class Player:
    """Plays a recording on a network that it joins by ``join``; raises RecordingError.

    ``speed`` 2 is twice as fast. Only ``topics`` are played (None: all), between ``from_s`` and
    ``to_s`` of the recording. ``prefix`` goes before every topic. What nodes told about
    themselves (``/node_state``) is played only with ``node_states``: those nodes do not run.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        join: Join = PeerNetwork,
        speed: float = 1.0,
        from_s: float = 0.0,
        to_s: float | None = None,
        topics: Collection[str] | None = None,
        prefix: str = "",
        node_states: bool = False,
    ) -> None:
        self.overview = overview(path)
        self.sent = 0
        self.unplayable = 0
        self._recording = Recording(path)
        self._speed = speed
        self._start_ns = self.overview.start_ns + round(from_s * 1e9)
        self._end_ns = None if to_s is None else self.overview.start_ns + round(to_s * 1e9)
        self._prefix = prefix
        self.topics = _chosen(self.overview, topics, node_states)
        self.is_stopping = False
        self._stopped = Wake()  # an Event could deadlock in a signal handler
        self._join = join
        self._networks: dict[str, Network] = {}
        self._publishers: dict[tuple[str, bool], Publisher] = {}
        self._leaving = ExitStack()
        try:
            self._open_publishers()
        except BaseException:
            self._leaving.close()
            raise

    def play(self, *, loop: bool = False) -> None:
        """Send everything at its time, again and again with ``loop``; returns early on stop()."""
        begin_s = time.monotonic()
        while not self.is_stopping:
            before = self.sent
            last_s = self._play_once(begin_s)
            if not loop or self.sent == before:
                return
            begin_s = max(last_s, begin_s + SHORTEST_ROUND_S)

    def wait_for_subscribers(self, timeout_s: float) -> bool:
        """Wait until somebody hears each topic; False when the time is over, or on stop()."""
        end_s = time.monotonic() + timeout_s
        for publisher in self._publishers.values():
            while not publisher.wait_for_subscribers(1, min(LOOK_S, timeout_s)):
                if self.is_stopping or time.monotonic() >= end_s:
                    return False
        return True

    def stop(self) -> None:
        """End play() at once; safe in a signal handler and from any thread."""
        self.is_stopping = True
        self._stopped()

    def close(self) -> None:
        """Leave the network."""
        self.stop()
        self._leaving.close()

    def __enter__(self) -> Player:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _play_once(self, begin_s: float) -> float:
        """Play from ``begin_s`` of the monotonic clock on; the time when it should end."""
        last_s = begin_s
        for message in self._recording:
            if message.topic not in self.topics or message.arrived_ns < self._start_ns:
                continue
            if self._end_ns is not None and message.arrived_ns > self._end_ns:
                continue
            due_s = begin_s + (message.arrived_ns - self._start_ns) / 1e9 / self._speed
            left_s = due_s - time.monotonic()
            if self.is_stopping or (left_s > 0 and self._waits(left_s)):
                break
            self._send(message)
            last_s = max(last_s, due_s)
        return last_s

    def _waits(self, wait_s: float) -> bool:
        """Wait so long; True when it was stopped meanwhile."""
        return bool(select.select([self._stopped], [], [], wait_s)[0])

    def _send(self, message: RawMessage) -> None:
        try:
            again = _as_it_was(message)
        except UnicodeDecodeError:
            self.unplayable += 1
            return
        self._publishers[message.topic, message.encoding == "msgpack"].send(again)
        self.sent += 1

    def _open_publishers(self) -> None:
        """A publisher has one encoding; a topic with more gets a second one on its own network."""
        for topic in sorted(self.topics):
            encodings = self.overview.topics[topic].encodings
            for is_msgpack in sorted({encoding == "msgpack" for encoding in encodings}):
                name = "-msgpack" if is_msgpack and len(encodings) > 1 else ""
                self._publishers[topic, is_msgpack] = Publisher(
                    self._prefix + topic,
                    network=self._network(name),
                    encoding="msgpack" if is_msgpack else None,
                    latched=topic in LATCHED,
                )

    def _network(self, name: str) -> Network:
        if name not in self._networks:
            network = self._join(f"play-{os.getpid()}{name}")
            self._leaving.callback(network.close)
            self._networks[name] = network
        return self._networks[name]


def _chosen(told: Overview, topics: Collection[str] | None, node_states: bool) -> set[str]:
    there = set(told.topics)
    if topics is None:
        return there if node_states else there - {NODE_STATE}
    if missing := sorted(set(topics) - there):
        raise RecordingError(
            "The recording has nothing of {missing}.",
            checklist=("It has: {sorted}.",),
            missing=", ".join(missing),
            sorted=", ".join(sorted(there)) or "no messages",
        )
    return set(topics)


def _as_it_was(message: RawMessage) -> Sendable:
    """What to send so that the same bytes go out; raises UnicodeDecodeError."""
    if message.encoding == "text":
        return message.payload.decode()
    if message.encoding == "bytes":
        return message.payload
    return msgspec.Raw(message.payload)  # goes out as it is
