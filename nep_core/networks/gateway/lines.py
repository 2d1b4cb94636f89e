"""The ports of each topic, and the programs of the original that were sent there.

A line is a pair of ports. In the mode many2many programs publish to the first and hear the
second. In the other modes one side binds by itself, so a line serves one side, and the gateway
stands between: whoever binds gets a line of its own, so that a second one is no trouble.
"""

from __future__ import annotations

import contextlib
import logging
import os
import queue
import socket as sockets
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec
import psutil
import zmq

from faults.files import content, whole_file
from nep_core.errors import BadMessage, MasterNotFound, NameTaken, NetworkError, PortTaken
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.frames import CANNOT_DECODE
from nep_core.wire.pubsub import Publisher, Subscriber

from .doors import (
    MOST_WAITING_BYTES,
    Context,
    Door,
    Request,
    Shape,
    Warner,
    Watch,
    WayIn,
    WayOut,
)

log = logging.getLogger(__name__)


# How many lines of the original's programs this process can serve: each takes several files.

FILES_A_LINE = 16
"""Sockets, their wakers and monitors, and a few connections."""
FILES_OF_OTHERS = 128
WANTED_FILES = 8192


def lines_allowed() -> int:
    """How many lines there may be; first asks the system for room."""
    if sys.platform == "win32":
        return WANTED_FILES // FILES_A_LINE
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = WANTED_FILES if hard == resource.RLIM_INFINITY else min(WANTED_FILES, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        with contextlib.suppress(OSError, ValueError):  # macOS has a further limit of its own
            resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
            soft = wanted
    files = WANTED_FILES if soft == resource.RLIM_INFINITY else min(soft, WANTED_FILES)
    return max(1, (files - FILES_OF_OTHERS) // FILES_A_LINE)


# Which program was sent to which port, in a file: programs of the original ask only once.
#
# A gateway that is started anew opens the same ports again, and they go on as if nothing was.


MOST_KEPT_BYTES = 10_000_000


class KeptProgram(msgspec.Struct, array_like=True, frozen=True):
    """One that asked for a line: ``born`` is when its process began, 0 when nobody knows."""

    node: str
    pid: int
    socket: str
    born: float


class KeptLine(msgspec.Struct, frozen=True):
    """A line as it is kept."""

    port: int
    request: Request
    programs: list[KeptProgram]


def remember(file: Path, lines: list[KeptLine]) -> None:
    """Write the file anew; a failure is no reason to serve nobody."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(file) as new:
            new.write(msgspec.json.encode(lines))
    except OSError as error:
        log.info("the ports of the original's programs are not kept: %s", error)


def recall(file: Path) -> list[KeptLine]:
    """What the file holds; nothing when it cannot be read."""
    try:
        return msgspec.json.decode(content(file, MOST_KEPT_BYTES), type=list[KeptLine])
    except (OSError, *CANNOT_DECODE) as error:
        log.info("no ports of the original's programs are known: %s", error)
        return []


PAIRS = 1000
"""After so many pairs of ports the numbers begin again: a port that was freed rests first."""
UNUSED_S = 10.0
"""A line that nobody is connected to for so long is freed."""
DECIDES_S = 0.5
"""The paper's programs do not say who binds: after so long it is seen."""
CLOCK_S = 2.0
"""When a process began is known less exactly when the computer's clock was set meanwhile."""
LAST_PORT = 65535
MOST_PROGRAMS = 100
"""So many programs of a line are known, those that asked last: each is told to all at each change.

One that made up another name for each request would else fill the memory. A line that somebody is
connected to stays, whoever is known of it.
"""

Key = tuple[object, ...]


@dataclass
class Line:
    """Two ports, ``port`` and the next, and the doors there."""

    request: Request
    port: int
    ways_in: list[WayIn] = field(default_factory=list)
    ways_out: list[WayOut] = field(default_factory=list)
    programs: list[KeptProgram] = field(default_factory=list)
    idle_since_s: float = 0.0
    decides_s: float = 0.0

    @property
    def doors(self) -> list[Door]:
        """All of them."""
        return [*self.ways_in, *self.ways_out]

    @property
    def is_idle(self) -> bool:
        """Whether nobody is connected."""
        return not any(door.connections for door in self.doors)


OnFrame = Callable[[str, Shape, bytes], None]


class Lines:
    """Opens a line when a program asks, and frees it when its programs are gone.

    ``context`` makes the sockets, which ``watch`` lets the gateway's thread look at; they are
    bound at ``host`` from ``first_port`` up. ``on_frame`` gets what programs publish,
    ``on_change`` the topic of a line whose programs have changed.
    """

    def __init__(
        self,
        context: Context,
        watch: Watch,
        host: str,
        first_port: int,
        on_frame: OnFrame,
        on_change: Callable[[str], None],
    ) -> None:
        self.all: list[Line] = []
        self._by_key: dict[Key | None, Line] = {}
        self._context = context
        self._watch = watch
        self._host = host
        self._first_port = first_port
        self._next_pair = 0
        self._allowed = lines_allowed()
        self._on_frame = on_frame
        self._on_change = on_change

    def of(self, topic: str) -> list[Line]:
        """All lines of a topic."""
        return [line for line in self.all if line.request.topic == topic]

    def ask(self, request: Request) -> int:
        """The port that a program should use; raises NetworkError when there is none left."""
        line = self._by_key.get(_key(request))
        if line is None:
            line = self._open(request)
            self._keep(line)
        line.idle_since_s = time.monotonic()
        known = [p for p in line.programs if (p.node, p.pid) != (request.node, request.pid)]
        born = _born(request.pid)
        asks = KeptProgram(request.node, request.pid, request.socket, born)
        line.programs = [*known, asks][-MOST_PROGRAMS:]
        return line.port

    def kept(self) -> list[KeptLine]:
        """What to know to open all lines again."""
        return [KeptLine(line.port, line.request, line.programs) for line in self.all]

    def reopen(self, kept: list[KeptLine]) -> None:
        """Open lines as they were, for those of their programs that are still there."""
        for old in kept:
            here = [program for program in old.programs if not _has_ended(program)]
            if not here or len(self.all) >= self._allowed:
                continue
            line = Line(old.request, old.port, programs=here, idle_since_s=time.monotonic())
            try:
                self._furnish(line)
            except (PortTaken, zmq.ZMQError):
                self._close_doors(line)
            else:
                self._keep(line)

    def sweep(self) -> bool:
        """Free what nobody needs any more; whether that was anything."""
        now_s = time.monotonic()
        changed = False
        born = cache(_born)  # many programs may name one process
        for line in list(self.all):
            if line.decides_s and now_s >= line.decides_s:
                # See who binds: if the program does, it is the one side; else it is on the other
                line.decides_s = 0.0
                endpoint = self._endpoint(line.port)
                ways: list[Callable[[Line], Door]] = [self._add_way_out, self._add_way_in]
                if line.request.mode == "many2one":
                    ways.reverse()
                ours, theirs = ways
                try:
                    ours(line).bind(endpoint)
                except PortTaken:
                    self._close_doors(line)
                    theirs(line).connect(endpoint)
            here = [program for program in line.programs if not _has_ended(program, born)]
            changed |= len(here) < len(line.programs)
            line.programs = here
            if not line.is_idle:
                line.idle_since_s = now_s
            elif not here or (now_s - line.idle_since_s > UNUSED_S and not self._serves(line)):
                self._free(line)
                changed = True
        return changed

    def close(self) -> None:
        """Free all ports."""
        for line in list(self.all):
            self._free(line)

    def _keep(self, line: Line) -> None:
        self.all.append(line)
        if key := _key(line.request):
            self._by_key[key] = line

    def _open(self, request: Request) -> Line:
        if len(self.all) >= self._allowed:
            raise NetworkError(
                "There are too many topics: no room for {topic}.", topic=request.topic
            )
        used = {line.port for line in self.all}
        for _ in range(PAIRS):
            port = self._first_port + 2 * self._next_pair
            self._next_pair = (self._next_pair + 1) % PAIRS
            if port >= LAST_PORT or port in used or not self._is_free(port):
                continue
            line = Line(request, port)
            try:
                self._furnish(line)
            except PortTaken:
                self._close_doors(line)
                continue
            except BaseException:  # no more sockets, for example
                self._close_doors(line)
                raise
            return line
        raise NetworkError("There is no port left for {topic}.", topic=request.topic)

    def _furnish(self, line: Line) -> None:
        role, mode = line.request.role, line.request.mode
        if role == "service":
            return
        if mode == "many2many":
            self._add_way_in(line).bind(self._endpoint(line.port))
            self._add_way_out(line).bind(self._endpoint(line.port + 1))
        elif role == "unknown":
            line.decides_s = time.monotonic() + DECIDES_S
        else:
            door = self._add_way_in(line) if role == "publisher" else self._add_way_out(line)
            program_binds = (role, mode) in (("publisher", "one2many"), ("subscriber", "many2one"))
            (door.connect if program_binds else door.bind)(self._endpoint(line.port))

    def _add_way_in(self, line: Line) -> WayIn:
        topic, shape = line.request.topic, line.request.shape
        way = WayIn(
            self._context,
            self._watch,
            lambda: self._on_change(topic),
            lambda frame: self._on_frame(topic, shape, frame),
        )
        line.ways_in.append(way)
        return way

    def _add_way_out(self, line: Line) -> WayOut:
        topic, shape = line.request.topic, line.request.shape
        way = WayOut(self._context, self._watch, lambda: self._on_change(topic), topic, shape)
        line.ways_out.append(way)
        return way

    def _serves(self, line: Line) -> bool:
        """Whether a service still uses its port, which the gateway does not touch."""
        return line.request.role == "service" and (
            any(program.born for program in line.programs) or not self._is_free(line.port)
        )

    def _free(self, line: Line) -> None:
        self.all.remove(line)
        self._by_key = {key: kept for key, kept in self._by_key.items() if kept is not line}
        self._close_doors(line)
        self._on_change(line.request.topic)

    def _close_doors(self, line: Line) -> None:
        for door in line.doors:
            door.close()
        line.ways_in, line.ways_out = [], []

    def _endpoint(self, port: int) -> str:
        return f"tcp://{self._host}:{port}"

    def _is_free(self, port: int) -> bool:
        with sockets.socket() as first, sockets.socket() as second:
            for probe, number in ((first, port), (second, port + 1)):
                if os.name == "posix":  # elsewhere it would let two programs have one port
                    probe.setsockopt(sockets.SOL_SOCKET, sockets.SO_REUSEADDR, 1)
                try:
                    probe.bind((self._host, number))
                except OSError:
                    return False
        return True


def _key(request: Request) -> Key | None:
    """What programs that may share a line have in common; None for one that binds by itself."""
    if request.role == "service":
        return (request.topic, "service")
    if request.mode == "many2many":
        return (request.topic, request.mode, request.shape)
    connects = {"one2many": "subscriber", "many2one": "publisher"}[request.mode]
    if request.role == connects:
        return (request.topic, request.mode, request.role, request.shape)
    return None


def _born(pid: int) -> float:
    """When a process began; 0 when there is none, or none that we can see."""
    if not pid:
        return 0.0
    try:
        process = psutil.Process(pid)
        return 0.0 if process.status() == psutil.STATUS_ZOMBIE else process.create_time()
    except psutil.Error:
        return 0.0


def _has_ended(program: KeptProgram, born: Callable[[int], float] = _born) -> bool:
    """Whether a process was there and is gone; never true for one that cannot be seen."""
    return bool(program.born) and abs(born(program.pid) - program.born) > CLOCK_S


# A topic on our side of the gateway: it speaks and listens in our network for the original's.
#
# Each has a thread of its own, because joining a topic waits for other programs.

T = TypeVar("T")


WAITING = 10_000
"""Messages that may wait for our network; when there are more, the newest are dropped."""
AGAIN_S = 1.0
ENDS_S = 2.0


class Side(ABC):
    """Takes part in a topic of our network, in a thread of its own."""

    def __init__(self, network: PeerNetwork, topic: str) -> None:
        self._network = network
        self._topic = topic
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"nep-original-{topic}", daemon=True)
        self._thread.start()

    @abstractmethod
    def close(self) -> None:
        """End soon."""

    @abstractmethod
    def _run(self) -> None:
        """Join the topic, and pass on until it is closed."""

    def wait(self) -> None:
        """Wait until it has ended, but not for ever."""
        self._thread.join(ENDS_S)

    def _joined(self, attempt: Callable[[], T]) -> T | None:
        """What ``attempt`` gives, as soon as there is a master; None when it is too late for it."""
        while not (self._closing.is_set() or self._network.closed):
            try:
                self._network.join()  # first: an attempt that fails would leave its half behind
                return attempt()
            except NetworkError as error:
                log.warning("programs of the original have to wait: %s", error.sentence)
                self._closing.wait(AGAIN_S)
        return None


class Speaker(Side):
    """Publishes in our network what a program of the original says."""

    def __init__(
        self, network: PeerNetwork, topic: str, encoding: Literal["msgpack"] | None = None
    ) -> None:
        self._encoding = encoding
        self._warn = Warner()
        self._waiting: queue.Queue[Any] = queue.Queue(WAITING)
        self._waiting_bytes, self._weighing = 0, threading.Lock()
        super().__init__(network, topic)

    def say(self, value: Any, size: int) -> None:
        """Publish a value soon, which came as so many bytes."""
        with self._weighing:
            has_room = self._waiting_bytes + size <= MOST_WAITING_BYTES or not self._waiting_bytes
            self._waiting_bytes += size if has_room else 0
        try:
            if not has_room:
                raise queue.Full
            self._waiting.put_nowait((value, size))
        except queue.Full:
            with self._weighing:
                self._waiting_bytes -= size if has_room else 0
            self._warn(f"{self._topic}: messages of the original come too fast for our network.")

    def close(self) -> None:
        """Publish what waits, then no more."""
        self._closing.set()
        try:
            self._waiting.put_nowait(None)
        except queue.Full:
            log.debug("%s: what waits is published first", self._topic)

    def _run(self) -> None:
        publisher = self._joined(self._open)
        if publisher is None:
            return
        while not (self._closing.is_set() and self._waiting.empty()):
            item = self._waiting.get()
            if item is None or self._network.closed:
                break
            value, size = item
            with self._weighing:
                self._waiting_bytes -= size
            try:
                publisher.send(value)
            except BadMessage as error:
                self._warn(f"{self._topic}: {error.sentence}")
        publisher.close()

    def _open(self) -> Publisher:
        try:
            return Publisher(self._topic, network=self._network, encoding=self._encoding)
        except (MasterNotFound, NameTaken):
            raise
        except NetworkError:  # published already with another encoding: then as it comes
            return Publisher(self._topic, network=self._network)


class Listener(Side):
    """Hears a topic of our network, but not what the gateway itself says there."""

    def __init__(
        self, network: PeerNetwork, topic: str, on_value: Callable[[str, Any], None]
    ) -> None:
        self._on_value = on_value
        self._lock = threading.Lock()
        self._subscriber: Subscriber[Any] | None = None
        super().__init__(network, topic)

    def close(self) -> None:
        """Hear no more."""
        self._closing.set()
        with self._lock:
            if self._subscriber is not None:
                self._subscriber.close()

    def _run(self) -> None:
        subscriber = self._joined(self._open)
        if subscriber is None:
            return
        for value in subscriber:
            header = subscriber.header
            if header is not None and header.node != self._network.node:
                self._on_value(self._topic, value)

    def _open(self) -> Subscriber[Any]:
        subscriber: Subscriber[Any] = Subscriber(self._topic, network=self._network)
        with self._lock:
            self._subscriber = subscriber
            if self._closing.is_set():
                subscriber.close()
        return subscriber
