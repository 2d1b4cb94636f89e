"""Expressions print as Python that reads back as the same expression."""

from __future__ import annotations

import ast

import pytest
from hostile import texts
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.generate.expressions import f_string, literal, show
from nep_studio.blocks.generate.names import RESERVED, NameTable, python_name

NAMES = st.sampled_from(["a", "nao", "größe", "x_2"])
LEAVES = (
    st.builds(ast.Constant, texts | st.booleans() | st.none())
    | st.builds(ast.Constant, st.integers(0, 10**20) | st.floats(0, 1e308).map(abs))
    | st.builds(ast.Name, NAMES)
)
OPERATORS = [ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Mod, ast.Pow]
SIGNS = [ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn]
BINARY = st.sampled_from(OPERATORS).map(lambda k: k())
COMPARISON = st.sampled_from(SIGNS).map(lambda k: k())
NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def table(entries: list[tuple[ast.expr, ast.expr]]) -> ast.expr:
    return ast.Dict([key for key, _ in entries], [value for _, value in entries])


def joined(parts: list[ast.expr]) -> ast.expr:
    """An f-string, where Python 3.11 can write it."""
    return f_string(parts) or parts[0]


def larger(inner: st.SearchStrategy[ast.expr]) -> st.SearchStrategy[ast.expr]:
    two_or_three = st.lists(inner, min_size=2, max_size=3)
    keywords = st.lists(st.builds(ast.keyword, NAMES, inner), max_size=2)
    return st.one_of(
        st.builds(ast.BinOp, inner, BINARY, inner),
        st.builds(ast.UnaryOp, st.sampled_from([ast.USub(), ast.Not()]), inner),
        st.builds(ast.BoolOp, st.sampled_from([ast.And(), ast.Or()]), two_or_three),
        st.builds(
            lambda left, sign, right: ast.Compare(left, [sign], [right]), inner, COMPARISON, inner
        ),
        st.builds(ast.Call, inner, st.lists(inner, max_size=3), keywords),
        st.builds(ast.Attribute, inner, NAMES),
        st.builds(ast.List, st.lists(inner, max_size=3)),
        st.lists(st.tuples(inner, inner), max_size=3).map(table),
        st.lists(inner, min_size=1, max_size=4).map(joined),
        st.builds(lambda body: ast.Lambda(NO_ARGUMENTS, body), inner),
        st.builds(ast.IfExp, inner, inner, inner),
        st.builds(ast.Subscript, inner, inner | st.builds(ast.Slice, inner | st.none(), inner)),
    )


def dumped(node: ast.AST) -> str:
    return ast.dump(node).replace(", ctx=Load()", "").replace("ctx=Load()", "")


@given(st.recursive(LEAVES, larger, max_leaves=25))
def test_what_is_printed_parses_to_what_was_printed(node: ast.expr):
    printed = show(node)

    assert "\n" not in printed
    assert dumped(ast.parse(printed, mode="eval").body) == dumped(node)


@given(texts)
def test_a_text_is_printed_as_one_visible_line_and_reads_back(text: str):
    printed = literal(text)

    assert printed.isprintable()
    assert ast.literal_eval(printed) == text


def test_texts_are_printed_in_double_quotes_unless_that_takes_more_escapes():
    assert literal("it's") == '"it\'s"'
    assert literal('say "hi"') == "'say \"hi\"'"
    assert literal("plain") == '"plain"'


@given(st.lists(texts.map(ast.Constant) | st.builds(ast.Name, NAMES), min_size=1, max_size=6))
def test_an_f_string_holds_any_text_and_reads_back(parts: list[ast.expr]):
    made = f_string([*parts, ast.Name("x")])

    assert made is not None and show(made).isprintable()
    assert dumped(ast.parse(show(made), mode="eval").body) == dumped(made)


@pytest.mark.parametrize("value", [-1, -0.0, float("inf"), float("nan")])
def test_a_constant_with_a_sign_or_without_an_end_is_not_printed(value: float):
    with pytest.raises(ValueError, match="sign"):
        show(ast.Constant(value))


@given(texts)
def test_any_text_becomes_a_name_that_python_reads_as_it_is_written(text: str):
    table = NameTable()

    names = [table.give(text, "variable") for _ in range(3)]

    assert len(set(names)) == 3
    for name in names:
        assert name.isidentifier() and name not in RESERVED
        assert ast.parse(name, mode="eval").body.id == name


def test_names_keep_the_letters_of_all_languages():
    assert python_name("größe (cm)", "variable") == "größe_cm"
    assert python_name("名前", "variable") == "名前"
    assert python_name("2 robots", "variable") == "variable_2_robots"
    assert python_name("ﬁne", "variable") == "fine"
    assert python_name("!!!", "variable") == "variable"


@pytest.mark.parametrize("name", ["class", "None", "print", "Robot", "wait", "random", "match"])
def test_names_that_python_or_the_program_needs_get_an_underscore(name: str):
    table = NameTable()

    assert [table.give(name, "variable") for _ in range(2)] == [f"{name}_", f"{name}_2"]
