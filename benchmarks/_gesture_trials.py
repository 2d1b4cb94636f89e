"""Trials of gesture recognisers: what is learned, what is tested, and how it went.

A trial is one person's recordings, or those of all other people, to learn from, and the rest of
that person's streams to be tested on. Ours always fire at the same certainty; the references are
judged at many thresholds, of which the report may choose the best.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context

import numpy as np

from benchmarks._gesture_folder import Folder, Sessions, split_sessions
from benchmarks._gesture_paper import PaperMatching
from benchmarks._gesture_references import NearestByWarping, Reference, fire
from benchmarks._gesture_scores import CLEAN, Score
from benchmarks._gesture_sensors import WORSE, worse
from nep_core.errors import RecordingError
from nodes.perceptual.recognition.dataset import simulated_everyday
from nodes.perceptual.recognition.features import Detection, describe
from nodes.perceptual.recognition.model import METHODS, TRIGGER, Model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import RATE_HZ, UNKNOWN, Take, takes_of
from nodes.perceptual.recognition.training import train
from nodes.perceptual.recognition.validation import Totals, match
from nodes.recordings import Recording
from nodes.sensory.arm.everyday import LIVELY
from nodes.sensory.arm.people import simulate_everyday

PAPER, WARPING = "paper as coded", "DTW 1-NN"
REFERENCES: dict[str, Callable[[Sessions, Sessions], Reference]] = {
    WARPING: NearestByWarping,
    PAPER: lambda training, everyday: PaperMatching(training),
}
THRESHOLDS = {
    WARPING: tuple(round(0.5 + 0.01 * step, 2) for step in range(21)),
    PAPER: tuple(round(0.05 * step, 2) for step in range(1, 20)),
}
OTHERS = "other people"
SIMULATED, SIMULATED_LIVELY = "simulated everyday", "simulated lively"
_UNSEEN = range(140, 144)
_SIMULATED_S = 60.0


@dataclass(frozen=True)
class Trial:
    """What to learn from and to be tested on; ``is_thorough``: also with a worse sensor."""

    name: str
    person: str
    training: Sessions
    rest: Sessions
    everyday: Sessions
    with_references: bool
    is_thorough: bool


def plan_trials(
    folder: Folder, examples: Sequence[int], *, is_quick: bool
) -> tuple[list[Trial], list[str]]:
    """The trials that a folder allows, and notes about what is left out."""
    trials: list[Trial] = []
    notes: list[str] = []
    for count in examples:
        for person, sessions in folder.people.items():
            split = split_sessions(sessions, count)
            notes += [f"{examples_named(count)}, {person}: {note}" for note in split.notes]
            is_thorough = count == max(examples) and not is_quick
            if split.rest:
                name = f"personal, {examples_named(count)}"
                parts = split.training, split.rest, folder.everyday
                trials.append(Trial(name, person, *parts, not is_quick, is_thorough))
    if len(folder.people) == 1:
        return trials, [*notes, f"{OTHERS}: there is one person only: left out"]
    for person, sessions in folder.people.items():
        others = [one for who, every in folder.people.items() if who != person for one in every]
        known = _gestures_of(others)
        if strange := sorted(_gestures_of(sessions) - known):
            notes.append(f"{OTHERS}, {person}: nobody else makes {', '.join(strange)}: left out")
        if known & _gestures_of(sessions):
            rest = tuple(_with_unknown(one, known) for one in sessions)
            parts = tuple(others), rest, folder.everyday
            trials.append(Trial(OTHERS, person, *parts, not is_quick, False))
    return trials, notes


def examples_named(count: int) -> str:
    """``1 example``, ``5 examples``."""
    return f"{count} example{'s' if count > 1 else ''}"


def hold_trials(trials: Sequence[Trial], workers: int = 0) -> list[Score]:
    """Hold all trials, side by side in processes; 1 worker: in this one. Scores are summed up."""
    workers = workers or os.cpu_count() or 1
    total: dict[tuple[str, str, str, float], Score] = {}
    for scores in _in_processes(trials, workers) if workers > 1 else map(hold_trial, trials):
        for score in scores:
            total[score.key] = total[score.key] + score if score.key in total else score
    return list(total.values())


def hold_trial(trial: Trial) -> list[Score]:
    """All scores of one trial; what cannot be measured is a score with a problem."""
    try:
        model = train(trial.training, simulated_everyday(), METHODS)
    except RecordingError as error:
        problem = f"{trial.person}: {error.sentence}"
        return [Score(trial.name, method, CLEAN, TRIGGER, problem=problem) for method in METHODS]
    scores = [score for method in METHODS for score in _of_ours(trial, model, method)]
    if trial.with_references:
        scores += [score for name in REFERENCES for score in _of_reference(trial, name)]
    return scores


def triggers(model: Model, recording: Recording, method: str) -> list[Detection]:
    """What a spotter finds in a recording at the usual certainty."""
    spotter = Spotter(
        model, method=method, trigger=TRIGGER, gravity_included=recording.gravity_included
    )
    return spotter.push(recording.t, recording.acc, recording.gyr) + spotter.flush()


def classify(model: Model, recording: Recording, method: str, take: Take) -> str:
    """The gesture that a marked take is most like."""
    recogniser = model.recogniser(method, recording.gravity_included, recording.gyr is not None)
    at = np.linspace(take.start_s, take.end_s, 32)
    columns = [*recording.acc.T, *(() if recording.gyr is None else recording.gyr.T)]
    raw = np.stack([np.interp(at, recording.t, one) for one in columns], axis=1)
    length = np.array([round(take.duration_s * RATE_HZ) + 1], np.intp)
    windows = describe(raw[None, :, : recogniser.channels.columns], length, recogniser.channels)
    return model.names[int(recogniser.scorer.scores(windows)[0].argmax())]


def _of_ours(trial: Trial, model: Model, method: str) -> Iterator[Score]:
    score = Score(trial.name, method, CLEAN, TRIGGER)
    try:
        yield _idle(replace(score, totals=_tally(model, trial.rest, method)), model, trial.everyday)
        yield _told_apart(score, trial, lambda one, take: classify(model, one, method, take))
        for sensor in WORSE if trial.is_thorough else ():
            rest = [worse(one, sensor) for one in trial.rest]
            yield replace(score, sensor=sensor, totals=_tally(model, rest, method))
        for sensor, idle in _simulated_idle() if trial.is_thorough else ():
            yield _idle(replace(score, sensor=sensor), model, idle)
    except RecordingError as error:
        yield replace(score, problem=f"{trial.person}: {error.sentence}")


def _tally(model: Model, recordings: Sequence[Recording], method: str) -> Totals:
    pairs = (match(takes_of(one), triggers(model, one, method)) for one in recordings)
    return sum(pairs, Totals())


def _idle(score: Score, model: Model, recordings: Sequence[Recording]) -> Score:
    try:
        false = sum(len(triggers(model, one, score.method)) for one in recordings)
    except RecordingError as error:  # it has no gravity, say: the gestures can still be measured
        return replace(score, problem=f"everyday movement: {error.sentence}")
    return replace(score, false=false, idle_s=sum(float(one.t[-1]) for one in recordings))


def _told_apart(score: Score, trial: Trial, ask: Callable[[Recording, Take], str]) -> Score:
    answers = [ask(one, take) == take.gesture for one in trial.rest for take in takes_of(one)]
    return replace(score, right=sum(answers), marked=len(answers))


def _of_reference(trial: Trial, name: str) -> Iterator[Score]:
    reference = REFERENCES[name](trial.training, tuple(simulated_everyday()))
    heard = [(takes_of(one), reference.look(one)) for one in trial.rest]
    idle = [reference.look(one) for one in trial.everyday]
    told = _told_apart(Score("", "", "", 0.0), trial, reference.classify)
    idle_s = sum(float(one.t[-1]) for one in trial.everyday)
    names = reference.names
    for threshold in THRESHOLDS[name]:
        tallies = (match(takes, fire(looks, names, threshold)) for takes, looks in heard)
        false = sum(len(fire(looks, names, threshold)) for looks in idle)
        score = Score(trial.name, name, CLEAN, threshold, sum(tallies, Totals()), false, idle_s)
        yield replace(score, right=told.right, marked=told.marked)


def _gestures_of(sessions: Sequence[Recording]) -> set[str]:
    return {name for one in sessions for name in one.labels or ()} - {"", UNKNOWN}


def _with_unknown(one: Recording, known: set[str]) -> Recording:
    """The recording with the gestures that are not known marked so: they are not asked for."""
    labels = [name if name in known or not name else UNKNOWN for name in one.labels or ()]
    return replace(one, labels=labels)


def _simulated_idle() -> Iterator[tuple[str, Sessions]]:
    """Everyday movement of simulated people that no model has seen, plain and with many signs."""
    yield SIMULATED, tuple(simulate_everyday(person, _SIMULATED_S) for person in _UNSEEN)
    lively = (simulate_everyday(person, _SIMULATED_S, activities=LIVELY) for person in _UNSEEN)
    yield SIMULATED_LIVELY, tuple(lively)


def _in_processes(trials: Sequence[Trial], workers: int) -> Iterator[list[Score]]:
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # else they are in each other's way
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    longest_first = sorted(trials, key=lambda one: -len(one.training))
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        yield from pool.map(hold_trial, longest_first)
