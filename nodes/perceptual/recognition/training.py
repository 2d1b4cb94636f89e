"""Training a model from labelled recordings and everyday movement."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.examples import Examples, collect
from nodes.perceptual.recognition.features import Channels
from nodes.perceptual.recognition.folds import fold_takes, fold_windows
from nodes.perceptual.recognition.gmr import Both, fit_gmr
from nodes.perceptual.recognition.model import METHODS, Model, Recogniser, Scorer
from nodes.perceptual.recognition.passages import Passage, passages_of
from nodes.perceptual.recognition.report import report_of
from nodes.perceptual.recognition.scans import (
    Gesture,
    gestures_in,
    is_long_enough,
    scan,
    window_lengths,
)
from nodes.perceptual.recognition.trees import TREES, fit_trees
from nodes.perceptual.recognition.validation import (
    USUAL_SCORE,
    Validation,
    cross_validate,
    unchecked,
)
from nodes.recordings import Recording

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
    usable = [one for one in passages if is_long_enough(one, lengths)]
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
        names = ", ".join(recording.source for recording in recordings)
        raise RecordingError(
            f"No gesture is marked in the recordings {names}.",
            checklist=(
                "A column named gesture says for each sample which gesture is being made.",
                "1 stands for the gesture in the file's name, as in ann_karate.csv; 0 for none.",
            ),
        )


def _check_length(passages: Sequence[Passage]) -> None:
    minutes = sum(passage.duration_s for passage in passages) / 60
    if minutes > _MOST_MINUTES:
        raise RecordingError(
            f"The recordings last {minutes:.0f} minutes, more than can be learned from at once.",
            checklist=(f"Train on {_MOST_MINUTES} minutes or less; five of each gesture do.",),
        )


def _in_words(recordings: Sequence[Recording], everyday: Sequence[Recording]) -> str:
    people = {recording.person for recording in recordings if recording.person}
    simulated = sum(recording.simulated for recording in recordings)
    minutes = sum(float(recording.t[-1]) for recording in everyday) / 60
    who = f"{len(people)} {'person' if len(people) == 1 else 'people'}" if people else "someone"
    kind = " simulated" if simulated == len(recordings) else ""
    noun = "recording" if len(recordings) == 1 else "recordings"
    return f"{len(recordings)}{kind} {noun} of {who}, {minutes:.1f} minutes of everyday movement"
