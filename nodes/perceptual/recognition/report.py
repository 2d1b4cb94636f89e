"""What a training found out, as data for the model file and in plain words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from nodes.perceptual.recognition.matching import NOTHING, Tally
from nodes.perceptual.recognition.scans import Gesture
from nodes.perceptual.recognition.validation import Validation

_FEW_TAKES = 5


def report_of(gestures: Sequence[Gesture], validation: Validation) -> dict[str, Any]:
    """The figures of a validation: pairs made and recognised ("" is nothing), and everyday.

    ``curves`` tell by gesture what each certainty would catch and let through, ``left_out`` how
    each take fared, ``people`` how each person did where there are several.
    """
    pairs = Counter(validation.tally.pairs)
    return {
        "takes": {gesture.name: gesture.takes for gesture in gestures},
        "confusion": [[made, found, count] for (made, found), count in sorted(pairs.items())],
        "recall": round(validation.tally.recall, 4),
        "precision": round(validation.tally.precision, 4),
        "f1": round(validation.tally.f1, 4),
        "everyday_triggers": validation.everyday_triggers,
        "everyday_s": round(validation.everyday_s, 1),
        "curves": {
            name: [_rounded(vars(point)) for point in points]
            for name, points in validation.curves.items()
        },
        "left_out": [_rounded(vars(take)) for take in validation.takes],
        "people": {person: _score(tally) for person, tally in validation.people.items()},
    }


def _rounded(figures: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: round(float(value), 4) if isinstance(value, float) else value
        for name, value in figures.items()
    }


def _score(tally: Tally) -> dict[str, float]:
    score = {"made": tally.made, "right": tally.right, "fired": tally.fired}
    return score | {"f1": round(tally.f1, 4)}


def in_words(method: str, report: Mapping[str, Any]) -> list[str]:
    """The report of one method, in lines for people."""
    counts = {(made, found): count for made, found, count in report["confusion"]}
    takes: dict[str, int] = report["takes"]
    if min(takes.values()) < 2:
        return [f"{method}: not checked. To check it, record each gesture at least twice."]
    lines = [f"{method}: gestures recognised in recordings that were left out of the training"]
    lines += [_gesture_line(name, takes[name], counts) for name in takes]
    lines.append(_everyday_line(report))
    return lines


def advice(report: Mapping[str, Any], has_own_everyday: bool) -> list[str]:
    """What would make the model better."""
    takes: dict[str, int] = report["takes"]
    few = [name for name, count in takes.items() if count < _FEW_TAKES]
    lines = []
    if few:
        names = ", ".join(few)
        lines.append(f"Record {names} {_FEW_TAKES} times or more: it will be recognised better.")
    if len(takes) == 1:
        or_everyday = "" if has_own_everyday else ", or your everyday movement with --everyday"
        lines.append(
            f"Nothing could be confused with {next(iter(takes))} yet:"
            f" add another gesture{or_everyday}."
        )
    return lines


def _gesture_line(name: str, takes: int, counts: Mapping[tuple[str, str], int]) -> str:
    right = counts.get((name, name), 0)
    missed = counts.get((name, NOTHING), 0)
    mistaken = {
        found: count
        for (made, found), count in counts.items()
        if made == name and found not in (name, NOTHING)
    }
    from_nothing = counts.get((NOTHING, name), 0)
    remarks = [f"taken for {other} {_times(count)}" for other, count in mistaken.items()]
    remarks += [f"missed {_times(missed)}"] if missed else []
    remarks += [f"seen where there was none {_times(from_nothing)}"] if from_nothing else []
    line = f"  {name}: {right} of {takes}"
    return line + (f" ({', '.join(remarks)})" if remarks else "")


def _everyday_line(report: Mapping[str, Any]) -> str:
    minutes = report["everyday_s"] / 60
    if not minutes:
        return "  Everyday movement: not checked, no such recording was given."
    a_minute = report["everyday_triggers"] / minutes
    return f"  Everyday movement: {a_minute:.2f} false triggers a minute, in {minutes:.1f} minutes."


def _times(count: int) -> str:
    return "once" if count == 1 else "twice" if count == 2 else f"{count} times"
