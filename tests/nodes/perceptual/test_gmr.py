"""Mixtures, the curves they expect, and distances, against closed forms and known truth."""

import numpy as np
import pytest

from nodes.perceptual.recognition.features import scan
from nodes.perceptual.recognition.gmr import Curves, Mixture, expected_curve, fit_mixture
from nodes.perceptual.recognition.streams import passages_of
from nodes.perceptual.recognition.training import train
from nodes.perceptual.recognition.trees import Trees


def test_one_gaussian_is_linear_regression():
    chance = np.random.default_rng(0)
    times = np.linspace(0, 1, 32)
    curves = 2 * times[None, :, None] + 1 + chance.normal(0, 0.5, (40, 32, 1))

    mean, covariance = expected_curve(fit_mixture(curves, components=1))

    slope, start = np.polyfit(np.tile(times, 40), curves.ravel(), 1)
    assert mean[:, 0] == pytest.approx(start + slope * times, abs=0.05)
    assert np.sqrt(covariance.ravel()) == pytest.approx(0.5, abs=0.03)


def test_the_covariance_follows_the_law_of_total_covariance():
    apart = Mixture(
        weight=np.array([0.5, 0.5]),
        mean=np.array([[0.5, -1.0], [0.5, 1.0]]),
        covariance=np.array([np.diag([0.1, 0.04])] * 2),
    )

    mean, covariance = expected_curve(apart)

    assert mean == pytest.approx(0.0)
    assert covariance == pytest.approx(0.04 + 1.0)


def test_a_known_mixture_is_expected_as_sampling_finds_it():
    chance = np.random.default_rng(1)
    mixture = Mixture(
        weight=np.array([0.3, 0.7]),
        mean=np.array([[0.2, 0.0, 1.0], [0.8, 2.0, -1.0]]),
        covariance=np.array(
            [
                [[0.02, 0.01, 0.0], [0.01, 0.1, 0.02], [0.0, 0.02, 0.2]],
                [[0.03, 0.0, -0.02], [0.0, 0.3, 0.1], [-0.02, 0.1, 0.2]],
            ]
        ),
    )
    which = chance.choice(2, 400_000, p=mixture.weight)
    drawn = np.empty((len(which), 3))
    for number in (0, 1):
        here = which == number
        drawn[here] = chance.multivariate_normal(
            mixture.mean[number], mixture.covariance[number], here.sum()
        )

    mean, covariance = expected_curve(mixture, points=5)

    for at in (1, 2, 3):
        near = drawn[np.abs(drawn[:, 0] - at / 4) < 0.01, 1:]
        assert mean[at] == pytest.approx(near.mean(axis=0), abs=0.05)
        assert covariance[at] == pytest.approx(np.cov(near.T), abs=0.06)


def test_fitting_finds_a_curve_that_bends():
    chance = np.random.default_rng(2)
    shape = np.sin(np.linspace(0, 2 * np.pi, 32))
    curves = shape[None, :, None] + chance.normal(0, 0.05, (10, 32, 1))

    mean, _ = expected_curve(fit_mixture(curves))

    assert np.abs(mean[:, 0] - shape).max() < 0.25
    assert np.corrcoef(mean[:, 0], shape)[0, 1] > 0.99


def test_the_distance_is_a_likelihood():
    chance = np.random.default_rng(3)
    covariance = np.array([[0.5, 0.2], [0.2, 0.4]])
    lower = np.linalg.cholesky(covariance)
    mean = chance.normal(size=(32, 2))
    curves = Curves(
        scale=np.array([2.0, 4.0]),
        mean=mean[None],
        whiten=np.tile(np.linalg.inv(lower), (1, 32, 1, 1)),
        log_det=np.array([np.log(np.linalg.det(covariance))]),
    )
    signals = chance.normal(size=(3, 32, 2))

    distances = curves.distances(signals)

    away = signals / [2.0, 4.0] - mean
    squares = np.einsum("nts,sr,ntr->nt", away, np.linalg.inv(covariance), away)
    expected = squares.mean(axis=1) + np.log(np.linalg.det(covariance))
    assert distances[:, 0] == pytest.approx(expected)


def _curves_that_bend():
    times = np.linspace(0, 1, 32)
    shapes = np.stack([np.sin(2 * np.pi * times), np.cos(2 * np.pi * times)])[..., None]
    return Curves(
        scale=np.ones(1),
        mean=shapes,
        whiten=np.full((2, 32, 1, 1), 4.0),
        log_det=np.zeros(2),
    )


def test_a_movement_that_is_early_on_its_curve_is_near_it_when_aligned():
    curves = _curves_that_bend()
    late = np.sin(2 * np.pi * np.clip(np.linspace(0, 1, 32) - 3 / 31, 0, 1))[None, :, None]

    plain, aligned = curves.distances(late), curves.aligned_distances(late)

    assert aligned[0, 0] < plain[0, 0] / 3
    assert aligned[0, 0] < aligned[0, 1]


def test_aligning_never_makes_a_movement_farther():
    curves = _curves_that_bend()
    any_signals = np.random.default_rng(4).normal(size=(700, 32, 1))

    plain, aligned = curves.distances(any_signals), curves.aligned_distances(any_signals)

    assert (aligned <= plain + 1e-4).all()
    assert curves.aligned_distances(any_signals[:0]).shape == (0, 2)


def test_what_several_people_taught_asks_trees_and_curves(model, sessions):
    (both,) = [one for one in model.recognisers if one.method == "trees" and one.channels.gyroscope]
    passage = passages_of(sessions[:1], gyroscope=True)[0]
    found = scan(passage, model.lengths)
    windows = found.windows(both.channels, np.arange(0, len(found.hop), 50))

    votes = both.scorer.trees.probabilities(windows.features)
    followed = both.scorer.curves.scores(windows, 1 - votes[:, -1])

    expected = 0.3 * votes[:, :-1] + 0.7 * followed
    assert both.scorer.scores(windows) == pytest.approx(expected)
    assert expected.max() > 0.5


def test_what_one_person_taught_asks_trees_alone(sessions):
    alone = train(sessions[:1], methods=("trees",))

    assert {type(one.scorer) for one in alone.recognisers} == {Trees}
