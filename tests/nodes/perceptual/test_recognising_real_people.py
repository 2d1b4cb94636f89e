"""Real people: trained on five repetitions of each gesture, recognised in the rest."""

from dataclasses import replace

import pytest

from benchmarks.gestures import first_takes, spot_all, triggers
from nodes.perceptual.recognition.everyday import simulated_everyday
from nodes.perceptual.recognition.training import train
from nodes.recordings import read_recordings


@pytest.mark.real_data
def test_the_right_trigger_fires_for_most_gestures_and_hardly_ever_else(shared_data):
    sessions = [one for one in read_recordings(shared_data / "uhh_gestures") if one.person == "j"]
    parts = [first_takes(one, 5) for one in sessions]
    model = train([first for first, _ in parts], simulated_everyday(), ["trees"])

    tally = spot_all(model, [rest for _, rest in parts], "trees")

    assert tally.made == 50
    assert tally.recall >= 0.85
    assert tally.precision >= 0.85
    everyday = [
        replace(one, labels=None) for one in read_recordings(shared_data / "everyday_watch")
    ]
    assert sum(len(triggers(model, one, "trees")) for one in everyday) <= 1
