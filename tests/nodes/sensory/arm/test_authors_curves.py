"""The simulated gestures begin and end as those of the paper's authors."""

import numpy as np
import pytest

from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import perform


@pytest.mark.real_data
@pytest.mark.parametrize("gesture", GESTURES)
@pytest.mark.parametrize("end", [slice(0, 4), slice(-4, None)], ids=["start", "end"])
def test_gravity_points_where_it_did_for_the_authors(shared_data, gesture, end):
    theirs = np.loadtxt(shared_data / "nep_models" / f"{gesture}_Mu.txt")[end].mean(axis=0)

    performances = [perform(gesture, person, 0, rate_hz=32) for person in range(100, 109)]
    ours = np.mean(
        [r.acc[np.array(r.labels) == gesture][end].mean(axis=0) for r in performances], axis=0
    )

    cosine = ours @ theirs / np.linalg.norm(ours) / np.linalg.norm(theirs)
    assert np.degrees(np.arccos(cosine)) < 25
