"""An object of the other side: calls its methods, hears its signals, reads its properties."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from .decoding import reader_of
from .encoding import encode
from .errors import NaoqiError, NoAnswer, NoSuchMethod, WrongArguments
from .frames import DYNAMIC_PAYLOAD
from .hearing import Hearing
from .metaobject import MetaObject, Signature
from .promise import Pending
from .service import GET, PROPERTIES, REGISTER, SET, UNREGISTER, Heard

if TYPE_CHECKING:
    from .peer import Peer

PATIENCE_S = 2.5
"""How long a call waits for its answer, unless it says so."""
_links = itertools.count(1)
NO_ANSWER = (
    "Is NAO switched on? Its chest button should glow.",
    "Is this computer on the same network as NAO?",
    "Wait a moment: NAO answers late while it starts or works hard.",
)


class RemoteObject:
    """An object on the robot. All calls may be made from any thread, but not from the reader's."""

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
            raise NaoqiError(f"{method} would wait for itself: use begin() here.")
        pending = self.begin(method, *args)
        if not pending.wait(timeout_s):
            self._peer.forget(pending)
            pending.cancel()
            raise NoAnswer(
                f"NAO has not answered {method} within {timeout_s:g} s.", checklist=NO_ANSWER
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
            raise NoSuchMethod(f"There is no signal “{signal}” here.")
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
            sentence = f"{signature.name} takes {signature.parameters}. {problem.sentence}"
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
