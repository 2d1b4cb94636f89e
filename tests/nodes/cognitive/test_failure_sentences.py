"""What a person reads when a program has failed, and what it offers to try."""

from __future__ import annotations

import string
from pathlib import Path

import pytest

from nep_core.errors import RobotNotAnswering
from nep_core.program.values import speak
from nodes.cognitive.failures import OTHER, SENTENCES, failure_of, in_spoken_language, line_of

CASES = {
    "1 / 0": "A number was divided by zero.",
    "print(nothing)": 'Something called "nothing" was used before it had a value.',
    'n = 3\n["a", "b"][n - 1]': "An item was asked for that the list does not have.",
    'names = ["a", "b"]\nn = 3\nnames[n - 1]': (
        "The list “names” has 2 items, and item 3 was asked for."
    ),
    'names = ["a", "b"]\nnames[int(9.0) - 1] = 1': (
        "The list “names” has 2 items, and item 9 was asked for."
    ),
    'from nep_core import Variables\nprogram = Variables(my_names=["a"])\nprogram.my_names[4]': (
        "The list “my names” has 1 items, and item 5 was asked for."
    ),
    "from nep_core import Variables\nprogram = Variables(n=1)\nprogram.n += 'a'": (
        'This cannot be worked out: 1 + "a". On the left is a number, on the right a text.'
    ),
    "from nep_core import Variables\nprogram = Variables(n=1)\nprogram.m + 1": (
        'Something called "m" was used before it had a value.'
    ),
    'names = ["a"]\ndel names[4]': "The list “names” has 1 items, and item 5 was asked for.",
    'names = ["a"]\nnames.pop(4)': "The list “names” has 1 items, and item 5 was asked for.",
    'names = ["a"]\nnames[-3]': (
        "The list “names” has 1 items, and item 3 from the end was asked for."
    ),
    'word = "ab"\nword[7]': "The text “word” has 2 letters, and letter 8 was asked for.",
    '"abc"[9]': "The text “'abc'” has 3 letters, and letter 10 was asked for.",
    '"abc"[int(9.5)]': "The text “'abc'” has 3 letters, and letter 10 was asked for.",
    '"abc".lower()[9]': "A letter was asked for that the text does not have.",
    "list_of_names = []\nlist_of_names[0]": (
        "The list “list of names” has 0 items, and item 1 was asked for."
    ),
    '"50%" % 3': (
        'This cannot be worked out: "50%" % 3. On the left is a text, on the right a number.'
    ),
    '"50" % 3': (
        'This cannot be worked out: "50" % 3. On the left is a text, on the right a number.'
    ),
    '"a b".split("")': "A text is parted at a mark, and this mark is empty.",
    "import random\nrandom.choice([])": "Something was taken from an empty list.",
    "[].pop()": "Something was taken from an empty list.",
    '{}["age"]': "Nothing is kept under the name 'age'.",
    'age = "ten"\nage + 1': (
        'This cannot be worked out: "ten" + 1. On the left is a text, on the right a number.'
    ),
    'age = 10\nage += " years"': (
        'This cannot be worked out: 10 + " years". On the left is a number, on the right a text.'
    ),
    "x = None\nx - 1": (
        "This cannot be worked out: None - 1. On the left is nothing, on the right a number."
    ),
    'str(1) + len("a")': (
        "This cannot be worked out: on the left is a text, on the right a number."
    ),
    'x = "a"\nx > 3': (
        'It cannot be told which is larger, "a" or 3: one is a text, the other a number.'
    ),
    'max("a", 3)': "It cannot be told which is larger: one is a number, the other a text.",
    "for x in 3: pass": "A list belongs here, and this is something else.",
    "len(3)": "A list belongs here, and this is something else.",
    'import math\nmath.sqrt("a")': "A number belongs here, and this is something else.",
    'range("a")': "A number belongs here, and this is something else.",
    "def f(a): pass\nf()": "“f” did not get the values that it needs.",
    "x = 3\nx()": "This was used like a block, but it is a number.",
    'float("ten")': "The text “ten” is not a number.",
    'int("ten")': "The text “ten” is not a number.",
    "import math\nmath.sqrt(-1)": (
        "This has no result for that number, such as the root of a number below zero."
    ),
    "import random\nrandom.randint(5, 1)": (
        "No number lies between the two: the first is larger than the second."
    ),
    "range(1, 5, 0)": "Counting in steps of zero never ends.",
    "[1].index(2)": "The list does not have what was looked for.",
    "max([])": "There is no result for a list that has too few items.",
    "import statistics\nstatistics.mean([])": (
        "There is no result for a list that has too few items."
    ),
    'int(float("nan"))': "A number cannot be written: it is too long, or it is no number at all.",
    "x = 3\nx.jump()": "This has no “jump”: it is a number.",
    "2.0 ** 9999": "A number became too large.",
    "def f(): f()\nf()": "The program called itself too many times.",
    "import no_such_package": "The Python package “no_such_package” is not installed.",
    "from math import no_such": "“no_such” cannot be imported: there is nothing of that name.",
    'open("no such file")': "There is no file “no such file”.",
    "raise SystemExit(3)": "The program ended itself with: 3.",
    "assert False": "AssertionError: AssertionError.",
    'raise ValueError("This one.")': "A value did not fit: This one.",
}


