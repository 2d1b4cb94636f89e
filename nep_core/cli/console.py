"""What the commands share: how arguments are read, the network is joined, and results are shown."""

from __future__ import annotations

import _thread
import argparse
import difflib
import io
import math
import os
import signal
import sys
import threading
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TextIO

import msgspec

from faults import reason_of
from nep_core.errors import NepError
from nep_core.networks import transports
from nep_core.networks.network import Network
from nep_core.networks.registry import Registration
from nep_core.networks.transports import topics_of
from nep_core.recordings.raw import RawMessage
from nep_core.wire.frames import CANNOT_ENCODE


def join(options: argparse.Namespace, name: str = "") -> Network:
    """Take part in the network as ``name`` (default: the command and its process)."""
    name = name or f"nep-{options.command}-{os.getpid()}"
    network = transports.network_for(name, master=options.master)
    network.on_stop = _end_as_by_ctrl_c
    return network


def _end_as_by_ctrl_c() -> None:
    """``nep kill`` ends a command too, also one that waits: a recording is finished."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:
        _thread.interrupt_main()


@contextmanager
def end_undisturbed() -> Iterator[None]:
    """Last in a ``with``: a second Ctrl-C does not interrupt how the others are closed.

    The interrupt would leave a socket open for which ZeroMQ waits; run_command() takes it back.
    """
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.SIG_IGN)


def registrations(options: argparse.Namespace) -> list[Registration]:
    """Who is there; raises MasterNotFound."""
    return transports.registrations(options.master)


def near(word: str, known: Iterable[str]) -> list[str]:
    """The known words that a person may have meant, the nearest first."""
    names = {name.strip("/").casefold(): name for name in sorted(known)}
    found = difflib.get_close_matches(word.strip("/").casefold(), names, n=3, cutoff=0.6)
    return [names[name] for name in found]


def about_nobody(topic: str, told: list[Registration]) -> str:
    """A sentence when nobody publishes ``topic``, with names that are near; "" when one does."""
    published = {ends.topic for ends in topics_of(told) if ends.publishers}
    if topic in published:
        return ""
    others = near(topic, published)
    meant = f" Did you mean {' or '.join(others)}?" if others else ""
    return f"Nobody publishes {topic} yet; it is waited for. Ctrl-C ends.{meant}"


# Kinds of arguments that several commands take.

OWN = "--own"
"""Told to a master that a session starts for itself: other sessions do not join it."""

MOST_SECONDS = 1e6
"""Nearly twelve days; the longest wait of some systems is not much longer."""


def seconds(text: str) -> float:
    """A time for argparse, 0 to 1,000,000 s; raises ArgumentTypeError."""
    return number(text, 0.0, MOST_SECONDS)


def count(text: str) -> int:
    """A number of messages for argparse, 1 or more; raises ArgumentTypeError."""
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f'"{text}" is not a number from 1')
    return int(text)


def number(text: str, least: float, most: float) -> float:
    """A number for argparse, ``least`` to ``most``; raises ArgumentTypeError."""
    try:
        given = float(text)
    except ValueError:
        given = math.nan
    if not least <= given <= most:
        raise argparse.ArgumentTypeError(f'"{text}" is not a number from {least:g} to {most:.0f}')
    return given


def add_json(parser: argparse.ArgumentParser, told: str = "for machines: one line of JSON") -> None:
    """Let the command speak JSON."""
    parser.add_argument("--json", action="store_true", help=told)


def add_times(parser: argparse.ArgumentParser, verb: str) -> None:
    """Let the command end by itself."""
    add: Callable[..., object] = parser.add_argument
    add("--count", type=count, default=0, metavar="N", help=f"{verb} N messages, then end")
    add("--seconds", type=seconds, metavar="S", help="end after S seconds")


# How commands show what they found: messages, tables, numbers.

SHOWN_BYTES = 32

_STEERS = frozenset(("Cc", "Cf", "Cs", "Zl", "Zp"))
"""Categories of Unicode that a terminal obeys, or that turn what stands behind them around."""
_JOINS = frozenset("\u200c\u200d\u00ad")
_OF_OURS = frozenset("\n\t")


def visible(text: str, *, but: frozenset[str] = frozenset()) -> str:
    """A text of others with its control characters written out, as in JSON: \\u001b."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        _escaped(letter) if letter not in but and _steers(letter) else letter for letter in text
    )


def _escaped(letter: str) -> str:
    """A letter as JSON writes it in English ones: some, as in the flag of Wales, take two."""
    code = letter.encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{code[at : at + 4]}" for at in range(0, len(code), 4))


def _steers(letter: str) -> bool:
    return unicodedata.category(letter) in _STEERS and letter not in _JOINS


class Visible(io.TextIOBase):
    """A stream to a terminal on which nothing that others sent steers it, whoever prints it.

    Only our own ends of lines and tabs pass; what stands in a line of ours goes through ``visible``
    before, so that nobody forges lines.
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write a text without what steers."""
        self.stream.write(visible(text, but=_OF_OURS))
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)

    def flush(self) -> None:
        """Write what waits."""
        self.stream.flush()

    def fileno(self) -> int:
        """The number of the file."""
        return self.stream.fileno()

    def isatty(self) -> bool:
        """Whether somebody reads along."""
        return self.stream.isatty()

    def writable(self) -> bool:
        """It is there to be written to."""
        return True


@contextmanager
def only_visible() -> Iterator[None]:
    """Whatever is printed meanwhile cannot steer the terminal."""
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = Visible(sys.stdout), Visible(sys.stderr)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before


def say(text: str) -> None:
    """One line for the reader, at once, also into a pipe; raises NepError."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left goes nowhere
        raise NepError(
            "The output cannot be written: {reason}.",
            checklist=("Has the disk room for it?",),
            reason=reason_of(error),
        ) from error


def remark(text: str) -> None:
    """One line beside the output, so that a pipe gets the output only."""
    print(text, file=sys.stderr, flush=True)


def say_json(value: object) -> None:
    """One line of JSON, for machines."""
    say(msgspec.json.encode(value).decode())


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Columns side by side under their names."""
    rows = [[visible(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = [
        "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]
    return "\n".join(lines)


def value_of(message: RawMessage) -> Any:
    """The message as plain values: text as text, bytes as bytes; raises CANNOT_DECODE."""
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
        return visible(value)
    if isinstance(value, bytes):
        start = value[:SHOWN_BYTES].hex(" ")
        return f"{len(value)} bytes: {start}{' ...' if len(value) > SHOWN_BYTES else ''}"
    try:
        text = msgspec.json.encode(value)
    except CANNOT_ENCODE:
        return _repr(value)  # what MessagePack has and JSON has not
    return (msgspec.json.format(text, indent=2) if pretty else text).decode(errors="replace")


def _repr(value: Any) -> str:
    try:
        return repr(value)
    except RecursionError:
        return "…"


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
