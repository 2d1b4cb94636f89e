"""What each certainty catches and lets through; stretches of which nobody knows what they are."""

from dataclasses import replace

import numpy as np

from nodes.perceptual.recognition.examples import NEITHER, label_scan
from nodes.perceptual.recognition.features import (
    Channels,
    Detection,
    Gesture,
    gestures_in,
    scan,
    window_lengths,
)
from nodes.perceptual.recognition.gmr import Curves
from nodes.perceptual.recognition.streams import UNKNOWN, Passage, Take, passages_of, takes_of
from nodes.perceptual.recognition.validation import CERTAINTIES, curves_of, rises, spot

GESTURES = (Gesture("left", 0.9, 1.0, 1.1, 2), Gesture("right", 0.9, 1.0, 1.1, 1))


def passage(*takes, unknown=(), seconds=20):
    return Passage("made", "ann", 0.0, np.zeros((seconds * 50, 3)), takes, unknown)


def at(name, certainty, end_s):
    return Detection(name, certainty, end_s - 1, end_s)


def points(curve):
    return {point.certainty: point for point in curve}


def test_a_higher_certainty_catches_fewer_and_lets_less_through():
    made = passage(Take("left", 1, 2), Take("left", 4, 5), Take("right", 8, 9))
    found = [at("left", 0.9, 2), at("left", 0.5, 5), at("left", 0.6, 9), at("left", 0.4, 15)]
    everyday = (passage(seconds=36), [at("left", 0.3, 7), at("right", 0.8, 9)])

    curve = points(curves_of(GESTURES, [(made, found), everyday])["left"])

    assert [curve[one].caught for one in (0.45, 0.5, 0.9, 0.95)] == [1, 1, 0.5, 0]
    assert [curve[one].false_in_others for one in (0.4, 0.45, 0.6, 0.65)] == [2, 1, 1, 0]
    assert [curve[one].false_everyday_per_hour for one in (0.3, 0.35)] == [100, 0]


def test_what_is_found_where_nobody_knows_does_not_count():
    made = passage(Take("left", 1, 2), unknown=((4, 6),))

    curve = points(curves_of(GESTURES, [(made, [at("left", 0.9, 5.5)])])["left"])

    assert curve[0.5].false_in_others == 0


def test_rises_are_what_the_spotter_would_find_at_some_trigger(sessions):
    one = passages_of(sessions[:1], gyroscope=True)[0]
    gestures = gestures_in(one.takes)
    found = scan(one, window_lengths(gestures))
    certainties = np.zeros((len(found.hop), len(gestures)))
    for column, height in ((0, 0.9), (1, 0.6)):
        take = next(take for take in one.takes if take.gesture == gestures[column].name)
        certainties[:, column] = height * (found.overlaps(take) > 0.8)

    peaks = rises(found, gestures, certainties)

    assert [(peak.gesture, peak.certainty) for peak in peaks] == [
        (gestures[0].name, 0.9),
        (gestures[1].name, 0.6),
    ]
    assert [peak.gesture for peak in spot(found, gestures, certainties)] == [gestures[0].name]
    assert (CERTAINTIES[0], CERTAINTIES[-1], len(CERTAINTIES)) == (0.05, 0.95, 19)


def test_nothing_is_learned_from_what_is_marked_as_unknown(sessions):
    recording = sessions[0]
    left_out = takes_of(recording)[0]
    inside = (recording.t >= left_out.start_s) & (recording.t <= left_out.end_s)
    labels = [
        UNKNOWN if here else label for here, label in zip(inside, recording.labels, strict=True)
    ]

    one = passages_of([replace(recording, labels=labels)], gyroscope=True)[0]
    gestures = gestures_in(one.takes)
    found = scan(one, window_lengths(gestures))
    held = label_scan(found, gestures)

    assert left_out not in one.takes
    assert one.unknown == ((left_out.start_s, left_out.end_s),)
    touching = (found.starts_s < left_out.end_s) & (found.ends_s > left_out.start_s)
    assert set(held[touching]) == {NEITHER}
    assert len(set(held[~touching])) > 1


def test_an_expected_curve_is_in_the_units_of_the_signals():
    curves = Curves(
        scale=np.array([2.0, 4.0]),
        mean=np.ones((1, 32, 2)),
        whiten=np.tile(np.diag([1 / 0.5, 1 / 0.1]), (1, 32, 1, 1)),
        log_det=np.zeros(1),
    )

    mean, spread = curves.expected(0)

    assert np.allclose(mean, [2.0, 4.0])
    assert np.allclose(spread, [1.0, 0.4])


def test_every_signal_has_a_name():
    for gravity in (False, True):
        for gyroscope in (False, True):
            channels = Channels(gravity, gyroscope)
            assert len(set(channels.signal_names)) == channels.signals
