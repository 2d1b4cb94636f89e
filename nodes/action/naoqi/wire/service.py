"""How a class becomes a service: its methods, signals and properties with their NAOqi signatures.

    class Lamp:
        touched = signal("touched::(m)")
        brightness = Property("brightness::f", 1.0)

        @method("shine::b(sf)")
        def shine(self, colour: str, seconds: float) -> bool: ...

Overloads are several methods with one NAOqi name. Calls of one caller come one after the other;
callers come at the same time. A method that has to wait returns ``promise.future``, or says
``blocks=True`` and gets a thread.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, TypeVar

from .inference import MARK
from .metaobject import META_OBJECT, MetaObject, Signature

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


def method(
    signature: str, *, uid: int = 0, description: str = "", blocks: bool = False
) -> Callable[[Method], Method]:
    """Offer a method under this signature, such as ``goToPosture::b(sf)``."""
    mark = Mark(Signature.parse(signature, uid=uid, description=description), blocks)

    def note(function: Method) -> Method:
        setattr(function, MARK, (*getattr(function, MARK, ()), mark))
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
