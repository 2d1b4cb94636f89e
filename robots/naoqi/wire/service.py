"""How a class becomes a service: its methods, signals and properties with their NAOqi signatures.

    class Lamp:
        touched = signal("touched::(m)")
        brightness = Property("brightness::f", 1.0)

        @method("shine::b(sf)")
        def shine(self, colour: str, seconds: float) -> bool: ...

Overloads are several methods with one NAOqi name, or one method with several signatures. Calls of
one caller come one after the other; callers come at the same time. A method that has to wait
returns ``promise.future``, or says ``blocks=True`` and gets a thread.
"""

from __future__ import annotations

import itertools
import logging
import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

from .codec import Reader, encode, read_value, reader_of
from .errors import (
    BadFrame,
    ConnectionLost,
    NaoqiError,
    NoSuchMethod,
    WrongArguments,
)
from .line import DYNAMIC_PAYLOAD, RETURN_TYPE, Frame, Kind
from .metaobject import META_OBJECT, MetaObject, Signature
from .promise import Pending, Promise
from .types import MARK

if TYPE_CHECKING:
    from .peer import Peer

log = logging.getLogger(__name__)


FIRST_UID = 100
"""Smaller numbers belong to the protocol."""
REGISTER, UNREGISTER, META, TERMINATE, GET, SET, PROPERTIES, REGISTER_AS = 0, 1, 2, 3, 5, 6, 7, 8
EVERY_OBJECT = {
    REGISTER: "registerEvent::L(IIL)",
    UNREGISTER: "unregisterEvent::v(IIL)",
    META: f"metaObject::{META_OBJECT}(I)",
    TERMINATE: "terminate::v(I)",
    GET: "property::m(m)",
    SET: "setProperty::v(mm)",
    PROPERTIES: "properties::[s]()",
    REGISTER_AS: "registerEventWithSignature::L(IILs)",
}
BUILT_IN = {uid: Signature.parse(text, uid=uid) for uid, text in EVERY_OBJECT.items()}

Heard = Callable[..., object]
Method = TypeVar("Method", bound=Callable[..., Any])


@dataclass(frozen=True)
class Mark:
    """What a decorator has noted: the signature, and whether the method may wait."""

    signature: Signature
    blocks: bool = False
    kind: str = "method"


def method(*signatures: str, uid: int = 0, blocks: bool = False) -> Callable[[Method], Method]:
    """Offer a method under these signatures, such as ``goToPosture::b(sf)``.

    ``uid`` is its number, where a robot has one for it; ``blocks``: it may wait, and gets a thread.
    """
    marks = tuple(Mark(Signature.parse(one, uid=uid), blocks) for one in signatures)

    def note(function: Method) -> Method:
        setattr(function, MARK, (*getattr(function, MARK, ()), *marks))
        return function

    return note


class Signal:
    """Tells everybody who listens, here and over the network."""

    def __init__(self, signature: str = "signal::(m)") -> None:
        self.signature = Signature.parse(signature)
        self._numbers = itertools.count(1)
        self._listeners: dict[int, Heard] = {}

    @property
    def is_heard(self) -> bool:
        """Whether anybody listens."""
        return bool(self._listeners)

    def listen(self, heard: Heard) -> Callable[[], None]:
        """Call this with the values of each event, in the thread that emits; returns the end."""
        number = next(self._numbers)
        self._listeners[number] = heard
        return lambda: self._listeners.pop(number, None) and None

    def emit(self, *values: Any) -> None:
        """Tell everybody; never waits for anybody."""
        for heard in list(self._listeners.values()):
            heard(*values)


class _Declared:
    """A signal or property as a class declares it; every instance gets its own."""

    def __init__(self, text: str, uid: int, kind: str) -> None:
        signature = Signature.parse(text, uid=uid)
        setattr(self, MARK, (Mark(signature, kind=kind),))
        self._text = text
        self._key = f"_signal_{signature.name}"

    def signal_of(self, owner: Any) -> Signal:
        """Return the signal of one instance."""
        found: Signal = vars(owner).setdefault(self._key, Signal(self._text))
        return found


class signal(_Declared):  # noqa: N801 read as a word at the place where it declares
    """Declare a signal in a class: ``touched = signal("touched::(m)")``."""

    def __init__(self, signature: str, *, uid: int = 0) -> None:
        super().__init__(signature, uid, "signal")

    def __get__(self, owner: Any, kind: type | None = None) -> Any:
        return self if owner is None else self.signal_of(owner)


