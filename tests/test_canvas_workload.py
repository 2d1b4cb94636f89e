"""The reference program of the canvas: the same as Blockly's, at any size."""

from pathlib import Path

import pytest

from benchmarks import canvas_workload as workload
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language


@pytest.fixture(scope="module")
def words() -> Language:
    return workload.language()


@pytest.mark.real_data
@pytest.mark.parametrize("blocks", [100, 1000, 5000])
def test_the_made_program_is_the_one_that_blockly_is_measured_with(
    shared_data: Path, words: Language, blocks: int
) -> None:
    file = shared_data / "blocks_workload" / f"workload_{blocks}.json"

    theirs = workload.read_blockly(file)

    assert workload.blockly(blocks // 100) == theirs
    assert to_bytes(workload.made(blocks, words)) == to_bytes(workload.translated(theirs, words))


@pytest.mark.parametrize("blocks", [100, 2_000])
def test_every_stack_has_exactly_100_blocks(words: Language, blocks: int) -> None:
    project = workload.made(blocks, words)

    sizes = {len(list(project.within(stack.body))) for stack in project.stacks.values()}
    assert sizes == {100}
    assert len(project.blocks) == blocks


def test_the_program_is_one_that_the_studio_opens(words: Language) -> None:
    for project in (workload.made(300, words), workload.one_stack(500, words)):
        data = to_bytes(project)

        assert to_bytes(from_bytes(data, "workload.nep", words)) == data


def test_one_stack_has_all_its_statements_in_one_chain_that_runs(words: Language) -> None:
    project = workload.one_stack(10_000, words)

    assert [len(stack.body) for stack in project.stacks.values()] == [1 + 10_000]
    assert generate_program(project, words).text.count(".say(") == 10_000


def test_a_size_that_is_no_multiple_of_a_stack_is_refused(words: Language) -> None:
    with pytest.raises(ValueError, match="150 is not a multiple of 100"):
        workload.made(150, words)
