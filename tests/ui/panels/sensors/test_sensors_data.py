"""What the plots are made of: rings, clocks, gaps, columns, fields, measures."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.wire.messages import Imu, RobotState
from nep_studio.ui.plugins.sensors.curves import ValueRange
from nep_studio.ui.plugins.sensors.curves_view import LiveColumns, columns_of
from nep_studio.ui.plugins.sensors.feed import FieldStream, number_at, numbers_in, parts_of
from nep_studio.ui.plugins.sensors.measuring import TimeView, fitting_length, measure
from nep_studio.ui.plugins.sensors.streams import Channel, ClockMap, ImuStream, Stream, StreamKey
from nep_studio.ui.ring import Ring

KEY = StreamKey("/imu", "watch")


def imu(t: np.ndarray, rate_hz: float = 50.0, **more: object) -> Imu:
    rows = [(float(x), 0.0, 9.8) for x in t]
    return Imu(source="watch", rate_hz=rate_hz, t=t.tolist(), acc=rows, gyr=rows, **more)


@given(
    st.integers(1, 20),
    st.lists(st.lists(st.floats(-1e6, 1e6), max_size=50), max_size=12),
)
def test_a_ring_gives_the_newest_samples_in_one_piece(
    capacity: int, batches: list[list[float]]
) -> None:
    ring = Ring(2, capacity)
    given_all: list[float] = []

    for batch in batches:
        ring.append(np.array([batch, batch]).reshape(2, -1))
        given_all += batch

    kept = given_all[-capacity:]
    assert ring.newest()[0].tolist() == kept
    assert ring.newest(3)[1].tolist() == kept[-3:]
    assert ring.total == len(given_all)


@given(st.integers(1, 8), st.integers(1, 20))
def test_the_newest_sample_of_a_ring_can_be_replaced(capacity: int, count: int) -> None:
    ring = Ring(1, capacity)
    ring.append(np.arange(count, dtype=float)[None])

    ring.replace_last(np.array([-1.0]))

    assert ring.newest()[0].tolist() == [*[*range(count)][-capacity:-1], -1.0]


def test_the_memory_of_a_stream_does_not_grow() -> None:
    stream = ImuStream(KEY, capacity=1000)
    size_bytes = stream.size_bytes

    for second in range(100):
        stream.hear(imu(second + np.arange(50) / 50), 1000.0 + second)

    assert stream.size_bytes == size_bytes
    assert len(stream.samples().t) == 1000


def test_times_of_a_steady_sensor_keep_their_steps_though_batches_come_unevenly() -> None:
    clock = ClockMap()
    uneven = np.random.default_rng(1).uniform(0, 0.02, 200)

    times = [
        clock.to_wall(at * 0.03 + np.array([0.01, 0.02, 0.03]), 500.0 + at * 0.03 + uneven[at])[0]
        for at in range(200)
    ]

    steps = np.diff(np.concatenate(times))
    assert steps == pytest.approx(0.01, rel=0.1)


@given(st.lists(st.tuples(st.floats(-5, 5), st.floats(0, 2)), min_size=1, max_size=40))
def test_times_on_the_wall_always_rise(steps: list[tuple[float, float]]) -> None:
    clock, t, arrived_s, last_s = ClockMap(), 0.0, 1000.0, -math.inf

    for forward, waited in steps:
        t, arrived_s = t + forward, arrived_s + waited
        times, _ = clock.to_wall(np.array([t, t + 0.01]), arrived_s)

        assert last_s < times[0] < times[1]
        last_s = times[1]


@pytest.mark.parametrize("speed", [0.25, 2.0, 5.0])
def test_a_recording_played_at_another_speed_stays_at_now(speed: float) -> None:
    clock = ClockMap()

    for at in range(200):
        arrived_s = 1000.0 + 0.03 * at
        t = speed * 0.03 * at
        times, _ = clock.to_wall(t + speed * np.array([0.01, 0.02, 0.03]), arrived_s)

    assert times[-1] == pytest.approx(arrived_s, abs=0.1)


def test_lost_samples_are_a_gap_and_counted() -> None:
    stream = ImuStream(KEY)

    stream.hear(imu(np.arange(50) / 50), 1000.0)
    stream.hear(imu(1.2 + np.arange(50) / 50), 1001.2)

    values = stream.samples().values[0]
    assert np.isnan(values).sum() == 1
    assert np.isnan(values[50])
    assert stream.lost == 10


def test_a_clock_that_is_set_back_starts_anew_after_a_gap() -> None:
    stream = ImuStream(KEY)

    stream.hear(imu(500 + np.arange(50) / 50), 1000.0)
    stream.hear(imu(np.arange(50) / 50), 1001.0)

    samples = stream.samples()
    assert (np.diff(samples.t) > 0).all()
    assert np.isnan(samples.values[0]).sum() == 1
    assert samples.t[-1] == pytest.approx(1001.0, abs=0.1)


def test_a_steady_sensor_has_no_gaps_at_any_rate() -> None:
    for rate_hz in (20.0, 50.0, 1000.0):
        stream = ImuStream(KEY)
        t = np.arange(300) / rate_hz
        for first in range(0, 300, 7):
            part = t[first : first + 7]
            stream.hear(imu(part, rate_hz=50.0), 1000.0 + float(part[-1]))

        assert not np.isnan(stream.samples().values[0]).any()
        assert stream.lost == 0


def test_a_batch_whose_rows_do_not_fit_is_left_out() -> None:
    stream = ImuStream(KEY)

    stream.hear(Imu(source="watch", rate_hz=50, t=[0.0, 0.02], acc=[(1.0, 2.0, 3.0)]), 1000.0)
    stream.hear(Imu(source="watch", rate_hz=50, t=[], acc=[]), 1000.0)

    assert stream.total == 0


def test_magnitude_is_the_length_of_the_vector() -> None:
    stream = ImuStream(KEY)

    stream.hear(Imu(source="watch", rate_hz=50, t=[0.0], acc=[(3.0, 4.0, 12.0)]), 1000.0)

    assert stream.samples().values[3].tolist() == [13.0]
    assert np.isnan(stream.samples().values[7]).all()
    assert not stream.has_rotation


@given(st.lists(st.integers(1, 40), max_size=30), st.floats(0.005, 0.3))
def test_live_columns_are_those_of_all_samples(counts: list[int], width_s: float) -> None:
    stream = Stream(KEY, (Channel("x", "", "x"),), 5000)
    live = LiveColumns(stream, width_s, 5000)
    noise = np.random.default_rng(3)
    t = 1000.0

    for count in counts:
        times = t + np.cumsum(noise.uniform(0.001, 0.05, count))
        stream.add(times, noise.normal(size=(1, count)), is_after_gap=count > 35)
        t = float(times[-1])
        live.refresh()

    whole = columns_of(stream.samples(), width_s)
    np.testing.assert_array_equal(live.columns().number, whole.number)
    np.testing.assert_array_equal(live.columns().low, whole.low)
    np.testing.assert_array_equal(live.columns().high, whole.high)


def test_columns_keep_the_one_sample_that_stands_out() -> None:
    stream = Stream(KEY, (Channel("x", "", "x"),), 40_000)
    values = np.zeros((1, 30_000))
    values[0, 12_345] = 7.0
    stream.add(1000 + np.arange(30_000) / 1000, values)

    columns = columns_of(stream.samples(), 0.03)

    assert len(columns.number) <= 1002
    assert columns.high.max() == 7.0


def test_numbers_of_a_message_have_paths() -> None:
    state = RobotState(
        robot="nao", joints={"HeadYaw": 0.5}, sensors={"sonar_left": 1.2}, moving=True, time=5.0
    )

    numbers = numbers_in(state)

    assert numbers["joints.HeadYaw"] == 0.5
    assert numbers["sensors.sonar_left"] == 1.2
    assert numbers["moving"] == 1.0
    assert "time" not in numbers


@pytest.mark.parametrize(
    ("message", "path", "number"),
    [
        ({"a": {"b": 2}}, "a.b", 2.0),
        ({"a": [1, 5]}, "a.1", 5.0),
        ({"a.b": 3}, "a.b", 3.0),
        ({"a": "text"}, "a", None),
        ({"a": 10**400}, "a", None),
        (7, "value", 7.0),
        (b"\0", "a", None),
    ],
)
def test_a_number_is_found_by_its_path(message: object, path: str, number: float | None) -> None:
    assert number_at(message, path) == number


def test_a_list_of_numbers_is_taken_apart() -> None:
    assert parts_of({"sees": {"face": [1, 2, 3]}}, "sees.face") == [
        f"sees.face.{number}" for number in range(3)
    ]
    assert parts_of({"a": 1}, "a") == []


def test_a_field_that_falls_silent_has_a_gap() -> None:
    stream = FieldStream(StreamKey("/a", "node", "b"))

    for time_s in (1.0, 1.1, 1.2, 9.0, 9.1):
        stream.hear({"b": time_s}, time_s)

    assert np.isnan(stream.samples().values[0]).tolist() == [False] * 3 + [True] + [False] * 2


@given(st.floats(0.5, 8.0), st.floats(0.1, 20.0), st.floats(-50, 50))
def test_the_frequency_of_a_wave_is_measured(hz: float, height: float, middle: float) -> None:
    t = 1000 + np.arange(2000) / 200
    noise = np.random.default_rng(2).normal(0, height * 0.05, len(t))
    values = middle + height * np.sin(2 * math.pi * hz * t) + noise

    measured = measure(t, values, 1000.0, 1010.0)

    assert measured.frequency_hz == pytest.approx(hz, rel=0.03)


def test_values_between_two_times_are_measured() -> None:
    t = np.array([0.0, 1.0, 2.0, 3.0])
    values = np.array([0.0, 4.0, np.nan, 6.0])

    measured = measure(t, values, 0.5, 3.0)

    assert (measured.first, measured.last, measured.change) == (2.0, 6.0, 4.0)
    assert (measured.least, measured.greatest, measured.mean) == (4.0, 6.0, 5.0)
    assert measured.frequency_hz is None


@given(st.floats(-1e6, 1e6), st.floats(0, 1e6))
def test_a_range_shows_all_values_and_holds_still(low: float, height: float) -> None:
    fitted = ValueRange().fitted(low, low + height)

    assert fitted.low <= low <= low + height <= fitted.high
    assert fitted.fitted(low, low + height) is fitted


def test_a_zoom_keeps_the_time_under_the_pointer() -> None:
    view = TimeView(10.0, end_s=100.0)

    zoomed = view.zoomed(0.5, share=0.25)

    assert zoomed.length_s == 5.0
    assert zoomed.start(0) + 0.25 * 5.0 == pytest.approx(view.start(0) + 0.25 * 10.0)


@given(st.floats(0.1, 5000))
def test_a_fitting_length_shows_all_in_few_steps(seconds: float) -> None:
    length_s = fitting_length(seconds)

    assert length_s >= min(seconds, 4000.0)
    assert length_s <= max(5.0, 2 * seconds)
