"""What begins a rule without being told: a condition that becomes true, and the time."""

from __future__ import annotations

import datetime
import re
import time
from collections.abc import Callable
from typing import Literal

from nep_core.errors import NepError

from .tasks import CLOCK, POLL_S, RuleStopped, current_task, wait

Fire = Callable[[], object]
Watch = Callable[[Fire], None]
"""Fires each time that something comes about; goes on until it is cancelled."""

Days = Literal[
    "every_day",
    "weekdays",
    "weekends",
    "monday",
    "tuesday",
    "wednesday",
    "thursday",
    "friday",
    "saturday",
    "sunday",
]

TELL_AGAIN_S = 1.0
"""What happens over and over is told no more often than this."""
SHORTEST_S = 0.01
"""A rule that begins more often than that would leave no time for anything else."""
LOOK_AT_CLOCK_S = 10.0
"""So long no clock is looked at: somebody may set it meanwhile."""

_WEEK = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")
_DAYS: dict[str, frozenset[str]] = {
    "every_day": frozenset(_WEEK),
    "weekdays": frozenset(_WEEK[:5]),
    "weekends": frozenset(_WEEK[5:]),
    **{day: frozenset({day}) for day in _WEEK},
}
_CLOCK_TIME = re.compile(r"(?P<hour>[01]?[0-9]|2[0-3]):(?P<minute>[0-5][0-9])")


class TimeRefused(NepError, title="The program stopped with an error"):
    """A time at which no rule can begin."""


def each_time_true(
    condition: Callable[[], object], note: Callable[[BaseException], object]
) -> Watch:
    """Fire each time that a condition becomes true.

    One that fails counts as no; ``note`` is given the error, once a second at most.
    """

    def watch(fire: Fire) -> None:
        was_true, told_s = False, -TELL_AGAIN_S
        was_wrong = False
        while True:
            try:
                is_true, is_wrong = bool(condition()), False
            except RuleStopped:  # in an own block that is asked
                is_true, is_wrong = False, False
            except Exception as error:
                is_true, is_wrong = False, True
                now_s = time.monotonic()
                if not was_wrong and now_s - told_s >= TELL_AGAIN_S:
                    told_s = now_s
                    note(error)
            if is_true and not was_true:
                fire()
            was_true, was_wrong = is_true, is_wrong
            current_task().sleep(POLL_S)

    return watch


def each(seconds: float) -> Watch:
    """Fire after so many seconds of the program, and so on; raises TimeRefused for too few.

    What was missed, as while the computer slept, is not made up for.
    """
    if not seconds >= SHORTEST_S:
        raise TimeRefused(
            "A rule cannot begin every {seconds} seconds.",
            checklist=("Write a time of at least a hundredth of a second.",),
            seconds=seconds,
        )

    def watch(fire: Fire) -> None:
        next_s = CLOCK.now_s() + seconds
        while True:
            wait(max(0.0, next_s - CLOCK.now_s()))
            fire()
            missed = max(0.0, CLOCK.now_s() - next_s) // seconds
            next_s += (1 + missed) * seconds

    return watch


def each_day(at: str, days: str) -> Watch:
    """Fire when the clock of the computer shows a time such as "09:30", on these days.

    Once in a minute of a day, also when the clock is set back. Raises TimeRefused for what is no
    time or no days.
    """
    said = _CLOCK_TIME.fullmatch(str(at).strip())
    if said is None or days not in _DAYS:
        raise TimeRefused(
            "“{time}” on “{days}” is no time of a day.",
            checklist=("Write hours and minutes with a colon, such as 09:30.",),
            time=at,
            days=days,
        )
    wanted = datetime.time(int(said["hour"]), int(said["minute"]))

    def watch(fire: Fire) -> None:
        fired: datetime.datetime | None = None
        while True:
            now = local_now()
            minute = now.replace(second=0, microsecond=0)
            is_it = minute.time() == wanted and _WEEK[now.weekday()] in _DAYS[days]
            if is_it and minute != fired:
                fired = minute
                fire()
            current_task().sleep(_until_look_s(now, wanted))

    return watch


def _until_look_s(now: datetime.datetime, wanted: datetime.time) -> float:
    """How long the clock need not be looked at: until the next minute of that name, or less."""
    then = datetime.datetime.combine(now.date(), wanted)
    if then <= now:
        then += datetime.timedelta(days=1)
    return min((then - now).total_seconds(), LOOK_AT_CLOCK_S)


def local_now() -> datetime.datetime:
    """What the clock of the computer shows."""
    return datetime.datetime.now()
