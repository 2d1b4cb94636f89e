"""Training a model from labelled recordings and everyday movement."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from nep_core.errors import RecordingError
from nodes.recordings import Recording

from .examples import Examples, collect
from .features import Channels, Gesture, Integers, Scan, gestures_in, scan, window_lengths
from .gmr import Both, fit_gmr
from .model import METHODS, Model, Recogniser, Scorer
from .streams import Passage, passages_of
from .trees import TREES, fit_trees
from .validation import NOTHING, USUAL_SCORE, Totals, Validation, cross_validate, unchecked

# What a training found out, as data for the model file and in plain words.

_FEW_TAKES = 5


def report_of(gestures: Sequence[Gesture], validation: Validation) -> dict[str, Any]:
    """The figures of a validation: pairs made and recognised ("" is nothing), and everyday.

    ``curves`` tell by gesture what each certainty would catch and let through, ``left_out`` how
    each take fared, ``people`` how each person did where there are several.
    """
    pairs = Counter(validation.totals.pairs)
    return {
        "takes": {gesture.name: gesture.takes for gesture in gestures},
        "confusion": [[made, found, count] for (made, found), count in sorted(pairs.items())],
        "recall": round(validation.totals.recall, 4),
        "precision": round(validation.totals.precision, 4),
        "f1": round(validation.totals.f1, 4),
        "everyday_triggers": validation.everyday_triggers,
        "everyday_s": round(validation.everyday_s, 1),
        "curves": {
            name: [_rounded(vars(point)) for point in points]
            for name, points in validation.curves.items()
        },
        "left_out": [_rounded(vars(take)) for take in validation.takes],
        "people": {person: _score(totals) for person, totals in validation.people.items()},
    }


def _rounded(figures: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: round(float(value), 4) if isinstance(value, float) else value
        for name, value in figures.items()
    }


def _score(totals: Totals) -> dict[str, float]:
    figures = {"made": totals.made, "right": totals.right, "fired": totals.fired}
    return figures | {"f1": round(totals.f1, 4)}


def in_words(method: str, report: Mapping[str, Any]) -> list[str]:
    """The report of one method, in lines for people."""
    counts = {(made, found): count for made, found, count in report["confusion"]}
    takes: dict[str, int] = report["takes"]
    if min(takes.values()) < 2:
        return [f"{method}: not checked. To check it, record each gesture at least twice."]
    return [
        f"{method}: gestures recognised in recordings that were left out of the training",
        *(_gesture_line(name, takes[name], counts) for name in takes),
        _everyday_line(report),
    ]


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


# Which part of the recordings is left out together with which, to check a recogniser.

FOLDS = 5
_ENOUGH_PEOPLE = 2
_BLOCK_S = 20.0  # everyday movement is dealt out in pieces of this length


def fold_takes(passages: Sequence[Passage]) -> list[list[int]]:
    """The fold of every take of every passage.

    With several people a fold is some of the people: the check then tells how new people fare.
    Else it is some of the takes of each gesture.
    """
    people = sorted({passage.person for passage in passages if passage.takes})
    if len(people) >= _ENOUGH_PEOPLE:
        fold_of = {person: number % FOLDS for number, person in enumerate(people)}
        return [[fold_of[one.person] for _ in one.takes] for one in passages]
    seen: Counter[str] = Counter()
    folds = []
    for passage in passages:
        own = []
        for take in passage.takes:
            own.append(seen[take.gesture] % FOLDS)
            seen[take.gesture] += 1
        folds.append(own)
    return folds


def fold_windows(found: Scan, take_folds: Sequence[int]) -> Integers:
    """The fold of each window of a scan: that of the take next to it."""
    middle_s = (found.starts_s + found.ends_s) / 2
    if not take_folds:
        return (middle_s // _BLOCK_S).astype(np.intp) % FOLDS
    takes_s = np.array([(take.start_s + take.end_s) / 2 for take in found.passage.takes])
    nearest = np.abs(middle_s[:, None] - takes_s).argmin(axis=1)
    nearby: Integers = np.array(take_folds, np.intp)[nearest]
    return nearby


_MOST_MINUTES = 90
_TREES_TO_CHECK = 12  # fewer than are used in the end: each part left out grows its own
_TREES_WITHOUT = 40  # for sensors that lack what most of them have


def train(
    recordings: Sequence[Recording],
    everyday: Sequence[Recording] = (),
    methods: Sequence[str] = METHODS,
    seed: int = 0,
    tell: Callable[[str], None] = lambda progress: None,
) -> Model:
    """Learn the labelled gestures; what is between them, and ``everyday``, is *no gesture*.

    With gyroscopes in all recordings the model also works without one. The same recordings and
    seed give the same model. RecordingError says which recordings cannot be used.

    ``methods`` are the recognisers to fit, ``seed`` is that of the chance; ``tell`` gets
    sentences about how far it is.
    """
    gyroscope = all(recording.gyr is not None for recording in (*recordings, *everyday))
    gravity = all(recording.gravity_included for recording in (*recordings, *everyday))
    passages = passages_of((*recordings, *everyday), gyroscope)
    _check_length(passages)
    people = {passage.person for passage in passages if passage.takes}
    takes = [take for passage in passages for take in passage.takes]
    gestures = gestures_in(takes, len(people))
    _check(recordings, gestures)
    lengths = window_lengths(gestures)
    usable = [one for one in passages if len(one.samples) >= lengths[0]]  # others hold no window
    material = _Material(usable, gestures, seed, several=len(people) > 1)
    best = Channels(gravity, gyroscope)
    tell(f"Checking what it learned with {best.in_words}…")
    validations = material.validate(best, methods)
    recognisers = []
    for channels in (Channels(gravity, with_gyr) for with_gyr in sorted({gyroscope, False})):
        tell(f"Training {' and '.join(methods)} with {channels.in_words}…")
        count = TREES if channels == best else _TREES_WITHOUT
        scorers = _fit(methods, seed, len(people) > 1, count, material.examples(channels))
        for method in methods:
            usual = validations[method].usual
            checked = usual if channels == best else np.maximum(usual, USUAL_SCORE)
            recognisers.append(Recogniser(method, channels, scorers[method], checked))
    report = {method: report_of(gestures, validations[method]) for method in methods}
    return Model(gestures, tuple(recognisers), _in_words(recordings, everyday), report)


def _fit(
    methods: Sequence[str], seed: int, several: bool, count: int, examples: Examples
) -> Mapping[str, Scorer]:
    """A scorer of each method; all of them ask the same trees, of several people the curves too."""
    trees = fit_trees(examples, seed, count)
    if tuple(methods) == ("trees",) and not several:
        return {"trees": trees}
    gmr = fit_gmr(examples, seed, trees)
    made: dict[str, Scorer] = {"trees": Both(trees, gmr.curves) if several else trees, "gmr": gmr}
    return {method: made[method] for method in methods}


class _Material:
    """Everything that can be learned from, whatever the sensor offers."""

    def __init__(
        self,
        passages: Sequence[Passage],
        gestures: tuple[Gesture, ...],
        seed: int,
        *,
        several: bool,
    ) -> None:
        lengths = window_lengths(gestures)
        self._gestures = gestures
        self._seed, self._several = seed, several
        self._takes_folds = fold_takes(passages)
        self._scans = [scan(passage, lengths) for passage in passages]
        self._folds = [
            fold_windows(found, folds)
            for found, folds in zip(self._scans, self._takes_folds, strict=True)
        ]
        self._known: dict[Channels, Examples] = {}

    def examples(self, channels: Channels) -> Examples:
        """All examples, seen through certain channels."""
        if channels not in self._known:
            self._known[channels] = collect(
                self._gestures, self._scans, self._folds, self._takes_folds, channels, self._seed
            )
        return self._known[channels]

    def validate(self, channels: Channels, methods: Sequence[str]) -> dict[str, Validation]:
        """How recognisers made from a part of everything do on what they have not seen."""
        fit = partial(_fit, methods, self._seed, self._several, _TREES_TO_CHECK)
        checked = cross_validate(fit, self.examples(channels), self._scans, self._folds)
        return {
            method: checked.get(method) or unchecked(self._gestures, self._scans)
            for method in methods
        }


def _check(recordings: Sequence[Recording], gestures: Sequence[Gesture]) -> None:
    if not gestures:
        raise RecordingError(
            "No gesture is marked in the recordings {names}.",
            checklist=(
                "A column named gesture says for each sample which gesture is being made.",
                "1 stands for the gesture in the file's name, as in ann_karate.csv; 0 for none.",
            ),
            names=", ".join(recording.source for recording in recordings),
        )


def _check_length(passages: Sequence[Passage]) -> None:
    minutes = sum(passage.duration_s for passage in passages) / 60
    if minutes > _MOST_MINUTES:
        raise RecordingError(
            "The recordings last {minutes} minutes, more than can be learned from at once.",
            checklist=("Train on {most_minutes} minutes or less; five of each gesture do.",),
            minutes=f"{minutes:.0f}",
            most_minutes=_MOST_MINUTES,
        )


def _in_words(recordings: Sequence[Recording], everyday: Sequence[Recording]) -> str:
    people = {recording.person for recording in recordings if recording.person}
    simulated = sum(recording.simulated for recording in recordings)
    minutes = sum(float(recording.t[-1]) for recording in everyday) / 60
    who = f"{len(people)} {'person' if len(people) == 1 else 'people'}" if people else "someone"
    kind = " simulated" if simulated == len(recordings) else ""
    noun = "recording" if len(recordings) == 1 else "recordings"
    return f"{len(recordings)}{kind} {noun} of {who}, {minutes:.1f} minutes of everyday movement"
