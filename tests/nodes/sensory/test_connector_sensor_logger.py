"""Sensor Logger pushes by HTTP: phones, watches, and those who only pretend."""

import http.client
import json
import random
import socket
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.sensory.connectors.sensor_logger import read_message, readings_of
from tests.nodes.sensory.connector_hearing import assert_same, opened, turned
from tests.nodes.sensory.senders import SensorLogger, resting


def logger(heard, **about):
    return SensorLogger(f"http://127.0.0.1:{heard.port}/data", **about)


def messages(count=5, **about):
    """Messages of Sensor Logger without sending them."""
    sender = SensorLogger("http://127.0.0.1/", **about)
    batches = sender.play(turned(count * 0.1), 1000, 0.1)
    return [sender.message(number, batch) for number, batch in enumerate(batches)]


@pytest.mark.parametrize("watch", [False, True])
@pytest.mark.parametrize("standardised", [False, True])
def test_what_a_phone_or_watch_pushes_is_its_movement(watch, standardised):
    units = "guess" if watch or standardised else "apple"
    recording = turned()

    with opened("sensor_logger", units=units) as heard:
        with logger(heard, watch=watch, standardised=standardised) as sender:
            sender.send(recording, speed=5)
        heard.until(lambda: len(heard.readings) == 100)

    assert_same(heard.readings, recording)
    assert set(sender.answers) == {200}
    assert heard.columns == ("wrist motion" if watch else "accelerometer + gravity + gyroscope")
    assert all(one.gravity_included for one in heard.readings)


def test_a_second_recording_goes_on_in_time():
    with opened("sensor_logger") as heard, logger(heard) as sender:
        sender.send(turned(0.2), speed=5)
        sender.send(resting(0.2), speed=5)
        heard.until(lambda: len(heard.readings) == 40)

    stamps = [one.stamp for one in heard.readings]
    assert stamps == sorted(set(stamps))
    assert [one.number for one in heard.arrivals] == list(range(len(heard.arrivals)))


def test_messages_that_overtake_each_other_are_put_in_order():
    disorder = [0, 2, 1, 3, 5, 4, 6, 7]

    with opened("sensor_logger") as heard, logger(heard) as sender:
        pushed = messages(8)
        for number in disorder:
            sender.push(pushed[number])
        heard.until(lambda: len(heard.readings) == 80)

    assert_same(heard.readings, turned(0.8))
    assert [one.number for one in heard.arrivals] == list(range(8))


def test_a_message_that_is_lost_holds_the_others_up_only_for_a_moment():
    with opened("sensor_logger") as heard, logger(heard) as sender:
        pushed = messages(8)
        for number in (0, 2, 3, 4, 5, 6, 7):
            sender.push(pushed[number])
        heard.until(lambda: len(heard.readings) == 70)

    assert [one.number for one in heard.arrivals] == [0, 2, 3, 4, 5, 6, 7]


def test_android_sends_its_whole_acceleration():
    [message] = messages(1)
    for one in message["payload"]:
        one["name"] = {"accelerometer": "totalacceleration"}.get(one["name"], one["name"])

    pushed = readings_of(read_message(json.dumps(message).encode()), "guess")

    assert pushed.used == "total acceleration + gyroscope"
    assert pushed.readings[0].acc[2] == pytest.approx(0)


def test_an_iphones_uncalibrated_acceleration_is_in_g_and_turned_round():
    values = {"x": 0.01, "y": -0.5, "z": -0.87}
    payload = [
        {"name": "accelerometeruncalibrated", "time": 10**18 + n * 10**7, "values": values}
        for n in range(10)
    ]

    pushed = readings_of(read_message(json.dumps({"payload": payload}).encode()), "guess")

    assert pushed.readings[0].acc == pytest.approx((-0.098, 4.903, 8.532), abs=0.001)


def test_without_the_sensor_gravity_it_says_so():
    [message] = messages(1)
    message["payload"] = [one for one in message["payload"] if one["name"] == "accelerometer"]

    pushed = readings_of(read_message(json.dumps(message).encode()), "guess")

    assert not pushed.readings[0].gravity_included
    assert pushed.readings[0].gyr is None


def test_two_phones_at_one_address_are_told_apart():
    with opened("sensor_logger") as heard:
        for device in ("aaaa1111", "bbbb2222", "aaaa1111"):
            with logger(heard, device=device) as sender:
                sender.push(messages(1, device=device)[0])
        heard.until(lambda: len(heard.arrivals) == 3)

    assert [one.sender for one in heard.arrivals] == [
        "127.0.0.1",
        "127.0.0.1 (bbbb22)",
        "127.0.0.1",
    ]


def test_a_phone_beside_a_watch_is_left_aside():
    with opened("sensor_logger") as heard, logger(heard) as sender:
        of_watch, of_phone = messages(4, watch=True), messages(4)
        for number in range(4):
            payload = of_phone[number]["payload"]
            if number != 2:  # the watch sends now and then
                payload = payload + of_watch[number]["payload"]
            sender.push(of_watch[number] | {"payload": payload})
        heard.until(lambda: len(heard.arrivals) == 4)

    assert [bool(one.readings) for one in heard.arrivals] == [True, True, False, True]
    assert heard.troubles == ""


