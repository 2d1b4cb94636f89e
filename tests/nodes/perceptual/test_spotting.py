"""Gestures are spotted in streams, good and bad ones."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import takes_of
from nodes.perceptual.recognition.validation import match
from nodes.sensory.arm.people import simulate_everyday, simulate_session

pytestmark = pytest.mark.long


def spotted(model, recording, *, gyroscope=True, **wishes):
    spotter = Spotter(model, **wishes)
    gyr = recording.gyr if gyroscope else None
    return spotter.push(recording.t, recording.acc, gyr) + spotter.flush()


@pytest.fixture(scope="module")
def usual(model, stranger):
    """What is spotted when nothing is unusual."""
    return spotted(model, stranger)


@pytest.mark.parametrize("method", ["trees", "gmr"])
@pytest.mark.parametrize("gyroscope", [True, False], ids=["with gyroscope", "without"])
def test_each_gesture_of_a_stranger_fires_once(model, stranger, method, gyroscope):
    found = spotted(model, stranger, method=method, gyroscope=gyroscope)

    totals = match(takes_of(stranger), found)
    assert totals.recall >= 5 / 6
    assert totals.fired - totals.right <= (2 if method == "trees" else 4)


def test_everyday_movement_fires_nothing(model):
    assert spotted(model, simulate_everyday(151, 60.0)) == []


def test_one_sample_at_a_time_gives_the_same_as_all_at_once_and_soon(model, stranger, usual):
    spotter, found, delays_s = Spotter(model), [], []

    for t, acc, gyr in zip(stranger.t, stranger.acc, stranger.gyr, strict=True):
        for one in spotter.push(t, acc, gyr):
            take = min(takes_of(stranger), key=lambda take: abs(take.end_s - one.t_end))
            assert one.t_start < take.end_s
            assert one.t_end > take.start_s
            delays_s.append(t - take.end_s)
            found.append(one)

    assert found + spotter.flush() == usual
    assert np.median(delays_s) < 0.4


@pytest.mark.parametrize("rate_hz", [25, 32, 100])
def test_the_rate_of_the_sensor_does_not_matter(model, rate_hz):
    recording = simulate_session(152, ("hand_up", "karate"), 2, rate_hz=rate_hz)

    totals = match(takes_of(recording), spotted(model, recording))

    assert (totals.right, totals.made) == (4, 4)


def test_a_spotter_of_one_gesture_tells_that_one_only(model, stranger, usual):
    every = Counter(one.gesture for one in usual)

    for name in model.names:
        own = Counter(one.gesture for one in spotted(model, stranger, gestures=[name]))
        assert set(own) == {name}
        assert own[name] == every[name]


def test_lost_samples_wrong_numbers_and_a_slipping_clock_do_not_matter(model, stranger):
    chance = np.random.default_rng(0)
    t, acc, gyr = stranger.t.copy(), stranger.acc.copy(), stranger.gyr.copy()
    broken = chance.choice(len(t), len(t) // 20, replace=False)
    acc[broken[::2]] = np.nan
    gyr[broken[1::3]] = np.inf
    t[broken[::5]] -= 0.3
    kept = chance.random(len(t)) > 0.1
    t, acc, gyr = (np.repeat(values[kept], 2, axis=0) for values in (t, acc, gyr))

    found = spotted(model, replace(stranger, t=t, acc=acc, gyr=gyr))

    assert match(takes_of(stranger), found).recall >= 5 / 6


def test_a_gyroscope_that_comes_and_goes_does_not_stop_it(model, stranger):
    spotter, found = Spotter(model), []
    for part in np.array_split(np.arange(len(stranger.t)), 2):
        for gyr in (stranger.gyr[part], None):
            found += spotter.push(stranger.t[part], stranger.acc[part], gyr)

    assert {one.gesture for one in found} == {"hand_up", "karate"}


def test_a_sensor_without_gravity_is_refused_by_a_model_that_needs_it(model, stranger):
    with pytest.raises(RecordingError, match=r"needs .* and the sensor does not send that") as told:
        spotted(model, stranger, gravity_included=False)
    assert told.value.checklist


def test_a_gesture_or_method_that_the_model_lacks_is_refused_by_name(model):
    with pytest.raises(RecordingError, match='does not know "karaty"') as told:
        Spotter(model, gestures=["karaty"])
    assert "hand_up, karate" in str(told.value.checklist[0])

    only_trees = replace(model, recognisers=model.recognisers[:1])
    with pytest.raises(RecordingError, match='cannot recognise by "gmr"'):
        Spotter(only_trees, method="gmr")
