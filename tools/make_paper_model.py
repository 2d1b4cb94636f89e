"""Makes the shipped model of the paper's five gestures, from simulated people.

    python -m tools.make_paper_model

The people are numbers 0 to 99: examples and tests show others, whom the model has never seen.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from nodes.perceptual.recognition.model import Model, write_model
from nodes.perceptual.recognition.streams import mirrored
from nodes.perceptual.recognition.training import in_words, train
from nodes.recordings import Recording
from nodes.resources import resource_folder
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import simulate_everyday, simulate_session

_PEOPLE = range(0, 4)
_REPETITIONS = 2
_EVERYDAY_PEOPLE = range(60, 68)
_EVERYDAY_S = 60.0


def make_paper_model() -> Model:
    """Train on sessions and everyday movement of simulated people; takes a few minutes."""
    sessions = [simulate_session(person, sorted(GESTURES), _REPETITIONS) for person in _PEOPLE]
    sessions += [_with_the_other_hand(session) for session in sessions]
    everyday = [simulate_everyday(person, _EVERYDAY_S) for person in _EVERYDAY_PEOPLE]
    return train(sessions, everyday, tell=print)


def _with_the_other_hand(session: Recording) -> Recording:
    """The same gestures made by a person who is the mirror image."""
    acc, gyr = mirrored(session.acc, session.gyr)
    return replace(session, acc=acc, gyr=gyr, person=f"{session.person}, mirrored")


def main() -> None:
    """Write the model into the resources and print how well it does."""
    path: Path = resource_folder() / "gestures" / "paper.gestures"
    model = make_paper_model()
    write_model(path, model)
    for method, report in model.report.items():
        print("\n".join(in_words(method, report)))


if __name__ == "__main__":
    main()
