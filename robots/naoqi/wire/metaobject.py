"""What an object can do: its methods, signals and properties, as it tells the other side."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from faults import Text, text_of

from .codec import encode
from .errors import BadFrame, NoSuchMethod, WrongArguments
from .types import Type, fit, parse_type, take_type, type_text_of

META_METHOD = (
    "(Issss[(ss)<MetaMethodParameter,name,description>]s)"
    "<MetaMethod,uid,returnSignature,name,parametersSignature,description,"
    "parameters,returnDescription>"
)
META_SIGNAL = "(Iss)<MetaSignal,uid,name,signature>"
META_PROPERTY = "(Iss)<MetaProperty,uid,name,signature>"
META_OBJECT = (
    f"({{I{META_METHOD}}}{{I{META_SIGNAL}}}{{I{META_PROPERTY}}}s)"
    "<MetaObject,methods,signals,properties,description>"
)


@dataclass(frozen=True)
class Signature:
    """One method, signal or property: ``name::returns(parameters)``, and its number.

    For a signal ``parameters`` are the types of its values; for a property ``returns`` is its type.
    """

    name: str
    parameters: str = "()"
    returns: str = "v"
    uid: int = 0
    description: str = ""

    @classmethod
    def parse(cls, text: str, *, uid: int = 0, description: str = "") -> Signature:
        """Read ``goToPosture::b(sf)``, ``touched::(m)`` or ``volume::f``. Raises BadFrame."""
        name, mark, rest = text.partition("::")
        if not (name and mark):
            raise BadFrame("“{text}” is not name::returns(parameters).", text=text[:80])
        first, rest = take_type(rest)
        if not rest:
            is_signal = first.letter == "("
            parameters, returns = (str(first), "v") if is_signal else ("()", str(first))
            return cls(name, parameters, returns, uid, description)
        return cls(name, str(parse_type(rest)), str(first), uid, description)

    @cached_property
    def parameter_types(self) -> tuple[Type, ...]:
        """The types of the parameters, one by one."""
        return parse_type(self.parameters).parts

    @property
    def takes_any(self) -> bool:
        """Whether it takes any number of values, as one dynamic value."""
        return self.parameters == "m"

    def fits(self, values: tuple[Any, ...]) -> float:
        """How well these values fit: 1 as they are, 0 not at all."""
        types = self.parameter_types
        if self.takes_any:
            return 0.5
        if len(types) != len(values):
            return 0.0
        fits = [fit(value, wanted) for value, wanted in zip(values, types, strict=True)]
        return sum(fits) / len(fits) if all(fits) and fits else float(not fits)

    def __str__(self) -> str:
        return f"{self.name}::{self.parameters}"


@dataclass(frozen=True)
class MetaObject:
    """All that an object can do, by number."""

    methods: dict[int, Signature] = field(default_factory=dict)
    signals: dict[int, Signature] = field(default_factory=dict)
    properties: dict[int, Signature] = field(default_factory=dict)
    description: str = ""

    @classmethod
    def from_wire(cls, value: Any) -> MetaObject:
        """Return what a decoded description says. Raises BadFrame."""
        try:
            methods, signals, properties, description = value
            return cls(
                {uid: Signature(it[2], it[3], it[1], uid, it[4]) for uid, it in methods.items()},
                {uid: Signature(it[1], it[2], "v", uid) for uid, it in signals.items()},
                {uid: Signature(it[1], "()", it[2], uid) for uid, it in properties.items()},
                description,
            )
        except (ValueError, TypeError, AttributeError, IndexError) as problem:
            raise BadFrame("An object describes itself in a way that is not known.") from problem

    @cached_property
    def encoded(self) -> bytes:
        """The bytes of this description."""
        methods: dict[int, tuple[Any, ...]] = {
            uid: (uid, it.returns, it.name, it.parameters, it.description, [], "")
            for uid, it in self.methods.items()
        }
        signals = {uid: (uid, it.name, it.parameters) for uid, it in self.signals.items()}
        properties = {uid: (uid, it.name, it.returns) for uid, it in self.properties.items()}
        return encode(META_OBJECT, (methods, signals, properties, self.description))

    @cached_property
    def by_name(self) -> dict[str, list[Signature]]:
        """All overloads of each method."""
        found: dict[str, list[Signature]] = {}
        for signature in self.methods.values():
            found.setdefault(signature.name, []).append(signature)
        return found

    def signal(self, name: str) -> Signature | None:
        """Return the signal of this name, also the one that a property has."""
        return _named(self.signals.values(), name)

    def property(self, name: str) -> Signature | None:
        """Return the property of this name."""
        return _named(self.properties.values(), name)

    def overload(self, name: str, values: tuple[Any, ...]) -> Signature:
        """Return the method that fits these values best. Raises NoSuchMethod, WrongArguments.

        ``name`` may also be whole, ``say::(s)``.
        """
        short, is_whole, _ = name.partition("::")
        overloads = self.by_name.get(short, [])
        if not overloads:
            raise NoSuchMethod("There is no method “{short}” here.", short=short)
        if is_whole:
            overloads = [one for one in overloads if str(one) == name]
        fitting = [
            one for one in overloads if one.takes_any or len(one.parameter_types) == len(values)
        ]
        if len(fitting) > 1:
            fitting = [max(fitting, key=lambda one: one.fits(values))]
        if not fitting or (len(overloads) > 1 and not fitting[0].fits(values)):
            raise WrongArguments(_mismatch(name, values, overloads))
        return fitting[0]


def _named(signatures: Iterable[Signature], name: str) -> Signature | None:
    return next((one for one in signatures if one.name == name), None)


def _mismatch(name: str, values: tuple[Any, ...], overloads: list[Signature]) -> Text:
    """Say it as NAOqi does, so that who knows NAOqi finds it."""
    try:
        given = type_text_of(values)
    except TypeError:
        given = "(?)"
    known = ", ".join(map(str, overloads)) or "none"
    wrong = f"Arguments types did not match for {name} (resolved to '{name}::{given}')"
    return text_of("{wrong}. There is: {known}.", wrong=wrong, known=known)
