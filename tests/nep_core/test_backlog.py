"""What waits for a subscriber is bounded, and what is lost is counted exactly."""

from __future__ import annotations

import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.wire import frames, inbox
from nep_core.wire import inbox as backlog_module
from nep_core.wire.frames import NUL, join, mark, notice, subscription
from nep_core.wire.inbox import Backlog


def frame(first: int, *payloads: bytes, run: str = "11111111", encoding: str = "json") -> bytes:
    start = subscription("/t")
    return join(start, "talker", first, 0, encoding, NUL.join(payloads or (b"0",)), run)  # type: ignore[arg-type]


def told(sent: int, run: str = "11111111") -> bytes:
    return mark("/t", "talker", run, sent)


def all_of(backlog: Backlog) -> list[bytes]:
    return [backlog.pop() or b"" for _ in range(len(backlog))]


def test_a_gap_between_frames_is_lost_whichever_way_the_frames_go() -> None:
    backlog = Backlog("/t")
    backlog.put(frame(5, b"5", b"6"))
    backlog.passed = frame(7)
    backlog.put(frame(10))

    backlog.passed = frame(12)
    backlog.count_passed()

    assert backlog.lost == 3
    assert len(backlog) == 2


def test_what_is_lost_at_the_end_is_known_from_a_mark() -> None:
    backlog = Backlog("/t")
    backlog.put(told(2))
    backlog.put(frame(3))

    backlog.put(told(8))
    backlog.put(told(8))

    assert backlog.lost == 5
    assert len(backlog) == 1


def test_what_was_sent_before_the_first_notice_says_where_to_begin_is_counted_once() -> None:
    backlog = Backlog("/t")
    for number in (5, 6):
        backlog.put(frame(number))  # its subscription was in force before it was known

    for _ in range(2):  # also when the connection is made again
        backlog.put(told(0))
        backlog.put(notice(frame(3), 6))  # the last latched message, which is older

    assert backlog.lost == 3
    assert len(backlog) == 3


def test_numbers_that_jump_make_no_loss_that_cannot_be_told() -> None:
    backlog = Backlog("/t")

    for number in (1, frames.MOST, 1, frames.MOST, 1, frames.MOST):
        backlog.put(frame(number))

    assert frames.to_json(backlog.lost) == b"9223372036854775807"


def test_a_publisher_that_starts_again_loses_nothing_with_or_without_a_run() -> None:
    backlog = Backlog("/t")
    for number, run in ((100, "aaaaaaaa"), (101, "aaaaaaaa"), (1, "bbbbbbbb"), (2, "bbbbbbbb")):
        backlog.put(frame(number, run=run))
    for number in (7, 8, 1, 2):
        backlog.put(frame(number, run=""))

    assert backlog.lost == 0


def test_two_publishers_of_one_name_are_counted_apart() -> None:
    backlog = Backlog("/t")
    for number in range(1, 4):
        backlog.put(frame(number, run="aaaaaaaa"))
        backlog.put(frame(number + 500, run="bbbbbbbb"))

    backlog.put(told(503 + 4, run="bbbbbbbb"))

    assert backlog.lost == 4


def test_a_latched_message_is_neither_a_gap_nor_a_repeat() -> None:
    late, early, between = Backlog("/t"), Backlog("/t"), Backlog("/t")

    late.put(notice(frame(3), 9))  # 4 to 9 were not for it
    late.put(frame(10))
    early.put(frame(3))  # it came before the welcome
    early.put(notice(frame(3), 3))
    between.put(frame(4))  # later than what is latched
    between.put(notice(frame(3), 4))
    between.put(notice(frame(3), 4))  # welcomed once more: the connection was broken

    assert (len(late), late.lost) == (2, 0)
    assert (len(early), early.lost) == (1, 0)
    assert (len(between), between.lost) == (2, 0)


def test_after_a_broken_connection_the_latched_message_counts_as_arrived() -> None:
    backlog = Backlog("/t")
    backlog.put(frame(1))

    backlog.put(notice(frame(4), 6))

    assert len(backlog) == 2
    assert backlog.lost == 4


