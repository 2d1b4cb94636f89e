"""Schedules of gestures."""

import pytest

from nep_core.errors import ParameterError
from nodes.sensory.virtual_watch import PAUSE_S, Schedule, read_schedule


def names(text):
    return [(planned.gesture.name, planned.at_s) for planned in read_schedule(text)]


def made(schedule, seconds, gesture_lasts_s=2.0):
    """What a person who follows the schedule begins, and when (tenths of a second)."""
    begun, busy_until_s = [], 0.0
    for tenth in range(int(seconds * 10)):
        now_s = tenth / 10
        gesture = schedule.due(now_s, is_busy=now_s < busy_until_s)
        if gesture:
            begun.append((now_s, gesture.name))
            busy_until_s = max(busy_until_s, now_s) + gesture_lasts_s
    return begun


def test_gestures_with_and_without_seconds():
    assert names("3 karate, 8.5 hand_up") == [("karate", 3.0), ("hand_up", 8.5)]
    assert names(" karate,hand_up ,") == [("karate", None), ("hand_up", None)]
    assert names("") == []


@pytest.mark.parametrize("text", ["karate hand_up", "x karate", "3 4 karate", "-1 karate",
                                  "nan karate", "1e9 karate"])  # fmt: skip
def test_what_is_no_schedule_names_the_part_and_shows_one(text):
    with pytest.raises(ParameterError, match=text) as raised:
        read_schedule(f"hand_up, {text}")

    assert "3 karate, 8 hand_up" in " ".join(map(str, raised.value.checklist))


def test_an_unknown_gesture_is_told_with_the_known_ones():
    with pytest.raises(ParameterError, match='no gesture "wave"') as raised:
        read_schedule("3 wave")

    assert "strech_up" in str(raised.value.checklist[0])


def test_gestures_are_begun_at_their_seconds():
    schedule = Schedule(read_schedule("3 karate, 8 hand_up"), repeat=False)

    assert made(schedule, 30) == [(3.0, "karate"), (8.0, "hand_up")]


def test_gestures_without_seconds_are_a_pause_apart():
    schedule = Schedule(read_schedule("karate, hand_up"), repeat=False)

    (first_s, _), (second_s, _) = made(schedule, 30)

    assert first_s == pytest.approx(PAUSE_S, abs=0.11)
    assert second_s == pytest.approx(first_s + 2 + PAUSE_S, abs=0.21)


def test_a_repeated_schedule_starts_again_when_the_last_gesture_is_made():
    schedule = Schedule(read_schedule("1 karate"), repeat=True)

    assert [round(at_s, 1) for at_s, _ in made(schedule, 10)] == [1.0, 4.0, 7.0]
