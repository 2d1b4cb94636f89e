"""An object of the other side: calls its methods, hears its signals, reads its properties."""

from __future__ import annotations

import contextlib
import itertools
import logging
import weakref
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from faults import text_of

from .codec import ObjectSource, Reader, encode, read_value, reader_of
from .errors import BadFrame, NaoqiError, NoAnswer, NoSuchMethod, WrongArguments
from .line import DYNAMIC_PAYLOAD, Frame
from .metaobject import MetaObject, Signature
from .promise import Pending
from .service import GET, PROPERTIES, REGISTER, SET, UNREGISTER, Heard, description_of

if TYPE_CHECKING:
    from .peer import Peer

log = logging.getLogger(__name__)


# Who hears one signal of the other side: the robot tells a connection once, it tells all.


class Hearing:
    """All who hear one signal. ``owner`` is the object that has the signal: it is kept alive."""

    def __init__(self, signal: Signature, link: int, owner: ObjectSource) -> None:
        self.link = link
        self._signal = signal
        self._owner = owner
        self._numbers = itertools.count(1)
        self._hearers: dict[int, Heard] = {}

    def add(self, heard: Heard) -> int:
        """One more hears it; return the number to remove it with."""
        number = next(self._numbers)
        self._hearers[number] = heard
        return number

    def remove(self, number: int) -> bool:
        """One less hears it; True when this was the last."""
        return self._hearers.pop(number, None) is not None and not self._hearers

    def take(self, frame: Frame) -> None:
        """Tell everybody of an event."""
        is_dynamic = bool(frame.flags & DYNAMIC_PAYLOAD)
        type_text = "m" if is_dynamic else self._signal.parameters
        try:
            values = read_value(reader_of(type_text), Reader(frame.payload, self._owner))
        except BadFrame as problem:
            log.warning("an event of %s could not be read: %s", self._signal, problem.sentence)
            return
        several = tuple(values) if isinstance(values, list | tuple) else (values,)
        for heard in list(self._hearers.values()):
            self._tell(heard, several)

    def _tell(self, heard: Heard, values: tuple[Any, ...]) -> None:
        try:
            heard(*values)
        except Exception:
            log.exception("who hears %s failed", self._signal)


PATIENCE_S = 2.5
"""How long a call waits for its answer, unless it says so."""
_links = itertools.count(1)
NO_ANSWER = (
    "Is NAO switched on? Its chest button should glow.",
    "Is this computer on the same network as NAO?",
    "Wait a moment: NAO answers late while it starts or works hard.",
)


