"""Which part of the recordings is left out together with which, to check a recogniser."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from nodes.perceptual.recognition.features import Integers
from nodes.perceptual.recognition.passages import Passage
from nodes.perceptual.recognition.scans import Scan

FOLDS = 5
_ENOUGH_PEOPLE = 2
_BLOCK_S = 20.0  # everyday movement is dealt out in pieces of this length


def fold_takes(passages: Sequence[Passage]) -> list[list[int]]:
    """The fold of every take of every passage.

    With several people a fold is some of the people: the check then tells how new people fare.
    Else it is some of the takes of each gesture.
    """
    people = sorted({passage.person for passage in passages if passage.takes})
    if len(people) >= _ENOUGH_PEOPLE:
        fold_of = {person: number % FOLDS for number, person in enumerate(people)}
        return [[fold_of[one.person] for _ in one.takes] for one in passages]
    seen: Counter[str] = Counter()
    folds = []
    for passage in passages:
        own = []
        for take in passage.takes:
            own.append(seen[take.gesture] % FOLDS)
            seen[take.gesture] += 1
        folds.append(own)
    return folds


def fold_windows(found: Scan, take_folds: Sequence[int]) -> Integers:
    """The fold of each window of a scan: that of the take next to it."""
    middle_s = (found.starts_s + found.ends_s) / 2
    if not take_folds:
        blocks: Integers = (middle_s // _BLOCK_S).astype(np.intp) % FOLDS
        return blocks
    takes_s = np.array([(take.start_s + take.end_s) / 2 for take in found.passage.takes])
    nearest = np.abs(middle_s[:, None] - takes_s).argmin(axis=1)
    nearby: Integers = np.array(take_folds, np.intp)[nearest]
    return nearby
