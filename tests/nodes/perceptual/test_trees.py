"""Flattened trees vote as the forest that they were made from."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nodes.perceptual.recognition.trees import Trees, flatten


def grown(seed, *, samples=80, labels=4, classes=None):
    from sklearn.ensemble import ExtraTreesClassifier  # takes seconds, in each worker

    chance = np.random.default_rng(seed)
    features = chance.normal(size=(samples, 6)).astype(np.float32).round(1)
    held = (
        chance.integers(0, labels, samples) if classes is None else chance.choice(classes, samples)
    )
    forest = ExtraTreesClassifier(7, class_weight="balanced", random_state=seed)
    return forest.fit(features, held), features


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000))
def test_the_votes_are_those_of_scikit_learn(seed):
    forest, features = grown(seed)
    on_thresholds = np.vstack([tree.tree_.threshold[:6] for tree in forest.estimators_])
    asked = np.vstack([features, on_thresholds.astype(np.float32), -features * 3])

    votes = flatten(forest, 4).probabilities(asked)

    assert np.allclose(votes, forest.predict_proba(asked), atol=1e-6)


def test_a_class_that_was_not_seen_gets_no_votes():
    forest, features = grown(1, classes=[0, 3])

    votes = flatten(forest, 4).probabilities(features)

    assert np.allclose(votes[:, [1, 2]], 0)
    assert np.allclose(votes[:, [0, 3]], forest.predict_proba(features), atol=1e-6)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("right", lambda right: np.zeros_like(right)),
        ("right", lambda right: right + 1_000_000),
        ("right", lambda right: right[:-1]),
        ("feature", lambda feature: feature + 50),
        ("leaf", lambda leaf: leaf - 5),
        ("roots", lambda roots: roots[:0]),
        ("votes", lambda votes: votes[:, 1:]),
        ("votes", lambda votes: votes * np.nan),
    ],
)
def test_arrays_that_would_lead_astray_or_in_circles_are_refused(name, change):
    arrays = flatten(grown(2)[0], 4).arrays()

    with pytest.raises(ValueError, match="do not fit"):
        Trees.from_arrays(arrays | {name: change(arrays[name])}, 3, 6)


def test_arrays_that_fit_are_taken():
    trees = flatten(grown(2)[0], 4)

    again = Trees.from_arrays(trees.arrays(), 3, 6)

    features = grown(2)[1]
    assert np.array_equal(again.probabilities(features), trees.probabilities(features))
