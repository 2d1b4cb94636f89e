"""How many gestures are recognised, and how often something else is taken for one.

Real people (../shared/data/uhh_gestures): a model for each of them, trained on the first five
repetitions of ten gestures, run on the rest of the same session; real everyday movement of others
(../shared/data/everyday_watch), in which every trigger is false. Simulated people, whom the shipped
model has not seen. The certainty that fires is always 0.75. The reference is the F1 that the
facts of this project measured for the paper's matching as its code does it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from nodes.perceptual.recognition.everyday import simulated_everyday
from nodes.perceptual.recognition.matching import Tally, match
from nodes.perceptual.recognition.model import METHODS, Model
from nodes.perceptual.recognition.model_file import read_model
from nodes.perceptual.recognition.passages import takes_of
from nodes.perceptual.recognition.peaks import Detection
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train
from nodes.recordings import Recording, read_recordings
from nodes.resources import resource_folder
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.simulate import simulate_everyday, simulate_session

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
REPETITIONS = 5
PAPER_F1 = 0.05
UNSEEN_PEOPLE = range(120, 130)

Row = dict[str, Any]


def run() -> list[Row]:
    """All figures; a row says so where the real recordings are not there."""
    if not (DATA / "uhh_gestures").is_dir():
        skipped = "gestures of real people: skipped, there is no ../shared/data"
        return [{"name": skipped, "value": None, "unit": ""}, *_simulated_rows()]
    return [*_real_rows(), *_simulated_rows()]


def first_takes(recording: Recording, takes: int) -> tuple[Recording, Recording]:
    """A recording up to the middle of the pause after so many takes, and the rest."""
    made = takes_of(recording)
    middle_s = (made[takes - 1].end_s + made[takes].start_s) / 2
    cut = int((recording.t < middle_s).sum())
    return _part(recording, slice(0, cut)), _part(recording, slice(cut, None))


def triggers(
    model: Model, recording: Recording, method: str, *, gyroscope: bool = True
) -> list[Detection]:
    """What a spotter finds in a recording, which is pushed as a whole."""
    spotter = Spotter(model, method=method, gravity_included=recording.gravity_included)
    gyr = recording.gyr if gyroscope else None
    return spotter.push(recording.t, recording.acc, gyr) + spotter.flush()


def spot_all(model: Model, recordings: Sequence[Recording], method: str) -> Tally:
    """How the triggers in all recordings agree with their labels."""
    tally = Tally()
    for recording in recordings:
        tally += match(takes_of(recording), triggers(model, recording, method))
    return tally


def _part(recording: Recording, chosen: slice) -> Recording:
    t, labels = recording.t[chosen], recording.labels
    return replace(
        recording,
        t=t - t[0],
        acc=recording.acc[chosen],
        gyr=None if recording.gyr is None else recording.gyr[chosen],
        labels=labels[chosen] if labels else None,
    )


def _real_rows() -> Iterator[Row]:
    sessions = read_recordings(DATA / "uhh_gestures")
    everyday = [replace(one, labels=None) for one in read_recordings(DATA / "everyday_watch")]
    minutes = sum(float(one.t[-1]) for one in everyday) / 60
    people = sorted({one.person for one in sessions})
    totals = {method: Tally() for method in METHODS}
    false = dict.fromkeys(METHODS, 0)
    for person in people:
        parts = [first_takes(one, REPETITIONS) for one in sessions if one.person == person]
        model = train([first for first, _ in parts], simulated_everyday())
        for method in METHODS:
            tally = spot_all(model, [rest for _, rest in parts], method)
            totals[method] += tally
            false[method] += sum(len(triggers(model, one, method)) for one in everyday)
            recall = f"real person {person}, {method}: recognised"
            goal = 0.85 if method == METHODS[0] else None  # for each person with the default method
            yield _row(recall, tally.recall, "of gestures", at_least=goal)
    for method in METHODS:
        yield from _tally_rows(f"real people, {method}", totals[method], reference=PAPER_F1)
        a_minute = false[method] / (minutes * len(people))
        yield _row(f"real everyday, {method}: false triggers", a_minute, "a minute", below=1.0)


def _simulated_rows() -> Iterator[Row]:
    model = read_model(resource_folder() / "gestures" / "paper.gestures")
    gestures = sorted(GESTURES)
    sessions = [simulate_session(person, gestures, 2) for person in UNSEEN_PEOPLE]
    everyday = [simulate_everyday(person, 60.0) for person in UNSEEN_PEOPLE]
    for method in METHODS:
        tally = spot_all(model, sessions, method)
        yield from _tally_rows(f"simulated people, {method}", tally, at_least=0.9)
        false = sum(len(triggers(model, one, method)) for one in everyday) / len(everyday)
        yield _row(f"simulated everyday, {method}: false triggers", false, "a minute", below=1.0)


def _tally_rows(
    who: str, tally: Tally, *, reference: float | None = None, at_least: float = 0.85
) -> Iterator[Row]:
    yield _row(f"{who}: recognised", tally.recall, "of gestures", at_least=at_least)
    yield _row(f"{who}: right triggers", tally.precision, "of triggers")
    yield _row(f"{who}: wrong triggers", tally.fired - tally.right, "")
    f1 = _row(f"{who}: F1", tally.f1, "")
    if reference is not None:
        f1 |= {"reference": reference, "ratio": round(tally.f1 / reference, 1)}
    yield f1


def _row(
    name: str,
    value: float,
    unit: str,
    *,
    at_least: float | None = None,
    below: float | None = None,
) -> Row:
    row: Row = {"name": name, "value": round(value, 3), "unit": unit}
    if at_least is not None:
        row |= {"goal": f"at least {at_least}", "ok": bool(value >= at_least)}
    if below is not None:
        row |= {"goal": f"less than {below}", "ok": bool(value < below)}
    return row
