"""Collects from the sources the sentences that reach the window with their values filled in."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from nep_studio import paths

ROOT = Path(paths.__file__).parent.parent
SOURCES = (
    "nep_studio/blocks/**/*.py",
    "nep_studio/node_checks.py",
    "nep_studio/problems.py",
    "nep_studio/own_master.py",
    "nep_studio/ui/documents_opening.py",
    "nep_studio/ui/canvas/fields/*.py",
    "nep_core/manifest.py",
    "nep_core/errors.py",
    "nep_core/process.py",
    "nep_core/launcher.py",
    "nep_core/node_name.py",
)
"""Where checks, refusals and errors say what they have to say."""

LEFT_OUT = (
    "definition_call.py",
    "definition_files.py",
    "definitions.py",
    "history.py",
    "profile.py",
    "sentence.py",
    "translation.py",
)
"""Errors of those who write block packs and translations: these are told in English."""
STILL_SAID = {"This place takes {noun}, not a value that is typed."}
"""What of these a person can meet."""

NO_SENTENCES = re.compile(r"Made with NEP Studio|^[^A-Za-z]*$|^\{\w+\}\. ?$|^range\(")
ENDINGS = re.compile(r"[.?]$|\{(reason|sentence|fault)\}$")
PARTS = {
    "nep_studio/blocks/values.py": [
        "nothing",
        "the number {value}",
        "a very large number",
        "the text {value}",
        "a list or a group of values",
    ],
    "nep_studio/blocks/file_text.py": [
        " at line {number}",
        " at line {line}, block {block}",
        " at block {block}",
        "its beginning",
        "a whole number",
        "a group of values",
        "at {place}: “{missing}” is missing.",
        "at {place}: this is not what belongs here.",
        "at {place}: {wanted} belongs here, not {told}.",
    ],
    "nep_studio/blocks/reading.py": ["in no stack", "inside itself"],
    "nep_studio/blocks/files.py": [
        "the system gives no reason",
        "a text in it cannot be written",
    ],
    "nep_studio/blocks/own_block_changes.py": ["1 place", "{count} places"],
    "nep_studio/blocks/operations/copying.py": ["The clipboard"],
    "nep_studio/blocks/checks/flow.py": ["A robot cannot walk after the posture “{label}”."],
    "nep_core/manifest.py": [
        'a text, such as "karate"',
        "a number, such as 0.5",
        "a whole number, such as 50",
        "true or false",
        "one of the choices",
        "the name of a file",
        'The node {id} needs the setting "{name}": {help}',
    ],
}
"""What is put together from pieces: no one text of the source has all of it."""
OF_THE_SYSTEM = ["no such file or directory", "permission denied", "no space left on device"]
"""Why a file cannot be opened, as the operating system says it."""


@cache
def templates() -> frozenset[str]:
    """Every sentence of the sources, with a readable name at each place that is filled in."""
    found = {words for path in _files() for words in _of_file(path)}
    return frozenset(found.union(*PARTS.values(), OF_THE_SYSTEM))


def _files() -> Iterator[Path]:
    for pattern in SOURCES:
        yield from sorted(ROOT.glob(pattern))


def _of_file(path: Path) -> Iterator[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    silent = {id(part) for node in ast.walk(tree) for part in _silent(node)}
    for node in ast.walk(tree):
        yield from filter(None, map(template, _told(node)))
    for node in ast.walk(tree):
        words = "" if id(node) in silent else template(node)
        is_said = path.name not in LEFT_OUT or words in STILL_SAID
        is_sentence = " " in words and ENDINGS.search(words) and not NO_SENTENCES.search(words)
        if is_said and is_sentence:
            yield words


def _silent(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, what is logged or told to programmers, words of tr(), parts of others."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield from (part for part in ast.walk(node) if part is not node)
    elif isinstance(node, ast.Call):
        name = ast.unparse(node.func)
        if name.startswith("log.") or name in ("tr", "count_words", "ValueError", "TypeError"):
            yield from ast.walk(node)
    elif isinstance(node, ast.keyword) and node.arg == "details":
        yield from ast.walk(node)


def _told(node: ast.AST) -> Iterator[ast.AST]:
    """Titles of errors and labels of fixes."""
    if isinstance(node, ast.ClassDef):
        for line in node.body:
            if isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "title":
                yield line.value
    elif isinstance(node, ast.Call) and ast.unparse(node.func) == "Fix":
        yield node.args[1]


def template(node: ast.AST) -> str:
    """The words of a text or of an f-string; nothing for anything else."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if not isinstance(node, ast.JoinedStr):
        return ""
    names: list[str] = []
    words = ""
    for part in node.values:
        if isinstance(part, ast.Constant):
            words += part.value
        elif isinstance(part, ast.FormattedValue):
            name = base = place_name(part.value)
            times = 1
            while name in names:
                times += 1
                name = f"{base}_{times}"
            names.append(name)
            words += f"{{{name}}}"
    return words


def place_name(node: ast.expr) -> str:
    """What is filled in, in a word: ``entry.name`` is a name, ``sentence(...)`` a block."""
    match node:
        case ast.Name(id=name):
            return name.strip("_").lower()
        case ast.Attribute(attr=name):
            return name.strip("_").lower()
        case ast.Call(func=ast.Name(id="sentence")):
            return "block"
        case ast.Call(func=ast.Name(id="_name")):
            return "own_block"
        case ast.Call(func=ast.Attribute(attr="join"), args=[only]):
            return place_name(only)
        case ast.Call(func=ast.Attribute(attr="title" | "rstrip", value=owner)):
            return place_name(owner)
        case ast.Call(func=ast.Attribute(attr="unparse")):
            return "code"
        case ast.Call(func=ast.Name(id="len"), args=[_]):
            return "count"
        case ast.Call(func=function):
            return place_name(function)
        case ast.Subscript(value=ast.Name(id=name), slice=index) if name.isupper():
            return place_name(index)
        case ast.Subscript(value=value) | ast.BinOp(left=value) | ast.BoolOp(values=[value, *_]):
            return place_name(value)
        case ast.IfExp(body=body):
            return place_name(body)
        case _:
            return "what"