class RemoteObject:
    """An object on the robot. All calls may be made from any thread, but not from the reader's.

    ``peer`` is the connection, ``meta`` what the object can do, ``service`` and ``number`` are
    the numbers by which it is called.
    """

    def __init__(self, peer: Peer, meta: MetaObject, service: int, number: int = 1) -> None:
        self._peer = peer
        self._meta = meta
        self._service = service
        self._number = number
        self._found: dict[tuple[str, int], Signature] = {}
        self._trade = peer.trade(service)

    @property
    def methods(self) -> Mapping[str, list[Signature]]:
        """The overloads of every method, as the robot tells them."""
        return self._meta.by_name

    @property
    def signals(self) -> list[str]:
        """The names of all signals."""
        return [it.name for it in self._meta.signals.values()]

    @property
    def is_lost(self) -> bool:
        """Whether the connection to it has ended."""
        return self._peer.is_closed

    def call(self, method: str, *args: Any, timeout_s: float = PATIENCE_S) -> Any:
        """Call the overload that fits, and wait. Raises NaoqiError."""
        if self._peer.is_read_here():
            raise NaoqiError("{method} would wait for itself: use begin() here.", method=method)
        pending = self.begin(method, *args)
        if not pending.wait(timeout_s):
            self._peer.forget(pending)
            pending.cancel()
            raise NoAnswer(
                "NAO has not answered {method} within {timeout_s} s.",
                checklist=NO_ANSWER,
                method=method,
                timeout_s=f"{timeout_s:g}",
            )
        return pending.result(0.0)

    def begin(self, method: str, *args: Any) -> Pending:
        """Call without waiting. Raises NaoqiError when it cannot be sent."""
        signature = self._signature(method, args)
        payload, flags = self._payload(signature, args)
        read = reader_of(signature.returns)
        return self._peer.begin(self._service, self._number, signature.uid, payload, read, flags)

    def post(self, method: str, *args: Any) -> None:
        """Call a method or emit a signal, and never hear of it again. Raises NaoqiError."""
        signal = self._meta.signal(method)
        signature = signal or self._signature(method, args)
        payload, _ = self._payload(signature, args)
        self._peer.post(self._service, self._number, signature.uid, payload)

    def connect(self, signal: str, heard: Heard) -> Callable[[], None]:
        """Call ``heard`` with the values of each event; the answer ends that. Raises NaoqiError.

        Events come one after the other, in a thread of the connection. The object stays alive.
        """
        found = self._meta.signal(signal)
        if found is None:
            raise NoSuchMethod("There is no signal “{signal}” here.", signal=signal)
        key = (self._service, self._number, found.uid)
        with self._peer.hearing_lock:
            known = self._peer.hearing.get(key)
            hearing = known if isinstance(known, Hearing) else Hearing(found, next(_links), self)
            self._peer.hearing[key] = hearing
            number = hearing.add(heard)
        if known is None:
            try:
                self._own(REGISTER, "(IIL)", (self._number, found.uid, hearing.link), "L")
            except NaoqiError:
                self._peer.hearing.pop(key, None)
                raise
        return lambda: self._disconnect(key, hearing, number)

    def take_object(self, meta: MetaObject, service: int, number: int) -> RemoteObject:
        """Return an object that came with an event of this one."""
        return self._trade.take_object(meta, service, number)

    def property(self, name: str) -> Any:
        """Return the value of a property. Raises NaoqiError."""
        return self._own(GET, "(m)", (name,), "m")

    def set_property(self, name: str, value: Any) -> None:
        """Change a property. Raises NaoqiError."""
        self._own(SET, "(mm)", (name, value), "v")

    def properties(self) -> list[str]:
        """Return the names of all properties. Raises NaoqiError."""
        names: list[str] = self._own(PROPERTIES, "()", (), "[s]")
        return names

    def _signature(self, method: str, args: tuple[Any, ...]) -> Signature:
        """Return the overload for these values; the only one of this length is remembered."""
        key = (method, len(args))
        if (known := self._found.get(key)) is not None:
            return known
        found = self._meta.overload(method, args)
        alike = [
            one
            for one in self._meta.by_name.get(found.name, ())
            if one.takes_any or len(one.parameter_types) == len(args)
        ]
        if len(alike) == 1:
            self._found[key] = found
        return found

    def _payload(self, signature: Signature, args: tuple[Any, ...]) -> tuple[bytes, int]:
        if signature.takes_any:
            return encode("m", args, self._trade), DYNAMIC_PAYLOAD
        try:
            return encode(signature.parameters, args, self._trade), 0
        except WrongArguments as problem:
            sentence = text_of(
                "{name} takes {parameters}. {sentence}",
                name=signature.name,
                parameters=signature.parameters,
                sentence=problem.sentence,
            )
            raise WrongArguments(sentence) from problem

    def _own(self, action: int, types: str, values: tuple[Any, ...], returns: str) -> Any:
        """Call what every object has."""
        payload = encode(types, values, self._trade)
        pending = self._peer.begin(self._service, self._number, action, payload, reader_of(returns))
        return pending.result(PATIENCE_S)

    def _disconnect(self, key: tuple[int, int, int], hearing: Hearing, number: int) -> None:
        with self._peer.hearing_lock:
            if not hearing.remove(number):
                return
            self._peer.hearing.pop(key, None)
        payload = encode("(IIL)", (self._number, key[2], hearing.link))
        with contextlib.suppress(NaoqiError):
            self._peer.begin(self._service, self._number, UNREGISTER, payload, reader_of("v"))


# Objects that go over a connection within messages, in both directions.


class Trade:
    """Gives and takes the objects in the messages of one service on one connection."""

    __slots__ = ("_peer", "_service")

    def __init__(self, peer: Peer, service: int) -> None:
        self._peer = peer
        self._service = service

    def give_object(self, value: Any) -> tuple[bytes, int, int]:
        """Describe an object that the other side can call now. Raises TypeError."""
        if isinstance(value, RemoteObject):
            raise TypeError("an object that is on a robot already")
        number = self._peer.add_object(value, self._service)
        return description_of(type(value)).meta.encoded, self._service, number

    def take_object(self, meta: MetaObject, service: int, number: int) -> RemoteObject:
        """Return the object of the other side that a message refers to; let it go when unused."""
        remote = RemoteObject(self._peer, meta, service, number)
        weakref.finalize(remote, self._peer.note_dropped, service, number).atexit = False
        return remote
