"""The programs of ``programs/*.toml`` are played on robots, and do what each says it does."""

from __future__ import annotations

import datetime
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.generate.program import generate_program
from tests.stories.block_theatre import BlockTheatre, block_theatre
from tests.stories.programs_in_blocks import LANGUAGE, programs

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blocks"))
from block_building import read_program

PROGRAMS = programs()
POLLING = ("control.forever", "control.while", "goal.until_state")
KNOWN = {"calls_itself"}
"""What is told of a program that is right: good to know, no fault."""

Play = Callable[[BlockTheatre], None]


@pytest.fixture(scope="module")
def theatre() -> Iterator[BlockTheatre]:
    with block_theatre() as made:
        yield made


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_needs_no_python_and_asks_nothing_over_and_over(name: str) -> None:
    project = PROGRAMS[name].project()

    types = {block.type for block in project.blocks.values()}

    assert not [each for each in types if each.startswith("code.") or each in POLLING]
    assert {problem.kind for problem in check(project, LANGUAGE)} <= KNOWN


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_python_of_a_program_is_read_back_as_the_same_blocks(name: str) -> None:
    project = PROGRAMS[name].project()
    code = generate_program(project, LANGUAGE.of(project)).text

    again = read_program(code, LANGUAGE, project)

    assert generate_program(again, LANGUAGE.of(again)).text == code
    types = [sorted(block.type for block in each.blocks.values()) for each in (project, again)]
    assert types[0] == types[1]
