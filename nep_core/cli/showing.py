"""How commands show what they found: messages, tables, numbers."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any

import msgspec

from nep_core.errors import NepError
from nep_core.recordings.raw import RawMessage

SHOWN_BYTES = 32


def say(text: str) -> None:
    """One line for the reader, at once, also into a pipe; raises NepError."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left goes nowhere
        raise NepError(
            f"The output cannot be written: {(error.strerror or 'unknown reason').lower()}.",
            checklist=("Has the disk room for it?",),
        ) from error


def remark(text: str) -> None:
    """One line beside the output, so that a pipe gets the output only."""
    print(text, file=sys.stderr, flush=True)


def say_json(value: object) -> None:
    """One line of JSON, for machines."""
    say(msgspec.json.encode(value).decode())


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Columns side by side under their names."""
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = [
        "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]
    return "\n".join(lines)


def value_of(message: RawMessage) -> Any:
    """The message as plain values: text as text, bytes as bytes; raises msgspec.MsgspecError."""
    if message.encoding == "json":
        return msgspec.json.decode(message.payload)
    if message.encoding == "msgpack":
        return msgspec.msgpack.decode(message.payload)
    if message.encoding == "text":
        return message.payload.decode(errors="replace")
    return message.payload


def value_text(value: Any, *, pretty: bool = False) -> str:
    """A value as a person reads it: text as it is, bytes as numbers, all else as JSON."""
    if isinstance(value, str):
        return value
    if isinstance(value, bytes):
        start = value[:SHOWN_BYTES].hex(" ")
        return f"{len(value)} bytes: {start}{' ...' if len(value) > SHOWN_BYTES else ''}"
    try:
        text = msgspec.json.encode(value)
    except (TypeError, ValueError, RecursionError, msgspec.MsgspecError):
        return repr(value)  # what MessagePack has and JSON has not
    return (msgspec.json.format(text, indent=2) if pretty else text).decode(errors="replace")


class NoField(Exception):
    """There is no such field; what there is instead."""


def field_of(value: Any, path: str) -> Any:
    """The part of a value at "acc.0.2"; raises NoField that says what there is."""
    for step in path.split("."):
        if isinstance(value, dict) and step in value:
            value = value[step]
        elif isinstance(value, list) and step.isdigit() and int(step) < len(value):
            value = value[int(step)]
        else:
            inside = f' in "{path}"' if step != path else ""
            raise NoField(f'There is no field "{step}"{inside}; {_fields(value)}.')
    return value


def _fields(value: Any) -> str:
    if isinstance(value, dict):
        return f"there are {', '.join(map(str, value)) or 'none'}"
    if isinstance(value, list):
        return f"there is a list of {len(value)}, counted from 0"
    return f"there is {value_text(value)[:40]}"


def amount(count_bytes: float) -> str:
    """A number of bytes for people."""
    for unit in ("B", "KB", "MB"):
        if count_bytes < 1000:
            return f"{count_bytes:.0f} {unit}" if unit == "B" else f"{count_bytes:.1f} {unit}"
        count_bytes /= 1000
    return f"{count_bytes:.1f} GB"


def many(count: int, one: str) -> str:
    """ "1 message", "2 messages"."""
    return f"{count} {one}" if count == 1 else f"{count} {one}s"
