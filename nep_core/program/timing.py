"""The time as programs ask for it: the clock and the date, told in words, and timers."""

from __future__ import annotations

import datetime
import threading
from collections.abc import Callable

from .tasks import CLOCK
from .triggers import local_now
from .values import as_text, refuse, spoken_language

_PARTS: dict[str, Callable[[datetime.datetime], int]] = {
    "hour": lambda now: now.hour,
    "minute": lambda now: now.minute,
    "second": lambda now: now.second,
    "weekday": lambda now: now.isoweekday(),
    "day": lambda now: now.day,
    "month": lambda now: now.month,
    "year": lambda now: now.year,
}


def time_part(part: str) -> int:
    """A part of what the clock shows now; "weekday" counts from 1 for Monday to 7 for Sunday.

    Raises ValueRefused for what is no part of a time.
    """
    if part not in _PARTS:
        refuse("“{part}” is no part of a time.", ", ".join(_PARTS), part=as_text(part))
    return _PARTS[part](local_now())


# How dates and times are told, by language.

_MONTHS = {
    "en": "January February March April May June July August September October November December",
    "de": "Januar Februar März April Mai Juni Juli August September Oktober November Dezember",
    "es": "enero febrero marzo abril mayo junio julio agosto septiembre octubre noviembre "
    "diciembre",
    "fr": "janvier février mars avril mai juin juillet août septembre octobre novembre décembre",
    "it": "gennaio febbraio marzo aprile maggio giugno luglio agosto settembre ottobre novembre "
    "dicembre",
}
_WEEKDAYS = {
    "en": "Monday Tuesday Wednesday Thursday Friday Saturday Sunday",
    "de": "Montag Dienstag Mittwoch Donnerstag Freitag Samstag Sonntag",
    "es": "lunes martes miércoles jueves viernes sábado domingo",
    "fr": "lundi mardi mercredi jeudi vendredi samedi dimanche",
    "it": "lunedì martedì mercoledì giovedì venerdì sabato domenica",
    "ja": "月曜日 火曜日 水曜日 木曜日 金曜日 土曜日 日曜日",
}
_DATES = {
    "en": "{month} {day}, {year}",
    "de": "{day}. {month} {year}",
    "es": "{day} de {month} de {year}",
    "fr": "{day} {month} {year}",
    "it": "{day} {month} {year}",
    "ja": "{year}年{number}月{day}日",
}
_FIRSTS = {"fr": "1er", "it": "1º"}
"""How the first day of a month is told where it is not just 1."""
_TIMES = {"de": "{hour}:{minute} Uhr", "fr": "{hour} h {minute}", "ja": "{hour}時{minute}分"}


def date_today() -> str:
    """The date of today, as it is told in the language of the program."""
    now, language = local_now(), spoken_language()
    names = _MONTHS.get(language, "").split()
    return _DATES[language].format(
        day=_FIRSTS.get(language, "1") if now.day == 1 else now.day,
        month=names[now.month - 1] if names else "",
        number=now.month,
        year=now.year,
    )


def time_now() -> str:
    """What the clock shows now, in hours and minutes, in the language of the program."""
    now = local_now()
    template = _TIMES.get(spoken_language(), "{hour}:{minute}")
    return template.format(hour=now.hour, minute=f"{now.minute:02}")


def weekday_today() -> str:
    """The name of the day of today, in the language of the program."""
    return _WEEKDAYS[spoken_language()].split()[local_now().weekday()]


# Timers: they count with the clock of the program, which stands still while that is paused.

_started_s: dict[str, float] = {}
_lock = threading.Lock()


def start_timer(name: object) -> None:
    """Let a timer count from 0, from now on."""
    with _lock:
        _started_s[as_text(name)] = CLOCK.now_s()


def timer_seconds(name: object) -> float:
    """How many seconds a timer has counted; 0 before it is started."""
    with _lock:
        started_s = _started_s.get(as_text(name))
    return 0 if started_s is None else max(0.0, CLOCK.now_s() - started_s)
