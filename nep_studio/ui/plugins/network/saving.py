"""Messages as files: JSON lines, or a table of their numbers and words as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import msgspec

from nep_studio.ui.node_style import as_json
from nep_studio.ui.running.runner import Heard


def as_json_lines(messages: Iterable[Heard]) -> str:
    """One line a message: when, from whom, and the message."""
    lines = (
        msgspec.json.encode(
            {"time": one.time_s, "sender": one.sender, "message": _json_safe(one.message)}
        ).decode()
        for one in messages
    )
    return "".join(f"{line}\n" for line in lines)


def as_csv(messages: Iterable[Heard]) -> str:
    """One row a message; a column for each value in it, named by its way: “joints.HeadYaw”."""
    rows = [
        {"time": _moment(one.time_s), "sender": one.sender, **dict(values_of(one.message))}
        for one in messages
    ]
    columns = list(dict.fromkeys(key for row in rows for key in row))
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def save(messages: Iterable[Heard], path: Path) -> None:
    """Write messages as the ending of the file's name says; raises OSError."""
    text = as_csv(messages) if path.suffix.lower() == ".csv" else as_json_lines(messages)
    path.write_text(text, encoding="utf-8", newline="")


def values_of(message: Any, way: str = "") -> Iterator[tuple[str, object]]:
    """All single values in a message with the way to each; a list is one value, as JSON."""
    data = msgspec.to_builtins(message) if isinstance(message, msgspec.Struct) else message
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from values_of(value, f"{way}.{key}" if way else str(key))
    elif isinstance(data, list | tuple | bytes):
        yield way or "message", as_json(data)
    else:
        yield way or "message", data


def number_fields(message: Any) -> list[str]:
    """The ways to the numbers in a message, and to lists of numbers: what can be plotted."""
    data = msgspec.to_builtins(message) if isinstance(message, msgspec.Struct) else message
    return list(_numbers(data, "")) if isinstance(data, Mapping) else []


def _numbers(data: Any, way: str) -> Iterator[str]:
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from _numbers(value, f"{way}.{key}" if way else str(key))
    elif _is_number(data) or _is_row(data):
        yield way


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_row(value: object) -> bool:
    """Whether it is a list of numbers, or of lists of numbers such as samples."""
    if not isinstance(value, list | tuple) or not value:
        return False
    return all(_is_number(one) or (isinstance(one, list | tuple) and _is_row(one)) for one in value)


def _json_safe(message: Any) -> Any:
    return as_json(message) if isinstance(message, bytes) else message


def _moment(time_s: float) -> str:
    return datetime.fromtimestamp(time_s).isoformat(timespec="milliseconds")
