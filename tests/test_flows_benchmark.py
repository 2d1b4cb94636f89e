"""The benchmark that counts the functions and files that four flows enter."""

from __future__ import annotations

import sys

import pytest

from benchmarks import flows
from faults import Text, text_of

pytestmark = pytest.mark.long


def test_functions_of_ours_are_counted_by_file_and_those_of_others_are_not() -> None:
    entered = flows.Entered()
    before = sys.getprofile()
    sys.setprofile(entered.see)

    with entered.counting():
        str(text_of("{node} works.", node="karate"))
        sorted([3, 1], key=lambda one: one)
    str(Text("not counted"))
    sys.setprofile(before)

    assert "text_of" in {name for _, name, _ in entered.functions}
    assert entered.files == {"faults/__init__.py"}


def test_nothing_is_counted_before_it_begins_or_after_it_ended() -> None:
    entered = flows.Entered()
    before = sys.getprofile()
    sys.setprofile(entered.see)
    text_of("{node} works.", node="karate")
    sys.setprofile(before)

    assert entered.functions == set()


def test_each_flow_of_a_real_window_enters_functions_and_files_of_ours() -> None:
    rows = flows.run()

    counts = {row["name"]: row["value"] for row in rows}
    assert list(counts) == [
        f"{flow}: {unit} entered" for flow in flows.BEFORE for unit in ("functions", "files")
    ]
    assert all(value > 20 for value in counts.values()), counts
    assert all(row["ratio"] > 0 for row in rows)
