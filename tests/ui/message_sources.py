"""Collects from the sources the templates of all that is told to a person, window or not."""

from __future__ import annotations

import ast
import gc
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

from message_parts import OF_THE_SYSTEM, PARTS

from nep_studio import paths

ROOT = Path(paths.__file__).parent.parent
SOURCES = (
    "faults/*.py",
    "nep_studio/**/*.py",
    "nep_core/**/*.py",
    "nodes/**/*.py",
    "robots/**/*.py",
)
"""Where checks, refusals, errors and nodes say what they have to say."""

LEFT_OUT = (
    # Errors of those who write block packs, translations and themes: these are told in English.
    "nep_studio/blocks/definitions.py",
    "nep_studio/blocks/definition_files.py",
    "nep_studio/blocks/edits/history.py",
    "nep_studio/blocks/editor.py",
    "nep_studio/blocks/definitions.py",
    "nep_studio/blocks/language.py",
    "nep_studio/ui/theme/colours.py",
    "nep_studio/ui/theme/icons.py",
)
NOT_SHOWN = (
    # What is written into files and terminals.
    "nep_core/cli/",
    "nep_core/networks/gateway/",
    "nep_core/recordings/",
    "nep_studio/__main__.py",
    "nep_studio/commands/",
    "nep_studio/help/",
    "nep_studio/run/python_file.py",
    "nep_studio/support/report.py",
    "nep_studio/ui/shell/show_command.py",
    "nep_studio/ui/shell/window_picture.py",
    "nodes/perceptual/recognition/command.py",
    "robots/naoqi/wire/service.py",  # as FROM_NAOQI
)
STILL_SAID = {
    "This place takes {noun}, not a value that is typed.",
    "“{value}” is not one of: {offered}.",
}
"""What of these a person can meet."""
IN_A_TERMINAL = {
    "  Everyday movement: not checked, no such recording was given.",
    " minutes.",
    " times or more: it will be recognised better.",
    ": not checked. To check it, record each gesture at least twice.",
}
"""What a file whose sentences are shown prints beside."""

FROM_NAOQI = {
    "Can't find pending service #{number}",
    "Cannot find service '{name}' in index",
    "Unregister Service: Can't find service #{number}",
    "updateServiceInfo: Can't find service #{number}",
    'Service "{name}" (#{number}) is already registered. '
    "Rejecting conflicting registration attempt.",
}
"""What the robot on the screen answers to programs of others, in NAOqi's own words."""

TELLING = (ast.Expr, ast.Constant, ast.ClassDef, ast.Call, ast.keyword, ast.Assign, ast.AnnAssign)
"""The parts of a source that can tell something."""

FOR_PROGRAMMERS = ("ValueError", "TypeError")
OF_THE_WINDOW = {
    "tr": slice(0, 1),
    "count_words": slice(1, 3),
    "NewAction": slice(1, 2),
    "NewPanel": slice(1, 2),
    "add": slice(1, 2),  # of ``Actions``
    "add_side_panel": slice(1, 2),
    "explained": slice(1, 2),
    "_tool": slice(0, 1),  # buttons of panels
    "WordsButton": slice(0, 1),
    "Section": slice(0, 1),  # of the panel “Person”
    "add_menu": slice(1, 2),
    "_submenu": slice(3, 4),
    "_heading": slice(0, 1),
    "hint": slice(0, 1),
    "EmptyHint": slice(1, 2),
    "label_of": slice(0, 1),
    "labelled": slice(0, 1),
    "labelled_items": slice(1, None),
    "quiet_button": slice(0, 1),
}
"""What is given to these, in these places, stands in the part [window] of a table."""

OF_THE_WINDOW_BY_NAME = {
    "NewAction": ("words", "tip"),
    "NewPanel": ("title",),
    "add": ("words", "tip"),
    "_tool": ("tip",),
    "_add": ("words", "tip"),  # of the tools of the panel “Sensors”
    "WordsButton": (),
    "explained": (),
    "labelled": ("text", "title", "window_title", "tip", "name", "description", "placeholder"),
}
"""The same, of what they are given by name; all the rest stands in [messages]."""

