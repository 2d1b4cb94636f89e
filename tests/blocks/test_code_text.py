"""What the text of a code block says about itself."""

from __future__ import annotations

from nep_studio.blocks.code_text import read_lines


def test_names_made_inside_a_function_are_not_made_here() -> None:
    read = read_lines("def part():\n    global x\n    x += 1\n\ny = 2\npart()")

    assert read.made == {"part", "x", "y"}
    assert read.set_here == {"part", "y"}
