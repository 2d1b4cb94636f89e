"""Arithmetic typed into number fields: what it comes to, what Python says it, what is refused."""

from __future__ import annotations

import ast
import math

import pytest
from block_building import B, build
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.arithmetic import LARGEST_NUMBER, ArithmeticRefused, calculate
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.generate.expressions import show
from nep_studio.blocks.generate.program import generate_program

SIGNS = "0123456789.+-*/%()^ ,eEpisqrtabound×π"  # noqa: RUF001 signs that people type


@pytest.mark.parametrize(
    ("text", "value", "python"),
    [
        ("2*pi/3", 2 * math.pi / 3, "2 * math.pi / 3"),
        (" 7 // 2 ", 3, "7 // 2"),
        ("-(1 + 2) ** 2", -9, "-(1 + 2) ** 2"),
        ("2^3", 8, "2 ** 3"),
        ("6 × 2 ÷ 4", 3, "6 * 2 / 4"),  # noqa: RUF001 signs that people type
        ("sqrt(2)/2", math.sqrt(2) / 2, "math.sqrt(2) / 2"),
        ("round(2.6) + max(1, 2)", 5, "round(2.6) + max(1, 2)"),
        ("sin(π/2)", 1, "math.sin(math.pi / 2)"),
        ("+5", 5, "5"),
        ("1e3", 1000, "1000.0"),
    ],
)
def test_arithmetic_has_a_value_and_a_python_text(text, value, python):
    read = calculate(text)

    assert read.value == pytest.approx(value)
    assert show(read.node) == python
    assert eval(python, {"math": math}) == pytest.approx(value)
    assert read.needs_math == ("math." in python)


@pytest.mark.parametrize(
    "text",
    [
        *("", " ", "x", "2pi", "1if 2else 3", "0x10", "1_000", "2,5", "(", "1)", "'a'", "1; 2"),
        *("9**9**9", "9**9**9 % 7", "2**10000000", "0**-1", "1/0", "1 % 0", "(-8)**(1/3)"),
        *("9" * 200, "1e400", "1e308*10", "-" * 150 + "1", "1+" * 150),
        *("__import__('os')", "abs.__class__", "min(1)", "pi()", "abs(x=1)", "[1]", "True", "1j"),
        *("1\n+1", "1\x00", "sqrt(-1)", "round(1, 2)", "１"),  # noqa: RUF001 a full-width digit
    ],
)
def test_what_is_no_arithmetic_is_refused_with_a_sentence(text):
    with pytest.raises(ArithmeticRefused) as refused:
        calculate(text)

    assert len(str(refused.value)) > 10


@given(st.text(SIGNS, max_size=30) | st.text(max_size=20))
def test_any_text_is_refused_or_comes_to_the_number_that_python_gives(text):
    try:
        read = calculate(text)
    except ArithmeticRefused:
        return

    assert abs(read.value) <= LARGEST_NUMBER
    python = show(read.node)
    assert eval(compile(ast.parse(python, mode="eval"), "x", "eval"), {"math": math}) == read.value


def test_a_number_field_takes_arithmetic_and_the_program_imports_math(language):
    editor = build(language, [B("event.started"), B("control.wait", {"seconds": "pi/2"})])

    text = generate_program(editor.project, language).text

    assert "import math\n" in text and "    wait(math.pi / 2)\n" in text


def test_a_time_below_nothing_is_refused(language):
    editor = build(language, [B("event.started"), B("control.wait")])
    wait = editor.project.pages["behaviour"][0].body[1]

    with pytest.raises(EditRefused, match="less than 0"):
        editor.apply(SetField(wait, "seconds", "1 - 2"))