TEMPLATES = {
    "Text": 0,
    "text_of": 0,
    "fault_of": 0,
    "told": 0,
    "advise": 0,
    "warn": 0,
    "ready": 0,
    "state": 1,
    "refuse": 0,
    "Connection": 1,
    "one_of": 2,
}
"""What takes a template, beside errors, and in which place."""

NO_SENTENCES = re.compile(
    r"Made with NEP Studio|^[^A-Za-z]*$|^(\{\w+\}[.:]? ?)+\.?$|^range\(|^  \[ \] |^ - |^# |^\(#"
)
ENDINGS = re.compile(r"[.?]$|\{(reason|sentence|fault|description|why)\}$")
CLASS = re.compile(r"^[ \t]*class (\w+)\(([^)]*)\):", re.MULTILINE)
ROOMS = ("faults", "nep_core", "nodes", "nep_studio", "robots")


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
    """Every template of the sources; the places to be filled in have names."""
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
            if not path.relative_to(ROOT).as_posix().startswith(NOT_SHOWN):
                yield path


@cache
def errors(*families: str) -> frozenset[str]:
    """The names of all errors that tell something, or of those of some families."""
    found = set(families or ("FaultError",))
    paths = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]
    told = (found for path in paths for found in CLASS.findall(path.read_text("utf-8")))
    classes = [(name, set(re.findall(r"\w+", parents))) for name, parents in told]
    while new := {name for name, parents in classes if found & parents} - found:
        found |= new
    return frozenset(found)


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
    labels = {id(text) for node in nodes for text in _texts_of_labels(node)}
    constants = dict(_constants(nodes))
    is_said = place not in LEFT_OUT
    for node in in_order(nodes):
        told = () if id(node) in labels else given_to_tell(node)
        given = [words for one in told for words in literals(one, constants)]
        words = "" if id(node) in silent else literal(node)
        is_sentence = " " in words and ENDINGS.search(words)
        for said in [*given, *([words] if is_sentence else [])]:
            is_shown = said in STILL_SAID or (is_said and said not in IN_A_TERMINAL | FROM_NAOQI)
            if is_shown and not NO_SENTENCES.search(said):
                yield said


def in_order(nodes: Iterable[ast.AST]) -> list[ast.AST]:
    """Parts of a file from its beginning to its end."""
    return sorted(nodes, key=lambda node: (node.lineno, node.col_offset))


def _silent(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, what is logged or told to programmers, words of tr(), parts of others."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        yield node.value
    elif isinstance(node, ast.Call):
        if _is_log(node.func) or _name(node.func) in ("tr", "count_words", *FOR_PROGRAMMERS):
            yield from ast.walk(node)
        for words in words_of_window(node):
            yield from ast.walk(words)
        if last_name(node.func) == "compile":
            yield from ast.walk(node)
    elif isinstance(node, ast.keyword) and node.arg == "details":
        yield from ast.walk(node)


def words_of_window(call: ast.Call) -> list[ast.expr]:
    """What a call puts on the window, in the language of the person."""
    name = last_name(call.func)
    by_name = OF_THE_WINDOW_BY_NAME.get(name, ())
    named = [keyword.value for keyword in call.keywords if keyword.arg in by_name]
    return [*call.args[OF_THE_WINDOW.get(name, slice(0, 0))], *named]


def _texts_of_labels(node: ast.AST) -> Iterator[ast.AST]:
    """The templates with values that are on the window: they are not told as messages."""
    is_label = isinstance(node, ast.Call) and last_name(node.func) not in ("tr", "count_words")
    if is_label:
        for words in words_of_window(node):
            yield from ast.walk(words)


def given_to_tell(node: ast.AST) -> Iterator[ast.expr]:
    """What a part of a source gives as a template to what tells it to a person."""
    if isinstance(node, ast.ClassDef):
        yield from (one.value for one in node.keywords if one.arg == "title")
        for line in node.body:
            is_set = isinstance(line, ast.Assign | ast.AnnAssign) and line.value is not None
            if is_set and ast.unparse(_target(line)) == "title":
                yield line.value
    elif isinstance(node, ast.Call):
        name = last_name(node.func)
        if name == "Fix":
            yield node.args[1]
        elif name == "Problem":
            yield from node.args[:2]
        elif name == "Diagnostic":
            yield from node.args[4:5]
        elif name == "Sort":
            yield from node.args[1:2]
        elif name in errors():
            yield from node.args[:1]
        elif name in TEMPLATES and not _is_log(node.func):
            yield from node.args[TEMPLATES[name] :][:1]
    elif isinstance(node, ast.keyword) and node.arg == "checklist":
        yield from node.value.elts if isinstance(node.value, ast.Tuple | ast.List) else ()


def _constants(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, ast.expr]]:
    for node in nodes:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            target = _target(node)
            if isinstance(target, ast.Name) and target.id.isupper():
                yield target.id, node.value


