"""What simulated people do when they make no gesture."""

import numpy as np
import pytest

from nodes.sensory.arm.everyday import CALM, CHORES, EVERYDAY, HANGING, LIVELY, SIGNS, clap, jolt
from nodes.sensory.arm.motion import Body, Motion, felt_exactly, joint_values
from nodes.sensory.arm.people import simulate_everyday

UNSEEN = 105
EVERY = sorted({*EVERYDAY, *SIGNS}, key=lambda activity: activity.__name__)


@pytest.mark.parametrize("activity", EVERY, ids=lambda activity: activity.__name__)
def test_an_activity_moves_the_watch_as_a_body_can(activity):
    recording = simulate_everyday(UNSEEN, 12.0, seed=1, activities=[activity])

    sizes = np.linalg.norm(recording.acc, axis=1)
    turning = np.linalg.norm(recording.gyr, axis=1)
    assert set(recording.labels) == {""}
    assert sizes.max() < 80
    assert 0.2 < turning.max() < 15
    assert np.median(sizes) == pytest.approx(9.81, abs=2.5)


def test_models_are_not_taught_that_the_signs_of_people_are_nothing():
    assert not set(SIGNS) & set(EVERYDAY)
    assert set(CHORES) < set(EVERYDAY)
    assert set(EVERYDAY) | set(SIGNS) == set(LIVELY)


def test_a_virtual_watch_that_waits_does_only_calm_things():
    assert not set(CALM) & {*CHORES, *SIGNS}


def test_clapping_is_felt_as_knocks_that_gesticulating_has_not():
    def sharpest(activities):
        recording = simulate_everyday(UNSEEN, 20.0, rate_hz=100, activities=activities)
        return np.abs(np.diff(recording.acc, axis=0)).max()

    assert sharpest([clap]) > 2 * sharpest(CALM)


def test_a_jolt_is_over_at_once_and_leaves_the_arm_where_it_was():
    motion = Motion(joint_values(HANGING))

    jolt(motion, 1.0, 0.003)
    acc, _gyr = felt_exactly(motion, Body(), np.arange(0.0, 2.0, 0.002))

    sizes = np.linalg.norm(acc, axis=1)
    assert sizes[:500] == pytest.approx(9.81, abs=1e-6)
    assert sizes[500:545].max() > 14
    assert sizes[545:] == pytest.approx(9.81, abs=1e-3)


def test_no_axis_of_an_accelerometer_is_exactly_right():
    at_rest = [simulate_everyday(person, 4.0).acc for person in (UNSEEN, UNSEEN + 1)]

    usual = [float(np.median(np.linalg.norm(acc, axis=1))) for acc in at_rest]
    assert usual[0] != pytest.approx(usual[1], abs=1e-3)
