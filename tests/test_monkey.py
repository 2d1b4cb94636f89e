"""A monkey at the window: a short turn each time, and what it would make of a fault."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
STEPS, SEED = 300, 7
LONGEST_S = 400


def play(*program: str) -> subprocess.CompletedProcess[str]:
    """Run the monkey, as a program of its own."""
    return subprocess.run(
        [sys.executable, *program],
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=LONGEST_S,
        check=False,
    )


@pytest.mark.timeout(LONGEST_S + 60)
def test_random_clicks_drags_and_keys_break_nothing() -> None:
    done = play("tools/monkey.py", "--steps", str(STEPS), "--seed", str(SEED))

    assert done.returncode == 0, f"{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
    assert f"{STEPS} steps" in done.stdout


NO_WAY_BACK = """do, leave = monkey.Monkey._do_something, monkey.Monkey._leave
def at_the_end(self):
    do(self) if self.done < self.steps else self.window.open_settings()
monkey.Monkey._do_something = at_the_end
monkey.Monkey._leave = lambda self, top: leave(self, top) if self.done < self.steps else None"""
"""The last step opens a dialog that cannot be left."""


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("monkey.Monkey._wait = lambda *_: 1 / 0", "ZeroDivisionError"),
        ("monkey.Monkey._wait = lambda *_: os.abort()", ""),
        (NO_WAY_BACK, "no way back"),
    ],
    ids=["an error", "a crash", "no way back"],
)
def test_what_goes_wrong_is_found_and_told_with_its_steps(fault: str, told: str) -> None:
    program = f"import os, sys\nfrom tools import monkey\n{fault}\n" + (
        "sys.exit(monkey.main(['--steps', '250', '--seed', '3']))"
    )

    done = play("-c", program)

    assert done.returncode != 0
    assert told in done.stdout
    assert not told or "The last steps:" in done.stdout
