"""Rules that begin by a condition or by the clock, the date in words, and timers."""

from __future__ import annotations

import datetime
import threading
from collections.abc import Callable, Iterator

import pytest

from nep_core.errors import ValueRefused
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks, timing, triggers
from nep_core.program.behavior import Behavior
from nep_core.program.tasks import CLOCK, Cancelled, Part, Task, stop_rule
from nep_core.program.timing import (
    date_today,
    start_timer,
    time_now,
    time_part,
    timer_seconds,
    weekday_today,
)
from nep_core.program.triggers import TimeRefused, Watch, each, each_day, each_time_true
from nep_core.program.values import speak

WAIT_S = 10.0
FRIDAY = datetime.datetime(2026, 11, 27, 9, 29, 59)


class Watching:
    """A watch that runs in a part of its own; each time that it fires can be waited for."""

    def __init__(self, watch: Watch) -> None:
        self._fired = threading.Semaphore(0)
        self.part = Part(lambda: watch(self._fired.release), "watch", Task()).start()

    def fires(self, timeout_s: float = WAIT_S) -> bool:
        return self._fired.acquire(timeout=timeout_s)

    def end(self) -> None:
        self.part.task.cancel()
        self.part.join(WAIT_S)
        assert not self.part.is_running


@pytest.fixture
def watching() -> Iterator[Callable[[Watch], Watching]]:
    made: list[Watching] = []

    def begin(watch: Watch) -> Watching:
        made.append(Watching(watch))
        return made[-1]

    yield begin
    for one in made:
        one.end()


class Clock:
    """The clock of a computer that somebody sets; each look at it is counted."""

    def __init__(self, now: datetime.datetime) -> None:
        self.now = now
        self._looks = threading.Semaphore(0)

    def __call__(self) -> datetime.datetime:
        self._looks.release()
        return self.now

    def set(self, **parts: int) -> None:
        """Set it, and wait until it was looked at, and what was seen was taken for it."""
        self.now = self.now.replace(**parts)
        while self._looks.acquire(blocking=False):
            pass
        for _ in range(2):
            assert self._looks.acquire(timeout=WAIT_S)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock(FRIDAY)
    monkeypatch.setattr(triggers, "local_now", made)
    monkeypatch.setattr(timing, "local_now", made)
    monkeypatch.setattr(triggers, "LOOK_AT_CLOCK_S", 0.01)
    return made


def test_a_rule_fires_each_time_that_its_condition_becomes_true(
    watching: Callable[[Watch], Watching],
) -> None:
    is_true = threading.Event()
    watch = watching(each_time_true(is_true.is_set, pytest.fail))

    is_true.set()
    assert watch.fires()
    assert not watch.fires(0.2)
    is_true.clear()
    assert not watch.fires(0.2)
    is_true.set()
    assert watch.fires()


def test_a_condition_that_fails_is_told_once_counts_as_no_and_is_asked_on(
    watching: Callable[[Watch], Watching],
) -> None:
    items: list[bool] = []
    errors: list[BaseException] = []
    watch = watching(each_time_true(lambda: items[0], errors.append))

    assert not watch.fires(0.5)
    assert [type(error) for error in errors] == [IndexError]
    items.append(True)
    assert watch.fires()


def test_a_condition_that_stops_the_rule_counts_as_no(
    watching: Callable[[Watch], Watching],
) -> None:
    answers = [stop_rule, lambda: True]
    watch = watching(each_time_true(lambda: answers.pop(0)() if answers else True, pytest.fail))

    assert watch.fires()


def test_a_condition_of_a_rule_begins_it(network: PeerNetwork) -> None:
    behavior, begun, told = Behavior(network=network), threading.Event(), threading.Event()
    behavior.when_true(told.is_set)(begun.set)
    thread = threading.Thread(target=behavior.run)
    thread.start()

    told.set()
    assert begun.wait(WAIT_S)
    tasks.PROGRAM.cancel()
    thread.join(WAIT_S)

    assert not thread.is_alive()


def test_every_so_often_fires_after_that_time_and_does_not_drift(
    watching: Callable[[Watch], Watching],
) -> None:
    begun_s = CLOCK.now_s()
    watch = watching(each(0.1))

    for _ in range(5):
        assert watch.fires()

    assert CLOCK.now_s() - begun_s >= 0.5 - 1e-3


