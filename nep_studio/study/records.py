"""What a study keeps, in files in the person's own folder: answers, and events of sessions.

    <folder>/open.json       the session that is recorded now; not there while none is
    <folder>/setup.json      the conditions that are compared
    <folder>/answers.jsonl   one questionnaire a line
    <folder>/events.jsonl    one event a line

Each line is written at once. A line that cannot be read, as after a full disk, is left out.
"""

from __future__ import annotations

import csv
import io
import logging
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from statistics import fmean, pstdev
from typing import Literal, TypeVar

import msgspec

from nep_core.places import whole_file

from .sus import ITEMS, PAPER, Questionnaire, questionnaire, sus_score

log = logging.getLogger(__name__)


What = Literal[
    "study_started",
    "app_opened",
    "project_opened",
    "run_asked",
    "run_started",
    "first_run",
    "run_ended",
    "stop_pressed",
    "error_told",
    "help_opened",
    "edits",
    "questionnaire_answered",
    "app_closed",
    "study_stopped",
]
"""What is recorded, and nothing else."""


class Sitting(msgspec.Struct, frozen=True):
    """One person with one condition; ``started_s`` is time.time()."""

    participant: str
    condition: str = ""
    started_s: float = msgspec.field(default_factory=time.time)


class Event(msgspec.Struct, frozen=True):
    """Something that happened; ``number`` counts or measures it, ``words`` tell of it."""

    sitting: Sitting
    what: What
    words: str = ""
    number: float | None = None
    time_s: float = msgspec.field(default_factory=time.time)

    @property
    def elapsed_s(self) -> float:
        """How long the sitting had lasted."""
        return self.time_s - self.sitting.started_s


class Reply(msgspec.Struct, frozen=True):
    """A questionnaire that somebody has answered; None is an item that was left open."""

    participant: str
    condition: str
    answers: list[int | None]
    questionnaire: str = PAPER
    time_s: float = msgspec.field(default_factory=time.time)

    @property
    def score(self) -> float:
        """From 0 to 100."""
        return sus_score(self.answers, len(questionnaire(self.questionnaire).options))

    @property
    def open_items(self) -> int:
        """How many items were left open."""
        return sum(answer is None for answer in self.answers)


Record = TypeVar("Record", bound=msgspec.Struct)


class StudyFolder:
    """The files of one person's studies; methods that write raise OSError."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._open, self._setup = folder / "open.json", folder / "setup.json"
        self._answers, self._events = folder / "answers.jsonl", folder / "events.jsonl"

    def sitting(self) -> Sitting | None:
        """The sitting that is recorded now, also after a new start of the program."""
        try:
            return msgspec.json.decode(self._open.read_bytes(), type=Sitting)
        except (OSError, msgspec.MsgspecError):
            return None

    def begin(self, sitting: Sitting) -> None:
        """Record a sitting from now on."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self._open.write_bytes(msgspec.json.encode(sitting))

    def finish(self) -> None:
        """Record no more."""
        self._open.unlink(missing_ok=True)

    def conditions(self) -> list[str]:
        """The conditions that are compared, as they were given last."""
        try:
            return msgspec.json.decode(self._setup.read_bytes(), type=list[str])
        except (OSError, msgspec.MsgspecError):
            return []

    def set_conditions(self, conditions: Sequence[str]) -> None:
        """Remember which conditions are compared."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self._setup.write_bytes(msgspec.json.encode(list(conditions)))

    def add_event(self, event: Event) -> None:
        """Keep an event."""
        self._append(self._events, event)

    def add_reply(self, reply: Reply) -> None:
        """Keep the answers to a questionnaire; raises ValueError where they have no score."""
        _ = reply.score
        self._append(self._answers, reply)

    def events(self) -> list[Event]:
        """All events, the oldest first."""
        return list(_lines(self._events, Event))

    def replies(self) -> list[Reply]:
        """All answers, the oldest first."""
        return [reply for reply in _lines(self._answers, Reply) if _has_score(reply)]

    def participants(self) -> list[str]:
        """The codes of all who took part."""
        found = [event.sitting.participant for event in self.events()]
        return list(dict.fromkeys([*found, *(reply.participant for reply in self.replies())]))

    def conditions_done(self, participant: str) -> set[str]:
        """The conditions that a participant has met already."""
        met = {
            one.sitting.condition for one in self.events() if one.sitting.participant == participant
        }
        return met | {one.condition for one in self.replies() if one.participant == participant}

    def delete_all(self) -> None:
        """Throw everything away that was kept, and record no more."""
        for path in (self._open, self._setup, self._answers, self._events):
            path.unlink(missing_ok=True)
        with suppress(OSError):
            self.folder.rmdir()

    def _append(self, path: Path, record: msgspec.Struct) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        line = msgspec.json.encode(record) + b"\n"
        with path.open("ab+") as file:
            if file.tell() and _last_byte(path) != b"\n":
                line = b"\n" + line  # the last line was cut short
            file.write(line)


def _last_byte(path: Path) -> bytes:
    with path.open("rb") as file:
        file.seek(-1, 2)
        return file.read(1)


def _lines(path: Path, kind: type[Record]) -> Iterator[Record]:
    try:
        lines = path.read_bytes().splitlines()
    except OSError:
        return
    for number, line in enumerate(lines, 1):
        if line.strip():
            try:
                yield msgspec.json.decode(line, type=kind)
            except msgspec.MsgspecError as error:
                log.warning("line %d of %s is left out: %s", number, path.name, error)


def _has_score(reply: Reply) -> bool:
    try:
        return reply.score >= 0
    except ValueError:
        return False


# Tables for spreadsheets: one row a questionnaire, and one row an event.
#
# A file is CSV as RFC 4180 has it, in UTF-8 with a byte order mark, without which spreadsheets
# misread letters. A cell of text that a spreadsheet would take for a formula gets an apostrophe
# before it (OWASP, "CSV Injection").

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
    with whole_file(path) as file:
        file.write(csv_text(columns, rows).encode("utf-8-sig", "replace"))


def _time(time_s: float) -> str:
    """Date and time as spreadsheets read them, in the time of the place."""
    return datetime.fromtimestamp(time_s).isoformat(" ", "seconds")


# What the answers of several people say together: means, deviations, and scores.
#
# A deviation is that of the people who were asked, divided by their number, as in the paper's
# table.


@dataclass(frozen=True)
class Spread:
    """A mean, the deviation from it, and of how many; ``count`` 0 means that nobody answered."""

    mean: float = 0.0
    deviation: float = 0.0
    count: int = 0


@dataclass(frozen=True)
class Summary:
    """Everything about one questionnaire: each item, each person, and all of them."""

    questionnaire: Questionnaire
    items: tuple[Spread, ...]
    replies: tuple[Reply, ...]
    overall: Spread
    by_condition: dict[str, Spread]


def summarize(replies: Sequence[Reply], form: Questionnaire) -> Summary:
    """Sum up the answers to this questionnaire; items that were left open do not count."""
    ours = tuple(reply for reply in replies if reply.questionnaire == form.id)
    items = tuple(
        spread([answer for reply in ours if (answer := reply.answers[number]) is not None])
        for number in range(len(form.items))
    )
    conditions = dict.fromkeys(reply.condition for reply in ours)
    by_condition = {
        condition: spread([reply.score for reply in ours if reply.condition == condition])
        for condition in conditions
    }
    return Summary(form, items, ours, spread([reply.score for reply in ours]), by_condition)


def spread(values: Sequence[float]) -> Spread:
    """Mean and deviation of values; of none, none."""
    return Spread(fmean(values), pstdev(values), len(values)) if values else Spread()
