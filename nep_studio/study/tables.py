"""Tables for spreadsheets: one row a questionnaire, and one row an event.

A file is CSV as RFC 4180 has it, in UTF-8 with a byte order mark, without which spreadsheets
misread letters. A cell of text that a spreadsheet would take for a formula gets an apostrophe
before it (OWASP, "CSV Injection").
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from nep_studio.study.records import Event, Reply
from nep_studio.study.sus import ITEMS

FORMULA_SIGNS = ("=", "+", "-", "@", "\t", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")
Cell = str | float | None

EVENT_COLUMNS = ("time", "participant", "condition", "elapsed_s", "event", "number", "words")
REPLY_COLUMNS = (
    "time",
    "participant",
    "condition",
    "questionnaire",
    *(f"item_{number}" for number in range(1, ITEMS + 1)),
    "left_open",
    "score",
)


def write_replies(path: Path, replies: Iterable[Reply]) -> None:
    """Write one row for each questionnaire that was answered; raises OSError."""
    rows: list[list[Cell]] = [
        [
            _time(reply.time_s),
            reply.participant,
            reply.condition,
            reply.questionnaire,
            *reply.answers,
            reply.open_items,
            round(reply.score, 2),
        ]
        for reply in replies
    ]
    _write(path, REPLY_COLUMNS, rows)


def write_events(path: Path, events: Iterable[Event]) -> None:
    """Write one row for each event; raises OSError."""
    rows: list[list[Cell]] = [
        [
            _time(event.time_s),
            event.sitting.participant,
            event.sitting.condition,
            round(event.elapsed_s, 3),
            event.what,
            event.number,
            event.words,
        ]
        for event in events
    ]
    _write(path, EVENT_COLUMNS, rows)


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """The table as CSV; an empty cell where nothing is known."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(columns)
    writer.writerows([_cell(cell) for cell in row] for row in rows)
    return text.getvalue()


def _cell(cell: Cell) -> str | float:
    if cell is None:
        return ""
    if isinstance(cell, str):
        cell = cell.replace("\0", "")
        return f"'{cell}" if cell.lstrip(" \xa0").startswith(FORMULA_SIGNS) else cell
    return cell


def _write(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write beside the old file, then put the new one in its place in one step."""
    new = path.with_name(f".{path.name}.{os.getpid()}.new")
    try:
        data = csv_text(columns, rows).encode("utf-8-sig", "replace")
        new.write_bytes(data)
        os.replace(new, path)
    except OSError:
        with suppress(OSError):
            new.unlink(missing_ok=True)
        raise


def _time(time_s: float) -> str:
    """Date and time as spreadsheets read them, in the time of the place."""
    return datetime.fromtimestamp(time_s).isoformat(" ", "seconds")
