"""What is kept over the runs of a program: read, written, and never lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
import time

import pytest

from nep_core.program import kept as kept_file
from nep_core.program.kept import Kept, keep_in, keep_now, take_troubles
from nep_core.program.tables import names_in, table_of
from nep_core.program.variables import Variables


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setattr(kept_file, "_keepers", [])
    monkeypatch.setattr(kept_file, "_place", [])
    take_troubles()
    keep_in(tmp_path / "game.kept.json")
    return tmp_path / "game.kept.json"


def test_variables_are_attributes_that_can_be_read_by_people():
    program = Variables(score=0, names=[], self=1)
    program.score += 1

    assert repr(program) == "Variables(score=1, names=[], self=1)"
    with pytest.raises(AttributeError, match="'Variables' object has no attribute 'other'"):
        _ = program.other


def test_a_run_begins_with_what_the_last_one_held(file):
    kept = Kept(best=0, names=[], table={}, told="")
    kept.best, kept.told = 2.5, "größte"
    kept.names.append([True])
    kept.table["Ada"] = 3
    keep_now()

    again = Kept(best=0, names=[], table={}, told="", new=1)

    values = "best=2.5, names=[[True]], table={'Ada': 3}, told='größte'"
    assert repr(again) == f"Kept({values}, new=1)"
    assert not list(file.parent.glob(".*"))


@pytest.mark.parametrize(
    "keys", [(1, True, "1"), (2.5, False), ("table",), ("table", "Ada"), ("",), ()]
)
def test_the_keys_of_tables_are_of_the_kinds_that_they_were(file, keys):
    inner = table_of(*(one for key in keys for one in (key, [{2: key}])))
    kept = Kept(votes={}, rounds=[])
    kept.votes = inner
    kept.rounds.append(inner)
    keep_now()

    again = Kept(votes={}, rounds=[])

    assert again.votes == inner and again.rounds == [inner]
    assert [(type(key), key) for key in names_in(again.votes)] == [(type(k), k) for k in keys]


def test_what_is_changed_in_place_is_in_the_file_soon(file):
    kept = Kept(names=[])
    kept.names.append("Ada")

    until = time.monotonic() + 10
    while not (file.exists() and json.loads(file.read_text())["names"] == ["Ada"]):
        assert time.monotonic() < until
        time.sleep(0.02)


def test_many_changes_are_few_writes(file, monkeypatch):
    writes = []
    monkeypatch.setattr(kept_file, "write_whole", lambda *given: writes.append(given))
    kept = Kept(n=0)
    for _ in range(100_000):
        kept.n += 1
    keep_now()

    assert kept.n == 100_000 and 1 <= len(writes) < 30


@pytest.mark.parametrize(
    "damage",
    [
        *(b"{bad", b"[1]", b"\xff\xfe", b"", b"[" * 100_000),
        *(b'{"best": {"table": 1}}', b'{"best": {"table": [[[], 1]]}}'),
    ],
)
def test_a_file_that_cannot_be_read_is_put_aside_and_told(file, damage):
    file.write_bytes(damage)

    kept = Kept(best=7)

    assert kept.best == 7
    assert file.with_name("game.kept.json.damaged").read_bytes() == damage
    (told,) = take_troubles()
    assert "cannot be read" in str(told.sentence) and take_troubles() == []
    kept.best = 8
    keep_now()
    assert json.loads(file.read_text()) == {"best": 8}


def test_what_no_file_can_hold_stays_as_it_was_and_others_stay_in_the_file(file):
    file.write_text('{"best": 3, "gone": [1]}')
    kept = Kept(best=0, thing=0)
    kept.thing = object()
    itself: list[object] = []
    itself.append(itself)
    kept.best = itself
    keep_now()

    assert json.loads(file.read_text()) == {"best": 3, "gone": [1]}


def test_what_cannot_be_written_is_told_once(file, monkeypatch):
    def full(*_given):
        raise OSError(28, "No space left on device")

    kept = Kept(best=0)
    monkeypatch.setattr(kept_file, "write_whole", full)
    for kept.best in (1, 2):
        keep_now()

    (told,) = take_troubles()
    assert "cannot be written" in str(told.sentence)


def test_a_program_keeps_beside_it_also_when_it_ends_by_an_error(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        textwrap.dedent("""
        from nep_core import Kept
        kept = Kept(runs=0)
        kept.runs += 1
        print(kept.runs)
        raise SystemExit(3)
        """)
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    said = [
        subprocess.run(
            [sys.executable, program], capture_output=True, text=True, env=environment, cwd="/"
        ).stdout
        for _ in range(2)
    ]

    assert said == ["1\n", "2\n"]
    assert json.loads((tmp_path / "program.kept.json").read_text()) == {"runs": 2}
