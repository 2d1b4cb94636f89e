"""The columns of lines are known by their names, or guessed from their numbers."""

import json
import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nep_core.errors import ParameterError
from nodes.sensory.line_reader import LineReader, named_columns, own_columns

G = 9.80665
RATE_HZ = 50


def movement(seconds=4.0, turn_rad_s=1.5):
    """A phone that is turned to and fro: t in s, acceleration in m/s² and rotation in rad/s."""
    noise = random.Random(1)
    for number in range(int(seconds * RATE_HZ)):
        t = number / RATE_HZ
        tilt = turn_rad_s * (1 - math.cos(2 * t)) / 2
        acc = [noise.gauss(0, 0.05), G * math.sin(tilt), G * math.cos(tilt)]
        yield t, acc, [turn_rad_s * math.sin(2 * t), noise.gauss(0, 0.01), noise.gauss(0, 0.01)]


def heard(lines, columns="", step_s=1 / RATE_HZ):
    """The readings of lines that arrive one after the other, and the reader."""
    reader, readings = LineReader(columns), []
    for number, line in enumerate(lines):
        readings += reader.read([line.encode()], 100 + number * step_s).readings
    return readings, reader


def csv(*values):
    return ",".join(f"{value:.9g}" if value < 1e8 else str(int(value)) for value in values)


