"""Values as the short texts that blocks show."""

from __future__ import annotations

import ast

from hypothesis import given
from hypothesis import strategies as st

from nep_core.program.robot import Robot
from nodes.cognitive.tracing.state import LONGEST, ProgramValues, shown

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.tuples(inner) | st.dictionaries(st.text(), inner),
    max_leaves=30,
)


@given(PLAIN)
def test_a_value_is_short_and_one_line(value: object) -> None:
    text = shown(value)

    assert "\n" not in text
    assert len(text) <= 10 * LONGEST  # escapes of letters that cannot be shown are long


@given(st.recursive(st.integers(-99, 99) | st.text("ab1 ", max_size=3), st.lists, max_leaves=4))
def test_texts_and_lists_are_told_apart(value: object) -> None:
    text = shown(value)

    assert "…" in text or ast.literal_eval(text) == value


def test_long_values_are_clipped() -> None:
    assert shown("a" * 1000) == f'"{"a" * 58}"…'
    assert shown(list(range(10**6))).endswith("…]")
    assert shown(10**5000) == "1e+5000"
    assert shown(-(10**5000)) == "-1e+5000"


def test_numbers_and_truths_in_collections_are_told_as_the_program_tells_them() -> None:
    assert shown([1, "a", None, True, 2.5, 2.0]) == '[1, "a", None, true, 2.5, 2]'
    assert shown((1,)) == "(1,)"
    assert shown({"a": [1]}) == '{"a": [1]}'
    assert shown(set()) == "set()"
    assert shown([[[[1]]]]) == "[[[…]]]"


def test_a_list_that_holds_itself_has_an_end() -> None:
    items: list[object] = [1]
    items.append(items)

    assert shown(items) == "[1, [1, [1, …]]]"


def test_what_is_no_value_is_left_out_until_it_takes_the_place_of_one() -> None:
    values = ProgramValues(frozenset({"robot", "x"}))
    values.namespace = {"robot": object(), "x": 1}
    first = values.changed()
    values.namespace = {"robot": object(), "x": object()}

    assert first == {"x": "1"}
    assert values.changed() == {"x": "…"}


def test_a_robot_is_shown_by_its_name_also_in_a_list() -> None:
    nao = object.__new__(Robot)  # without a network
    nao.robots = ["NAO"]

    assert shown(nao) == "NAO"
    assert shown([nao, "NAO"]) == '[NAO, "NAO"]'
