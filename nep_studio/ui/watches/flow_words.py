"""How a watch sends, in words and numbers: rate, loss, gaps, delay and the drift of its clock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from nep_studio.ui.words import count_words, tr

from .receiving import Flow

Grade = Literal["good", "fair", "poor"]

GOOD_HZ, FAIR_HZ = 25.0, 14.0
"""Gestures are told apart from 16 samples a second on; 25 and more are better."""
GOOD_LOSS, FAIR_LOSS = 0.02, 0.10
GOOD_DELAY_MS, FAIR_DELAY_MS = 150.0, 500.0
GOOD_GAPS, FAIR_GAPS = 0, 5
GOOD_DRIFT_PPM, FAIR_DRIFT_PPM = 500.0, 5000.0


@dataclass(frozen=True)
class Figure:
    """One number of a watch: what it is, the number with its unit, how good it is, and why."""

    name: str
    number: str
    grade: Grade
    words: str


def figures(flow: Flow) -> list[Figure]:
    """What is known of how a watch sends, the most important first."""
    return [*_rate(flow), *_loss(flow), *_gaps(flow), *_delay(flow), *_drift(flow)]


def figure_lines(flow: Flow) -> str:
    """The same, a line each, as for a tool tip."""
    return "\n".join(f"{one.name}: {one.number} ({one.words})" for one in figures(flow))


def rate_words(rate_hz: float) -> str:
    """Such as “62 samples a second”."""
    return count_words(round(rate_hz), "1 sample a second", "{n} samples a second")


def _grade(value: float, good: float, fair: float) -> Grade:
    """How good a value is of which less is better."""
    if value <= good:
        return "good"
    return "fair" if value <= fair else "poor"


def _rate(flow: Flow) -> Iterator[Figure]:
    grade = _grade(-flow.rate_hz, -GOOD_HZ, -FAIR_HZ)
    words = {
        "good": tr("fast enough"),
        "fair": tr("enough; 50 are better"),
        "poor": tr("too few: choose 50 in the app"),
    }
    number = tr("{number} a second", number=round(flow.rate_hz))
    yield Figure(tr("Samples"), number, grade, words[grade])


def _loss(flow: Flow) -> Iterator[Figure]:
    if flow.loss is None:
        return
    grade = _grade(flow.loss, GOOD_LOSS, FAIR_LOSS)
    words = {
        "good": tr("next to nothing is missing"),
        "fair": tr("it still works"),
        "poor": tr("go nearer to the Wi-Fi"),
    }
    percent = flow.loss * 100
    number = tr("{percent} %", percent=f"{percent:.1f}" if 0 < percent < 9.95 else f"{percent:.0f}")
    yield Figure(tr("Lost"), number, grade, words[grade])


def _gaps(flow: Flow) -> Iterator[Figure]:
    grade = _grade(flow.gaps, GOOD_GAPS, FAIR_GAPS)
    words = {
        "good": tr("it never paused in the last minute"),
        "fair": tr("short pauses in the last minute"),
        "poor": tr("many pauses: keep its screen on"),
    }
    yield Figure(tr("Gaps"), str(flow.gaps), grade, words[grade])


def _delay(flow: Flow) -> Iterator[Figure]:
    if flow.delay_ms is None:
        return
    grade = _grade(flow.delay_ms, GOOD_DELAY_MS, FAIR_DELAY_MS)
    words = {
        "good": tr("as good as at once"),
        "fair": tr("a little late"),
        "poor": tr("late: let the app send more often"),
    }
    number = tr("{number} ms", number=round(flow.delay_ms))
    yield Figure(tr("Delay"), number, grade, words[grade])


def _drift(flow: Flow) -> Iterator[Figure]:
    if flow.drift_ppm is None:
        return
    grade = _grade(abs(flow.drift_ppm), GOOD_DRIFT_PPM, FAIR_DRIFT_PPM)
    words = {
        "good": tr("its clock runs like ours"),
        "fair": tr("its clock runs a little differently; that is allowed for"),
        "poor": tr("its clock runs very differently; that is allowed for"),
    }
    per_hour_s = flow.drift_ppm * 3600 / 1e6
    number = tr("{seconds} s an hour", seconds=f"{per_hour_s:+.2f}")
    yield Figure(tr("Clock"), number, grade, words[grade])
