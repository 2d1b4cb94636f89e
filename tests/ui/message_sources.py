"""Collects from the sources the sentences that reach the window with their values filled in."""

from __future__ import annotations

import ast
import gc
import re
import tomllib
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from message_parts import OF_THE_SYSTEM, PARTS

from nep_studio import paths

ROOT = Path(paths.__file__).parent.parent
SOURCES = (
    "nep_studio/*.py",
    "nep_studio/blocks/**/*.py",
    "nep_studio/ui/**/*.py",
    "nep_core/*.py",
    "nep_core/over_zenoh/*.py",
    "nep_core/security/*.py",
    "nodes/**/*.py",
)
"""Where checks, refusals, errors and nodes say what they have to say."""

LEFT_OUT = (
    # Errors of those who write block packs, translations and themes: these are told in English.
    "nep_studio/blocks/definitions.py",
    "nep_studio/blocks/definition_files.py",
    "nep_studio/blocks/definitions.py",
    "nep_studio/blocks/edits/history.py",
    "nep_studio/blocks/editor.py",
    "nep_studio/blocks/definition_files.py",
    "nep_studio/blocks/sentence.py",
    "nep_studio/blocks/language.py",
    "nep_studio/ui/theme/colours.py",
    "nep_studio/ui/theme/icons.py",
)
NOT_SHOWN = (
    # What is written into files and terminals.
    "nep_studio/__main__.py",
    "nep_studio/run/python_file.py",
    "nep_studio/support/report.py",
    "nep_studio/support/report.py",
    "nep_studio/support/report.py",
    "nep_studio/ui/shell/show_command.py",
    "nep_studio/ui/shell/window_picture.py",
    "nep_core/networks/zenoh_session.py",
    "nep_core/recordings/file.py",
    "nep_core/recordings/player.py",
    "nep_core/recordings/recorder.py",
    "nodes/perceptual/recognition/command.py",
    "nodes/perceptual/recognition/training.py",
    # What the robot on the screen answers to programs of others, in the language of NAOqi.
    "robots/naoqi/server/directory.py",
    "robots/naoqi/wire/service.py",
)
STILL_SAID = {"This place takes {noun}, not a value that is typed."}
"""What of these a person can meet."""

TELLING = (ast.Expr, ast.Constant, ast.JoinedStr, ast.ClassDef, ast.Call, ast.keyword)
"""The parts of a source that can tell something."""

FOR_PROGRAMMERS = ("ValueError", "TypeError")
STATES = {"ready": 0, "warn": 0, "state": 1, "Connection": 1}
"""Where nodes tell how they are doing: which argument; these sentences need no full stop."""

NO_SENTENCES = re.compile(
    r"Made with NEP Studio|^[^A-Za-z]*$|^(\{\w+\}[.:]? ?)+\.?$|^range\(|^  \[ \] |^ - |^# "
)
ENDINGS = re.compile(r"[.?]$|\{(reason|sentence|fault|description|why)\}$")


def parsed(paths: Iterable[Path]) -> Iterator[tuple[Path, list[ast.AST]]]:
    """The parts of files, without order; the collector would look through millions of them."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        for path in paths:
            yield path, list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    finally:
        if was_enabled:
            gc.enable()


@cache
def templates() -> frozenset[str]:
    """Every sentence of the sources, with a readable name at each place that is filled in."""
    return frozenset(templates_in_order())


@cache
def templates_in_order() -> tuple[str, ...]:
    """The same, in the order of the sources, so that what belongs together stays together."""
    found = [words for path, nodes in parsed(files()) for words in _of_file(path, nodes)]
    found += [words for told in PARTS.values() for words in told]
    return tuple(dict.fromkeys([*found, *_of_manifests(), *OF_THE_SYSTEM]))


def files() -> Iterator[Path]:
    """The files that say something to a person."""
    for pattern in SOURCES:
        for path in sorted(ROOT.glob(pattern)):
            if path.relative_to(ROOT).as_posix() not in NOT_SHOWN:
                yield path


def _of_manifests() -> Iterator[str]:
    """What the nodes' own descriptions say of them."""
    for path in sorted((ROOT / "nodes").glob("*/*.toml")):
        manifest = tomllib.loads(path.read_text(encoding="utf-8"))
        parameters = manifest.get("parameters", {}).values()
        yield from (manifest["title"], manifest["description"])
        yield from (one["help"] for one in parameters if one.get("help"))


def _of_file(path: Path, nodes: list[ast.AST]) -> Iterator[str]:
    place = path.relative_to(ROOT).as_posix()
    nodes = [node for node in nodes if isinstance(node, TELLING)]
    silent = {id(part) for node in nodes for part in _silent(node)}
    for node in in_order(nodes):
        yield from filter(None, map(template, _told(node)))
        words = "" if id(node) in silent else template(node)
        is_said = place not in LEFT_OUT or words in STILL_SAID
        is_sentence = " " in words and ENDINGS.search(words) and not NO_SENTENCES.search(words)
        if is_said and is_sentence:
            yield words


def in_order(nodes: Iterable[ast.AST]) -> list[ast.AST]:
    """Parts of a file from its beginning to its end."""
    return sorted(nodes, key=lambda node: (node.lineno, node.col_offset))


def _silent(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, what is logged or told to programmers, words of tr(), parts of others."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield from (part for part in ast.walk(node) if part is not node)
    elif isinstance(node, ast.Call):
        if _is_log(node.func) or _name(node.func) in ("tr", "count_words", *FOR_PROGRAMMERS):
            yield from ast.walk(node)
    elif isinstance(node, ast.keyword) and node.arg == "details":
        yield from ast.walk(node)


def _told(node: ast.AST) -> Iterator[ast.AST]:
    """Titles of errors and problems, labels of fixes, states of nodes."""
    if isinstance(node, ast.ClassDef):
        for line in node.body:
            if isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "title":
                yield line.value
    elif isinstance(node, ast.Call):
        name = last_name(node.func)
        if name == "Fix":
            yield node.args[1]
        elif name == "Problem" and node.args and " " in template(node.args[0]):
            yield node.args[0]
        elif name in STATES:
            yield from node.args[STATES[name] :][:1]
    elif isinstance(node, ast.keyword) and node.arg == "checklist":
        yield from node.value.elts if isinstance(node.value, ast.Tuple) else ()


def _is_log(function: ast.expr) -> bool:
    return isinstance(function, ast.Attribute) and _name(function.value) == "log"


def _name(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def last_name(node: ast.expr) -> str:
    """What a function or a class is called, without where it is from."""
    return node.attr if isinstance(node, ast.Attribute) else _name(node)


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
        case ast.Attribute(attr="strerror"):
            return "reason"
        case ast.Attribute(attr=name):
            return name.strip("_").lower()
        case ast.Call(func=ast.Name(id="sentence")):
            return "block"
        case ast.Call(func=ast.Name(id="_name")):
            return "own_block"
        case ast.Call(func=ast.Attribute(attr="join"), args=[only]):
            return place_name(only)
        case ast.Call(func=ast.Attribute(attr="title" | "rstrip" | "lower", value=owner)):
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
