"""What a study keeps, in files in the person's own folder: answers, and events of sessions.

    <folder>/open.json       the session that is recorded now; not there while none is
    <folder>/setup.json      the conditions that are compared
    <folder>/answers.jsonl   one questionnaire a line
    <folder>/events.jsonl    one event a line

Each line is written at once. A line that cannot be read, as after a full disk, is left out.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Literal, TypeVar

import msgspec

from nep_studio.study.sus import PAPER, questionnaire, sus_score

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
