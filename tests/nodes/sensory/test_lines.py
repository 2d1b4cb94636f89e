"""Lines of apps that say what they are become readings, and no line is a danger."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.sensory.line_reader import LineReader
from nodes.sensory.reading import Reading

ACC, GYR = (0.5, -1.0, 9.8), (0.1, 0.2, -0.3)


def read(*lines, now_s=0.0, reader=None):
    return (reader or LineReader()).read([line.encode() for line in lines], now_s)


@pytest.mark.parametrize(
    ("line", "readings"),
    [
        ("a;20140000;0.5;-1;9.8", [Reading(ACC, None, 20140000, 1e-9)]),
        ("y;20140000;0.1;0.2;-0.3", [Reading(None, GYR, 20140000, 1e-9)]),
        (
            '{"type":"android.sensor.accelerometer","timestamp":5000,"values":[0.5,-1,9.8]}',
            [Reading(ACC, None, 5000, 1e-9)],
        ),
        (
            '{"type":"android.sensor.gyroscope","timestamp":5000,"values":[0.1,0.2,-0.3]}',
            [Reading(None, GYR, 5000, 1e-9)],
        ),
        ('{"type":"android.sensor.light","timestamp":5000,"values":[12]}', []),
        ('{"type":"android.gps","longitude":5.0,"latitude":1.0,"time":7}', []),
        (
            '{"op":"hyperimu","Timestamp":15,"Accelerometer":[0.5,-1,9.8],"Gyroscope":[0.1,0.2,-0.3]}',
            [Reading(ACC, GYR, 15, 1e-3)],
        ),
        (
            '{"accelerometer":{"value":[0.5,-1,9.8],"timestamp":7},'
            '"gyroscope":{"value":[0.1,0.2,-0.3],"timestamp":8}}',
            [Reading(ACC, None, 7, 1e-9), Reading(None, GYR, 8, 1e-9)],
        ),
        (
            '{"accelerometer":{"x":0.5,"y":-1,"z":9.8,"timestamp":7},'
            '"gyroscope":{"x":0.1,"y":0.2,"z":-0.3,"timestamp":8}}',
            [Reading(ACC, None, 7, 1e-9), Reading(None, GYR, 8, 1e-9)],
        ),
    ],
)
def test_a_line_of_each_kind(line, readings):
    found = read(line)

    assert found.readings == readings
    assert found.fault is None


def test_zig_sim_counts_in_g_towards_the_earth():
    line = json.dumps(
        {
            "device": {"os": "ios"},
            "timestamp": "2018_02_17_12:00:00.000",
            "sensordata": {
                "accel": {"x": 0, "y": 0.5, "z": 0},
                "gravity": {"x": 0, "y": 0, "z": -1},
                "gyro": {"x": 0.1, "y": 0.2, "z": -0.3},
            },
        }
    )

    [reading] = read(line).readings

    assert reading.acc == pytest.approx((0, -4.903, 9.807), abs=0.001)
    assert reading.gyr == GYR
    assert reading.gravity_included


def test_zig_sim_without_gravity_says_so():
    [reading] = read('{"sensordata": {"accel": {"x": 0, "y": 0, "z": 0}}}').readings

    assert not reading.gravity_included


@pytest.mark.parametrize(
    "line",
    [
        "hello", "1", "1,2", "1,2,x", "1,2,nan", "1,2,inf", "1e400,2,3",
        "a;1;2;3", "a;x;1;2;3", "{", "{}", "[1,2,3]", '{"acc": [1, 2]}', '{"acc": [1, 2, "x"]}',
        '{"acc": [1, 2, true]}', '{"acc": [1, 2, null]}', '{"sensordata": 5}',
        '{"sensordata": {}}', '{"type": "android.sensor.gyroscope", "values": 3}',
        '{"acc": {"value": [1]}}', "{" * 9000, '{"acc":' * 1000, "1" * 9000,
    ],
)  # fmt: skip
def test_what_is_no_reading_is_refused(line):
    found = read(line)

    assert found.readings == []
    assert found.fault is not None


def test_a_packet_may_hold_many_lines_and_tells_the_first_that_is_wrong():
    found = read("a;1;1;2;3", "", "what\r", "a;2;4;5;6", "again")

    assert [reading.acc for reading in found.readings] == [(1, 2, 3), (4, 5, 6)]
    assert (
        str(found.fault.sentence("a watch")) == 'a watch sends a line that cannot be read: "what"'
    )


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("POST /data HTTP/1.1", "speaks HTTP"),
        ("1,2,nan", "not numbers"),
        ("inf;1;2;3", "not numbers"),
        ("\x16\x03\x01\x02", "encrypted"),
        ("hello\x07you", "cannot be read"),
    ],
)
def test_what_is_wrong_with_a_line_is_told_in_a_sentence(line, words):
    told = str(read(line).fault.sentence("192.168.1.7"))

    assert words in told
    assert told.isprintable()


@pytest.mark.parametrize("sign", [" ", ",", ";", "\t", "a", "(", "1,", "{", "[", "x:", "=", "-"])
@pytest.mark.timeout(30)  # a pattern that goes back and tries again would need hours
def test_no_line_takes_long_to_read(sign):
    line = ("a" + sign * 9000)[:8190] + "b"

    said = LineReader().read([line.encode()] * 20, 0.0)

    assert said is not None


@given(st.lists(st.binary(max_size=300), max_size=30))
def test_no_bytes_crash_the_reader(lines):
    found = LineReader().read(lines, 0.0)

    assert all(reading.acc or reading.gyr for reading in found.readings)
    assert found.fault is None or str(found.fault.sentence("somebody"))


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["x", "y", "z", "value", "timestamp", "acc"]), inner)
    ),
    max_leaves=8,
)
names = st.sampled_from(
    ["t", "acc", "gyr", "type", "values", "timestamp", "sensordata", "device", "Accelerometer"]
)


@given(st.dictionaries(names, values, max_size=5))
def test_no_json_crashes_the_reader(message):
    for reading in read(*[json.dumps(message)] * 25).readings:
        assert reading.acc is None or max(map(abs, reading.acc)) <= 1e5 * 9.81 * 2
