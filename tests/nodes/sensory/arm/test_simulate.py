"""Recordings of simulated people."""

import numpy as np
import pytest

from nep_core.errors import ParameterError
from nodes.recordings import read_recording, write_recording
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import perform, person_numbered, simulate_everyday, simulate_session

UNSEEN = 103


def of_gesture(recording, gesture):
    return np.array([label == gesture for label in recording.labels])


@pytest.mark.parametrize("gesture", GESTURES)
def test_a_gesture_is_labelled_with_rest_before_and_after(gesture):
    recording = perform(gesture, UNSEEN, take=0)

    made = np.flatnonzero(of_gesture(recording, gesture))
    seconds = len(made) / recording.rate_hz
    assert set(recording.labels) == {"", gesture}
    assert made[0] > 50
    assert made[-1] < len(recording.t) - 50
    assert np.all(np.diff(made) == 1)
    assert seconds == pytest.approx(GESTURES[gesture].duration_s, rel=0.3)
    assert recording.simulated


def test_a_gesture_that_nobody_knows_is_told_with_those_that_are_known():
    with pytest.raises(ParameterError, match='no gesture "wave"') as raised:
        perform("wave", UNSEEN, take=0)

    assert "karate" in str(raised.value.checklist[0])


def test_the_same_person_and_take_move_exactly_the_same():
    once, again = perform("karate", UNSEEN, 4), perform("karate", UNSEEN, 4)

    assert np.array_equal(once.acc, again.acc)
    assert np.array_equal(once.gyr, again.gyr)
    assert once.labels == again.labels


def test_another_take_is_another_performance_of_the_same_gesture():
    curves = [perform("karate", UNSEEN, take).acc for take in (0, 1)]

    assert curves[0].shape != curves[1].shape or not np.allclose(curves[0], curves[1], atol=0.5)


def test_people_differ_more_than_the_takes_of_one():
    def shape(person, take):
        recording = perform("katana", person, take)
        made = recording.acc[of_gesture(recording, "katana")]
        at = np.linspace(0, len(made) - 1, 60)
        return np.stack([np.interp(at, np.arange(len(made)), axis) for axis in made.T])

    shapes = np.array([[shape(person, take) for take in range(4)] for person in (101, 102, 103)])
    within = shapes.std(axis=1).mean()
    between = shapes.mean(axis=1).std(axis=0).mean()

    assert between > within


def test_a_person_is_a_pure_function_of_a_number():
    assert person_numbered(7).body == person_numbered(7).body
    assert len({person_numbered(number).body for number in range(200)}) == 200


def test_every_tenth_person_wears_the_watch_on_the_left():
    left = [number for number in range(40) if person_numbered(number).sensor.left_wrist]

    assert left == [9, 19, 29, 39]


def test_on_the_left_wrist_the_hand_that_hangs_is_felt_on_the_other_side_of_x():
    right, left = (simulate_everyday(person, 2).acc[0] for person in (8, 9))

    assert right[0] > 7
    assert left[0] < -7


def test_a_session_has_every_gesture_as_often_as_asked_in_a_stream_without_jumps():
    session = simulate_session(UNSEEN, ["karate", "hand_up"], repetitions=3, rate_hz=50, seed=1)

    labels = np.array(session.labels)
    begins = np.flatnonzero((labels[1:] != labels[:-1]) & (labels[1:] != ""))
    assert sorted(labels[begins + 1]) == ["hand_up"] * 3 + ["karate"] * 3
    assert np.diff(session.t) == pytest.approx(0.02)
    sizes = np.linalg.norm(session.acc, axis=1)
    assert sizes.max() < 60
    assert np.abs(np.diff(session.acc, axis=0)).max() < 15  # m/s² in 20 ms: no spike at a seam


def test_everyday_movement_lasts_as_asked_has_no_gesture_and_feels_gravity():
    everyday = simulate_everyday(UNSEEN, seconds=60, rate_hz=50, seed=3)

    assert everyday.t[-1] == pytest.approx(59.98)
    assert set(everyday.labels) == {""}
    assert np.median(np.linalg.norm(everyday.acc, axis=1)) == pytest.approx(9.81, abs=0.4)
    assert np.abs(everyday.gyr).max() > 0.5


def test_a_simulated_recording_is_read_back_as_it_was_and_still_says_so(tmp_path):
    session = simulate_session(UNSEEN, ["karate"], repetitions=1)

    write_recording(tmp_path / "session.csv", session)
    read = read_recording(tmp_path / "session.csv")

    assert read.acc == pytest.approx(session.acc, abs=1e-3)
    assert read.gyr == pytest.approx(session.gyr, abs=1e-3)
    assert read.t == pytest.approx(session.t - session.t[0], abs=1e-6)
    assert read.labels == session.labels
    assert (read.person, read.simulated, read.gravity_included) == ("103", True, True)


def test_the_rate_is_that_of_the_watch():
    assert perform("karate", UNSEEN, 0, rate_hz=33).rate_hz == pytest.approx(33, rel=1e-6)
