"""The table of every block about robots, and what was looked at for it on both robots."""

from __future__ import annotations

from nep_studio.blocks.definitions import Definition
from tests.stories.robot_block_looks import LOOKS
from tests.stories.robot_block_stage import DRIVERS, block_stage, robot_blocks

BEGINNING = """# Every block about robots

Each block was run twice, as a program of its own: on the robot on the screen, and on a robot that
is reached over NAOqi by the driver that also moves a real NAO. Then the state of the robot itself
was looked at, not the answer to the call. `python tools/robot_pages.py blocks` makes this table;
`tests/stories/test_robot_blocks_on_both_robots.py` runs the same blocks.

| block | what was looked at | on the screen | over NAOqi |
|---|---|---|---|
"""
YES, NO = "yes", "**no**"


def words_of(definition: Definition) -> str:
    """The sentence of a block, with … for each of its places."""
    return definition.in_words.replace("|", "\\|")


def table(results: dict[str, dict[str, bool]]) -> str:
    """The whole file; ``results`` by driver and block, what is not there is taken as right."""
    rows = []
    for definition in robot_blocks():
        told = [
            YES if results.get(driver, {}).get(definition.id, True) else NO for driver in DRIVERS
        ]
        look = LOOKS[definition.id].what
        rows.append(f"| {words_of(definition)} | {look} | {' | '.join(told)} |")
    return BEGINNING + "\n".join(rows) + "\n"


def run_all(driver: str, free_port: int) -> dict[str, bool]:
    """Run every block on one robot; whether the robot then was as it should be."""
    results = {}
    with block_stage(driver, free_port) as stage:
        for definition in robot_blocks():
            seen = stage.look(definition.id)
            results[definition.id] = bool(LOOKS[definition.id].holds(seen))
            print(driver, definition.id, YES if results[definition.id] else seen, flush=True)
    return results
