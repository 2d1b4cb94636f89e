"""A sensor's samples come out at an even rate, whatever its clock does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.perceptual.recognition.streams import MAX_GAP_S, EvenStream, Memory

ramps = st.lists(st.floats(0.001, MAX_GAP_S * 0.99), min_size=2, max_size=60)


def rows_of(stretches):
    found = list(stretches)
    assert all(found), "no empty stretch"
    return np.concatenate([one.t for one in found]), np.vstack([one.values for one in found])


@given(steps_s=ramps, start_s=st.floats(-1e6, 1e6), slope=st.floats(-10, 10))
def test_a_straight_line_stays_a_straight_line_at_any_rate(steps_s, start_s, slope):
    t = start_s + np.cumsum(steps_s)
    values = slope * (t - t[0])[:, None] * [1, 2, -1]

    even_s, rows = rows_of(EvenStream(50).push(t, values))

    assert np.allclose(np.diff(even_s), 0.02, atol=1e-6)
    assert even_s[0] == t[0]
    assert t[-1] - 0.0201 <= even_s[-1] <= t[-1] + 1e-6
    assert np.allclose(rows, slope * (even_s - t[0])[:, None] * [1, 2, -1], atol=1e-4)


@given(steps_s=ramps, cuts=st.lists(st.integers(0, 60), max_size=6))
def test_it_does_not_matter_how_the_samples_are_batched(steps_s, cuts):
    t = np.cumsum(steps_s)
    values = np.sin(np.outer(t, [1, 2, 3, 4, 5, 6]))
    whole_t, whole = rows_of(EvenStream().push(t, values))
    stream, parts = EvenStream(), []

    for part in np.split(np.arange(len(t)), sorted(cuts)):
        parts += list(stream.push(t[part], values[part])) if len(part) else []

    t, values = rows_of(parts)
    assert np.allclose(t, whole_t)
    assert np.allclose(values, whole)
    assert [part.follows for part in parts] == [False] + [True] * (len(parts) - 1)


@given(
    st.lists(
        st.tuples(st.floats(allow_nan=True), st.floats(allow_nan=True)), min_size=1, max_size=40
    )
)
def test_any_numbers_give_finite_samples_at_rising_times(samples):
    stream = EvenStream()
    for t, value in samples:
        for stretch in stream.push(t, [value, 0.0, value]):
            assert np.isfinite(stretch.values).all()
            assert (np.diff(stretch.t) > 0).all()
            assert len(stretch.t) <= MAX_GAP_S * 50 + 1


def test_a_gap_and_a_clock_set_back_begin_a_new_stretch():
    t = [0.0, 0.1, 0.2, 5.0, 5.1, 2.0, 2.1]

    stretches = list(EvenStream().push(t, np.zeros((7, 3))))

    assert [(one.t[0], one.follows) for one in stretches] == [
        (0.0, False),
        (5.0, False),
        (2.0, False),
    ]


def test_samples_that_come_twice_or_late_are_left_out():
    t = [0.0, 0.1, 0.1, 0.05, 0.2]
    values = np.array([[0.0], [1.0], [50.0], [70.0], [2.0]]) * np.ones(3)

    even_s, rows = rows_of(EvenStream().push(t, values))

    assert np.allclose(rows[:, 0], even_s * 10)


def test_values_that_no_sensor_can_measure_are_limited():
    _, rows = rows_of(EvenStream().push([0.0], [[1e300, -1e300, 5.0, 1e300, 0.0, 0.0]]))

    assert rows[0].tolist() == [320.0, -320.0, 5.0, 80.0, 0.0, 0.0]


@pytest.mark.parametrize("count", [0, 1, 7, 8, 9, 31, 32, 33, 100])
def test_memory_keeps_the_last_samples_in_order(count):
    memory = Memory(8)

    for number in range(count):
        memory.add(np.array([number, -number]))

    expected = list(range(count))[-8:]
    assert len(memory) == len(expected)
    assert not expected or memory.samples()[:, 0].tolist() == expected
