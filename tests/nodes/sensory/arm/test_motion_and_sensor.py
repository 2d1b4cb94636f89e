"""The physics of the simulated arm."""

import numpy as np
import pytest

from nodes.sensory.arm.motion import (
    GRAVITY_M_S2,
    Body,
    Joint,
    Motion,
    Swing,
    felt_exactly,
    joint_values,
    minimum_jerk,
    watch_frames,
)

BODY = Body()


def moving() -> Motion:
    motion = Motion(joint_values({Joint.ELBOW: 40, Joint.ABDUCTION: 10}))
    motion.move({Joint.FLEXION: 100, Joint.ELBOW: 90, Joint.PRONATION: -50}, 0.3, 0.8)
    motion.move({Joint.TWIST: 40, Joint.ROTATION: 60, Joint.UP: -0.2}, 0.6, 0.9)
    return motion


def test_at_rest_the_watch_feels_gravity_upward_and_does_not_turn():
    t = np.arange(0, 1, 0.02)

    acc, gyr = felt_exactly(Motion(np.zeros(len(Joint))), BODY, t)

    # the arm hangs: up is towards the elbow, the watch's x on the right wrist
    assert acc == pytest.approx(np.tile([GRAVITY_M_S2, 0, 0], (50, 1)), abs=1e-6)
    assert gyr == pytest.approx(np.zeros((50, 3)), abs=1e-9)


@pytest.mark.parametrize(
    ("pose", "up"),
    [
        ({Joint.FLEXION: 180}, [-1, 0, 0]),  # hand overhead
        ({Joint.FLEXION: 90, Joint.PRONATION: 90}, [0, 0, 1]),  # forward, palm down
        ({Joint.FLEXION: 90, Joint.PRONATION: -90}, [0, 0, -1]),  # forward, palm up
        ({Joint.ELBOW: 90}, [0, -1, 0]),  # forearm forward, thumb up
    ],
)
def test_gravity_tells_how_the_forearm_is_turned(pose, up):
    acc, _gyr = felt_exactly(Motion(joint_values(pose)), BODY, np.array([0.0]))

    assert acc[0] / GRAVITY_M_S2 == pytest.approx(np.array(up, float), abs=1e-6)


def test_the_gyroscope_summed_up_gives_the_change_of_attitude():
    t = np.arange(0.0005, 2.0, 0.001)
    motion = moving()

    _acc, gyr = felt_exactly(motion, BODY, t)
    attitude = watch_frames(motion.poses(np.array([0.0])), BODY)[1][0]
    for rate in gyr:
        attitude = attitude @ rotation(rate * 0.001)

    at_the_end = watch_frames(motion.poses(np.array([2.0])), BODY)[1][0]
    assert attitude == pytest.approx(at_the_end, abs=1e-4)
    assert not np.allclose(at_the_end, watch_frames(motion.poses(np.zeros(1)), BODY)[1][0], atol=1)


def test_the_acceleration_summed_up_twice_gives_the_way_of_the_wrist():
    step_s = 0.001
    t = np.arange(0, 2.0, step_s)
    motion = moving()
    positions, rotations = watch_frames(motion.poses(t), BODY)

    acc, _gyr = felt_exactly(motion, BODY, t)
    in_world = np.einsum("nij,nj->ni", rotations, acc) - [0, 0, GRAVITY_M_S2]
    connector = (np.cumsum(np.cumsum(in_world, axis=0), axis=0) * step_s**2)[-1]

    moved = positions[-1] - positions[0]
    assert np.linalg.norm(moved) > 0.3
    assert connector == pytest.approx(moved, abs=0.003)


def test_a_stroke_that_begins_during_another_makes_no_jump():
    motion = moving()
    motion.move({Joint.FLEXION: -20}, 0.7, 0.5)

    acc, gyr = felt_exactly(motion, BODY, np.arange(0, 2, 0.001))

    assert np.abs(np.diff(acc, axis=0)).max() < 0.8  # m/s² in a millisecond
    assert np.abs(np.diff(gyr, axis=0)).max() < 0.1


def test_plans_given_up_leave_what_is_under_way_without_a_jump():
    motion, kept = moving(), moving()
    sway = Swing(0.0, 5.0, 2.0, 0.3, joint_values({Joint.ELBOW: 5}))
    motion.swing(sway)
    kept.swing(sway)
    motion.move({Joint.FLEXION: 170}, 1.0, 0.5)
    t = np.arange(0, 3, 0.002)

    motion.give_up_plans(0.8)

    before = t < 0.8
    assert motion.poses(t)[before] == pytest.approx(kept.poses(t)[before], abs=1e-12)
    acc, _gyr = felt_exactly(motion, BODY, t)
    assert np.abs(np.diff(acc, axis=0)).max() < 1.5
    assert motion.poses(t)[-1] == pytest.approx(kept.goal)


def test_what_is_forgotten_changes_no_later_pose():
    motion, t = moving(), np.arange(1.6, 3, 0.01)
    poses = motion.poses(t)

    motion.forget_before(1.6)

    assert motion.poses(t) == pytest.approx(poses)


def test_minimum_jerk_starts_and_ends_without_speed():
    part = minimum_jerk(np.linspace(-0.5, 1.5, 2001))

    assert part[0] == 0
    assert part[-1] == 1
    assert np.all(np.diff(part) >= 0)
    assert np.abs(np.diff(part[495:510])).max() < 1e-5


def rotation(vector):
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
