"""Lists every message that the program can show, from its sources, with its checklist."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from message_sources import ROOT, in_order, template

ROOMS = ("nep_core", "nodes", "nep_studio")
NOT_SHOWN = (
    "nep_core/cli/",
    "nep_core/gateway/",
    "nep_core/security/zap.py",
    "nep_studio/commands/",
    "nodes/perceptual/recognition/command.py",
)
"""What is told in a terminal, or to programs."""

PROBLEM_OF_BLOCKS = ("error", "warning", "info")
"""With what a problem that is drawn at a block begins."""

CALM = ("info", "success")
"""Kinds of messages that ask nothing of a person."""


@dataclass(frozen=True)
class Said:
    """A place of the sources that makes a message.

    ``words`` say which one it is; ``texts`` are those of its words that stand there themselves:
    title, sentence, steps.
    """

    place: str
    line: int
    made_by: str
    words: str
    texts: tuple[str, ...]
    has_checklist: bool
    is_question: bool = False
    is_calm: bool = False

    def __str__(self) -> str:
        return f"{self.place}:{self.line} {self.made_by}: {self.words}"


@cache
def trees() -> tuple[tuple[str, ast.Module], ...]:
    """Every file of the program."""
    found = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]
    return tuple((_place(path), ast.parse(path.read_text(encoding="utf-8"))) for path in found)


def _place(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@cache
def errors() -> frozenset[str]:
    """The names of all errors that a person can act on."""
    found = {"NepError", "BlocksError"}
    classes = [node for _, tree in trees() for node in ast.walk(tree) if _is_class(node)]
    while new := {one.name for one in classes if found & set(map(_last, one.bases))} - found:
        found |= new
    return frozenset(found)


def _is_class(node: ast.AST) -> bool:
    return isinstance(node, ast.ClassDef)


@cache
def messages() -> tuple[Said, ...]:
    """Every message, in the order of the sources."""
    return tuple(
        said
        for place, tree in trees()
        if not place.startswith(NOT_SHOWN)
        for said in _of_file(place, tree)
    )


def _of_file(place: str, tree: ast.Module) -> Iterator[Said]:
    asked = {id(node.args[0]) for node in ast.walk(tree) if _asks(node)}
    for node in in_order(tree):
        if not isinstance(node, ast.Call):
            continue
        name = _last(node.func)
        arguments = _arguments(node, name)
        if arguments is None:
            continue
        kind, words, checklist = arguments
        yield Said(
            place,
            node.lineno,
            name,
            " | ".join(filter(None, map(_words, words))),
            tuple(filter(None, map(_text, [*words, *_steps(checklist)]))),
            has_checklist=_is_there(checklist),
            is_question=id(node) in asked,
            is_calm=kind in CALM,
        )


def _asks(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and _last(node.func) == "ask" and bool(node.args)


def _arguments(
    call: ast.Call, name: str
) -> tuple[str, list[ast.expr | None], ast.expr | None] | None:
    """The kind of a message, the words of its title and sentence, and its checklist."""
    if name in errors():
        return "error", [_argument(call, 0, "sentence")], _argument(call, None, "checklist")
    if name == "Message":
        words = [_argument(call, 1, "title"), _argument(call, 2, "sentence")]
        kind = _words(_argument(call, 0, "kind"))
        return kind, words, _argument(call, 3, "checklist")
    if name in ("Problem", "BlockProblem"):
        first = _argument(call, 0, "title")
        if isinstance(first, ast.Constant) and first.value in PROBLEM_OF_BLOCKS:
            words = [_argument(call, 4, "sentence")]
            return str(first.value), words, _argument(call, 5, "checklist")
        words = [first, _argument(call, 1, "sentence")]
        return "error", words, _argument(call, 2, "checklist")
    if name == "refuse":
        return "warning", [_argument(call, 0, "reason")], _argument(call, 1, "checklist")
    if name == "confirm" and "essages" in ast.unparse(call.func):
        return "success", [_argument(call, 0, "title")], None
    if name == "Told" and len(call.args) == 4:  # of nodes/cognitive/failure_sentences.py
        return "error", [call.args[2]], call.args[3]
    return None


def _argument(call: ast.Call, place: int | None, name: str) -> ast.expr | None:
    by_name = (keyword.value for keyword in call.keywords if keyword.arg == name)
    if place is not None and place < len(call.args):
        return call.args[place]
    return next(by_name, None)


def _is_there(checklist: ast.expr | None) -> bool:
    return checklist is not None and not (isinstance(checklist, ast.Tuple) and not checklist.elts)


def _steps(checklist: ast.expr | None) -> list[ast.expr]:
    return list(checklist.elts) if isinstance(checklist, ast.Tuple) else []


def _words(node: ast.expr | None) -> str:
    """What is said, or the name of what holds it."""
    return "" if node is None else _text(node) or ast.unparse(node)


def _text(node: ast.expr | None) -> str:
    """A text, or the text of ``tr(...)``; nothing for what is only known when it runs."""
    if isinstance(node, ast.Call) and _last(node.func) in ("tr", "count_words"):
        return _text(node.args[0])
    return "" if node is None else template(node)


def _last(node: ast.expr) -> str:
    return ast.unparse(node).rpartition(".")[2]
