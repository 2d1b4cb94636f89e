"""What the phone page may send, and which of several phones is followed."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.sensory.phone_page.site import (
    MOST_SAMPLES,
    Allowance,
    Receiving,
    Turn,
    read_message,
    readings_of,
)

GOOD = {"id": "a1", "t": [1.0], "acc": [[0.0, 1.0, 9.81]]}


def message(**more):
    return read_message(json.dumps(GOOD | more))


def test_a_batch_without_a_gyroscope_has_readings_without_rotation():
    [reading] = readings_of(message(gravity=False))

    assert reading.acc == (0.0, 1.0, 9.81)
    assert reading.gyr is None
    assert not reading.gravity_included


@pytest.mark.parametrize(
    "change",
    [
        {"gyr": []},
        {"acc": []},
        {"acc": [[1.0, 2.0]]},
        {"acc": [[1.0, 2.0, "x"]]},
        {"acc": [[1.0, 2.0, 1e300]]},
        {"acc": [[1.0, 2.0, math.nan]]},
        {"acc": [[1.0, 2.0, math.inf]]},
        {"t": [None]},
        {"t": 1.0},
        {"hand": "foot"},
        {"id": "x" * 100},
        {"device": "x" * 100},
        {"lost": -1},
        {"t": [1.0] * (MOST_SAMPLES + 1), "acc": [[0.0, 0.0, 0.0]] * (MOST_SAMPLES + 1)},
    ],
)
def test_what_the_page_would_never_send_is_refused(change):
    with pytest.raises(ValueError, match=r"."):
        message(**change)


@pytest.mark.parametrize("text", ["[" * 10_000, "{}", "[]", "1e999", "NaN", b"\xff\xfe"])
def test_what_is_no_message_is_refused(text):
    with pytest.raises(ValueError, match=r"."):
        read_message(text)


@given(st.binary(max_size=200))
def test_no_bytes_make_anything_but_a_value_error(data):
    try:
        read_message(data)
    except ValueError:
        return
    raise AssertionError("a batch out of nothing")


class Clock:
    """A clock that a test sets."""

    now_s = 0.0

    def __call__(self):
        return self.now_s


def test_a_phone_that_is_silent_loses_its_turn_and_one_that_leaves_at_once():
    turn = Turn()

    assert turn.take("a", 0.0)
    assert not turn.take("b", 2.9)
    assert turn.take("b", 3.0)
    assert not turn.take("a", 3.1)
    turn.leave("a")
    assert not turn.take("a", 3.2)
    turn.leave("b")
    assert turn.take("a", 3.3)


def test_a_phone_that_connected_anew_keeps_its_turn_when_its_old_connection_ends():
    given_on, clock = [], Clock()
    receiving = Receiving(given_on.append, clock)
    receiving.take(message(), "1.1.1.1")
    by_the_old_one_s = receiving.followed_s
    clock.now_s = 10.0
    receiving.take(message(), "1.1.1.2")

    receiving.leave(message().id, by_the_old_one_s)

    assert receiving.take(message(id="b2"), "2.2.2.2") == "busy"
    receiving.leave(message().id, receiving.followed_s)
    assert receiving.take(message(id="b2"), "2.2.2.2") == "followed"


def test_an_allowance_fills_again_with_time_and_each_sender_has_its_own():
    allowance = Allowance(rate=10.0, burst=2.0)

    granted = [allowance.grants("a", 0.0) for _ in range(4)]

    assert granted == [True, True, False, False]
    assert allowance.grants("b", 0.0)
    assert allowance.grants("a", 0.1)
    assert not allowance.grants("a", 0.1)


def test_a_million_senders_take_no_memory():
    allowance = Allowance(rate=1.0, burst=1.0)

    for number in range(1000):
        allowance.grants(str(number), 0.0)

    assert len(allowance._left) < 200


def test_a_page_that_rests_does_not_take_the_turn_of_another():
    given_on, clock = [], Clock()
    receiving = Receiving(given_on.append, clock)

    assert receiving.take(message(t=[], acc=[]), "1.1.1.1") == "followed"
    assert receiving.take(message(id="b2"), "2.2.2.2") == "followed"
    assert receiving.take(message(t=[], acc=[]), "1.1.1.1") == "busy"
    assert [arrived.sender for arrived in given_on] == ["2.2.2.2"]


def test_the_user_is_told_of_a_second_phone_now_and_then():
    given_on, clock = [], Clock()
    receiving = Receiving(given_on.append, clock)
    for clock.now_s in (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0):
        receiving.take(message(), "1.1.1.1")
        receiving.take(message(id="b2", device="iPhone"), "2.2.2.2")

    told = [str(arrived.trouble) for arrived in given_on if arrived.trouble]

    assert (
        told
        == [
            "A second phone (iPhone 2.2.2.2) has the page open; 1.1.1.1 is followed.",
        ]
        * 2
    )


def test_more_samples_than_any_phone_has_are_left_out_and_counted():
    given_on, clock = [], Clock()
    receiving = Receiving(given_on.append, clock)
    many = message(t=[1.0] * 500, acc=[[0.0, 0.0, 9.81]] * 500)

    for _ in range(4):
        receiving.take(many, "1.1.1.1")

    assert [len(arrived.readings) for arrived in given_on] == [500, 500, 500, 0]
    assert given_on[-1].dropped == 500
