"""A program's side of the talk with the master: register, stay known, hear of changes."""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections.abc import Callable

import msgspec
import zmq

from faults import heard_fault, verbatim
from nep_core.closing import Closing
from nep_core.errors import NameTaken, NetworkError
from nep_core.wire.io_thread import IoThread, Wake
from nep_core.wire.outbox import network_closed

from . import master_messages as says
from . import security
from .endpoints import fixed_endpoint
from .master_messages import no_master
from .registry import LEASE_S, Publishing, Registration

log = logging.getLogger(__name__)


HEARTBEAT_S = 0.5
ANSWER_S = 5.0
"""How long a program waits for its master before it says that there is none."""
SETTLE_S = LEASE_S
"""So long after a restart a publisher that the new master does not know is still heard: it may
come back later than we did."""
RECONNECT_MS, LONGEST_RECONNECT_MS = 50, 200

OnPublishers = Callable[[str, list[Publishing]], None]


class MasterClient:
    """Keeps this program's registration true; its DEALER socket belongs to the I/O thread.

    ``on_publishers`` is told who publishes a topic that is heard here, ``on_stop_asked`` that
    somebody asks this program to stop, ``on_computers`` which keys an opened network lets in; all
    in the I/O thread.

    ``context`` makes its socket, ``io`` is the I/O thread, ``master`` an endpoint, ``told``
    what is registered first; ``broker`` is where a broker serves, if the master is its registry.
    """

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        io: IoThread,
        master: str,
        told: Registration,
        on_publishers: OnPublishers,
        on_stop_asked: Callable[[], None] = lambda: None,
        on_computers: Callable[[list[str]], None] = lambda keys: None,
        broker: str = "",
    ) -> None:
        self.master = master
        self._broker = broker
        self._on_computers = on_computers
        self._registration = told
        self._on_publishers = on_publishers
        self._on_stop_asked = on_stop_asked
        self._io = io
        self._socket = context.socket(zmq.DEALER)
        self._socket.linger = 200
        self._socket.setsockopt(zmq.IMMEDIATE, 1)  # nothing piles up while the master is away
        self._socket.reconnect_ivl = RECONNECT_MS
        self._socket.reconnect_ivl_max = LONGEST_RECONNECT_MS
        security.connect_to_master(self._socket, master)
        self._changed = threading.Condition()
        self._version = 0
        self._asked: set[str] = set()
        self._sent: Registration | None = None
        self._sent_version = 0
        self._answer: says.Registered | says.Refused | None = None
        self._mistake = ""
        self._epoch = ""
        self._publishers: dict[str, list[Publishing]] = {}
        self._subscribers: dict[str, list[str]] = {}
        self._before_restart: dict[str, list[Publishing]] = {}
        self._settled_s = 0.0
        self._next_beat_s = 0.0
        self._closed = False
        io.watch(self._socket)
        io.tend(self.tend)

    def change(
        self, edit: Callable[[Registration], None], topic: str = ""
    ) -> tuple[list[Publishing], list[str]]:
        """Change what is told and wait for the master's answer: who is at ``topic``.

        These are its publishers, and the ids of its subscribers. Raises MasterNotFound, NameTaken,
        and NetworkError with the master's own sentence when it cannot use what it is told.
        """
        with self._changed:
            self._mistake = ""
            version = self._edit(edit, topic)
            self._io.wake()
            self._changed.wait_for(
                lambda: (
                    self._closed
                    or self._mistake
                    or (self._answer and self._answer.version >= version)
                ),
                ANSWER_S,
            )
            answer, mistake = self._answer, self._mistake
            ends = self._publishers.get(topic, []), self._subscribers.get(topic, [])
        if self._closed:
            raise network_closed(self._registration.node)
        if answer is None or answer.version < version:
            if mistake:
                raise NetworkError(
                    "The NEP master does not take what this program tells it: {sentence}",
                    checklist=("Use the same version of NEP Studio on all computers.",),
                    sentence=verbatim(mistake),
                )
            raise no_master(self.master, self._broker)
        if isinstance(answer, says.Refused):
            if (fault := heard_fault(answer.fault)) is not None:
                raise NameTaken.of(fault)
            raise NameTaken(verbatim(answer.sentence), checklist=tuple(answer.checklist))
        return ends

    def change_later(self, edit: Callable[[Registration], None]) -> None:
        """Change what is told without waiting."""
        with self._changed:
            self._edit(edit)
        self._io.wake()

    def tend(self) -> None:
        """Read what the master says, and say what it should know (the I/O thread)."""
        for answer in says.arrived(self._socket):
            self._hear(answer)
        now_s = time.monotonic()
        if self._before_restart and now_s >= self._settled_s:
            # Hear from now on exactly those that the master knows
            topics, self._before_restart = list(self._before_restart), {}
            for topic in topics:
                self._on_publishers(topic, self._publishers.get(topic, []))
        if now_s >= self._next_beat_s and self._answer is None:
            self._sent, self._sent_version = None, 0  # the master may have ended before it answered
        if self._sent_version < self._version:
            self._tell()
        elif self._epoch and now_s >= self._next_beat_s:
            self._say(says.Alive(instance=self._registration.instance))

    def close(self) -> None:
        """Say good-bye; after the I/O thread has ended."""
        self._say(says.Bye(instance=self._registration.instance))
        self._socket.close()
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _edit(self, edit: Callable[[Registration], None], topic: str = "") -> int:
        """Change a copy, since the I/O thread may be sending the other; the new version."""
        old = self._registration
        told = msgspec.structs.replace(
            old, publishes=list(old.publishes), subscribes=dict(old.subscribes)
        )
        edit(told)
        self._registration = told
        self._version += 1
        self._asked.add(topic)
        return self._version

    def _hear(self, answer: says.Answer) -> None:
        match answer:
            case says.Registered():
                if self._epoch not in ("", answer.epoch):
                    self._begin_to_settle()
                self._epoch = answer.epoch
                for topic, publishers in answer.publishers.items():
                    self._take_publishers(topic, publishers)
            case says.Refused():
                if self._epoch and not isinstance(self._answer, says.Refused):
                    log.warning("the master does not take us back: %s", answer.sentence)
                self._sent = None
            case says.Publishers():
                self._take_publishers(answer.topic, answer.publishers)
            case says.Heard():
                if not answer.known or answer.epoch != self._epoch:
                    self._sent, self._sent_version = None, 0  # tell all again
            case says.StopAsked():
                self._on_stop_asked()
            case says.Computers():
                self._on_computers(answer.keys)
            case says.Mistake():
                log.warning("the master answered: %s", answer.sentence)
                with self._changed:
                    self._mistake = answer.sentence
                    self._changed.notify_all()
            case _:
                log.warning("the master answered: %s", answer)
        if isinstance(answer, says.Registered | says.Refused):
            with self._changed:
                self._answer = answer
                if isinstance(answer, says.Registered):
                    self._subscribers |= answer.subscribers
                self._changed.notify_all()

    def _take_publishers(self, topic: str, publishers: list[Publishing]) -> None:
        with self._changed:
            self._publishers[topic] = publishers
        told = {publisher.instance for publisher in publishers}
        before = self._before_restart.get(topic, [])
        missing = [publisher for publisher in before if publisher.instance not in told]
        self._on_publishers(topic, [*publishers, *missing])

    def _begin_to_settle(self) -> None:
        """A new master: until all have come back, go on hearing whom the one before knew."""
        self._settled_s = time.monotonic() + SETTLE_S
        for topic, publishers in self._publishers.items():
            old = self._before_restart.get(topic, [])
            self._before_restart[topic] = [*old, *(one for one in publishers if one not in old)]

    def _tell(self) -> None:
        """Say what has changed, or all when the master knows nothing of us."""
        with self._changed:
            version, told, asked = self._version, self._registration, self._asked
            self._asked = set()
        request: says.Request
        if self._sent is None:
            request = says.Register(version=version, registration=told, epoch=self._epoch)
        else:
            # What the master should know, beside the topics whose ends are asked for
            sent = self._sent
            before, now = set(sent.publishes), set(told.publishes)
            request = says.Change(
                instance=told.instance,
                version=version,
                base=self._sent_version,
                publishes=sorted((now - before) | (now & asked)),
                publishes_no_more=sorted(before - now),
                subscribes=dict(told.subscribes.items() - sent.subscribes.items()),
                subscribes_no_more=sorted(sent.subscribes.keys() - told.subscribes.keys()),
            )
        if self._say(request):
            self._sent, self._sent_version = told, version
            # Topics that are neither heard nor published here any more
            heard = set(told.subscribes.values())
            with self._changed:
                for topic in self._publishers.keys() - heard:
                    del self._publishers[topic]
                    self._before_restart.pop(topic, None)
                for topic in self._subscribers.keys() - set(told.publishes):
                    del self._subscribers[topic]
        else:
            with self._changed:
                self._asked |= asked

    def _say(self, request: says.Request) -> bool:
        try:
            self._socket.send(says.encode(request), zmq.NOBLOCK)
        except zmq.Again:
            return False  # the master is away: the next tick tries again
        self._next_beat_s = time.monotonic() + HEARTBEAT_S
        return True