class Property(_Declared):
    """Declare a property in a class; setting it tells everybody who listens."""

    def __init__(self, signature: str, start: Any = None, *, uid: int = 0) -> None:
        super().__init__(signature, uid, "property")
        self._start = start
        self._value_key = f"{self._key}_value"

    def __get__(self, owner: Any, kind: type | None = None) -> Any:
        return self if owner is None else vars(owner).get(self._value_key, self._start)

    def __set__(self, owner: Any, value: Any) -> None:
        vars(owner)[self._value_key] = value
        self.signal_of(owner).emit(value)


@dataclass
class Description:
    """What a class offers: how it tells others, and the attribute behind each number."""

    meta: MetaObject
    attributes: dict[int, str] = field(default_factory=dict)
    blocking: set[int] = field(default_factory=set)
    signals: dict[int, str] = field(default_factory=dict)


def description_of(kind: type) -> Description:
    """Return what a class offers; the same class always has the same numbers."""
    return _description_of(kind)  # mypy holds that a class cannot be hashed


@lru_cache(maxsize=512)
def _description_of(kind: Any) -> Description:
    marks = _marks(kind)
    taken = {mark.signature.uid for _, mark in marks}
    free = (uid for uid in itertools.count(FIRST_UID) if uid not in taken)
    described = Description(MetaObject(dict(BUILT_IN), {}, {}, (kind.__doc__ or "").strip()))
    for attribute, mark in marks:
        uid = mark.signature.uid or next(free)
        _add(described, attribute, replace(mark, signature=replace(mark.signature, uid=uid)))
    return described


def _marks(kind: type) -> list[tuple[str, Mark]]:
    """Return all marks in their order, those of base classes first, overridden ones once."""
    found: dict[str, tuple[str, Mark]] = {}
    for base in reversed(kind.__mro__):
        for attribute, member in vars(base).items():
            marks = getattr(member, MARK, ())
            if marks:  # a method that is only defined again keeps its signatures
                found = {key: it for key, it in found.items() if it[0] != attribute}
            for mark in marks:
                found[str(mark.signature)] = (attribute, mark)
    return list(found.values())


def _add(described: Description, attribute: str, mark: Mark) -> None:
    signature, meta = mark.signature, described.meta
    uid = signature.uid
    described.attributes[uid] = attribute
    if mark.kind == "method":
        meta.methods[uid] = signature
        if mark.blocks:
            described.blocking.add(uid)
        return
    if mark.kind == "property":
        meta.properties[uid] = signature
        signature = Signature(signature.name, f"({signature.returns})", "v", uid)
    meta.signals[uid] = signature
    described.signals[uid] = attribute


def signal_of(thing: Any, described: Description, uid: int) -> Signal | None:
    """Return a signal of an instance, also the one that a property has."""
    attribute = described.signals.get(uid)
    declared = getattr(type(thing), attribute) if attribute else None
    return declared.signal_of(thing) if isinstance(declared, _Declared) else None


# Threads that call what programs gave: one that keeps the order, and a few for what blocks.
#
# All end with the program, even when a call never returns.

Job = Callable[[], object]