def _target(node: ast.Assign | ast.AnnAssign) -> ast.expr:
    return node.targets[0] if isinstance(node, ast.Assign) else node.target


def literals(node: ast.expr, constants: Mapping[str, ast.expr]) -> Iterator[str]:
    """The texts that an argument can be: one, one of several, or a constant of the file."""
    match node:
        case ast.IfExp(body=body, orelse=orelse):
            yield from literals(body, constants)
            yield from literals(orelse, constants)
        case ast.BoolOp(values=values):
            for value in values:
                yield from literals(value, constants)
        case ast.Name(id=name) if name in constants:
            yield from literals(constants[name], {})
        case ast.Call(func=function, args=[first, *_]) if last_name(function) in TEMPLATES:
            yield from literals(first, constants)
        case ast.Constant(value=str(words)) if words:
            yield words


def literal(node: ast.AST) -> str:
    """A text that stands there; nothing for anything else."""
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return node.value if is_text else ""


def _is_log(function: ast.expr) -> bool:
    return isinstance(function, ast.Attribute) and _name(function.value) == "log"


def _name(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def last_name(node: ast.expr) -> str:
    """What a function or a class is called, without where it is from."""
    return node.attr if isinstance(node, ast.Attribute) else _name(node)


@cache
def filled_too_early() -> tuple[str, ...]:
    """Where a template has its values already: nobody could find its translation."""
    return tuple(
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path, nodes in parsed(files())
        for node in nodes
        for told in given_to_tell(node)
        if isinstance(told, ast.JoinedStr)
    )


@cache
def unfilled() -> tuple[str, ...]:
    """Where a template with places is given without the values of all of them."""
    return tuple(
        f"{path.relative_to(ROOT)}:{node.lineno} {words}"
        for path, nodes in parsed(files())
        for node, named in _calls(nodes)
        if all(keyword.arg for keyword in node.keywords)
        for words in _templates_of(node, named)
        if set(re.findall(r"\{(\w+)\}", words)) - {keyword.arg for keyword in node.keywords}
    )


def _calls(nodes: Iterable[ast.AST]) -> Iterator[tuple[ast.Call, dict[str, ast.expr]]]:
    """All calls, those in a function with the texts that have a name there."""
    for place in nodes:
        if isinstance(place, ast.Module | ast.FunctionDef | ast.AsyncFunctionDef):
            parts = list(ast.walk(place))
            given = () if isinstance(place, ast.Module) else parts
            assigned = [part for part in given if isinstance(part, ast.Assign)]
            named = {_name(part.targets[0]): part.value for part in assigned if literal(part.value)}
            yield from ((part, named) for part in parts if isinstance(part, ast.Call))


def _templates_of(call: ast.Call, named: Mapping[str, ast.expr]) -> Iterator[str]:
    """The templates of a call that takes their values by name."""
    name = last_name(call.func)
    if name in (*OF_THE_WINDOW, *TEMPLATES, *errors()) and name not in (
        "Text",
        "told",
        "Connection",
        "one_of",
    ):
        at = TEMPLATES.get(name, 0)
        for argument in call.args[at : at + 1]:
            if not any(isinstance(part, ast.Call) for part in ast.walk(argument)):
                yield from literals(argument, named)
