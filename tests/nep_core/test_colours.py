"""Colours are made from their parts and mixed."""

import pytest

from nep_core.program.robot import colour_from, mix_colours


def test_a_colour_is_made_from_its_parts_within_their_limits():
    assert colour_from(255, 127.6, 0) == "#ff8000"
    assert colour_from(-5, 300, 0) == "#00ff00"


def test_colours_are_mixed():
    assert mix_colours("#000000", "#ffffff", 50) == "#808080"
    assert mix_colours("#102030", "#ffffff", 0) == "#102030"
    assert mix_colours("#000000", "#FFFFFF", 150) == "#ffffff"


def test_what_is_no_colour_is_told():
    with pytest.raises(ValueError, match="written like #ff8800"):
        mix_colours("red", "#ffffff")