@pytest.mark.parametrize(("bound", "value"), [("FRAMES", 3), ("BYTES", 3 * len(frame(1)) + 2)])
def test_the_oldest_events_are_dropped_and_counted(
    bound: str, value: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(backlog_module, bound, value)
    backlog = Backlog("/t")
    backlog.put(frame(1, b"", b""))

    for number in range(3, 9):
        backlog.put(frame(number))

    assert all_of(backlog) == [frame(6), frame(7), frame(8)]
    assert backlog.lost == 5


def test_the_newest_event_is_kept_whatever_its_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backlog_module, "BYTES", 100)
    backlog = Backlog("/t")

    backlog.put(frame(1))
    backlog.put(frame(2, b"0" * 1000))

    assert all_of(backlog) == [frame(2, b"0" * 1000)]


def test_of_states_the_newest_of_each_publisher_is_kept_and_none_is_lost() -> None:
    backlog = Backlog("/t", "state")
    for number in (1, 2, 9):
        backlog.put(frame(number, run="aaaaaaaa"))
        backlog.put(frame(number, run="bbbbbbbb"))

    backlog.put(notice(frame(0, run="aaaaaaaa"), 9))  # what is latched is older

    assert all_of(backlog) == [frame(9, run="aaaaaaaa"), frame(9, run="bbbbbbbb")]
    assert backlog.lost == 0


def test_bytes_with_nul_are_one_message() -> None:
    backlog = Backlog("/t")

    backlog.put(frame(1, b"\0\0\0", encoding="bytes"))
    backlog.put(frame(2))

    assert backlog.lost == 0


def test_a_topic_that_lives_for_weeks_remembers_a_bounded_number_of_publishers() -> None:
    backlog = Backlog("/t")

    for start in range(inbox.MOST_PUBLISHERS + 10):
        backlog.put(frame(1, run=f"{start:08}"))

    assert len(backlog._known) == inbox.MOST_PUBLISHERS


@given(st.lists(st.binary(max_size=60) | st.binary(max_size=60).map(lambda b: b"/t\0" + b)))
def test_any_bytes_are_taken_in(rubbish: list[bytes]) -> None:
    for policy in ("events", "state"):
        backlog = Backlog("/t", policy)  # type: ignore[arg-type]
        for data in rubbish:
            backlog.put(data)
            backlog.passed = data
            backlog.count_passed()
        all_of(backlog)

        backlog.put(frame(2**40))

        assert backlog.pop() == frame(2**40)


@given(st.lists(st.integers(1, 4), max_size=30), st.data())
def test_received_and_lost_are_what_was_sent(sizes: list[int], data: st.DataObject) -> None:
    backlog = Backlog("/t")
    backlog.put(told(0))
    sent = received = 0
    for size in sizes:
        if data.draw(st.booleans()):
            backlog.put(frame(sent + 1, *[b"0"] * size))
            received += size
        sent += size
        if data.draw(st.booleans()):
            backlog.put(told(sent))

    backlog.put(told(sent))

    assert received + backlog.lost == sent
    assert frames.read_header(told(sent).split(NUL)[1]).sent == sent


def test_states_of_ever_new_publishers_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backlog_module, "BYTES", 10 * len(frame(1)))
    backlog = Backlog("/t", "state")

    for start in range(50):
        backlog.put(frame(1, run=f"{start:08}"))
        backlog.put(frame(2, run=f"{start:08}"))

    assert len(backlog) == 10
    assert all_of(backlog)[-1] == frame(2, run="00000049")
    assert backlog._bytes == 0


def test_what_is_remembered_of_publishers_does_not_grow_with_their_names() -> None:
    backlog = Backlog("/t", "state")
    tracemalloc.start()
    for number in range(100):
        name = f"{number} " + "n" * 100_000
        backlog.put(join(subscription("/t"), name, 1, 0, "json", b"0", name))
        assert backlog.pop() is not None

    kept_bytes, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()

    assert kept_bytes < 1_000_000
