"""The Python of all examples is as careful readers want it: ruff finds nothing in it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from nep_studio.blocks.files import load
from nep_studio.blocks.generate.program import generate_program
from nep_studio.help.texts import examples

EXAMPLES = sorted((Path(__file__).parents[2] / "resources/examples").glob("*.nep"))
RULES = "B,SIM,PLW0603"
AS_THE_BLOCK_SAYS = "SIM117,SIM201,SIM905"
"""Findings about a single block that the help shows: a part of a behaviour tree is a ``with`` of
its own, also where it is the only one in another; “repeat until” is ``while not``, which reads back
as itself; “the parts of” takes apart the text that is typed in it."""


def findings(folder: Path, but: str = "") -> str:
    """What ruff has to say about the files in a folder, but for some of its rules."""
    ruff = [sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "--select", RULES]
    ruff += ["--ignore", but] if but else []
    return subprocess.run([*ruff, folder], capture_output=True, text=True, check=False).stdout


def test_ruff_finds_nothing_in_the_python_of_examples(language, tmp_path):
    for path in EXAMPLES:
        text = generate_program(load(path, language), language).text
        (tmp_path / f"{path.stem}.py").write_text(text, encoding="utf-8")

    assert len(list(tmp_path.iterdir())) == len(EXAMPLES) > 15
    assert "All checks passed" in findings(tmp_path)


def test_ruff_finds_nothing_in_the_python_of_the_help(language, tmp_path):
    for name, example in examples().items():
        text = generate_program(example.project(language, "en", name), language).text
        (tmp_path / f"{name}.py").write_text(text, encoding="utf-8")

    assert len(list(tmp_path.iterdir())) == len(examples()) > 50
    assert "All checks passed" in findings(tmp_path, AS_THE_BLOCK_SAYS)


def test_it_would_find_something(tmp_path):
    (tmp_path / "a.py").write_text("def f():\n    global x\n    x = 1\n", encoding="utf-8")

    assert "PLW0603" in findings(tmp_path)