# Following what a master has registered, for tools that show it.

RENEW_S = 0.5
"""How often the feed asks again: for the lease, and for what it may have missed."""
SILENT_S = 3 * RENEW_S
LOOK_MS = 100

OnChange = Callable[[list[Registration]], None]


class Feed(Closing):
    """Calls ``on_change``, in a thread of its own, with all registrations whenever they change.

    ``registrations`` are those who are there, or were when they were last told; ``is_answered``
    is false while nobody tells, and that change is told too.
    """

    def __init__(self, on_change: OnChange) -> None:
        self.registrations: list[Registration] = []
        self.is_answered = False
        self._on_change = on_change
        self._thread = threading.Thread(target=self._run, name="nep-feed", daemon=True)

    def close(self) -> None:
        """Follow no more; waits for a callback that is running, unless it is the caller."""
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        """Follow until the end."""
        raise NotImplementedError

    def _tell(self) -> None:
        try:
            self._on_change(self.registrations)
        except Exception:
            log.exception("the callback of the feed failed")


class MasterFeed(Feed):
    """Follows what is registered at a master.

    While no master answers the last registrations stay, since programs go on without it.
    Raises NetworkError when ``master`` is not an endpoint.
    """

    def __init__(self, master: str, on_change: OnChange) -> None:
        self.master = fixed_endpoint(master)
        super().__init__(on_change)
        self._by_instance: dict[str, Registration] = {}
        self._epoch, self._number = "", 0
        self._heard_s = self._asked_s = 0.0
        self._is_closed = False
        self._wake = Wake()
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.linger = 0
        self._socket.setsockopt(zmq.IMMEDIATE, 1)
        self._socket.reconnect_ivl_max = 500
        try:
            security.connect_to_master(self._socket, master)
        except BaseException:
            self._context.destroy(linger=0)
            raise
        self._thread.start()

    def close(self) -> None:
        """Follow no more."""
        self._is_closed = True
        self._wake()
        super().close()

    def _run(self) -> None:
        poller = zmq.Poller()
        poller.register(self._socket, zmq.POLLIN)
        poller.register(self._wake.fileno(), zmq.POLLIN)
        while not self._is_closed:
            before = self._by_instance, self.is_answered
            self._ask()
            poller.poll(LOOK_MS)
            for answer in says.arrived(self._socket):
                self._hear(answer)
            if not self._is_closed and (self._by_instance, self.is_answered) != before:
                self.registrations = list(self._by_instance.values())
                self._tell()
        self._context.destroy(linger=0)
        self._wake.close()

    def _ask(self) -> None:
        now_s = time.monotonic()
        self.is_answered = self.is_answered and now_s - self._heard_s < SILENT_S
        if now_s - self._asked_s < RENEW_S:
            return
        with contextlib.suppress(zmq.Again):  # the master is away
            request = says.Watch(epoch=self._epoch, number=self._number)
            self._socket.send(says.encode(request), zmq.NOBLOCK)
            self._asked_s = now_s

    def _hear(self, answer: says.Answer) -> None:
        self.is_answered, self._heard_s = True, time.monotonic()
        match answer:
            case says.Listing():
                self._epoch, self._number = answer.epoch, answer.number
                self._by_instance = {told.instance: told for told in answer.registrations}
            case says.Changed() if answer.epoch == self._epoch:
                if answer.number > self._number + 1:
                    self._asked_s = 0.0  # one was missed: ask at once
                    return
                self._number = max(answer.number, self._number)
                there = self._by_instance | {told.instance: told for told in answer.came}
                self._by_instance = {i: it for i, it in there.items() if i not in answer.gone}
