"""Many random decision trees as plain arrays: asked with numpy alone, grown with scikit-learn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.examples import Examples
from nodes.perceptual.recognition.features import Singles, Windows

from .streams import Floats

TREES = 100


@dataclass(frozen=True)
class Trees:
    """Extremely randomised trees (Geurts, Ernst and Wehenkel 2006), all nodes in one list.

    ``roots`` (trees,) are the trees' first nodes. A node of the n in all sends a window whose
    ``feature`` is at most ``threshold`` to the node after it, another to node ``right``. A node
    whose ``right`` is itself is a leaf: it votes with row ``leaf`` of ``votes`` (leaves, gestures
    + 1), the last column being *no gesture*.
    """

    roots: NDArray[np.int32]
    feature: NDArray[np.int16]
    threshold: NDArray[np.float32]
    right: NDArray[np.int32]
    leaf: NDArray[np.int32]
    votes: NDArray[np.float32]

    def scores(self, windows: Windows) -> Floats:
        """The share of the votes for each gesture; (n, gestures)."""
        return self.probabilities(windows.features)[:, :-1]

    def probabilities(self, features: Singles) -> Floats:
        """The share of the votes for each gesture and none, for features (n, f); (n, gestures+1).

        The same numbers as scikit-learn's ``predict_proba``.
        """
        values = np.ascontiguousarray(features).ravel()
        first = np.repeat(np.arange(len(features)) * features.shape[1], len(self.roots))
        nodes = np.tile(self.roots, len(features))
        on_the_way = np.flatnonzero(self.right.take(nodes) != nodes)
        while len(on_the_way):
            here = nodes.take(on_the_way)
            asked = values.take(first.take(on_the_way) + self.feature.take(here))
            above = asked > self.threshold.take(here)
            below = np.where(above, self.right.take(here), here + 1)
            nodes[on_the_way] = below
            on_the_way = on_the_way[self.right.take(below) != below]
        votes = self.votes[self.leaf[nodes]].reshape(len(features), len(self.roots), -1)
        shares: Floats = votes.mean(axis=1, dtype=np.float64)
        return shares

    def gate(self, trees: int) -> Trees:
        """The first ``trees`` of these trees, asked only whether it is any gesture at all."""
        nodes = int(self.roots[trees]) if trees < len(self.roots) else len(self.right)
        any_or_none = np.stack([1 - self.votes[:, -1], self.votes[:, -1]], axis=1)
        votes, which = _distinct(any_or_none)
        return Trees(
            self.roots[:trees],
            self.feature[:nodes],
            self.threshold[:nodes],
            self.right[:nodes],
            which[self.leaf[:nodes]].astype(np.int32),
            votes,
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""
        return dict(vars(self))

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]], gestures: int, features: int) -> Trees:
        """Trees from a model file; ValueError or KeyError when they could not be asked."""
        trees = cls(
            roots=arrays["roots"].astype(np.int32),
            feature=arrays["feature"].astype(np.int16),
            threshold=arrays["threshold"].astype(np.float32),
            right=arrays["right"].astype(np.int32),
            leaf=arrays["leaf"].astype(np.int32),
            votes=arrays["votes"].astype(np.float32),
        )
        trees._check(gestures, features)
        return trees

    def _check(self, gestures: int, features: int) -> None:
        n = len(self.right)
        itself = np.arange(n)
        is_leaf = self.right == itself
        sound = (
            self.feature.shape == self.threshold.shape == self.right.shape == self.leaf.shape
            and self.votes.ndim == 2
            and self.votes.shape[1] == gestures + 1
            and self.roots.ndim == 1
            and len(self.roots) > 0
            and bool(np.all((self.roots >= 0) & (self.roots < n)))
            and bool(np.all(is_leaf | ((self.right > itself) & (self.right < n))))
            and bool(is_leaf[-1])
            and bool(np.all((self.feature >= 0) & (self.feature < features)))
            and bool(np.all((self.leaf >= 0) & (self.leaf < len(self.votes))))
            and bool(np.all(np.isfinite(self.votes)))
        )
        if not sound:
            raise ValueError("the decision trees do not fit together")


def fit_trees(examples: Examples, seed: int = 0, trees: int = TREES) -> Trees:
    """Grow trees that tell the gestures of the examples, and *no gesture*, apart."""
    from sklearn.ensemble import ExtraTreesClassifier

    forest = ExtraTreesClassifier(trees, class_weight="balanced", random_state=seed, n_jobs=-1)
    forest.fit(examples.windows.features, examples.labels)
    return flatten(forest, len(examples.gestures) + 1)


def flatten(forest: Any, classes: int) -> Trees:
    """The trees of a fitted scikit-learn forest whose classes are some of range(classes)."""
    grown = [estimator.tree_ for estimator in forest.estimators_]
    roots = np.cumsum([0] + [tree.node_count for tree in grown])[:-1]
    right, feature, threshold, leaf_votes, is_leaf = [], [], [], [], []
    for root, tree in zip(roots, grown, strict=True):
        ends = tree.children_left < 0
        itself = root + np.arange(tree.node_count)
        right.append(np.where(ends, itself, root + tree.children_right))
        feature.append(np.where(ends, 0, tree.feature))
        threshold.append(np.where(ends, 0.0, _rounded_down(tree.threshold)))
        shares = tree.value[ends, 0, :] / tree.value[ends, 0, :].sum(axis=1, keepdims=True)
        votes = np.zeros((len(shares), classes))
        votes[:, forest.classes_] = shares
        leaf_votes.append(votes)
        is_leaf.append(ends)
    votes, which = _distinct(np.concatenate(leaf_votes))
    leaf = np.zeros(len(np.concatenate(is_leaf)), np.int32)
    leaf[np.concatenate(is_leaf)] = which
    return Trees(
        roots=roots.astype(np.int32),
        feature=np.concatenate(feature).astype(np.int16),
        threshold=np.concatenate(threshold).astype(np.float32),
        right=np.concatenate(right).astype(np.int32),
        leaf=leaf,
        votes=votes.astype(np.float32),
    )


def _distinct(votes: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.intp]]:
    """The different rows of votes, and which of them each row is.

    Nearly all leaves vote for one class alone: only the others need sorting.
    """
    classes = votes.shape[1]
    which = votes.argmax(axis=1)
    mixed = votes.max(axis=1) < 1
    others, which_other = np.unique(votes[mixed], axis=0, return_inverse=True)
    which[mixed] = classes + which_other.ravel()
    return np.concatenate([np.eye(classes, dtype=votes.dtype), others]), which


def _rounded_down(threshold: Floats) -> Floats:
    """The largest 32-bit number up to each threshold: it splits 32-bit features alike."""
    rounded = threshold.astype(np.float32)
    return np.where(rounded > threshold, np.nextafter(rounded, np.float32(-np.inf)), rounded)