def test_while_the_program_is_paused_no_time_passes_for_a_rule(
    watching: Callable[[Watch], Watching], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(CLOCK, "is_pausable", True)
    watch = watching(each(0.3))
    try:
        CLOCK.pause()
        assert not watch.fires(0.6)
    finally:
        CLOCK.resume()

    assert watch.fires()


def test_what_was_missed_is_not_made_up_for(
    watching: Callable[[Watch], Watching], monkeypatch: pytest.MonkeyPatch
) -> None:
    times = iter([0.0, 0.0, 100.5])
    monkeypatch.setattr(CLOCK, "now_s", lambda: next(times, 100.5))
    waited: list[float] = []

    def rest(seconds: float) -> None:
        waited.append(seconds)
        if len(waited) == 2:
            raise Cancelled

    monkeypatch.setattr(triggers, "wait", rest)
    watch = watching(each(1.0))
    watch.part.join(WAIT_S)

    assert waited == [1.0, 0.5]
    assert watch.fires(0) and not watch.fires(0)


@pytest.mark.parametrize("seconds", [0, -1, 0.001, float("nan")])
def test_a_time_that_is_too_short_is_refused(seconds: float) -> None:
    with pytest.raises(TimeRefused):
        each(seconds)


def test_a_rule_fires_once_in_its_minute(
    clock: Clock, watching: Callable[[Watch], Watching]
) -> None:
    watch = watching(each_day("09:30", "every_day"))
    assert not watch.fires(0.1)

    clock.set(minute=30, second=0)
    assert watch.fires()
    clock.set(second=30)
    clock.set(minute=29)
    clock.set(minute=30, second=10)

    assert not watch.fires(0.1)
    clock.set(day=28)
    assert watch.fires()


@pytest.mark.parametrize(
    ("days", "expected"),
    [
        ("every_day", [True] * 7),
        ("weekdays", [True] * 5 + [False] * 2),
        ("weekends", [False] * 5 + [True] * 2),
        ("sunday", [False] * 6 + [True]),
    ],
)
def test_a_rule_fires_on_its_days(
    clock: Clock, watching: Callable[[Watch], Watching], days: str, expected: list[bool]
) -> None:
    clock.now = datetime.datetime(2026, 11, 22, 9, 30)
    watch = watching(each_day("9:30", days))
    watch.fires(0.1)

    fired = []
    for day in range(23, 30):  # from Monday
        clock.set(day=day)
        fired.append(watch.fires(0.05))

    assert fired == expected


@pytest.mark.parametrize(("time", "days"), [("24:00", "monday"), ("9", "monday"), ("09:30", "x")])
def test_what_is_no_time_of_a_day_is_refused(time: str, days: str) -> None:
    with pytest.raises(TimeRefused):
        each_day(time, days)


def test_the_parts_of_the_time_are_numbers(clock: Clock) -> None:
    parts = ("hour", "minute", "second", "weekday", "day", "month", "year")

    assert [time_part(part) for part in parts] == [9, 29, 59, 5, 27, 11, 2026]
    with pytest.raises(ValueRefused):
        time_part("century")


@pytest.mark.parametrize(
    ("language", "expected"),
    [
        ("en", ["November 27, 2026", "9:29", "Friday"]),
        ("de", ["27. November 2026", "9:29 Uhr", "Freitag"]),
        ("es", ["27 de noviembre de 2026", "9:29", "viernes"]),
        ("fr", ["27 novembre 2026", "9 h 29", "vendredi"]),
        ("it", ["27 novembre 2026", "9:29", "venerdì"]),
        ("ja", ["2026年11月27日", "9時29分", "金曜日"]),
    ],
)
def test_date_and_time_are_told_in_the_language_of_the_program(
    clock: Clock, language: str, expected: list[str]
) -> None:
    speak(language)
    try:
        assert [date_today(), time_now(), weekday_today()] == expected
    finally:
        speak("en")


def test_a_timer_counts_from_its_start_but_not_while_the_program_is_paused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now_s = 5.0
    monkeypatch.setattr(CLOCK, "now_s", lambda: now_s)
    assert timer_seconds("never started") == 0

    start_timer("game")
    now_s = 7.5
    assert timer_seconds("game") == 2.5
    start_timer("game")

    assert timer_seconds("game") == 0
