"""What a study keeps: nothing is lost, nothing stays, and spreadsheets read it as it is."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from nep_studio.study.records import (
    FORMULA_SIGNS,
    Event,
    Reply,
    Sitting,
    StudyFolder,
    write_events,
    write_replies,
)

ANSWERS: list[int | None] = [6, 2, 7, None, 5, 2, 6, 2, 5, 1]


@pytest.fixture
def folder(tmp_path: Path) -> StudyFolder:
    return StudyFolder(tmp_path / "study")


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_nothing_is_on_the_disk_until_a_study_begins(folder: StudyFolder) -> None:
    assert (folder.sitting(), folder.events(), folder.replies()) == (None, [], [])
    assert not folder.folder.exists()


def test_a_sitting_goes_on_after_a_new_start_until_it_is_finished(folder: StudyFolder) -> None:
    sitting = Sitting("P01", "blocks")
    folder.begin(sitting)

    again = StudyFolder(folder.folder)

    assert again.sitting() == sitting
    again.finish()
    assert folder.sitting() is None


def test_events_and_answers_come_back_as_they_were(folder: StudyFolder) -> None:
    event = Event(Sitting("P01"), "run_ended", "with an “error”\nand more", 3.5)
    reply = Reply("P01", "blocks", ANSWERS)

    folder.add_event(event)
    folder.add_reply(reply)

    assert folder.events() == [event]
    assert folder.replies() == [reply]
    assert folder.participants() == ["P01"]


def test_answers_without_a_score_are_not_kept(folder: StudyFolder) -> None:
    with pytest.raises(ValueError, match="answer"):
        folder.add_reply(Reply("P01", "", [None] * 10))

    assert folder.replies() == []


def test_a_line_that_was_cut_short_costs_only_itself(folder: StudyFolder) -> None:
    first, second = Event(Sitting("P01"), "run_asked"), Event(Sitting("P01"), "run_started")
    folder.add_event(first)
    file = folder.folder / "events.jsonl"
    file.write_bytes(file.read_bytes() + b'{"sitting":{"partic')

    folder.add_event(second)

    assert folder.events() == [first, second]


UNREADABLE = [b"[" * 100_000, b'"\xff"', b'{"sitting":' + b"[" * 100_000, b"1" * 5_000]


@pytest.mark.parametrize("bad", UNREADABLE, ids=["deep", "no UTF-8", "deep inside", "long number"])
def test_what_no_decoder_can_read_costs_only_itself(folder: StudyFolder, bad: bytes) -> None:
    event = Event(Sitting("P01"), "run_asked")
    folder.add_event(event)
    for name in ("events.jsonl", "answers.jsonl"):
        with (folder.folder / name).open("ab") as file:
            file.write(bad + b"\n")
    for name in ("open.json", "setup.json"):
        (folder.folder / name).write_bytes(bad)

    folder.add_event(event)

    assert folder.events() == [event, event]
    assert (folder.replies(), folder.sitting(), folder.conditions()) == ([], None, [])


def test_deleting_leaves_nothing(folder: StudyFolder) -> None:
    folder.begin(Sitting("P01"))
    folder.add_event(Event(Sitting("P01"), "app_opened"))
    folder.add_reply(Reply("P01", "", ANSWERS))

    folder.delete_all()

    assert not folder.folder.exists()
    assert folder.sitting() is None


def test_a_table_of_answers_has_a_row_for_each_questionnaire(tmp_path: Path) -> None:
    path = tmp_path / "answers.csv"

    write_replies(path, [Reply("P01", "móvil, „x“", ANSWERS), Reply("P02", "", [4] * 10)])

    first, second = rows(path)
    assert path.read_bytes().startswith(b"\xef\xbb\xbf")
    assert (first["participant"], first["condition"]) == ("P01", "móvil, „x“")
    assert (first["item_1"], first["item_4"], first["left_open"]) == ("6", "", "1")
    assert float(first["score"]) == 80
    assert float(second["score"]) == 50


def test_a_table_of_events_has_a_row_for_each_event(tmp_path: Path) -> None:
    path = tmp_path / "events.csv"
    sitting = Sitting("P01", "blocks", started_s=1000.0)

    write_events(path, [Event(sitting, "error_told", 'a "quoted"\nline', time_s=1012.25)])

    [row] = rows(path)
    assert (row["elapsed_s"], row["event"], row["words"]) == (
        "12.25",
        "error_told",
        'a "quoted"\nline',
    )


@pytest.mark.parametrize("sign", FORMULA_SIGNS)
@pytest.mark.parametrize("before", ["", " ", "\xa0 "])
def test_no_cell_is_taken_for_a_formula(tmp_path: Path, sign: str, before: str) -> None:
    path = tmp_path / "events.csv"

    write_events(
        path, [Event(Sitting(f"{before}{sign}1+1"), "error_told", f"{sign}cmd|' /C calc'")]
    )

    [row] = rows(path)
    assert row["participant"].startswith("'")
    assert row["words"].startswith("'")


def test_a_table_that_cannot_be_written_leaves_the_old_one(tmp_path: Path) -> None:
    there = tmp_path / "folder"
    there.mkdir()

    with pytest.raises(OSError, match=r"answers|folder"):
        write_replies(there, [])

    assert list(tmp_path.iterdir()) == [there]
