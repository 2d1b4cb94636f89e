"""Every table of translations has every word of the window and of the steps that undo names."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import pytest
from message_sources import (
    OF_THE_SYSTEM,
    PARTS,
    ROOT,
    filled_too_early,
    last_name,
    parsed,
    templates,
    unfilled,
    words_of_window,
)

from nep_studio import paths
from nep_studio.blocks.slots import KINDS
from nep_studio.project.examples import examples
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.fields.editors import slot_name
from nep_studio.ui.theme.colours import load_theme, themes

TABLES = sorted((paths.resources() / "translations").glob("*.toml"))
STUDIO = Path(paths.__file__).parent
SOURCES = sorted(STUDIO.rglob("*.py"))

SHOWN = {
    "transaction": slice(0, 1),
    "apply": slice(1, 2),
    "_label": slice(3, 5),  # "Undo" and "Undo “{step}”" of ui/shell/menus.py
    "Fix": slice(1, 2),
    "change": slice(0, 1),  # of the trainer's desk: the label of a step
}
"""Functions whose words are shown besides ``OF_THE_WINDOW``: which arguments."""

NAMED = {
    "blocks/slots.py": "COLOURS",
    "ui/canvas/fields/editors.py": "_BUTTON_TIPS",
    "blocks/operations/wrapping.py": "LABELS",
    "run/timeline.py": "EVENT_WORDS",
    "ui/workbench/problems.py": "SEVERITIES",
    "ui/workbench/palette/levels.py": "LEVELS",
    "ui/shell/commands.py": "NOT_NOW",
    "ui/shell/gallery.py": "NEEDS DIFFICULTIES TAGS",
    "ui/running/actions.py": "PACES RUN_WORDS STATE_WORDS",
    "ui/shell/settings_dialog.py": "FOLDERS FOLDER_BUTTONS",
    "ui/plugins/cues/arranging.py": "COLOURS",
    "ui/plugins/gestures/project_gestures.py": "LABELS",
    "ui/plugins/motion/commands.py": "LOOKS",
    "ui/plugins/network/sending.py": "SENT NO_NETWORK",
    "ui/plugins/person/senses.py": "PUSHES SOUNDS",
    "ui/plugins/robots/stage_tools.py": "KIND_WORDS VIEWS",
}
"""Data whose words are given to tr() or put on the window one by one."""


def literals(node: ast.expr) -> Iterator[str]:
    """The texts that an argument can be: one, or one of two."""
    if isinstance(node, ast.IfExp):
        yield from literals(node.body)
        yield from literals(node.orelse)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value


def words_in(data: object) -> Iterator[str]:
    if isinstance(data, str):
        if not data.startswith("#"):
            yield data
    elif isinstance(data, dict):
        for value in data.values():
            yield from words_in(value)
    elif isinstance(data, list | tuple):
        for value in data:
            yield from words_in(value)


@dataclass
class Found:
    """What the sources of the program give to the functions that show words."""

    shown: set[str] = field(default_factory=set)
    of_edits: set[str] = field(default_factory=set)
    of_blocks: set[str] = field(default_factory=set)
    filled: list[str] = field(default_factory=list)
    """Where words have their values already when they are to be translated."""


@cache
def found_in_sources() -> Found:
    found = Found()
    for path, nodes in parsed(SOURCES):
        for node in nodes:
            if isinstance(node, ast.Call):
                of_call(found, path, node)
            elif path.parent.name == "edits" and is_label(node):
                found.of_edits.update(literals(node.value))
    return found


def is_label(node: ast.AST) -> bool:
    is_given = isinstance(node, ast.AnnAssign) and node.value is not None
    return is_given and ast.unparse(node.target) == "label"


def of_call(found: Found, path: Path, node: ast.Call) -> None:
    name = last_name(node.func)
    on_window = [one for argument in words_of_window(node) for one in templates_of(argument)]
    for argument in [*on_window, *(node.args[SHOWN[name]] if name in SHOWN else ())]:
        found.shown.update(literals(argument))
    if any(isinstance(argument, ast.JoinedStr) for argument in on_window):
        found.filled.append(f"{path.relative_to(STUDIO)}:{node.lineno}")
    is_asked = name == "word" or (name == "get" and ast.unparse(node.func) == "words.get")
    if is_asked and node.args and "blocks" in path.relative_to(STUDIO).parts:
        found.of_blocks.update(literals(node.args[0]))


def templates_of(argument: ast.expr) -> Iterator[ast.expr]:
    """What stands in the sources for words that may have values: their templates."""
    if isinstance(argument, ast.IfExp):
        yield from (*templates_of(argument.body), *templates_of(argument.orelse))
    else:
        is_filled = isinstance(argument, ast.Call) and last_name(argument.func) == "text_of"
        yield argument.args[0] if is_filled else argument


def words_of_data() -> Iterator[str]:
    for place, name in NAMED.items():
        tree = ast.parse((STUDIO / place).read_text(encoding="utf-8"))
        for node in tree.body:
            if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if ast.unparse(targets[0]) in name.split():
                    yield from words_in(ast.literal_eval(node.value))


def words_of_slots() -> Iterator[str]:
    for definition in studio_language().definitions.values():
        yield from (slot_name(slot) for slot in definition.slots.values())
    for kind in KINDS.values():
        yield from (kind.noun, kind.hint, kind.unit if kind.unit.isalpha() else "")


def words_of_examples() -> Iterator[str]:
    """What the gallery says of the examples, which is told in resources/examples/examples.toml."""
    for example in examples():
        yield from example.words()


@cache
def window_words() -> set[str]:
    titles = {load_theme(name).title for name in themes()}
    sources = found_in_sources()
    found = {*sources.shown, *sources.of_edits, *words_of_data(), *words_of_slots(), *titles}
    found.update(words_of_examples())
    return {words for words in found if words.strip()}


def block_words() -> set[str]:
    """What the sentences of blocks take from ``Language.words``."""
    return found_in_sources().of_blocks


def places(words: str) -> list[str]:
    return sorted(re.findall(r"\{[^{}]*\}", words))


@cache
def read_table(path: Path) -> dict:
    return tomllib.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(params=TABLES, ids=lambda path: path.stem)
def table(request: pytest.FixtureRequest) -> dict:
    return read_table(request.param)


def test_the_words_of_the_window_are_found() -> None:
    found = window_words()

    assert {"Undo", "1 block", "{n} blocks", "move a stack", "tidy up", "sky blue", "a number"} <= (
        found
    )
    assert {"define", "all robots", "on"} <= block_words()


def test_no_words_are_filled_in_before_they_are_translated() -> None:
    assert found_in_sources().filled == []
    assert filled_too_early() == ()


def test_every_place_of_a_template_is_given_a_value() -> None:
    assert unfilled() == ()


def test_a_table_has_all_words_of_the_window(table) -> None:
    missing = window_words() - table.get("window", {}).keys()

    assert sorted(missing) == []


def test_a_table_has_no_words_that_nobody_shows(table) -> None:
    unknown = table.get("window", {}).keys() - window_words()

    assert sorted(unknown) == []


def test_a_translation_has_the_places_of_the_english_words(table) -> None:
    wrong = [w for w, told in table.get("window", {}).items() if places(w) != places(told)]

    assert wrong == []


def messages() -> set[str]:
    """The sentences of problems, refusals and errors, with places for their values."""
    return {words for words in templates() if words not in window_words() or places(words)}


def test_the_sentences_of_checks_and_refusals_are_found() -> None:
    found = messages()

    assert {
        "Nothing recognises the gesture “{gesture}” yet.",
        "This place needs {noun}, and “{block_name}” gives {result}.",
        "{file_name} is not a NEP Studio project.",
        "Choose “{choice}”",
        "This project cannot be used",
    } <= found


def test_what_is_put_together_from_pieces_is_still_in_the_sources() -> None:
    gone = [
        (place, piece)
        for place, told in PARTS.items()
        for piece in (re.split(r"\{\w+\}", words) for words in told)
        if not any(part.strip(" .,:“”") in (ROOT / place).read_text("utf-8") for part in piece)
    ]

    assert gone == []
    assert all(words.islower() for words in OF_THE_SYSTEM)


def test_a_table_has_exactly_the_sentences_of_checks_and_refusals(table) -> None:
    told = table.get("messages", {})

    assert sorted(messages() - told.keys()) == []
    assert sorted(told.keys() - messages()) == []


def test_a_sentence_has_the_places_of_the_english_one_and_is_not_empty(table) -> None:
    wrong = [w for w, told in table.get("messages", {}).items() if places(w) != places(told)]

    assert wrong == []
    assert all(told.strip() for told in table.get("messages", {}).values())


def test_no_translation_is_empty_and_each_table_has_a_name(table) -> None:
    empty = [words for words, told in table.get("window", {}).items() if not told.strip()]

    assert empty == []
    assert table["name"].strip()


def test_a_table_has_exactly_the_words_that_sentences_of_blocks_take(table) -> None:
    assert table.get("words", {}).keys() == block_words()


def test_access_keys_of_menus_are_told_in_every_language(table) -> None:
    """A menu that opens with Alt and a letter does so in every language."""
    menus = {words for words in window_words() if re.search(r"&\w", words)}
    told = {words: table.get("window", {}).get(words, "") for words in menus}

    assert [words for words, said in told.items() if not re.search(r"&\w|\(&\w\)", said)] == []
