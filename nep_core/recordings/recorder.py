"""Recording topics into an MCAP file, which Foxglove and PlotJuggler open, and playing it again."""

from __future__ import annotations

import logging
import os
import select
import stat
import threading
import time
from collections.abc import Callable, Collection, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from faults import reason_of
from nep_core.closing import Closing
from nep_core.errors import RecordingError
from nep_core.networks import transports
from nep_core.networks.master_client import Feed
from nep_core.networks.network import Network
from nep_core.networks.registry import Registration
from nep_core.networks.transports import topics_of
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.frames import Sendable
from nep_core.wire.io_thread import Wake
from nep_core.wire.messages import LATCHED, NODE_STATE
from nep_core.wire.pubsub import Publisher

from .file import Channel, Overview, Recording, channel_of, overview
from .raw import RawMessage, RawSubscriber, SteadyClock

log = logging.getLogger(__name__)

if TYPE_CHECKING:
    from mcap.writer import Writer


CHUNK_S = 0.5
"""A chunk is closed and brought to the disk so often: no more than this is lost in a power cut."""
CHUNK_BYTES = 1_000_000
TURN_S = 0.2
"""How often a quiet topic looks whether the recording is over."""
LAST_S = 1.0
"""How long what has come by then is still kept, in a flood that does not end."""
SEQUENCES = 2**32
"""MCAP counts messages with 32 bits."""


class _Output:
    """A file whose every write reaches the system, and which knows where it was last whole."""

    def __init__(self, path: Path, replace: bool) -> None:
        self._file = path.open("wb" if replace else "xb", buffering=0)
        self._is_on_disk = stat.S_ISREG(os.fstat(self._file.fileno()).st_mode)
        self.whole = 0

    def write(self, data: bytes) -> int:
        """Write all of it; raises OSError."""
        left = memoryview(data)
        while left:
            left = left[self._file.write(left) or 0 :]
        return len(data)

    def tell(self) -> int:
        """How many bytes there are."""
        return self._file.tell()

    def flush(self) -> None:
        """Note that the file is whole up to here."""
        self.whole = self._file.tell()

    def sync(self) -> None:
        """Bring it to the disk, where there is one: /dev/null has none."""
        if self._is_on_disk:
            os.fsync(self._file.fileno())

    def cut(self) -> None:
        """Drop what is behind the last whole chunk."""
        if self._is_on_disk:
            self._file.truncate(self.whole)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


@dataclass
class Totals:
    """How much was recorded; ``topics`` counts messages."""

    messages: int = 0
    payload_bytes: int = 0
    topics: dict[str, int] = field(default_factory=dict)


