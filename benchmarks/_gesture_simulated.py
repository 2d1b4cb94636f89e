"""The paper's figure of five gestures, on simulated people whom no model has seen.

The paper had ten recordings of five volunteers; here five simulated people make each gesture ten
times. The shipped model was trained on other simulated people; the paper's matching learns from
ten recordings of each gesture by five others, with its limits as set by hand. All of them are
right-handed; how those fare who wear the watch on the left, and did not say so, is told apart.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

from benchmarks._gesture_paper import PaperMatching
from benchmarks._gesture_references import fire
from benchmarks._gesture_scores import CLEAN, Score
from benchmarks._gesture_trials import PAPER, SIMULATED, SIMULATED_LIVELY, triggers
from nodes.perceptual.recognition.model import METHODS, TRIGGER, Model, read_model
from nodes.perceptual.recognition.streams import takes_of
from nodes.perceptual.recognition.validation import Totals, match
from nodes.recordings import Recording
from nodes.resources import resource_folder
from nodes.sensory.arm.everyday import LIVELY
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import perform, simulate_everyday, simulate_session

NAME = "five gestures of simulated people"
VOLUNTEERS = (120, 121, 122, 123, 124)
LEFT_HANDED = (129, 139)
LEFT_WRIST = "left wrist"
TAKES = 10
_TEACHERS = range(5)
_LESSONS = 2
_LIMITS = {"batting": 50.0, "katana": 50.0, "hand_up": 100.0, "karate": 100.0, "strech_up": 100.0}
_PAPERS_THRESHOLD = 0.7
_EVERYDAY_S = 60.0


def paper_figure(
    people: Sequence[int] = (*VOLUNTEERS, *LEFT_HANDED), takes: int = TAKES
) -> list[Score]:
    """Scores with the pairs of gesture made and recognised, by method, summed over people."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    ask = partial(_scores_of, takes)
    total: dict[tuple[str, str, str, float], Score] = {}
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        for score in (score for scores in pool.map(ask, people) for score in scores):
            total[score.key] = total[score.key] + score if score.key in total else score
    return list(total.values())


def _scores_of(takes: int, person: int) -> list[Score]:
    session = simulate_session(person, sorted(GESTURES), takes)
    model = read_model(resource_folder() / "gestures" / "paper.gestures")
    known = {one.method for one in model.recognisers}
    methods = [method for method in METHODS if method in known]
    if person in LEFT_HANDED:
        return [_spotted(model, method, session, LEFT_WRIST) for method in methods]
    plain = simulate_everyday(person, _EVERYDAY_S)
    lively = simulate_everyday(person, _EVERYDAY_S, activities=LIVELY)
    scores = [one for method in methods for one in _of_ours(model, method, session, plain, lively)]
    return [*scores, _of_the_paper(session, plain)]


def _spotted(model: Model, method: str, session: Recording, sensor: str) -> Score:
    totals = match(takes_of(session), triggers(model, session, method))
    return Score(NAME, method, sensor, TRIGGER, totals)


def _of_ours(
    model: Model, method: str, session: Recording, plain: Recording, lively: Recording
) -> tuple[Score, ...]:
    clean = _spotted(model, method, session, CLEAN)
    idle = [
        Score(NAME, method, sensor, TRIGGER, Totals(), false, _EVERYDAY_S)
        for sensor, false in (
            (SIMULATED, len(triggers(model, plain, method))),
            (SIMULATED_LIVELY, len(triggers(model, lively, method))),
        )
    ]
    return clean, *idle


def _of_the_paper(session: Recording, plain: Recording) -> Score:
    lessons = [
        perform(gesture, person, take)
        for gesture in GESTURES
        for person in _TEACHERS
        for take in range(_LESSONS)
    ]
    matching = PaperMatching(lessons, _LIMITS)
    found = fire(matching.look(session), matching.names, _PAPERS_THRESHOLD)
    false = len(fire(matching.look(plain), matching.names, _PAPERS_THRESHOLD))
    totals = match(takes_of(session), found)
    return Score(NAME, PAPER, CLEAN, _PAPERS_THRESHOLD, totals, false, _EVERYDAY_S)
