"""A gesture is varied as people differ, and by nothing else."""

import numpy as np
import pytest

from nodes.perceptual.recognition.examples import varied
from nodes.perceptual.recognition.features import POINTS, Channels, signals_of

CHANCE = np.random.default_rng(0)
RAW = CHANCE.normal(size=(40, POINTS, 6)) * 4


def test_the_same_seed_gives_the_same_variations_and_another_gives_others():
    assert np.array_equal(varied(RAW, (1, 2)), varied(RAW, (1, 2)))
    assert not np.allclose(varied(RAW, (1, 2)), varied(RAW, (1, 3)))


def test_what_is_given_stays_as_it_is():
    before = RAW.copy()

    varied(RAW, (4,))

    assert np.array_equal(RAW, before)


def test_gravity_is_turned_but_neither_stronger_nor_weaker():
    still = np.tile([0.0, 9.81, 0.0, 0.0, 0.0, 0.0], (60, POINTS, 1))

    gravity = varied(still, (5,))[..., :3]

    assert np.linalg.norm(gravity, axis=2) == pytest.approx(9.81)
    degrees = np.degrees(np.arccos(gravity[:, 0, 1] / 9.81))
    assert 2 < np.median(degrees) < 12


def test_a_stronger_performance_has_the_same_signals():
    channels = Channels(gravity=False, gyroscope=True)

    usual, strong = signals_of(RAW * 5, channels), signals_of(RAW * 20, channels)

    assert np.abs(usual - strong).max() < 0.1


def test_a_constant_acceleration_is_no_movement():
    channels = Channels(gravity=False, gyroscope=False)

    assert signals_of(RAW[..., :3] + [0, 0, 9.81], channels) == pytest.approx(
        signals_of(RAW[..., :3], channels)
    )
