"""The scores of the gesture benchmark as rows for people, with goals, and as data for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from benchmarks._gesture_folder import Folder
from benchmarks._gesture_scores import CLEAN, Score
from benchmarks._gesture_sensors import WORSE
from benchmarks._gesture_trials import (
    OTHERS,
    REFERENCES,
    SIMULATED,
    SIMULATED_LIVELY,
    WARPING,
    examples_named,
)
from nodes.perceptual.recognition.validation import NOTHING

Row = dict[str, Any]

F1_GOALS = {
    f"personal, {examples_named(5)}": 0.95,
    f"personal, {examples_named(3)}": 0.90,
    OTHERS: 0.85,
}
MOST_FALSE_A_MINUTE = 0.1
SIMULATED_RECALL = 0.9
SIMULATED_FALSE_A_MINUTE = 1.0


def rows_of(
    folder: Folder | None,
    scores: Sequence[Score],
    figure: Sequence[Score],
    notes: Sequence[str],
) -> list[Row]:
    """All figures, and what was left out."""
    rows = [_row(f"note: {note}", None, "") for note in notes]
    if folder is not None:
        rows += _about(folder)
        best = at_best(scores)
        for score in best:
            if score.sensor == CLEAN:
                rows += _clean_rows(folder.name, score, best)
                rows += _calm_rows(folder.name, score, scores)
        rows += [row for score in best for row in _other_rows(folder.name, score)]
    return rows + [row for score in figure for row in _figure_rows(score)]


def as_data(
    folder: Folder | None,
    scores: Sequence[Score],
    figure: Sequence[Score],
    notes: Sequence[str],
) -> dict[str, Any]:
    """Everything for programs: the scores at their best threshold, with all pairs."""
    idle_s = sum(float(one.t[-1]) for one in folder.everyday) if folder else 0.0
    return {
        "folder": folder.name if folder else "",
        "people": list(folder.people) if folder else [],
        "gestures": list(folder.gestures) if folder else [],
        "simulated": folder.is_simulated if folder else True,
        "everyday_s": round(idle_s, 1),
        "notes": list(notes),
        "scores": [
            _score_data(score) | {"f1_when_calm": _f1_when_calm(score, scores)}
            for score in at_best(scores)
        ],
        "simulated_figure": [_score_data(score) for score in figure],
    }


def at_best(scores: Sequence[Score]) -> list[Score]:
    """One score of each kind: at the threshold with the best F1, which only references choose."""
    best: dict[tuple[str, str, str], Score] = {}
    for score in scores:
        kind = (score.trial, score.method, score.sensor)
        if kind not in best or _worth(score) > _worth(best[kind]):
            best[kind] = score
    return list(best.values())


def _worth(score: Score) -> tuple[float, int]:
    return score.totals.f1, -score.false


def _about(folder: Folder) -> Iterator[Row]:
    kind = "simulated people" if folder.is_simulated else "people"
    count = len(folder.people)
    people = kind if count != 1 else kind.replace("people", "person")
    who = f"{folder.name}: {count} {people}, {len(folder.gestures)} gestures"
    sessions = [one for every in folder.people.values() for one in every]
    minutes = sum(float(one.t[-1]) for one in sessions) / 60
    yield _row(f"{who}: their streams", round(minutes, 2), "minutes")
    if folder.everyday:
        idle = sum(float(one.t[-1]) for one in folder.everyday) / 60
        yield _row(f"{folder.name}: everyday movement of others", round(idle, 2), "minutes")


def _clean_rows(name: str, score: Score, best: Sequence[Score]) -> Iterator[Row]:
    who = f"{name}: {score.trial}, {_named(score)}"
    if score.problem:
        yield _row(f"{who}: left out: {score.problem}", None, "")
    if not score.totals.pairs:
        return
    is_ours = score.method not in REFERENCES
    goal = F1_GOALS.get(score.trial) if is_ours else None
    f1 = _row(f"{who}: F1", score.totals.f1, "", at_least=goal)
    rival = next((one for one in best if (one.trial, one.method) == (score.trial, WARPING)), None)
    if is_ours and rival and rival.totals.f1:
        f1 |= {
            "reference": round(rival.totals.f1, 3),
            "ratio": round(score.totals.f1 / rival.totals.f1, 2),
        }
    yield f1
    yield _row(f"{who}: recall", score.totals.recall, "of gestures")
    yield _row(f"{who}: precision", score.totals.precision, "of triggers")
    if score.false_a_minute is not None:
        most = MOST_FALSE_A_MINUTE if goal else None
        yield _row(f"{who}: false triggers", score.false_a_minute, "a minute", at_most=most)
    if score.accuracy is not None:
        yield _row(f"{who}: told apart when cut out", score.accuracy, "of gestures")


def _calm_rows(name: str, score: Score, scores: Sequence[Score]) -> Iterator[Row]:
    """A reference at another threshold: with no more false triggers than are allowed to ours."""
    f1 = _f1_when_calm(score, scores)
    if score.method in REFERENCES and f1 is not None:
        most = f"at most {MOST_FALSE_A_MINUTE:g} false triggers a minute"
        yield _row(f"{name}: {score.trial}, {score.method} ({most}): F1", f1, "")


def _f1_when_calm(score: Score, scores: Sequence[Score]) -> float | None:
    """The best F1 of all thresholds with no more false triggers than are allowed."""
    same = (one for one in scores if one.key[:3] == score.key[:3])
    calm = [
        one.totals.f1
        for one in same
        if one.false_a_minute is not None and one.false_a_minute <= MOST_FALSE_A_MINUTE
    ]
    return round(max(calm), 4) if calm else None


def _other_rows(name: str, score: Score) -> Iterator[Row]:
    who = f"{name}: {score.trial}, {score.method}"
    if score.sensor in WORSE:
        if score.problem:
            yield _row(f"{who}, {score.sensor}: left out: {score.problem}", None, "")
        else:
            yield _row(f"{who}, {score.sensor}: F1", score.totals.f1, "")
    elif score.sensor in (SIMULATED, SIMULATED_LIVELY) and score.false_a_minute is not None:
        what = f"{who}, {score.sensor} movement: false triggers"
        yield _row(what, score.false_a_minute, "a minute")


def _figure_rows(score: Score) -> Iterator[Row]:
    who = f"simulated people, paper's five gestures, {score.method}"
    is_ours = score.method not in REFERENCES
    if score.totals.pairs and score.sensor:
        yield _row(f"{who}, {score.sensor} unsaid: recall", score.totals.recall, "of gestures")
    elif score.totals.pairs:
        goal = SIMULATED_RECALL if is_ours else None
        yield _row(f"{who}: recall", score.totals.recall, "of gestures", at_least=goal)
        yield _row(f"{who}: precision", score.totals.precision, "of triggers")
        yield _row(f"{who}: F1", score.totals.f1, "")
    if score.false_a_minute is not None:
        movement = score.sensor or SIMULATED
        most = SIMULATED_FALSE_A_MINUTE if is_ours and movement == SIMULATED else None
        what = f"{who}, {movement} movement: false triggers"
        yield _row(what, score.false_a_minute, "a minute", at_most=most)


def _named(score: Score) -> str:
    if score.method in REFERENCES:
        return f"{score.method} (best threshold {score.threshold:g})"
    return score.method


def _score_data(score: Score) -> dict[str, Any]:
    pairs = Counter(score.totals.pairs)
    return {
        "trial": score.trial,
        "method": score.method,
        "sensor": score.sensor,
        "threshold": score.threshold,
        "f1": round(score.totals.f1, 4),
        "recall": round(score.totals.recall, 4),
        "precision": round(score.totals.precision, 4),
        "made": score.totals.made,
        "fired": score.totals.fired,
        "from_nothing": sum(count for (made, _), count in pairs.items() if made == NOTHING),
        "false_a_minute": _rounded(score.false_a_minute),
        "told_apart": _rounded(score.accuracy),
        "pairs": [[made, found, count] for (made, found), count in sorted(pairs.items())],
        "problem": score.problem,
    }


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 4)


def _row(
    name: str,
    value: float | None,
    unit: str,
    *,
    at_least: float | None = None,
    at_most: float | None = None,
) -> Row:
    row: Row = {"name": name, "value": None if value is None else round(value, 3), "unit": unit}
    if at_least is not None:
        row |= {"goal": f"at least {at_least}", "ok": bool(value is not None and value >= at_least)}
    if at_most is not None:
        row |= {"goal": f"at most {at_most}", "ok": bool(value is not None and value <= at_most)}
    return row
