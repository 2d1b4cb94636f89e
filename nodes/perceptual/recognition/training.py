"""Training a model from labelled recordings and everyday movement."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.examples import collect
from nodes.perceptual.recognition.features import Channels
from nodes.perceptual.recognition.folds import fold_takes, fold_windows
from nodes.perceptual.recognition.gmr import fit_gmr
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
from nodes.perceptual.recognition.trees import fit_trees
from nodes.perceptual.recognition.validation import Fit, Validation, cross_validate
from nodes.recordings import Recording

_MOST_MINUTES = 90
_FITS: dict[str, Callable[..., Scorer]] = {"trees": fit_trees, "gmr": fit_gmr}


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
    gestures = gestures_in([take for passage in passages for take in passage.takes])
    _check(recordings, gestures)
    recognisers, report = [], {}
    for channels in (Channels(gravity, with_gyr) for with_gyr in sorted({gyroscope, False})):
        prepared = _Prepared(passages, gestures, channels, seed)
        for method in methods:
            tell(f"Training {method} with {channels.in_words} ...")
            recogniser, validation = prepared.fit(method, partial(_FITS[method], seed=seed))
            recognisers.append(recogniser)
            if channels.gyroscope == gyroscope:
                report[method] = report_of(gestures, validation)
    return Model(gestures, tuple(recognisers), _in_words(recordings, everyday), report)


class _Prepared:
    """Everything that can be learned from, seen through certain channels."""

    def __init__(
        self,
        passages: Sequence[Passage],
        gestures: tuple[Gesture, ...],
        channels: Channels,
        seed: int,
    ) -> None:
        lengths = window_lengths(gestures)
        passages = [passage for passage in passages if is_long_enough(passage, lengths)]
        takes_folds = fold_takes(passages)
        self._channels = channels
        self._scans = [scan(passage, lengths, channels) for passage in passages]
        self._folds = [
            fold_windows(found, folds)
            for found, folds in zip(self._scans, takes_folds, strict=True)
        ]
        self._examples = collect(gestures, self._scans, self._folds, takes_folds, channels, seed)

    def fit(self, method: str, fit: Fit) -> tuple[Recogniser, Validation]:
        """A recogniser made from everything, and how its like do on what they have not seen."""
        validation = cross_validate(fit, self._examples, self._scans, self._folds)
        scorer = fit(self._examples)
        return Recogniser(method, self._channels, scorer, validation.usual), validation


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
