"""The runner finds each planted bug, keeps its input, and goes on with the next."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fuzz import __main__ as command
from fuzz.runner import Run
from fuzz.targets import NAMES
from fuzz.targets import target as real
from fuzz.watched import BOARD_BYTES, ROOT, Board, kept_bytes, smaller, waited_by_all_s
from tests.fuzz.planted import BAD, ONCE, SHUT, target

pytestmark = pytest.mark.long

MODULE = "tests.fuzz.planted"


def tried(way: str, folder: Path, *inputs: bytes, is_thorough: bool = False) -> Run:
    paths = []
    for number, data in enumerate(inputs):
        paths.append(folder / f"input_{number}")
        paths[-1].write_bytes(data)
    run = Run(
        target(way),
        seed=0,
        module=MODULE,
        found=folder / "found",
        hangs_s=6.0 if way == "slow" else 1.0,  # it is fed three times
        makes_smaller=is_thorough,
    )
    run.files(paths)
    return run


@pytest.mark.parametrize(
    ("way", "kind"),
    [
        ("raises", "raises"),
        ("logs", "raises"),
        ("thread", "raises"),
        ("wordless", "raises"),
        ("slow", "slow"),
        ("hangs", "hangs"),
        ("large", "large"),
        ("ends", "ends"),
    ],
)
def test_a_planted_bug_is_found_and_its_input_kept(tmp_path: Path, way: str, kind: str) -> None:
    tally = tried(way, tmp_path, b"good", b"xx bad xx", b"good", is_thorough=way == "raises").tally

    [found] = tally.findings
    assert found.kind == kind
    assert tally.done == 3
    assert found.path is not None and BAD in found.path.read_bytes()
    assert found.path.with_suffix(".txt").read_text(encoding="utf-8").startswith(kind)


def test_what_hangs_only_behind_others_is_tried_again_behind_them(tmp_path: Path) -> None:
    tally = tried("tires", tmp_path, b"good", b"good", b"bad", is_thorough=True).tally

    [found] = tally.findings
    assert found.kind == "hangs"
    assert "behind those from number 0" in found.words
    assert "waited" in found.words
    assert "planted.py" in found.words or not hasattr(signal, "SIGUSR1")  # where it stands
    assert tally.held_up == 0


def test_what_is_held_up_once_is_told_and_no_finding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    once = tmp_path / "once"
    once.touch()
    monkeypatch.setenv(ONCE, str(once))

    tally = tried("once", tmp_path, b"good", b"bad", b"good", is_thorough=True).tally

    assert (tally.done, tally.held_up, tally.findings) == (3, 1, [])
    assert "1 held up" in tally.words


WRITES = """
import sys, time
from pathlib import Path
from fuzz.watched import Board
board, number = Board(Path(sys.argv[1])), 0
while True:
    number += 1
    board.write(number if number % 2 else -1, time.monotonic(), number)
"""


def test_a_board_is_read_whole_however_often_it_is_written(tmp_path: Path) -> None:
    path = tmp_path / "board"
    path.write_bytes(bytes(BOARD_BYTES))
    board = Board(path)
    began_s = time.monotonic()
    board.write(-1, began_s, 0)

    writer = subprocess.Popen([sys.executable, "-c", WRITES, str(path)], cwd=ROOT)
    while board.read()[2] == 0 and writer.poll() is None:
        time.sleep(0.01)
    read = [board.read() for _ in range(20_000)]
    writer.kill()
    writer.wait()
    board.close()

    assert all(one[1] >= began_s and one[0] in (-1, one[2]) for one in read)
    assert read[-1][2] > read[0][2] > 0


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells what threads wait for")
def test_what_others_take_of_the_processor_is_told() -> None:
    allowed, before_s = os.sched_getaffinity(0), waited_by_all_s(os.getpid())
    os.sched_setaffinity(0, {min(allowed)})
    other = subprocess.Popen([sys.executable, "-c", "while True: pass"])

    until_s = time.monotonic() + 30
    while waited_by_all_s(os.getpid()) < before_s + 0.05 and time.monotonic() < until_s:
        sum(range(100_000))
    other.kill()
    other.wait()
    os.sched_setaffinity(0, allowed)

    assert waited_by_all_s(os.getpid()) >= before_s + 0.05


@pytest.mark.skipif(sys.platform != "linux", reason="others keep less at hand")
def test_only_memory_that_is_kept_is_growth() -> None:
    before = kept_bytes()
    many = [bytes(1000) for _ in range(60_000)]
    last = many[-1]  # the memory below it cannot be given back by itself
    while_kept = kept_bytes()
    del many

    assert while_kept - before > 40_000_000
    assert kept_bytes() - before < 20_000_000
    assert len(last) == 1000


def test_what_is_refused_in_a_sentence_is_no_finding(tmp_path: Path) -> None:
    assert tried("sound", tmp_path, b"bad", b"good").tally.findings == []


def test_an_input_is_made_smaller_as_long_as_it_breaks() -> None:
    assert smaller(b"a long text that is bad, and more", lambda data: BAD in data, tries=200) == BAD


def test_a_number_tells_an_input_again() -> None:
    one, again = real("csv"), real("csv")

    inputs = [one.input(5, number) for number in range(60)]

    assert inputs == [again.input(5, number) for number in range(60)]
    assert inputs != [one.input(6, number) for number in range(60)]
    assert inputs[: len(one.seeds)] == list(one.seeds)


@pytest.mark.parametrize("name", NAMES)
def test_changes_are_bytes_whatever_they_change(name: str) -> None:
    target = real(name)

    for number in range(100):
        data = target.mutate(b"", random.Random(number), [b"", b"\xff"])
        assert isinstance(data, bytes)


def test_the_command_says_what_it_does_not_know(capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["no_such_target"]) == command.WRONG_USE
    assert "csv" in capsys.readouterr().out


def test_the_command_tries_a_target(capsys: pytest.CaptureFixture[str]) -> None:
    code = command.main(["lines", "--count", "30", "--seed", "1"])

    said = capsys.readouterr().out
    assert code == command.DONE, said
    assert "The seed is 1." in said and "lines: 30 inputs" in said


def test_a_target_that_cannot_be_tried_is_not_said_to_be_sound(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        command, "Run", lambda _, **how: Run(target(SHUT), **how | {"module": MODULE})
    )

    code = command.main(["lines", "--count", "3"])

    said = capsys.readouterr().out
    assert code == command.FOUND_SOME
    assert "the door does not open" in said and "1 found" in said