class Turns:
    """Does jobs in threads that start when they are needed, at most ``most`` at once."""

    def __init__(self, name: str, most: int = 1) -> None:
        self._name = name
        self._most = most
        self._jobs: queue.SimpleQueue[tuple[Job, bool] | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._threads: list[threading.Thread] = []
        self._busy = 0
        self._is_closed = False

    def add(self, job: Job, *, is_owed: bool = False) -> None:
        """Do this as soon as a thread is free; with one thread, in the order of adding.

        ``is_owed``: even if ``close`` comes before its turn, since somebody waits for it.
        """
        with self._lock:
            if self._is_closed:
                return
            self._busy += 1
            if self._busy > len(self._threads) < self._most:
                name = f"{self._name}-{len(self._threads)}"
                thread = threading.Thread(target=self._work, name=name, daemon=True)
                self._threads.append(thread)
                thread.start()
        self._jobs.put((job, is_owed))

    def close(self) -> None:
        """Do no more jobs but what is owed; the one under way goes on."""
        with self._lock:
            self._is_closed = True
            for _ in self._threads:
                self._jobs.put(None)

    def is_here(self) -> bool:
        """Whether the caller is one of these threads."""
        return threading.current_thread() in self._threads

    def _work(self) -> None:
        while (next_one := self._jobs.get()) is not None:
            job, is_owed = next_one
            try:
                if is_owed or not self._is_closed:
                    job()
            except Exception:
                log.exception("a call that %s made failed", self._name)
            with self._lock:
                self._busy -= 1


# One object as the other side of a connection reaches it: its methods, signals and properties.

BLOCKING = Turns("naoqi-blocking", most=8)
"""The threads of the methods that wait."""
_calling = threading.local()


def caller() -> Peer | None:
    """Return the connection that calls, within a service method; None elsewhere."""
    return getattr(_calling, "peer", None)


class Bound:
    """Answers the calls to one object. Objects may be reached over several connections."""

    def __init__(self, thing: Any, service: int, number: int = 1) -> None:
        self.thing = thing
        self.service = service
        self.number = number
        self._described = description_of(type(thing))
        self._links: dict[tuple[Peer, int], Any] = {}
        self._own: dict[int, Callable[..., Any]] = {
            REGISTER: self._register,
            REGISTER_AS: self._register,
            UNREGISTER: self._unregister,
            META: lambda peer, *_: self._described.meta,
            TERMINATE: lambda peer, *_: peer.drop_object(self.service, self.number),
            GET: self._get,
            SET: self._set,
            PROPERTIES: self._names,
        }

    def take(self, frame: Frame, peer: Peer) -> None:
        """Do what a CALL or POST asks for, and answer a CALL."""
        _calling.peer = peer
        try:
            self._do(frame, peer)
        except NaoqiError as problem:
            peer.answer_error(frame, problem.sentence)
        except Exception as problem:
            log.exception("%s failed", type(self.thing).__name__)
            peer.answer_error(frame, str(problem) or type(problem).__name__)
        finally:
            _calling.peer = None

    def call(self, method: str, values: tuple[Any, ...]) -> Any:
        """Call a method from within this program. Raises NaoqiError, whatever it raises."""
        uid = self._described.meta.overload(method, values).uid
        return getattr(self.thing, self._described.attributes[uid])(*values)

    def begin(self, uid: int, values: tuple[Any, ...]) -> Pending:
        """Begin a method from within this program, in a thread. Raises NoSuchMethod."""
        attribute = self._described.attributes.get(uid)
        if attribute is None or uid not in self._described.meta.methods:
            raise NoSuchMethod("There is no method {uid} here.", uid=uid)
        return self._work(getattr(self.thing, attribute), values)

    def leave(self, peer: Peer) -> None:
        """This connection is not there any more."""
        for key in [key for key in list(self._links) if key[0] is peer]:
            self._links.pop(key)()

    def _do(self, frame: Frame, peer: Peer) -> None:
        uid = frame.action
        if uid == META and frame.kind == Kind.CALL:
            peer.answer(frame.answer(Kind.REPLY, self._described.meta.encoded))
            return
        signature = self._described.meta.methods.get(uid)
        if signature is None:
            self._emit(frame, peer)
            return
        values, wanted = self._arguments(frame, peer, signature)
        if uid in self._own:
            result = self._own[uid](peer, *values)
            self._answer(frame, peer, signature, result, wanted)
            return
        called = getattr(self.thing, self._described.attributes[uid])
        is_blocking = uid in self._described.blocking
        result = self._work(called, values) if is_blocking else called(*values)
        self._finish(frame, peer, signature, result, wanted)

    def _arguments(
        self, frame: Frame, peer: Peer, signature: Signature
    ) -> tuple[tuple[Any, ...], str]:
        """Return the values of a call, and the type that the caller wants back if it says so."""
        if frame.flags & DYNAMIC_PAYLOAD or signature.takes_any:
            reader = Reader(frame.payload, peer.trade(self.service))
            values = read_value(reader_of("m"), reader)
            values = tuple(values) if isinstance(values, list | tuple) else (values,)
            if not signature.takes_any and not signature.fits(values):
                raise WrongArguments(
                    "Arguments types did not match for {signature}.", signature=signature
                )
        else:
            reader = Reader(frame.payload, peer.trade(self.service))
            values = tuple(read_value(reader_of(signature.parameters), reader))
        wanted = read_value(reader_of("s"), reader) if frame.flags & RETURN_TYPE else ""
        return values, wanted

    def _work(self, called: Any, values: tuple[Any, ...]) -> Pending:
        """Call a method in a thread for those that wait."""
        promise = Promise()

        def work() -> None:
            try:
                result = called(*values)
            except NaoqiError as problem:
                promise.fail(problem.sentence)
            except Exception as problem:
                log.exception("a method of %s failed", type(self.thing).__name__)
                promise.fail(str(problem) or type(problem).__name__)
            else:
                promise.set(result)

        BLOCKING.add(work)
        return promise.future

    def _finish(
        self, frame: Frame, peer: Peer, signature: Signature, result: Any, wanted: str
    ) -> None:
        """Answer with a result, now or when it is there."""
        pending = result.future if isinstance(result, Promise) else result
        if not isinstance(pending, Pending):
            self._answer(frame, peer, signature, result, wanted)
            return

        def answer(value: Any) -> None:
            self._answer(frame, peer, signature, value, wanted)

        peer.answer_later(frame, pending, answer)

    def _answer(
        self, frame: Frame, peer: Peer, signature: Signature, result: Any, wanted: str
    ) -> None:
        if frame.kind != Kind.CALL:
            return
        try:
            payload = encode(signature.returns, result, peer.trade(self.service))
        except (WrongArguments, BadFrame) as problem:
            log.error("%s gave what it should not: %s", signature, problem.sentence)
            peer.answer_error(frame, problem.sentence)
            return
        if wanted and signature.returns != "m":  # the caller converts it by itself
            payload, flags = encode("m", result, peer.trade(self.service)), DYNAMIC_PAYLOAD
        else:
            flags = 0
        peer.answer(frame.answer(Kind.REPLY, payload, flags))

    def _emit(self, frame: Frame, peer: Peer) -> None:
        """A POST to a signal emits it for everybody."""
        signal = signal_of(self.thing, self._described, frame.action)
        if signal is None or frame.kind != Kind.POST:
            place = f"{{{frame.service}.{frame.object}.{frame.action}, id:{frame.number}}}"
            raise BadFrame("No such method {place}", place=place)
        declared = self._described.meta.signals[frame.action]
        values, _ = self._arguments(frame, peer, declared)
        signal.emit(*values)

    def _register(self, peer: Peer, _number: int, uid: int, link: int, _type: str = "") -> int:
        signal = signal_of(self.thing, self._described, uid)
        if signal is None:
            raise BadFrame("No such signal")
        declared = self._described.meta.signals[uid]

        def tell(*values: Any) -> None:
            self._tell(peer, declared, values)

        old = self._links.pop((peer, link), None)
        if old is not None:
            old()
        self._links[peer, link] = signal.listen(tell)
        return link

    def _tell(self, peer: Peer, declared: Signature, values: tuple[Any, ...]) -> None:
        try:
            payload = encode(declared.parameters, values, peer.trade(self.service))
            peer.send(Frame(Kind.EVENT, 0, self.service, self.number, declared.uid, payload))
        except WrongArguments as problem:
            log.error("%s was emitted wrongly: %s", declared, problem.sentence)
        except ConnectionLost:
            self.leave(peer)

    def _unregister(self, peer: Peer, number: int, _uid: int, link: int) -> None:
        end = self._links.pop((peer, link), None)
        if end is None:
            raise BadFrame(
                "Unregister request failed for {link} {number}", link=link, number=number
            )
        end()

    def _property(self, key: Any) -> str:
        meta = self._described.meta
        found = meta.properties.get(key) if isinstance(key, int) else meta.property(str(key))
        if found is None:
            raise BadFrame("Unknown property: {key}", key=key)
        return self._described.attributes[found.uid]

    def _get(self, peer: Peer, key: Any) -> Any:
        return getattr(self.thing, self._property(key))

    def _set(self, peer: Peer, key: Any, value: Any) -> None:
        attribute = self._property(key)
        uid = next(u for u, a in self._described.attributes.items() if a == attribute)
        wanted, trade = self._described.meta.properties[uid].returns, peer.trade(self.service)
        value = read_value(reader_of(wanted), Reader(encode(wanted, value, trade), trade))
        setattr(self.thing, attribute, value)

    def _names(self, peer: Peer) -> list[str]:
        return [it.name for it in self._described.meta.properties.values()]