@pytest.mark.parametrize(
    ("name", "unit_s"), [("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("us", 1e-6), ("ns", 1e-9)]
)
def test_the_unit_of_time_is_told_by_when_the_lines_arrive(name, unit_s):
    lines = [csv((1000 + t) / unit_s, *acc) for t, acc, _ in movement()]

    readings, reader = heard(lines)

    assert readings[-1].stamp_unit_s == unit_s
    assert reader.columns.startswith("t (" + ("us" if name == "µs" else name))
    assert len(readings) == len(lines)


@pytest.mark.parametrize(("unit", "size"), [("m/s²", 1.0), ("g", G), ("mg", G / 1000)])
def test_the_unit_of_acceleration_is_told_by_gravity(unit, size):
    lines = [csv(t, *(one / size for one in acc)) for t, acc, _ in movement()]

    readings, reader = heard(lines)

    assert reader.columns == f"t (s), ax, ay, az ({unit})"
    assert math.hypot(*readings[0].acc) == pytest.approx(G, rel=0.02)
    assert readings[0].gravity_included


@pytest.mark.parametrize("turn_rad_s", [0.4, 1.5])
@pytest.mark.parametrize(("unit", "size"), [("rad/s", 1.0), ("°/s", math.pi / 180)])
def test_the_unit_of_rotation_is_told_by_how_gravity_turns(unit, size, turn_rad_s):
    lines = [
        csv(t, *acc, *(one / size for one in gyr))
        for t, acc, gyr in movement(turn_rad_s=turn_rad_s)
    ]

    readings, reader = heard(lines)

    assert reader.columns == f"t (s), ax, ay, az (m/s²), gx, gy, gz ({unit})"
    assert max(reading.gyr[0] for reading in readings[-100:]) == pytest.approx(turn_rad_s, rel=0.02)


def test_a_magnetometer_and_other_columns_are_left_out():
    lines = [csv(7, t * 1000, *acc, 20, 30, 40.5, *gyr, 99) for t, acc, gyr in movement()]

    _, reader = heard(lines)

    assert reader.columns == "-, t (ms), ax, ay, az (m/s²), -, -, -, gx, gy, gz (rad/s), -"


def test_a_rotation_before_the_acceleration_is_found():
    lines = [csv(t, *gyr, *acc) for t, acc, gyr in movement()]

    _, reader = heard(lines)

    assert reader.columns == "t (s), gx, gy, gz (rad/s), ax, ay, az (m/s²)"


def test_a_column_that_counts_is_no_time():
    lines = [csv(number, *acc) for number, (_, acc, _) in enumerate(movement())]

    readings, reader = heard(lines)

    assert reader.columns == "-, ax, ay, az (m/s²)"
    assert readings[-1].stamp is None


def test_lines_without_time_lose_only_those_before_the_guess():
    lines = [csv(*acc) for _, acc, _ in movement()]

    readings, _ = heard(lines)

    assert len(readings) == len(lines) - 19


def test_acceleration_without_gravity_says_so():
    lines = [csv(t, 0.1, 0.02, -0.1) for t, *_ in movement()]

    readings, _ = heard(lines)

    assert not readings[-1].gravity_included


def test_a_slow_sender_is_guessed_after_a_second():
    lines = [csv(t * RATE_HZ * 0.4, *acc) for t, acc, _ in movement()][:8]

    readings, _ = heard(lines, step_s=0.4)

    assert len(readings) == 8


def test_a_fast_turn_that_comes_later_corrects_the_unit():
    still = [csv(t, 0, 0, G, 0.5, 0.1, -0.2) for t, *_ in movement()]
    fast = [csv(4 + t, 0, 0, G, 200, 0, 0) for t, *_ in movement()] * 2

    readings, reader = heard([*still, *fast])

    assert reader.columns.endswith("(°/s)")
    assert readings[-1].gyr[0] == pytest.approx(math.radians(200))


def test_a_header_names_the_columns():
    header = "time_ms;gyro_z (deg/s);gyro_y;gyro_x;label;acc_x [g];acc_y;acc_z"
    lines = [csv(t * 1000, 3, 2, 1, 0, 0, 0, 1).replace(",", ";") for t, *_ in movement()]

    readings, reader = heard([header, *lines])

    assert reader.columns == "t (ms), gz (°/s), gy, gx, -, ax, ay, az (g)"
    assert readings[0].acc == pytest.approx((0, 0, G))
    assert readings[0].gyr == pytest.approx([math.radians(one) for one in (1, 2, 3)])


def test_commas_are_points_between_semicolons():
    lines = [csv(t, *acc).replace(",", ";").replace(".", ",") for t, acc, _ in movement()]

    readings, reader = heard(lines)

    assert reader.columns == "t (s), ax, ay, az (m/s²)"
    assert math.hypot(*readings[9].acc) == pytest.approx(G, rel=0.02)


@pytest.mark.parametrize("between", [":", "=", " : "])
def test_names_may_stand_before_the_numbers(between):
    lines = [
        ", ".join(f"{name}{between}{value:.5f}" for name, value in zip("xyz", acc, strict=True))
        for _, acc, _ in movement()
    ]

    _, reader = heard(lines)

    assert reader.columns == "ax, ay, az (m/s²)"


def test_a_persons_own_columns_are_taken_whatever_the_numbers_say():
    lines = [csv(t, *acc) for t, acc, _ in movement()]

    readings, reader = heard(lines, columns="-,ay(g),az,ax")

    assert reader.columns == "-, ay, az (g), ax"
    assert readings[-1].acc[1] == pytest.approx(0, abs=3)
    assert readings[-1].stamp is None


@pytest.mark.parametrize("columns", ["hello", "t,ax,ay", "gx,gy,gz", ",,,"])
def test_columns_without_an_acceleration_are_refused(columns):
    with pytest.raises(ParameterError, match="names no acceleration") as told:
        own_columns(columns)

    assert told.value.checklist


@pytest.mark.parametrize(
    "message",
    [
        lambda t, acc, gyr: {"t": t, "acc": acc, "gyr": gyr},
        lambda t, acc, gyr: {"timestamp": t, "accel": dict(zip("xyz", acc, strict=True)),
                             "rotationRate": dict(zip("xyz", gyr, strict=True)), "battery": 3},
        lambda t, acc, gyr: dict(zip(["ts", "ax", "ay", "az", "gx", "gy", "gz"],
                                     [t, *acc, *gyr], strict=True)),
    ],
)  # fmt: skip
def test_json_is_read_by_its_names(message):
    lines = [json.dumps(message(t, acc, gyr)) for t, acc, gyr in movement()]

    readings, reader = heard(lines)

    assert reader.columns == "t (s), ax, ay, az (m/s²), gx, gy, gz (rad/s)"
    assert len(readings) == len(lines)


@pytest.mark.parametrize(
    ("names", "roles"),
    [
        ("t,ax,ay,az", "t ax ay az"),
        ("Timestamp , Accelerometer.x , Accelerometer.y , Accelerometer.z", "t ax ay az"),
        ("time,seconds_elapsed,z,y,x", "t - az ay ax"),
        ("AccX,AccY,AccZ,GyroX,GyroY,GyroZ,MagX", "ax ay az gx gy gz -"),
        ("ax,ay,temperature", None),
        ("hello,world", None),
    ],
)
def test_names_of_columns(names, roles):
    layout = named_columns(names.split(","))

    assert (layout and " ".join(layout.roles)) == roles


numbers = st.floats(allow_nan=False, allow_infinity=False, width=32)


@settings(max_examples=30)
@given(st.lists(st.lists(numbers, min_size=3, max_size=3), min_size=30, max_size=40),
       st.integers(0, 8), st.floats(0, 1))  # fmt: skip
def test_no_numbers_crash_the_guess(rows, more, step_s):
    lines = [csv(*row, *range(more)) for row in rows]

    readings, reader = heard(lines, step_s=step_s)

    assert isinstance(reader.columns, str)
    assert all(max(map(abs, reading.acc or (0,))) <= 1e5 for reading in readings)


def test_a_sender_that_mixes_all_kinds_of_lines_takes_no_more_memory():
    reader = LineReader()
    for width in range(3, 60):
        for _ in range(30):
            reader.read([csv(*range(1, width + 1)).encode()], 0.0)

    assert len(reader._forms) <= 4


@pytest.mark.parametrize("gyroscope", ["", ',"gx":0.1,"gy":0.2,"gz":{at}'])
def test_a_clock_of_whole_seconds_does_not_take_the_samples_between_them_away(gyroscope):
    form = '{{"time":{second},"ax":0.{at:03d},"ay":0.2,"az":9.8' + gyroscope + "}}"
    lines = [form.format(second=1_732_000_000 + at // RATE_HZ, at=at) for at in range(200)]

    readings, reader = heard(lines)

    assert len(readings) > 150
    assert {one.stamp for one in readings} == {None}
    assert reader.columns.startswith("-, ax")
