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
import re
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Literal, TypeVar

import msgspec

from faults import Tr, plain
from faults.files import content, whole_file, write_whole
from nep_core.wire.frames import CANNOT_DECODE

# The System Usability Scale: its items and its score, as in the paper and as Brooke made it.
#
# Source: J. Brooke, "SUS: a quick and dirty usability scale", in P. W. Jordan et al. (eds.),
# Usability Evaluation in Industry, Taylor & Francis 1996, pp. 189-194. Odd items are told in
# favour of the thing that is judged, even items against it. Brooke gives five options; an answer
# is worth 0 to 4: for odd items the option less 1, for even items 5 less the option. The sum, 0 to
# 40, times 2.5 is a score from 0 to 100.
# The paper (section "Evaluation of End-user Programming Interface", table "Subjective Satisfaction
# Scores") has seven options and words after K. Finstad, "The System Usability Scale and non-native
# English speakers", Journal of Usability Studies 1 (2006) 185-188, and does not write its formula
# down. The same way of counting with k options makes an answer worth 0 to k - 1, and
#     score = 100 / (10 (k - 1)) · (Σ odd (x - 1) + Σ even (k - x)),
# which is Brooke's for k = 5. For k = 7 the means of the paper's table give 78.3. They are told to
# one decimal, so that the true score is between 77.5 and 79.2, and the paper's 78.6 is in there.

ITEMS = 10
PAPER, BROOKE = "sus-7", "sus-5"
"""The two questionnaires, by their names in files."""

Answers = Sequence[int | None]
"""The option that was chosen for each item, from 1; None for one that was left open."""


@dataclass(frozen=True)
class Questionnaire:
    """Ten items and what one can answer, from strong disagreement to strong agreement."""

    id: str
    title: str
    items: tuple[str, ...]
    options: tuple[str, ...]

    @property
    def middle(self) -> int:
        """The option in the middle, from 1."""
        return (len(self.options) + 1) // 2


def questionnaire(questionnaire_id: str, tr: Tr = plain) -> Questionnaire:
    """The questionnaire of this name in the words of ``tr``; the paper's for any other name."""
    return brooke_questionnaire(tr) if questionnaire_id == BROOKE else paper_questionnaire(tr)


def paper_questionnaire(tr: Tr = plain) -> Questionnaire:
    """The paper's: seven options, in its words."""
    items = (
        tr("I think that I would like to use this interface frequently"),
        tr("I found the interface unnecessarily complex"),
        tr("I thought the interface was easy-to-use"),
        tr("I needed technical support to use this interface"),
        tr("I found the functions in this interface well integrated"),
        tr("There was too much inconsistency in this interface"),
        tr("Most people can learn to use this interface very quickly"),
        tr("The interface is very difficult/awkward to use"),
        tr("I felt very confident using the interface"),
        tr("I learned a lot of things before I could use the interface"),
    )
    options = (
        tr("Strongly disagree"),
        tr("Disagree"),
        tr("Rather disagree"),
        tr("Neither agree nor disagree"),
        tr("Rather agree"),
        tr("Agree"),
        tr("Strongly agree"),
    )
    return Questionnaire(PAPER, tr("As in the paper, with 7 options"), items, options)


def brooke_questionnaire(tr: Tr = plain) -> Questionnaire:
    """Brooke's: five options, in his words."""
    items = (
        tr("I think that I would like to use this system frequently"),
        tr("I found the system unnecessarily complex"),
        tr("I thought the system was easy to use"),
        tr(
            "I think that I would need the support of a technical person to be able to use this"
            " system"
        ),
        tr("I found the various functions in this system were well integrated"),
        tr("I thought there was too much inconsistency in this system"),
        tr("I would imagine that most people would learn to use this system very quickly"),
        tr("I found the system very cumbersome to use"),
        tr("I felt very confident using the system"),
        tr("I needed to learn a lot of things before I could get going with this system"),
    )
    options = (
        tr("Strongly disagree"),
        tr("Disagree"),
        tr("Neither agree nor disagree"),
        tr("Agree"),
        tr("Strongly agree"),
    )
    return Questionnaire(BROOKE, tr("As Brooke made it, with 5 options"), items, options)


def sus_score(answers: Answers, options: int) -> float:
    """The score of one person, 0 to 100.

    An item left open counts as the option in the middle, as Brooke tells people to mark it.
    Raises ValueError where there are not ten answers, or one is not an option, or all are open.
    """
    if len(answers) != ITEMS or all(answer is None for answer in answers):
        raise ValueError(f"a score needs {ITEMS} items of which one at least is answered")
    middle = (options + 1) / 2
    filled = [middle if answer is None else answer for answer in answers]
    if any(not 1 <= answer <= options for answer in filled):
        raise ValueError(f"an answer is 1 to {options}, not {list(answers)}")
    return score_of_means(filled, options)