class Recorder(Closing):
    """Records the topics that are added, until it is closed; raises RecordingError.

    An existing file is kept unless ``replace``. When the file cannot grow any more, ``failure``
    says so, ``is_over`` is True, and what was recorded before stays readable.
    """

    def __init__(
        self, path: str | os.PathLike[str], *, network: Network, replace: bool = False
    ) -> None:
        from mcap.writer import Writer

        self.path = Path(path)
        self.totals = Totals()
        self.failure: RecordingError | None = None
        self._ended = threading.Event()
        self._network = network
        self._clock = SteadyClock()
        self._lock = threading.Lock()
        self._channels: dict[Channel, int] = {}
        self._schemas: dict[str, int] = {"": 0}
        self._subscribers: dict[str, RawSubscriber] = {}
        self._threads: list[threading.Thread] = []
        self._feed: Feed | None = None
        try:
            self._output = _Output(self.path, replace)
        except OSError as error:
            raise _cannot_open(self.path, error) from error
        self._writer: Writer = Writer(self._output, chunk_size=CHUNK_BYTES)  # type: ignore[arg-type]
        self._do(self._writer.start, "", "nep")
        self._do(self._output.flush)
        self._start(self._keep_on_disk, "nep-record")

    @property
    def is_over(self) -> bool:
        """Whether nothing more is recorded."""
        return self._ended.is_set()

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive."""
        there = list(self._subscribers.values())  # topics may come meanwhile, in another thread
        return sum(subscriber.lost for subscriber in there)

    @property
    def file_bytes(self) -> int:
        """How large the file is, up to its last whole chunk."""
        return self._output.whole

    def add(self, topics: Iterable[str]) -> None:
        """Record these topics too, whether somebody publishes them yet or not."""
        for topic in topics:
            if topic in self._subscribers or self._ended.is_set():
                continue
            subscriber = RawSubscriber(topic, network=self._network, clock=self._clock)
            self._subscribers[topic] = subscriber
            self._start(partial(self._record, subscriber), f"nep-record-{topic}")

    def follow(self, master: str | None = None, *, without: Collection[str] = ()) -> None:
        """Record every topic of the project's network, also those that appear later."""

        def add(told: list[Registration]) -> None:
            self.add(ends.topic for ends in topics_of(told) if ends.topic not in without)

        add(transports.registrations(master))
        self._feed = transports.follow(add, master)

    def close(self) -> None:
        """Record no more and finish the file; raises RecordingError when it could not be kept."""
        self._ended.set()
        if self._feed is not None:
            self._feed.close()
        for thread in self._threads:
            thread.join()
        for subscriber in self._subscribers.values():
            subscriber.close()
        if self.failure is None:
            self._do(self._finish)
        self._output.close()
        if self.failure is not None:
            raise self.failure

    def _start(self, work: Callable[[], None], name: str) -> None:
        thread = threading.Thread(target=work, name=name, daemon=True)
        self._threads.append(thread)
        thread.start()

    def _record(self, subscriber: RawSubscriber) -> None:
        while not (self._ended.is_set() or subscriber.closed):
            try:
                self._keep_next(subscriber, TURN_S)
            except Exception:  # one message that cannot be kept is not the end of a topic
                log.exception("%s: a message is not recorded", subscriber.topic)
                self._ended.wait(TURN_S)
        end_s = time.monotonic() + LAST_S
        while self._keep_next(subscriber, 0.0) and time.monotonic() < end_s:
            pass

    def _keep_next(self, subscriber: RawSubscriber, timeout_s: float) -> bool:
        message = subscriber.receive(timeout_s)
        if message is not None:
            self._do(self._keep, message)
        return message is not None

    def _keep(self, message: RawMessage) -> None:
        channel, data = channel_of(message)
        if channel not in self._channels:
            name, schema = channel.schema
            if name not in self._schemas:
                self._schemas[name] = self._writer.register_schema(name, "jsonschema", schema)
            self._channels[channel] = self._writer.register_channel(
                channel.topic, channel.message_encoding, self._schemas[name], channel.metadata
            )
        number = self._channels[channel]
        sent_ns, sequence = max(0, message.sent_ns), message.sequence % SEQUENCES
        self._writer.add_message(number, message.arrived_ns, data, sent_ns, sequence)
        self.totals.messages += 1
        self.totals.payload_bytes += len(message.payload)
        self.totals.topics[message.topic] = self.totals.topics.get(message.topic, 0) + 1

    def _keep_on_disk(self) -> None:
        kept = 0
        while not self._ended.wait(CHUNK_S):
            if self.totals.messages > kept:
                kept = self.totals.messages
                self._do(self._writer.flush)
                self._do(self._output.sync)

    def _finish(self) -> None:
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._output.flush()
        self._output.sync()

    def _do(self, step: Callable[..., object], *words: object) -> None:
        """Work on the file; when that fails, keep what is whole and end the recording."""
        with self._lock:
            if self.failure is not None:
                return
            try:
                step(*words)
            except OSError as error:
                self.failure = _cannot_write(self.path, error, self._output.whole)
                self._ended.set()
                self._output.cut()


def _cannot_open(path: Path, error: OSError) -> RecordingError:
    if isinstance(error, FileExistsError):
        return RecordingError(
            "{path} is there already, and it is kept.",
            checklist=("Choose another name.", "Or let it be replaced: add --force."),
            path=path,
        )
    return RecordingError(
        "{path} cannot be written: {reason}.",
        checklist=("Is there such a folder?", "May you write into it?"),
        details=str(error),
        path=path,
        reason=reason_of(error),
    )


def _cannot_write(path: Path, error: OSError, kept: int) -> RecordingError:
    return RecordingError(
        "The recording ended because {path} cannot grow: {reason}. What was recorded before is "
        "kept: {kept} bytes.",
        checklist=("Make room on the disk, or record to another one.", "Record fewer topics."),
        details=str(error),
        path=path,
        reason=reason_of(error),
        kept=kept,
    )


Join = Callable[[str], Network]

LOOK_S = 0.1
"""How often a wait for subscribers looks whether it should end."""
SHORTEST_ROUND_S = 0.1
"""A recording of a single message, played in a loop, must not become a flood."""


class Player(Closing):
    """Plays a recording on a network that it joins by ``join``; raises RecordingError.

    ``speed`` 2 is twice as fast. Only ``topics`` are played (None: all), between ``from_s`` and
    ``to_s`` of the recording. ``prefix`` goes before every topic. What nodes told about
    themselves (``/node_state``) is played only with ``node_states``: those nodes do not run.

    ``path`` is the recording's file.
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
            if left_s > 0:
                select.select([self._stopped], [], [], left_s)
            if self.is_stopping:
                break
            self._send(message)
            last_s = max(last_s, due_s)
        return last_s

    def _send(self, message: RawMessage) -> None:
        again: Sendable = message.payload
        if message.encoding == "text":
            try:
                again = message.payload.decode()
            except UnicodeDecodeError:
                log.warning("%s: a text that is not UTF-8 is not played", message.topic)
                return
        elif message.encoding != "bytes":
            again = msgspec.Raw(message.payload)  # goes out as it is
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
