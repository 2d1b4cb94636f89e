"""The runner finds each planted bug, keeps its input, and goes on with the next."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from fuzz import __main__ as command
from fuzz.runner import Run
from fuzz.targets import NAMES
from fuzz.targets import target as real
from fuzz.watched import smaller
from tests.fuzz.planted import BAD, target

MODULE = "tests.fuzz.planted"


def tried(way: str, folder: Path, *inputs: bytes) -> Run:
    paths = []
    for number, data in enumerate(inputs):
        paths.append(folder / f"input_{number}")
        paths[-1].write_bytes(data)
    run = Run(
        target(way),
        seed=0,
        module=MODULE,
        found=folder / "found",
        hangs_s=6.0,
        makes_smaller=way == "raises",
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
    tally = tried(way, tmp_path, b"good", b"xx bad xx", b"good").tally

    [found] = tally.findings
    assert found.kind == kind
    assert tally.done == 3
    assert found.path is not None and BAD in found.path.read_bytes()
    assert found.path.with_suffix(".txt").read_text(encoding="utf-8").startswith(kind)


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