def test_the_buttons_test_message_and_a_browser_are_answered():
    with opened("sensor_logger") as heard, logger(heard) as sender:
        answer = sender.push({"messageId": 0, "sessionId": "", "deviceId": "x", "payload": []})
        browser = http.client.HTTPConnection("127.0.0.1", heard.port)
        browser.request("GET", "/anything")
        response = browser.getresponse()

        assert answer == 200
        assert response.status == 200
        assert b"push URL" in response.read()
        browser.close()


def test_a_phone_that_sends_other_sensors_is_told_which_to_switch_on():
    payload = [{"name": "barometer", "time": 1, "values": {"pressure": 1000}}]

    with opened("sensor_logger") as heard, logger(heard) as sender:
        sender.push({"messageId": 0, "payload": payload})
        heard.until(lambda: "only barometer" in heard.troubles)

    assert "Switch on Accelerometer" in heard.troubles


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b"", 400), (b"hello", 400), (b"[]", 400), (b"{}", 400), (b'{"payload": 5}', 400),
        (b"{" * 100_000, 400), (b'{"payload": [1]}', 400), (b"\xff\x00", 400),
        (b'{"payload": [{"name": "\xff"}]}', 400), (b'{"payload": [' + b"1" * 5_000 + b"]}", 400),
        (b'{"other":' + b"[" * 50_000, 400),
        (b'{"payload":' + b"[" * 50_000, 400), (b'{"payload":[' + b"{}," * 5_000 + b"{}]}", 400),
        (b"x" * 3_000_000, 413), (b'{"payload":[{}]}', 200),
    ],
)  # fmt: skip
def test_wrong_bodies_are_refused_with_a_sentence(body, status):
    with opened("sensor_logger") as heard, logger(heard) as sender:
        answered = sender.push(body)
        heard.until(lambda: heard.arrivals)

    assert answered == status
    assert heard.readings == []
    assert ("pushes" in heard.troubles) == (status != 200)


@pytest.mark.parametrize("value", ["NaN", "1e999", '"x"', "null", "true"])
def test_values_that_are_not_numbers_are_left_out_and_told(value):
    good = '{"name":"totalacceleration","time":2,"values":{"x":0,"y":0,"z":9.8}}'
    bad = good.replace("9.8", value)

    with opened("sensor_logger") as heard, logger(heard) as sender:
        answer = sender.push(f'{{"payload":[{bad},{good}]}}'.encode())
        heard.until(lambda: heard.arrivals)

    # NaN and 1e999 are no JSON at all
    assert answer == (400 if value in ("NaN", "1e999") else 200)
    assert [one.acc for one in heard.readings] == ([] if answer == 400 else [(0, 0, 9.8)])
    assert heard.troubles


def test_slow_connections_make_room_for_new_ones():
    with opened("sensor_logger") as heard:
        slow = []
        for _ in range(60):
            client = socket.create_connection(("127.0.0.1", heard.port))
            client.sendall(b"POST / HTTP/1.1\r\nContent-Length: 1000\r\n")
            slow.append(client)
        with logger(heard) as sender:
            sender.push(messages(1)[0])
            heard.until(lambda: heard.readings)
        for client in slow:
            client.close()

    assert sender.answers == [200]


def test_a_connection_that_ends_in_the_middle_of_a_body_is_forgotten():
    with opened("sensor_logger") as heard:
        with socket.create_connection(("127.0.0.1", heard.port)) as client:
            client.sendall(b"POST / HTTP/1.1\r\nContent-Length: 1000\r\n\r\n{")
        with logger(heard) as sender:
            sender.push(messages(1)[0])
            heard.until(lambda: heard.readings)


def test_a_flood_of_messages_keeps_memory_bounded():
    with opened("sensor_logger") as heard, logger(heard) as sender:
        [message] = messages(1)
        end_s = time.monotonic() + 0.4
        count = 0
        while time.monotonic() < end_s:  # and nobody takes them
            count += 1
            sender.push(message | {"messageId": count, "deviceId": str(random.random())})

        assert len(heard.connector._devices) <= 16
        assert len(heard.connector._arrived) <= 256


parts = st.dictionaries(
    st.sampled_from(["name", "time", "values", "x"]),
    st.sampled_from(["accelerometer", "wrist motion", "gravity", 5, -1e300, None, [1], {"x": 1}])
    | st.dictionaries(st.sampled_from(["x", "y", "z", "gravityX"]), st.floats() | st.text()),
)


@given(st.lists(parts, max_size=5), st.sampled_from(["guess", "apple", "standard"]))
def test_no_payload_crashes_the_reader(payload, units):
    message = read_message(json.dumps({"payload": payload}).encode())

    assert message is None or isinstance(readings_of(message, units).readings, list)
