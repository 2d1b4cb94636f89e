"""Windows are cut and described as the formulas say."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.perceptual.recognition.features import (
    POINTS,
    Channels,
    cut_windows,
    describe,
    feature_count,
    signals_of,
)

ALL_CHANNELS = [Channels(gravity, gyro) for gravity in (True, False) for gyro in (True, False)]


@pytest.mark.parametrize("channels", ALL_CHANNELS, ids=lambda channels: channels.in_words)
def test_the_counts_of_signals_and_features_are_as_told(channels):
    raw = np.random.default_rng(0).normal(size=(5, POINTS, channels.columns))

    windows = describe(raw, np.full(5, 40), channels)

    assert windows.signals.shape == (5, POINTS, channels.signals)
    assert windows.features.shape == (5, feature_count(channels))
    assert np.isfinite(windows.features).all()


@given(last=st.integers(10, 99), length=st.integers(2, 11))
def test_a_window_runs_evenly_from_its_first_to_its_last_sample(last, length):
    samples = np.arange(100.0)[:, None]

    window = cut_windows(samples, np.array([last]), np.array([length]))[0, :, 0]

    assert np.allclose(window, np.linspace(last - length + 1, last, POINTS))


def test_a_still_watch_has_only_gravity():
    raw = np.tile([0.0, 9.81, 0.0, 0.0, 0.0, 0.0], (1, POINTS, 1))

    signals = signals_of(raw, Channels(gravity=True, gyroscope=True))

    assert np.allclose(signals[..., :8], 0.0)
    assert np.allclose(signals[..., 8:], [0.0, 1.0, 0.0])


@given(st.integers(0, 1000))
def test_lengths_of_vectors_do_not_depend_on_how_the_watch_sits(seed):
    chance = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(chance.normal(size=(3, 3)))
    raw = chance.normal(size=(1, POINTS, 6)) * 5
    turned = np.concatenate([raw[..., :3] @ turn, raw[..., 3:] @ turn], axis=2)
    channels = Channels(gravity=False, gyroscope=True)

    usual, other = signals_of(raw, channels), signals_of(turned, channels)

    assert np.allclose(usual[..., [3, 7]], other[..., [3, 7]])
    assert not np.allclose(usual, other)
