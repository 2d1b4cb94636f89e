from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nao_stage import BODY

from robots.body.body import Angles
from robots.body.keyframes import Keyframes, Track, track_angles
from robots.body.motion import TICK_S, Motion, braking, keyframe_motion, move

ALL = range(26)
postures = st.sampled_from(sorted(BODY.postures))
angle = st.floats(-4.0, 4.0)


@st.composite
def tracks(draw: st.DrawFn) -> Track:
    count = draw(st.integers(1, 5))
    gaps = draw(st.lists(st.floats(0.03, 1.0), min_size=count, max_size=count))
    keys = draw(st.lists(angle, min_size=count, max_size=count))
    handle = st.tuples(st.floats(-2, 0), st.floats(-2, 2), st.floats(0, 2), st.floats(-2, 2))
    handles = draw(st.none() | st.lists(handle, min_size=count, max_size=count).map(tuple))
    return Track(tuple(np.cumsum(gaps).tolist()), tuple(keys), handles)


keyframes = st.dictionaries(st.sampled_from(BODY.names), tracks(), min_size=1, max_size=6).map(
    Keyframes
)


def assert_possible(start: Angles, motion: Motion) -> None:
    """No joint is out of its limits, or faster than its motor."""
    whole = np.vstack([start] * (len(motion.angles) + 1))
    whole[1:, motion.columns] = motion.angles
    _, clamped = BODY.clamped(whole[1:])
    speeds = np.abs(np.diff(whole, axis=0)) / TICK_S
    assert clamped == []
    assert (speeds <= BODY.max_speed * 1.001).all(), BODY.names[
        (speeds / BODY.max_speed).max(0).argmax()
    ]


@given(postures, keyframes)
def test_any_keyframes_from_any_posture_stay_within_limits_and_speeds(
    posture: str, wished: Keyframes
) -> None:
    start = BODY.posture_angles(posture)

    motion = keyframe_motion(BODY, start, wished)

    assert_possible(start, motion)


@given(postures, postures, st.floats(0.05, 1.0))
def test_any_move_between_postures_stays_within_limits_and_speeds(
    start: str, goal: str, speed: float
) -> None:
    motion = move(BODY, BODY.posture_angles(start), BODY.posture_angles(goal), ALL, speed=speed)

    assert_possible(BODY.posture_angles(start), motion)
    assert motion.angles[-1] == pytest.approx(BODY.posture_angles(goal))


@given(postures, st.lists(st.floats(-1, 1), min_size=26, max_size=26))
def test_braking_stays_within_limits_and_speeds_and_ends_at_rest(
    posture: str, speeds: list[float]
) -> None:
    start = BODY.posture_angles(posture)
    joint_speed = np.array(speeds) * BODY.max_speed
    joint_speed[BODY.index["RHipYawPitch"]] = joint_speed[BODY.index["LHipYawPitch"]]

    motion = braking(BODY, start, joint_speed, ALL)

    assert_possible(start, motion)
    assert motion.angles[-1] == pytest.approx(motion.angles[-2], abs=1e-3)


def test_a_smooth_track_reaches_its_keys_and_goes_nowhere_beyond_them() -> None:
    track = Track((0.5, 1.0, 1.5), (1.0, 1.0, 0.2))

    curve = track_angles(track, 0.0, np.arange(0, 1.6, 0.01), 8.0)

    assert curve[[0, 50, 100, 150]] == pytest.approx([0.0, 1.0, 1.0, 0.2])
    assert curve.min() >= 0.0 and curve.max() <= 1.0 + 1e-9