def score_of_means(means: Sequence[float], options: int) -> float:
    """The score, 0 to 100, of the mean answers to ten items: the mean score of the people."""
    in_favour, against = means[0::2], means[1::2]
    worth = sum(mean - 1 for mean in in_favour) + sum(options - mean for mean in against)
    return 100 * worth / (ITEMS * (options - 1))


# In which order a person meets the conditions of a study: a balanced Latin square.
#
# Source: E. J. Williams, "Experimental designs balanced for the estimation of residual effects of
# treatments", Australian Journal of Scientific Research A 2 (1949) 149-168. Each condition is as
# often at each place, and follows each other one as often. An odd number of conditions needs two
# squares, of which the second is the mirror of the first.


def latin_square(count: int) -> list[list[int]]:
    """The rows of the square for so many conditions, which are numbered from 0."""
    first = [0]
    for step in range(1, count):
        first.append((first[-1] + (step if step % 2 else -step)) % count)
    square = [[(number + row) % count for number in first] for row in range(count)]
    return square + [row[::-1] for row in square] if count % 2 and count > 1 else square


def conditions_for(participant: int, conditions: Sequence[str]) -> list[str]:
    """The conditions in the order for a participant, who are numbered from 1."""
    if not conditions:
        return []
    square = latin_square(len(conditions))
    return [conditions[number] for number in square[(participant - 1) % len(square)]]


def participant_number(code: str) -> int | None:
    """The number in a participant's code, as 7 in P07; None where there is none."""
    found = re.search(r"(\d{1,9})\D*$", code)
    return int(found[1]) or None if found else None


def next_code(codes: Sequence[str]) -> str:
    """A code for the next participant, P01 for the first."""
    last = max((participant_number(code) or 0 for code in codes), default=0)
    return f"P{last + 1:02d}"


# What a study keeps, in files in the person's own folder: answers, and events of sessions.

log = logging.getLogger(__name__)


What = Literal[
    "study_started", "app_opened", "project_opened", "run_asked", "run_started", "first_run",
    "run_ended", "stop_pressed", "error_told", "help_opened", "edits", "questionnaire_answered",
    "app_closed", "study_stopped",
]  # fmt: skip
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
Value = TypeVar("Value")


class StudyFolder:
    """The files of one person's studies; methods that write raise OSError."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._open, self._setup = folder / "open.json", folder / "setup.json"
        self._answers, self._events = folder / "answers.jsonl", folder / "events.jsonl"

    def sitting(self) -> Sitting | None:
        """The sitting that is recorded now, also after a new start of the program."""
        try:
            return msgspec.json.decode(content(self._open), type=Sitting)
        except (OSError, *CANNOT_DECODE):
            return None

    def begin(self, sitting: Sitting) -> None:
        """Record a sitting from now on."""
        self.folder.mkdir(parents=True, exist_ok=True)
        write_whole(self._open, msgspec.json.encode(sitting))

    def finish(self) -> None:
        """Record no more."""
        self._open.unlink(missing_ok=True)

    def conditions(self) -> list[str]:
        """The conditions that are compared, as they were given last."""
        try:
            return msgspec.json.decode(content(self._setup), type=list[str])
        except (OSError, *CANNOT_DECODE):
            return []

    def set_conditions(self, conditions: Sequence[str]) -> None:
        """Remember which conditions are compared."""
        self.folder.mkdir(parents=True, exist_ok=True)
        write_whole(self._setup, msgspec.json.encode(list(conditions)))

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
            if file.tell():
                file.seek(-1, io.SEEK_END)
                if file.read() != b"\n":
                    line = b"\n" + line  # the last line was cut short
            file.write(line)


def _lines(path: Path, kind: type[Record]) -> Iterator[Record]:
    try:
        lines = content(path).splitlines()
    except OSError:
        return
    for number, line in enumerate(lines, 1):
        if line.strip():
            try:
                yield msgspec.json.decode(line, type=kind)
            except CANNOT_DECODE as error:
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
    return without_formula(cell.replace("\0", "")) if isinstance(cell, str) else cell


def without_formula(cell: Value) -> Value | str:
    """A value as a cell that no program for tables takes for something to reckon or to fetch."""
    if isinstance(cell, str) and cell.lstrip(" \xa0").startswith(FORMULA_SIGNS):
        return f"'{cell}"
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
    from statistics import fmean, pstdev  # loaded with a study, not with the window

    return Spread(fmean(values), pstdev(values), len(values)) if values else Spread()
