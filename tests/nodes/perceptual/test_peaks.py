"""A certainty that rises and falls is one gesture."""

import numpy as np

from nodes.perceptual.recognition.features import Detection, Gesture, PeakPicker, best_lengths
from nodes.perceptual.recognition.streams import Take
from nodes.perceptual.recognition.validation import Totals, match

GESTURES = (Gesture("left", 0.9, 1.0, 1.1, 5), Gesture("right", 0.9, 1.0, 1.1, 5))
SECOND = np.array([1.0, 1.0])


def fired(*certainties, hop_s=0.08):
    picker = PeakPicker(GESTURES, trigger=0.75)
    found = [
        picker.look(number * hop_s, np.array(certainty), SECOND)
        for number, certainty in enumerate(certainties)
    ]
    return [one for one in [*found, picker.flush()] if one]


def bump(height, column=0):
    rising = [0.2, 0.5, 0.8, 0.95, 1.0, 0.95, 0.8, 0.5, 0.2, 0.0, 0.0]
    return [np.eye(2)[column] * height * part for part in rising]


def test_a_rise_over_the_trigger_fires_once_with_its_highest_certainty():
    found = fired(*bump(0.95))

    assert [(one.gesture, round(one.certainty, 2)) for one in found] == [("left", 0.95)]
    assert (round(found[0].t_start, 2), round(found[0].t_end, 2)) == (-0.68, 0.32)


def test_a_rise_that_stays_below_the_trigger_does_not_fire():
    assert fired(*bump(0.74)) == []


def test_the_gesture_that_is_more_certain_wins():
    both = [left + right for left, right in zip(bump(0.8), bump(0.9, 1), strict=True)]

    assert [one.gesture for one in fired(*both)] == ["right"]


def test_a_second_rise_in_the_same_movement_does_not_fire():
    assert len(fired(*bump(0.95)[:8], *bump(1.0)[1:], hop_s=0.05)) == 1


def test_the_same_gesture_made_again_fires_again():
    assert len(fired(*bump(0.9), *[np.zeros(2)] * 10, *bump(0.9))) == 2


def test_what_is_waiting_at_the_end_fires():
    assert len(fired(*bump(0.9)[:5])) == 1


def test_only_windows_of_a_fitting_length_count():
    certainties = np.array([[0.9, 0.1], [0.2, 0.3]])

    best, which = best_lengths(certainties, np.array([[False, True], [True, True]]))

    assert best.tolist() == [0.2, 0.3]
    assert which.tolist() == [1, 1]


def test_triggers_are_paired_with_the_takes_that_caused_them():
    takes = [Take("left", 1.0, 2.0), Take("right", 4.0, 5.0), Take("left", 7.0, 8.0)]
    detections = [
        Detection("left", 0.9, 1.1, 2.1),
        Detection("right", 0.8, 1.4, 2.2),
        Detection("left", 0.9, 4.0, 4.9),
        Detection("left", 0.9, 20.0, 21.0),
    ]

    totals = match(takes, detections)

    assert sorted(totals.pairs) == [
        ("", "left"),
        ("", "right"),
        ("left", ""),
        ("left", "left"),
        ("right", "left"),
    ]
    assert (totals.made, totals.right, totals.fired) == (3, 1, 4)
    assert (totals.recall, totals.precision, totals.f1) == (1 / 3, 1 / 4, 2 / 7)
    assert (Totals().recall, Totals().f1) == (0.0, 0.0)
