"""One side of a connection: calls the other side, is called by it, and hears its events.

NAOqi is symmetrical: a client may offer objects as well, which the server then calls. One thread
reads; it answers the calls of the other side itself (``is_server``) or leaves them to a second
thread, which also calls whoever waits for events and results.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from faults import Words

from .codec import Read, Reader, encode, read_value, reader_of
from .errors import BadFrame, CallCancelled, CallFailed, ConnectionLost, NaoqiError
from .line import DYNAMIC_PAYLOAD, Frame, Kind, Line
from .promise import Pending
from .remote import Trade
from .service import TERMINATE, Bound, Turns

log = logging.getLogger(__name__)

TRACEBACK = "\n\nAt:\n"
MAIN = 1
"""The number of the object that a service itself is."""
ENDED = "The connection to NAO has ended."


class Answering(Protocol):
    """What answers the calls to one object."""

    def take(self, frame: Frame, peer: Peer) -> None:
        """Do what a CALL or POST asks for, and answer a CALL."""


class Hears(Protocol):
    """Takes the events of one signal of the other side."""

    def take(self, frame: Frame) -> None:
        """Tell everybody of an event."""


class Peer:
    """One connection and everything that goes over it."""

    def __init__(self, line: Line, *, name: str, is_server: bool = False) -> None:
        self.line = line
        self.capabilities: dict[str, Any] = {}
        self.objects: dict[tuple[int, int], Answering] = {}
        self.hearing: dict[tuple[int, int, int], Hears] = {}
        self.hearing_lock = threading.Lock()
        self.running: dict[int, Pending] = {}
        self.find: Callable[[int, int], Answering | None] = lambda service, thing: None
        self.gate: Callable[[Frame], bool] | None = None
        self.turns = Turns(f"{name}-turns")
        self.when_closed: list[Callable[[str], None]] = []
        self._is_server = is_server
        self._name = name
        self._numbers = itertools.count(1)
        self._object_numbers = itertools.count(2)
        self._lock = threading.Lock()
        self._pending: dict[int, tuple[Pending, Read]] = {}
        self._dropped: deque[tuple[int, int]] = deque()
        self._is_over = False
        self._reader = 0

    def start(self) -> None:
        """Begin to read, in a thread of its own."""
        threading.Thread(target=self.run, name=f"{self._name}-reader", daemon=True).start()

    @property
    def is_closed(self) -> bool:
        """Whether the connection has ended."""
        return self.line.is_closed or self._is_over

    def is_read_here(self) -> bool:
        """Whether this thread is the one that reads: it would wait for itself."""
        return threading.get_ident() == self._reader

    def begin(
        self, service: int, thing: int, action: int, payload: bytes, read: Read, flags: int = 0
    ) -> Pending:
        """Call the other side. Raises ConnectionLost.

        ``service``, ``thing`` and ``action`` are the numbers of service, object and method;
        ``payload`` holds the arguments, ``read`` reads the answer; ``flags`` are those of
        the frame.
        """
        number = next(self._numbers) & 0xFFFFFFFF
        pending = Pending(lambda: self._cancel(number, service, thing))
        with self._lock:
            if self._is_over:
                raise ConnectionLost(ENDED)
            self._pending[number] = (pending, read)  # before sending: the answer may be quick
        try:
            self.send(Frame(Kind.CALL, number, service, thing, action, payload, flags))
        except ConnectionLost:
            self._pending.pop(number, None)
            raise
        return pending

    def post(self, service: int, thing: int, action: int, payload: bytes) -> None:
        """Call the other side without an answer. Raises ConnectionLost.

        ``service``, ``thing`` and ``action`` are the numbers of service, object and method;
        ``payload`` holds the arguments.
        """
        number = next(self._numbers) & 0xFFFFFFFF
        self.send(Frame(Kind.POST, number, service, thing, action, payload))

    def send(self, frame: Frame) -> None:
        """Send a frame without waiting. Raises ConnectionLost."""
        while self._dropped:
            with contextlib.suppress(IndexError):
                self._terminate(*self._dropped.popleft())
        self.line.send(frame)

    def forget(self, pending: Pending) -> None:
        """Do not wait for this any more; its answer, if there comes one, is dropped."""
        with self._lock:
            for number, (waiting, _) in list(self._pending.items()):
                if waiting is pending:
                    del self._pending[number]

    def trade(self, service: int) -> Trade:
        """Return what brings objects in and out of the messages of a service."""
        return Trade(self, service)

    def add_object(self, thing: Any, service: int) -> int:
        """Make an object reachable for the other side until that lets it go; its number."""
        number = next(self._object_numbers)
        self.objects[service, number] = Bound(thing, service, number)
        return number

    def note_dropped(self, service: int, number: int) -> None:
        """Tell the other side, with the next frame, that nobody uses this object of it any more.

        Called wherever Python collects what is not used, so it must not send by itself.
        """
        self._dropped.append((service, number))

    def drop_object(self, service: int, number: int) -> None:
        """The other side does not need this object any more."""
        gone = self.objects.pop((service, number), None)
        if isinstance(gone, Bound):
            gone.leave(self)

    def run(self) -> None:
        """Read until the connection ends."""
        why = ENDED
        self._reader = threading.get_ident()
        try:
            self.line.read(self._take)
        except BadFrame as problem:
            why = str(problem)
            log.info("%s: %s", self._name, why)
        except (OSError, ValueError) as problem:
            log.debug("%s: %r", self._name, problem)
        except Exception:
            log.exception("%s could not go on", self._name)
        self._end(why)
        self._reader = 0
        self.line.release()

    def close(self) -> None:
        """End the connection."""
        self.line.close()

    def _take(self, frame: Frame) -> None:
        if self.gate is not None and not self.gate(frame):
            return
        kind = frame.kind
        if kind == Kind.CALL or kind == Kind.POST:
            key = (frame.service, frame.object)
            bound = self.objects.get(key) or self.find(*key)
            if bound is None:
                place = f"{{{frame.service}.{frame.object}.{frame.action}, id:{frame.number}}}"
                self.answer_error(frame, f"can't find service, address: {place}")
            elif self._is_server:
                bound.take(frame, self)
            else:
                self.turns.add(lambda: bound.take(frame, self))
        elif kind == Kind.REPLY or kind == Kind.ERROR or kind == Kind.CANCELLED:
            self._take_answer(frame)
        elif kind == Kind.EVENT:
            hearing = self.hearing.get((frame.service, frame.object, frame.action))
            if hearing is not None:
                self.turns.add(lambda: hearing.take(frame))
        elif kind == Kind.CANCEL:
            self._take_cancel(frame)
        elif kind == Kind.CAPABILITY:
            self.take_capabilities(frame)

    def take_capabilities(self, frame: Frame) -> None:
        """Remember what the other side says it can do."""
        with contextlib.suppress(BadFrame):
            said = read_value(reader_of("{sm}"), Reader(frame.payload))
            self.capabilities = said

    def answer_error(self, frame: Frame, text: Words) -> None:
        """Say why a call could not be done."""
        if frame.kind == Kind.CALL:
            self.answer(frame.answer(Kind.ERROR, encode("m", str(text))))

    def answer(self, frame: Frame) -> None:
        """Send an answer, if there is still somebody to have it."""
        with contextlib.suppress(ConnectionLost):
            self.send(frame)

    def answer_later(self, frame: Frame, pending: Pending, answer: Callable[[Any], None]) -> None:
        """Call ``answer`` with the result of a call when it is there; say why if there is none."""
        self.running[frame.number] = pending

        def end(done: Pending) -> None:
            self.running.pop(frame.number, None)
            if isinstance(done.failure, CallCancelled):
                if frame.kind == Kind.CALL:
                    self.answer(frame.answer(Kind.CANCELLED))
            elif done.failure is not None:
                self.answer_error(frame, done.failure.sentence)
            else:
                answer(done.value)

        pending.when_done(end)

    def _take_answer(self, frame: Frame) -> None:
        with self._lock:
            pending, read = self._pending.pop(frame.number, (None, None))
        if pending is None or read is None:
            return  # nobody waits for it any more
        if frame.kind == Kind.CANCELLED:
            self._settle(pending, failure=CallCancelled("The call was cancelled."))
            return
        if frame.kind == Kind.ERROR or frame.flags & DYNAMIC_PAYLOAD:
            read = reader_of("m")
        try:
            value = read_value(read, Reader(frame.payload, self.trade(frame.service)))
        except BadFrame as problem:
            self._settle(pending, failure=problem)
            return
        if frame.kind == Kind.ERROR:
            self._settle(pending, failure=_told_failure(str(value)))
        else:
            self._settle(pending, value)

    def _settle(
        self, pending: Pending, value: Any = None, failure: NaoqiError | None = None
    ) -> None:
        """End a call; whoever is to be told is told by the second thread."""
        for on_done in pending.settle_quietly(value, failure) or ():
            self.turns.add(functools.partial(on_done, pending), is_owed=True)

    def _take_cancel(self, frame: Frame) -> None:
        with contextlib.suppress(BadFrame):
            number = read_value(reader_of("I"), Reader(frame.payload))
            running = self.running.get(number)
            if running is not None:
                running.cancel()

    def _cancel(self, number: int, service: int, thing: int) -> None:
        if not self.capabilities.get("RemoteCancelableCalls"):
            return  # robots of 2013 do not know how
        with contextlib.suppress(ConnectionLost):
            payload = encode("I", number)
            self.send(Frame(Kind.CANCEL, next(self._numbers), service, thing, 0, payload))

    def _terminate(self, service: int, number: int) -> None:
        payload = encode("(I)", (number,))
        with contextlib.suppress(ConnectionLost):
            frame = Frame(Kind.POST, next(self._numbers), service, number, TERMINATE, payload)
            self.line.send(frame)

    def _end(self, why: str) -> None:
        """Nothing comes any more: fail all that waits, forget all that listened."""
        with self._lock:
            self._is_over = True
            waiting, self._pending = self._pending, {}
        for pending, _ in waiting.values():
            self._settle(pending, failure=ConnectionLost(why))
        for bound in list(self.objects.values()):
            if isinstance(bound, Bound):
                bound.leave(self)
        self.objects.clear()
        self.hearing.clear()
        for told in self.when_closed:
            with contextlib.suppress(Exception):
                told(why)
        self.turns.close()


def _told_failure(text: str) -> CallFailed:
    """Return why a call failed; services in Python tell their traceback as well."""
    sentence, _, where = text.partition(TRACEBACK)
    return CallFailed(sentence.strip(), details=text if where else "")