def fail(folder: Path, source: str) -> BaseException:
    file = folder / "program.py"
    file.write_text(source, encoding="utf-8")
    try:
        exec(compile(source, str(file), "exec"), {})
    except BaseException as error:
        return error
    pytest.fail("the program did not fail")


@pytest.mark.parametrize("source", CASES, ids=lambda source: source.replace("\n", "; "))
def test_a_failure_is_told_in_plain_words_with_what_to_try(source: str, tmp_path: Path) -> None:
    failure = failure_of(fail(tmp_path, source))

    assert str(failure.sentence) == CASES[source]
    assert failure.checklist


def test_what_is_not_python_is_told_with_its_line(tmp_path: Path) -> None:
    error = fail(tmp_path, "x = 1\ny = (")

    assert (
        str(failure_of(error).sentence)
        == "The program is not Python that can run: '(' was never closed."
    )
    assert line_of(error, str(tmp_path / "program.py")) == 2


def test_an_error_that_explains_itself_is_told_as_it_is() -> None:
    error = RobotNotAnswering("NAO does not answer.", checklist=("Is it on?",))

    failure = failure_of(error)

    assert str(failure.sentence) == "NAO does not answer."
    assert list(map(str, failure.checklist)) == ["Is it on?"]


def test_no_code_of_the_program_is_run_to_tell_of_its_failure(tmp_path: Path) -> None:
    source = "calls = []\ndef f():\n    calls.append(1)\n    return 'a'\n"
    failing = f"{source}try:\n    f() + 1\nexcept TypeError as error:\n    kept = error\nraise kept"

    error = fail(tmp_path, failing)
    failure_of(error)

    assert error.__traceback__ is not None
    assert error.__traceback__.tb_next is not None
    assert error.__traceback__.tb_next.tb_frame.f_globals["calls"] == [1]


def test_a_value_of_any_length_makes_a_short_sentence(tmp_path: Path) -> None:
    sentence = str(failure_of(fail(tmp_path, 'x = "a" * 9999\nx + 10 ** 9')))
    longer = str(failure_of(fail(tmp_path, "x = 10 ** 9999\ny = 'a'\nx + y")))

    assert len(sentence) < 160
    assert "…" in longer


@pytest.mark.parametrize("told", [*SENTENCES, OTHER], ids=lambda told: told.sentence)
def test_a_sentence_has_named_places_and_a_checklist(told) -> None:
    places = [name for _, name, _, _ in string.Formatter().parse(told.sentence) if name is not None]

    assert all(place.isidentifier() for place in places)
    assert told.steps
    assert all(step[-1] in ".?" for step in (told.sentence, *told.steps))


@pytest.mark.parametrize(
    ("language", "expected"),
    [
        ("en", "A number was divided by zero."),
        ("de", "Eine Zahl wurde durch null geteilt."),
        ("xx", "A number was divided by zero."),
    ],
)
def test_a_program_tells_its_errors_in_its_own_language(language: str, expected: str) -> None:
    speak(language)
    try:
        assert in_spoken_language(failure_of(ZeroDivisionError()).sentence) == expected
    finally:
        speak("en")


def test_values_in_a_sentence_stay_as_they_are() -> None:
    error = RobotNotAnswering("{name} does not answer.", name="NAO {x}")

    assert in_spoken_language(error.sentence) == "NAO {x} does not answer."
