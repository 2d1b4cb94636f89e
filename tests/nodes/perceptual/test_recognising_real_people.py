"""Real people: trained on five repetitions of each gesture, recognised in the rest."""

from dataclasses import replace

import numpy as np
import pytest

from nodes.perceptual.recognition.dataset import simulated_everyday
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import takes_of
from nodes.perceptual.recognition.training import train
from nodes.perceptual.recognition.validation import Totals, match
from nodes.recordings import read_recordings

pytestmark = pytest.mark.long


def between(recording, start_s, end_s):
    """The part of a recording from one time to another."""
    inside = np.flatnonzero((recording.t >= start_s) & (recording.t < end_s))
    return replace(
        recording,
        t=recording.t[inside] - recording.t[inside[0]],
        acc=recording.acc[inside],
        gyr=recording.gyr[inside],
        labels=[recording.labels[at] for at in inside],
    )


def first_takes(recording, count):
    """A recording up to the middle of the pause after so many takes, and the rest."""
    last, following = takes_of(recording)[count - 1 : count + 1]
    middle_s = (last.end_s + following.start_s) / 2
    return between(recording, 0, middle_s), between(recording, middle_s, np.inf)


def triggers(model, recording):
    spotter = Spotter(model, gravity_included=recording.gravity_included)
    return spotter.push(recording.t, recording.acc, recording.gyr) + spotter.flush()


@pytest.mark.real_data
def test_the_right_trigger_fires_for_most_gestures_and_hardly_ever_else(shared_data):
    sessions = [one for one in read_recordings(shared_data / "uhh_gestures") if one.person == "j"]
    parts = [first_takes(one, 5) for one in sessions]
    model = train([first for first, _ in parts], simulated_everyday(), ["trees"])

    totals = sum((match(takes_of(rest), triggers(model, rest)) for _, rest in parts), Totals())

    assert totals.made == 50
    assert totals.recall >= 0.85
    assert totals.precision >= 0.85
    everyday = [
        replace(one, labels=None) for one in read_recordings(shared_data / "everyday_watch")
    ]
    assert sum(len(triggers(model, one)) for one in everyday) <= 1
