"""Every block about robots, on the robot on the screen and on one that is driven over NAOqi."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

import dev
from nep_core.p2p import PeerNetwork
from tests.stories.robot_block_looks import LOOKS
from tests.stories.robot_block_stage import DRIVERS, block_stage, robot_blocks
from tests.stories.robot_block_table import table

TRIED = [one for one in DRIVERS if one != "virtual" or not os.environ.get("CI")]
"""Where a change is judged, test_every_robot_block.py tries the virtual robot, which is quicker."""
CATEGORIES = sorted({definition.category.id for definition in robot_blocks()})


def test_no_block_about_robots_is_left_out() -> None:
    assert sorted(LOOKS) == sorted(definition.id for definition in robot_blocks())


def test_the_table_in_the_documentation_has_every_block_and_all_is_well() -> None:
    made = (Path(dev.__file__).parent / "docs" / "robot_blocks.md").read_text(encoding="utf-8")

    assert made == table({}), "run docs/make_robot_blocks.py"


@pytest.mark.timeout(300)
@pytest.mark.parametrize("category", CATEGORIES)
@pytest.mark.parametrize("driver", TRIED)
def test_every_block_has_done_to_the_robot_what_it_says(
    network: PeerNetwork,
    join: Callable[[str], PeerNetwork],
    free_port: int,
    driver: str,
    category: str,
) -> None:
    blocks = [one.id for one in robot_blocks() if one.category.id == category]
    wrong = {}

    with block_stage(network, join("outside"), driver, free_port) as stage:
        for block in blocks:
            seen = stage.look(block)
            if not LOOKS[block].holds(seen):
                wrong[block] = (LOOKS[block].what, seen.value, seen.refused, seen.after)

    assert wrong == {}
