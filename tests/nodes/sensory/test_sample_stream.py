"""Readings of one sender become a stream with one clock."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.sensory.reading import Reading
from nodes.sensory.sample_stream import SampleStream

ACC, GYR = (0.0, 0.0, 9.81), (0.1, 0.2, 0.3)


def times(stream, packets):
    return [
        sample.t
        for arrived_s, readings in packets
        for sample in stream.samples(readings, arrived_s)
    ]


@pytest.mark.parametrize("unit", [1, 1e-3, 1e-6, 1e-9])
def test_the_senders_clock_is_followed_in_whatever_unit_it_counts(unit):
    stamps = [(1000 + number * 0.02) / unit for number in range(50)]
    jitter = [0.01 * (number % 3) for number in range(50)]

    found = times(
        SampleStream(),
        [(n * 0.02 + late, [Reading(ACC, stamp=stamp)])
         for n, (stamp, late) in enumerate(zip(stamps, jitter, strict=True))],
    )  # fmt: skip

    steps = [after - before for before, after in itertools.pairwise(found)]
    assert steps == pytest.approx([0.02] * len(steps), rel=1e-3)


def test_our_own_clock_is_used_for_a_sender_without_one():
    packets = [(100 + n * 0.02, [Reading(ACC)]) for n in range(20)]

    assert times(SampleStream(), packets)[1:] == pytest.approx([n * 0.02 for n in range(1, 20)])


def test_lines_that_come_together_without_times_are_spread_over_the_time_before():
    packets = [(n * 0.1, [Reading(ACC)] * 5) for n in range(4)]
    stream = SampleStream()

    found = times(stream, packets)

    assert found[-10:] == pytest.approx([0.1 + 0.02 * (n + 1) for n in range(10)])
    assert stream.flow.rate_hz == pytest.approx(50)


def test_a_rotation_joins_the_accelerations_after_it_while_it_is_fresh():
    stream = SampleStream()

    [before] = stream.samples([Reading(ACC, stamp=1.0)], 0.0)
    [joined] = stream.samples([Reading(None, GYR, 1.01), Reading(ACC, stamp=1.02)], 0.02)
    [late] = stream.samples([Reading(ACC, stamp=2.0)], 1.0)

    assert before.gyr is None
    assert joined.gyr == GYR
    assert late.gyr is None


def test_late_and_repeated_samples_are_left_out():
    stream = SampleStream()

    found = times(stream, [(n * 0.02, [Reading(ACC, stamp=s)]) for n, s in
                           enumerate([1.00, 1.02, 1.02, 1.01, 1.04])])  # fmt: skip

    assert len(found) == 3


def test_a_clock_that_is_started_anew_goes_on_with_the_time_that_passed():
    packets = [(n * 0.02, [Reading(ACC, stamp=500 + n * 0.02)]) for n in range(10)]
    packets += [(2 + n * 0.02, [Reading(ACC, stamp=3 + n * 0.02)]) for n in range(10)]

    found = times(SampleStream(), packets)

    assert len(found) == 20
    assert found[10] - found[9] == pytest.approx(1.82)
    assert all(after > before for before, after in itertools.pairwise(found))


def test_the_rate_is_measured():
    stream = SampleStream()

    assert stream.flow.rate_hz == 0
    times(stream, [(n * 0.03, [Reading(ACC, stamp=n * 0.0201)]) for n in range(100)])
    assert stream.flow.rate_hz == pytest.approx(1 / 0.0201, rel=0.01)


def test_gravity_is_told_by_the_usual_size():
    with_gravity, without = SampleStream(), SampleStream()
    for n in range(20):
        with_gravity.samples([Reading(ACC, stamp=n * 0.02)], n * 0.02)
        without.samples([Reading((0.1, 0.2, 0.1), stamp=n * 0.02)], n * 0.02)

    assert with_gravity.gravity_included
    assert not without.gravity_included


stamps = st.none() | st.floats(allow_nan=False, allow_infinity=False)
readings = st.builds(Reading, st.just(ACC), st.none() | st.just(GYR), stamps)


@given(st.lists(st.tuples(st.floats(0, 10), st.lists(readings, max_size=4)), max_size=30))
def test_whatever_the_senders_clock_does_time_goes_forward(packets):
    now_s, timed = 0.0, []
    for pause_s, lines in packets:
        now_s += pause_s
        timed.append((now_s, lines))

    found = times(SampleStream(), timed)

    assert all(after > before for before, after in itertools.pairwise(found))
