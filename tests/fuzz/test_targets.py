"""Every door takes all that was ever kept, and some inputs by chance."""

from __future__ import annotations

from pathlib import Path

import pytest

from fuzz.runner import Run
from fuzz.targets import NAMES, target

pytestmark = pytest.mark.long

SEED = 15
BY_CHANCE = 120
"""Some tenths of a second of each; `dev.py fuzz` tries as many as there is time for."""


@pytest.mark.timeout(240)
@pytest.mark.parametrize("name", NAMES)
def test_a_door_takes_whatever_comes(name: str, tmp_path: Path) -> None:
    door = target(name)
    run = Run(door, seed=SEED, found=tmp_path, hangs_s=30.0, makes_smaller=False)

    tally = run.random(count=len(door.seeds) + BY_CHANCE)

    told = [f"{one.kind}, number {one.number}: {one.words}" for one in tally.findings]
    assert not told, f"seed {SEED}: " + "\n".join(told)
    assert len(door.seeds) > 4
    assert tally.done >= len(door.seeds) + BY_CHANCE
