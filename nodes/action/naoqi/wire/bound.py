"""One object as the other side of a connection reaches it: its methods, signals and properties."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import service as s
from .decoding import Reader, read_value, reader_of
from .encoding import encode
from .errors import (
    BadFrame,
    CallCancelled,
    ConnectionLost,
    NaoqiError,
    NoSuchMethod,
    WrongArguments,
)
from .frames import DYNAMIC_PAYLOAD, RETURN_TYPE, Frame, Kind
from .metaobject import Signature
from .promise import Pending, Promise
from .turns import Turns

if TYPE_CHECKING:
    from .peer import Peer

log = logging.getLogger(__name__)

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
        self._described = s.description_of(type(thing))
        self._links: dict[tuple[Peer, int], Any] = {}
        self._own: dict[int, Callable[..., Any]] = {
            s.REGISTER: self._register,
            s.REGISTER_AS: self._register,
            s.UNREGISTER: self._unregister,
            s.META: lambda peer, *_: self._described.meta,
            s.TERMINATE: lambda peer, *_: peer.drop_object(self.service, self.number),
            s.GET: self._get,
            s.SET: self._set,
            s.PROPERTIES: self._names,
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
            raise NoSuchMethod(f"There is no method {uid} here.")
        return self._work(getattr(self.thing, attribute), values)

    def leave(self, peer: Peer) -> None:
        """This connection is not there any more."""
        for key in [key for key in list(self._links) if key[0] is peer]:
            self._links.pop(key)()

    def _do(self, frame: Frame, peer: Peer) -> None:
        uid = frame.action
        if uid == s.META and frame.kind == Kind.CALL:
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
                raise WrongArguments(f"Arguments types did not match for {signature}.")
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
        peer.running[frame.number] = pending

        def answer(done: Pending) -> None:
            peer.running.pop(frame.number, None)
            if isinstance(done.failure, CallCancelled):
                if frame.kind == Kind.CALL:
                    peer.answer(frame.answer(Kind.CANCELLED))
            elif done.failure is not None:
                peer.answer_error(frame, done.failure.sentence)
            else:
                self._answer(frame, peer, signature, done.value, wanted)

        pending.when_done(answer)

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
        signal = s.signal_of(self.thing, self._described, frame.action)
        if signal is None or frame.kind != Kind.POST:
            place = f"{{{frame.service}.{frame.object}.{frame.action}, id:{frame.number}}}"
            raise BadFrame(f"No such method {place}")
        declared = self._described.meta.signals[frame.action]
        values, _ = self._arguments(frame, peer, declared)
        signal.emit(*values)

    def _register(self, peer: Peer, _number: int, uid: int, link: int, _type: str = "") -> int:
        signal = s.signal_of(self.thing, self._described, uid)
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
            raise BadFrame(f"Unregister request failed for {link} {number}")
        end()

    def _property(self, key: Any) -> str:
        meta = self._described.meta
        found = meta.properties.get(key) if isinstance(key, int) else meta.property(str(key))
        if found is None:
            raise BadFrame(f"Unknown property: {key}")
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
