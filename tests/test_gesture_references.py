"""The references of the gesture benchmark: time warping and the paper's matching."""

import numpy as np
import pytest

from benchmarks._gesture_paper import PaperMatching, split
from benchmarks._gesture_references import Looks, NearestByWarping, fire, warped_distances
from nodes.perceptual.recognition.streams import takes_of
from nodes.sensory.arm.people import perform, simulate_everyday, simulate_session

RATE_HZ = 33.0


def session_of(person, gesture, takes):
    return simulate_session(person, [gesture], takes, RATE_HZ)


def test_warping_finds_the_same_curve_made_faster_at_first():
    t = np.linspace(0, 1, 32)
    curve = np.stack([np.sin(2 * np.pi * t), np.cos(3 * np.pi * t)], axis=1)
    warped = np.stack([np.sin(2 * np.pi * t**1.2), np.cos(3 * np.pi * t**1.2)], axis=1)
    other = np.stack([np.cos(2 * np.pi * t), np.sin(3 * np.pi * t)], axis=1)

    distances = warped_distances(warped[None], np.stack([curve, other]))

    assert distances[0, 0] < 0.3 * distances[0, 1]
    assert distances[0, 0] < 0.5 * np.linalg.norm(warped - curve)
    assert warped_distances(curve[None], curve[None]) == pytest.approx(0, abs=0.01)


def test_the_highest_scores_fire_and_their_neighbours_do_not():
    ends_s = np.arange(0.1, 3.0, 0.1)
    scores = np.zeros((len(ends_s), 2))
    scores[9:12, 0] = (0.7, 0.9, 0.8)
    scores[24, 1] = 0.6
    looks = Looks(ends_s, scores, np.full(scores.shape, 0.5), delay_s=0.1)

    found = fire(looks, ["a", "b"], 0.5)

    assert [one.gesture for one in found] == ["a", "b"]
    assert found[0].t_end == pytest.approx(1.0)
    assert fire(looks, ["a", "b"], 0.95) == []


def test_the_papers_filter_parts_gravity_from_the_body():
    t = np.arange(0, 12, 1 / 32)
    raw = np.stack([np.full_like(t, 9.81), np.sin(2 * np.pi * 5 * t), np.zeros_like(t)], axis=1)

    gravity, body = split(raw[None])

    middle = slice(200, None)
    assert gravity[0, middle, 0] == pytest.approx(9.81, abs=0.3)
    assert np.abs(gravity[0, middle, 1]).max() < 0.05
    assert np.abs(body[0, middle, 1]).max() > 0.5


def test_the_papers_matching_knows_again_what_it_learned():
    lessons = [perform(name, 103, take) for name in ("karate", "katana") for take in range(2)]

    matching = PaperMatching(lessons)

    known = [
        matching.classify(one, take) == take.gesture for one in lessons for take in takes_of(one)
    ]
    assert all(known)
    assert matching.look(lessons[0]).scores.max() <= 1.0


def test_the_nearest_example_spots_a_take_it_has_not_seen():
    lessons = [perform(name, 103, take) for name in ("karate", "hand_up") for take in range(2)]
    nearest = NearestByWarping(lessons, [simulate_everyday(1, 10.0)])
    unseen = perform("karate", 103, 7)

    found = fire(nearest.look(unseen), nearest.names, 0.52)

    assert [one.gesture for one in found] == ["karate"]
