"""Every block about robots, on the robot on the screen and on one that is driven over NAOqi."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

import dev
from tests.stories.robot_block_looks import LOOKS
from tests.stories.robot_block_stage import DRIVERS, BlockStage, block_stage, robot_blocks
from tests.stories.robot_block_table import table

pytestmark = pytest.mark.long

TRIED = [one for one in DRIVERS if one != "virtual" or not os.environ.get("CI")]
"""Where a change is judged, test_every_robot_block.py tries the virtual robot, which is quicker."""
CATEGORIES = sorted({definition.category.id for definition in robot_blocks()})


def test_no_block_about_robots_is_left_out() -> None:
    left_out = {definition.id for definition in robot_blocks()} ^ LOOKS.keys()

    assert not left_out, "say in robot_block_looks.py what they do to a robot"


def test_the_table_in_the_documentation_has_every_block_and_all_is_well() -> None:
    made = (Path(dev.__file__).parent / "docs" / "robot_blocks.md").read_text(encoding="utf-8")

    assert made == table({}), "run tools/robot_pages.py blocks"


@pytest.fixture(scope="module", params=TRIED)
def stage(request: pytest.FixtureRequest) -> Iterator[BlockStage]:
    """One robot for all blocks: each begins by calming it down."""
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        port = chosen.getsockname()[1]
    with block_stage(request.param, port) as made:
        yield made


@pytest.mark.timeout(300)
@pytest.mark.parametrize("category", CATEGORIES)
def test_every_block_has_done_to_the_robot_what_it_says(stage: BlockStage, category: str) -> None:
    blocks = [one.id for one in robot_blocks() if one.category.id == category]
    wrong = {}

    for block in sorted(blocks, key=lambda one: sorted(LOOKS[one].in_sight)):
        seen = stage.look(block)
        if seen.refused:  # a robot that was late on a busy computer is met again by now
            seen = stage.look(block)
        if not LOOKS[block].holds(seen):
            wrong[block] = (LOOKS[block].what, seen.value, seen.refused, seen.after)

    assert wrong == {}
