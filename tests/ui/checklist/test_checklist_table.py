"""The table of the checklist names every test, and only tests that there are."""

from __future__ import annotations

import re
from pathlib import Path

HERE = Path(__file__).parent


def test_every_row_has_its_test_and_every_test_its_row() -> None:
    named = re.findall(r"\| (test_\w+) \|", (HERE / "README.md").read_text(encoding="utf-8"))
    files = [file for file in HERE.glob("test_*.py") if file != Path(__file__)]
    there = [name for f in files for name in re.findall(r"^def (test_\w+)", f.read_text(), re.M)]

    assert sorted(named) == sorted(there)
