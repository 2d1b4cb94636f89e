"""What the text of a code block says about itself."""

from __future__ import annotations

import json

import pytest
from block_building import B, build

from nep_studio.blocks.arithmetic import ArithmeticRefused, calculate
from nep_studio.blocks.code_text import (
    CodeTextRefused,
    plainly,
    plainly_and_short,
    read_lines,
)
from nep_studio.blocks.files import from_bytes, to_bytes


def test_names_made_inside_a_function_are_not_made_here() -> None:
    read = read_lines("def part():\n    global x\n    x += 1\n\ny = 2\npart()")

    assert read.made == {"part", "x", "y"}
    assert read.set_here == {"part", "y"}


HIDDEN = f"1{' ' * 3000}or __import__('os').getpid()"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HIDDEN, "1 ⟨3000 ␣⟩ or __import__('os').getpid()"),
        ("a\u202eb", "a⟨U+202E⟩b"),
        ("a\x1b[2Jb", "a⟨U+001B⟩[2Jb"),
        ("a\u200bb\ufeff", "a⟨U+200B⟩b⟨U+FEFF⟩"),
        ("x\u3000" + "\u3000" * 20, "x ⟨21 ␣⟩ "),
        ("if a:\n        b = 1", "if a:\n        b = 1"),
        ("Grüße, 日本, نیم‌فاصله, 👩‍👧", "Grüße, 日本, نیم‌فاصله, 👩‍👧"),
    ],
)
def test_what_cannot_be_seen_has_signs(text: str, told: str) -> None:
    assert plainly(text) == told


@pytest.mark.parametrize(
    ("block", "written", "kept"),
    [
        ("code.value", "  1 ", "1"),
        ("code.value", HIDDEN + "   ", HIDDEN),
        ("code.lines", "\n\n  \nx = 1  \n\n", "x = 1"),
        ("code.lines", "if x:\n    y = 2\n\n", "if x:\n    y = 2"),
    ],
)
def test_python_is_trimmed_when_a_file_is_read(language, block: str, written: str, kept: str):
    editor = build(language, [B("event.started"), B("control.wait"), B("code.lines")])
    data = json.loads(to_bytes(editor.project))
    found = next(one for one in data["blocks"] if one["type"] == "code.lines")
    found["fields"] = {"code": written}
    if block == "code.value":
        wait = next(one for one in data["blocks"] if one["type"] == "control.wait")
        stack = data["pages"]["behaviour"][0]["body"]
        stack.remove(found["id"])
        wait["inputs"], found["type"] = {"seconds": found["id"]}, block

    project = from_bytes(json.dumps(data).encode(), "a.nep", language)

    assert project.blocks[found["id"]].fields["code"] == kept
    assert (
        from_bytes(to_bytes(project), "a.nep", language).blocks[found["id"]]
        == (project.blocks[found["id"]])
    )


@pytest.mark.parametrize(
    "text",
    [
        *(HIDDEN, "__import__('os')", "().__class__", "1 if 1 else 2", "[1][0]", "lambda: 1"),
        *("1;2", "1#", "open('x')", "pi.real", "e()", "True", "'a'*3", "1 or 2", "x:=1", "f'{1}'"),
        *("9**9**9", "round(1, ndigits=2)", "max(*[1,2])", "1_000", "0x10", "1j", "abs(-1).real"),
        *("1\u202e2", "1\x002", "1\n+2", "1\u3000or 2"),
    ],
)
def test_a_number_field_takes_arithmetic_only(text: str) -> None:
    with pytest.raises(ArithmeticRefused):
        calculate(text)


@pytest.mark.parametrize(
    ("text", "sign"),
    [
        ("1" + "\t" * 300 + "or evil()", "300"),
        ("1" + "\u202f" * 30 + "or evil()", "30"),
        ("x = 1;\u3164 = 2", "U+3164"),
        ("s = 'a\U000e0101\U000e0102\U000e0103'", "U+E0103"),
        ("s = '\u845b\U000e0100\U000e0101'", "U+E0101"),
        ("s = 'a" + "\u0301" * 200 + "'", "U+0301"),
    ],
)
def test_letters_that_hide_what_stands_behind_or_in_them_have_signs(text: str, sign: str) -> None:
    assert sign in plainly(text)
    assert plainly(plainly(text)) == plainly(text)


@pytest.mark.parametrize(
    "text",
    [
        "\u2764\ufe0f 1\ufe0f\u20e3",  # a heart and a key
        "\U0001f468\u200d\U0001f469\u200d\U0001f467",  # a family
        "\u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645",  # Persian
        "\u845b\U000e0100",  # one look of a Japanese letter
        *("e\u0301\u0323", "\ud55c\uad6d\uc5b4", "x\ty"),
    ],
)
def test_letters_of_people_have_none(text: str) -> None:
    assert plainly(text) == text


def test_empty_lines_behind_which_nobody_looks_are_counted() -> None:
    told = plainly_and_short("x = 1\n" + "\n" * 800 + "evil()\n\n\ny = 2")

    assert told == "x = 1\n⟨800 ↵⟩\nevil()\n\n\ny = 2"


def test_a_name_that_cannot_be_seen_is_refused() -> None:
    with pytest.raises(CodeTextRefused):
        read_lines("\u3164 = 1")
