"""Numbers as people type them, and the order in which Tab goes from field to field."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.arithmetic import LARGEST_NUMBER, number_text, typed_number
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.fields.choice import Option, matching
from nep_studio.ui.canvas.fields.editors import field_after, fields_within
from nep_studio.ui.canvas.fields.line_editor import result_text, stepped
from tests.blocks.block_building import B, build

NUMBERS = st.one_of(
    st.integers(-LARGEST_NUMBER, LARGEST_NUMBER),
    st.floats(-1e12, 1e12, allow_nan=False).filter(lambda n: abs(n) > 1e-4 or n == 0),
)


@given(number=NUMBERS)
def test_a_number_that_is_shown_is_read_again(number) -> None:
    assert typed_number(number_text(number)) == number


@given(number=NUMBERS, steps=st.integers(-10, 10))
def test_steps_up_and_down_again_give_the_same_number(number, steps) -> None:
    assert stepped(stepped(number, steps), -steps) == pytest.approx(number)


def test_a_step_leaves_no_dust_behind_the_point() -> None:
    assert stepped(0.1, 1) == 1.1
    assert stepped(1.1, -1) == 0.1
    assert stepped("2*3", 1) == 7


@pytest.mark.parametrize(
    ("text", "shown"),
    [("2*pi/3", "= 2.094"), ("2+3", "= 5"), ("7", ""), ("-1,5", ""), ("2*", ""), ("", "")],
)
def test_only_arithmetic_shows_what_it_comes_to(text, shown) -> None:
    assert result_text(text) == shown


def test_what_begins_with_the_typed_word_is_found_first() -> None:
    options = [Option("lie on the back"), Option("back flip"), Option("sit")]

    assert [o.label for o in matching(options, "BACK")] == ["back flip", "lie on the back"]


def test_accents_and_underlines_do_not_matter() -> None:
    options = [Option("Überraschung", "x"), Option("touched", "touched_head")]

    assert matching(options, "uber")[0].value == "x"
    assert matching(options, "head")[0].value == "touched_head"


def test_fields_follow_each_other_as_they_are_read() -> None:
    number = B("math.arithmetic", {"a": 1, "b": 2})
    loop = B("control.repeat", {}, {"times": number}, {"do": [B("control.wait")]})
    editor = build(studio_language(), [loop, B("control.wait")])
    project, language = editor.project, editor.language
    first, last = next(iter(project.pages["behaviour"])).body

    inside = [key for _, key in fields_within(project, language, first)]
    places = list(fields_within(project, language, first))
    after = field_after(project, language, places[-1], forward=True)

    assert inside == ["a", "operation", "b", "seconds"]
    assert after == (last, "seconds")
    assert field_after(project, language, after, forward=True) is None
    assert field_after(project, language, after, forward=False) == places[-1]


def test_fields_of_folded_blocks_are_passed_over() -> None:
    editor = build(studio_language(), [B("control.wait"), B("control.wait"), B("control.wait")])
    project = editor.project
    one, two, three = next(iter(project.pages["behaviour"])).body
    project.blocks[two].collapsed = True

    after = field_after(project, editor.language, (one, "seconds"), forward=True)

    assert after == (three, "seconds")
