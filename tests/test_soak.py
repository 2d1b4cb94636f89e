"""The soak benchmark in short, and its account: what is excused, and that a loss is seen."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from benchmarks._soak_account import TAIL_S, account
from benchmarks.soak import soak

pytestmark = pytest.mark.long


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="programs are killed by signals")
def test_nothing_is_lost_between_programs_that_live_while_others_are_killed(
    tmp_path: Path,
) -> None:
    report = soak(3.0, 5, tmp_path, every_s=0.3)

    told = report.account
    assert report.kills >= 1
    assert report.master_kills >= 1
    assert report.died == [], (tmp_path / "errors.txt").read_text("utf-8")
    assert told.lost == 0, told.losses
    assert told.disordered == 0
    assert told.received == told.owed - told.excused
    assert told.received > 2000


SENT_S = (10.0, 10.1, 10.2, 10.3)


def write(folder: Path, got: list[int], end: str = "") -> None:
    """The diaries of one publisher, whose first message nobody was owed, and one subscriber."""
    lines = ["topic /x publisher.1.0"]
    for number, sent_s in enumerate(SENT_S, start=1):
        lines += ["heard hearer"] if number == 2 else []
        lines.append(f"send {number} {sent_s}")
    (folder / "publisher.1.0.sent").write_text("\n".join([*lines, "send 5"]), "utf-8")
    lines = ["id hearer /x", *(f"got publisher.1.0 {number}" for number in got), end]
    (folder / "subscriber.1.0.heard").write_text("\n".join([*lines, ""]), "utf-8")


def test_what_was_sent_after_the_handshake_is_owed(tmp_path: Path) -> None:
    write(tmp_path, [2, 3, 4])

    told = account(tmp_path, {})

    assert (told.sent, told.owed, told.received, told.lost) == (4, 3, 3, 0)


def test_a_gap_is_a_loss_whoever_was_killed(tmp_path: Path) -> None:
    write(tmp_path, [2, 4])

    told = account(tmp_path, {"publisher.1": 10.4, "subscriber.1": 10.4})

    assert (told.lost, told.excused) == (1, 0)
    assert told.losses == ("publisher.1.0 to hearer: [3] of 4",)


@pytest.mark.parametrize("killed", ["publisher.1", "subscriber.1"])
def test_the_last_messages_of_a_killed_end_are_excused(tmp_path: Path, killed: str) -> None:
    write(tmp_path, [2])

    told = account(tmp_path, {killed: 10.4})

    assert (told.lost, told.excused) == (0, 2)


def test_the_last_messages_are_lost_when_both_live_or_the_kill_came_much_later(
    tmp_path: Path,
) -> None:
    write(tmp_path, [2])

    assert account(tmp_path, {}).lost == 2
    assert account(tmp_path, {"publisher.1": SENT_S[2] + TAIL_S + 0.05}).lost == 1


def test_a_subscriber_that_closed_is_owed_nothing_more(tmp_path: Path) -> None:
    write(tmp_path, [2, 3], end="end 10.25")

    assert account(tmp_path, {}).lost == 0


def test_a_message_that_comes_twice_is_seen(tmp_path: Path) -> None:
    write(tmp_path, [2, 3, 3, 4])

    assert account(tmp_path, {}).disordered == 1