def test_handles_shape_the_curve_as_a_bezier() -> None:
    # x = (0, 0.6, 0.7, 1), y = (0, 0, 1, 1): the curve is late, and (0.6125, 0.5) at its middle.
    handles = ((-0.3, 0.0, 0.0, 0.0),)
    late = Track((1.0,), (1.0,), handles)
    plain = Track((1.0,), (1.0,))

    times = np.array([0.5])

    assert track_angles(late, 0.0, times, 8.0)[0] == pytest.approx(
        _bezier_at(0.5, (0, 1 / 3, 0.7, 1), (0, 0, 1, 1)), abs=1e-6
    )
    assert track_angles(plain, 0.0, times, 8.0)[0] == pytest.approx(0.5)


def _bezier_at(t: float, x: tuple[float, ...], y: tuple[float, ...]) -> float:
    """A Bezier piece's y where its x is t, by looking at 100,001 of its points."""
    u = np.linspace(0, 1, 100_001)
    weights = np.array([(1 - u) ** 3, 3 * (1 - u) ** 2 * u, 3 * (1 - u) * u**2, u**3])
    return float(np.interp(t, np.array(x) @ weights, np.array(y) @ weights))


def test_a_movement_that_is_too_fast_is_stretched_and_says_so() -> None:
    hasty = Keyframes({"HeadYaw": Track((0.5, 0.55), (1.0, -1.0))})

    motion = keyframe_motion(BODY, BODY.posture_angles("Stand"), hasty)

    assert "slower" in motion.notes[0]
    assert motion.duration_s > 1.0


def test_a_movement_beyond_the_limits_is_clamped_and_says_where() -> None:
    wide = Keyframes({"LShoulderRoll": Track((2.0,), (3.0,))})

    motion = keyframe_motion(BODY, BODY.posture_angles("Stand"), wide)

    assert motion.notes == ("kept within the limits of LShoulderRoll",)
    assert motion.angles[-1] == pytest.approx(1.3265)


def test_the_way_to_a_far_first_key_gets_the_time_it_needs() -> None:
    soon = Keyframes({"RShoulderPitch": Track((0.05, 1.0), (-1.5, -1.4))})

    motion = keyframe_motion(BODY, BODY.posture_angles("Stand"), soon)

    assert motion.notes == ()
    assert motion.duration_s > 1.5


def test_a_head_that_only_turns_nods_where_the_shell_wants_it() -> None:
    start = BODY.posture_angles("Stand")
    start[BODY.index["HeadPitch"]] = np.radians(29)

    motion = keyframe_motion(BODY, start, Keyframes({"HeadYaw": Track((2.0,), (1.5,))}))

    assert np.degrees(motion.angles[-1, 1]) == pytest.approx(11.5, abs=0.5)


def test_mirrored_moves_the_other_side_the_other_way() -> None:
    wave = Keyframes(
        {"RShoulderRoll": Track((1.0,), (-0.4,)), "RShoulderPitch": Track((1.0,), (0.2,))}
    )

    mirrored = wave.mirrored()

    assert mirrored.tracks["LShoulderRoll"].keys == (0.4,)
    assert mirrored.tracks["LShoulderPitch"].keys == (0.2,)


@given(keyframes)
def test_twice_mirrored_and_twice_reversed_is_the_same_movement(wished: Keyframes) -> None:
    assert wished.mirrored().mirrored() == wished
    for name, track in wished.reversed().reversed().delayed(wished.first_key_s).tracks.items():
        assert track.times == pytest.approx(wished.tracks[name].times)
        assert track.keys == wished.tracks[name].keys


def test_reversed_plays_the_last_key_first() -> None:
    track = Keyframes({"HeadYaw": Track((1.0, 3.0), (0.1, 0.2))}).reversed().tracks["HeadYaw"]

    assert (track.times, track.keys) == ((0.0, 2.0), (0.2, 0.1))


def test_repeated_plays_it_again_after_its_end() -> None:
    twice = Keyframes({"HeadYaw": Track((1.0, 3.0), (0.1, 0.2))}).repeated(2)

    assert twice.tracks["HeadYaw"].times == (1.0, 3.0, 4.0, 6.0)
    assert twice.duration_s == 6.0
