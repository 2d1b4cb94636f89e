"""The call that a block stands for, when it is one call of the robot API.

    call = { on = "robot", method = "say", arguments = ["text"], keywords = { gesture = "face" } }
    call = { function = "wait", arguments = ["seconds"] }

``arguments`` and ``keywords`` name slots. A keyword whose slot holds its default is left out when
it is listed in ``optional``. Functions are those of nep_core; no other module can be reached.
"""

from __future__ import annotations

import keyword
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field


class CallError(ValueError):
    """A call that cannot be made; its text says why."""


@dataclass(frozen=True, slots=True)
class Call:
    """A function of nep_core, or a method of the robot in slot ``on``, with slots as arguments."""

    name: str
    on: str = ""
    arguments: tuple[str, ...] = ()
    keywords: Mapping[str, str] = field(default_factory=dict)
    optional: frozenset[str] = frozenset()


def read_call(data: object, slots: Collection[str]) -> Call:
    """Check a call read from TOML against the slots of its block, or raise CallError."""
    if not isinstance(data, dict):
        raise CallError("call must be a table")
    unknown = set(data) - {"method", "on", "function", "arguments", "keywords", "optional"}
    if unknown:
        raise CallError(f"call has no key “{min(unknown)}”")
    if ("method" in data) == ("function" in data) or ("method" in data) != ("on" in data):
        raise CallError("call needs either a function, or a method and the slot it is called on")
    call = Call(
        _identifier(data.get("method", data.get("function"))),
        str(data.get("on", "")),
        tuple(_slot_names(data.get("arguments", []), slots)),
        _keywords(data.get("keywords", {}), slots),
        frozenset(_slot_names(data.get("optional", []), slots)),
    )
    if call.on and call.on not in slots:
        raise CallError(f"call is on slot “{call.on}”, which the sentence does not have")
    if not call.optional <= set(call.keywords.values()):
        raise CallError("optional slots must be among the keywords")
    return call


def _keywords(data: object, slots: Collection[str]) -> dict[str, str]:
    if not isinstance(data, dict):
        raise CallError("keywords must be a table")
    _slot_names(list(data.values()), slots)
    return {_identifier(name): slot for name, slot in data.items()}


def _slot_names(data: object, slots: Collection[str]) -> list[str]:
    if not isinstance(data, list):
        raise CallError("arguments and optional must be lists of slots")
    for name in data:
        if name not in slots:
            raise CallError(f"call uses slot “{name}”, which the sentence does not have")
    return data


def _identifier(name: object) -> str:
    """Names from a file reach the code as they are, so that they must be plain public names."""
    plain = isinstance(name, str) and name.isascii() and name.isidentifier()
    if not plain or str(name).startswith("_") or keyword.iskeyword(str(name)):
        raise CallError(f"{name!a} is not the name of a function")
    return str(name)
