"""Lists every message that the program can show, from its sources, with its checklist."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from message_sources import ROOT, errors, in_order, last_name, literal, parsed

ROOMS = ("nep_core", "nodes", "nep_studio", "robots")
NOT_SHOWN = (
    "nep_core/cli/",
    "nep_core/networks/gateway/",
    "nep_core/networks/security/curve.py",
    "nep_studio/commands/",
    "nodes/perceptual/recognition/command.py",
)
"""What is told in a terminal, or to programs."""

PROBLEM_OF_BLOCKS = ("error", "warning", "info")
"""With what a problem that is drawn at a block begins."""

TAKE_WORDS = ("tr", "count_words", "Text", "text_of")

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


MADE_BY = ("Message", "Problem", "Diagnostic", "Sort", "refuse", "confirm", "Explanation")
"""What makes messages besides errors."""


def _files() -> list[Path]:
    """Every file of the program."""
    return [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]


def _place(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def _errors() -> frozenset[str]:
    """Those that are shown as messages of their own."""
    return errors("NepError", "BlocksError")


@cache
def messages() -> tuple[Said, ...]:
    """Every message, in the order of the sources."""
    makes = re.compile(rf"\b({'|'.join((*MADE_BY, *_errors()))})\(")
    files = [path for path in _files() if makes.search(path.read_text("utf-8"))]
    return tuple(
        said
        for path, nodes in parsed(one for one in files if not _place(one).startswith(NOT_SHOWN))
        for said in _of_file(_place(path), nodes)
    )


def _of_file(place: str, nodes: list[ast.AST]) -> Iterator[Said]:
    calls = [node for node in nodes if isinstance(node, ast.Call)]
    asked = {id(call.args[0]) for call in calls if _asks(call)}
    for call in in_order(calls):
        name = last_name(call.func)
        arguments = _arguments(call, name)
        if arguments is None:
            continue
        kind, words, checklist = arguments
        yield Said(
            place,
            call.lineno,
            name,
            " | ".join(filter(None, map(_words, words))),
            tuple(filter(None, map(_text, [*words, *_steps(checklist)]))),
            has_checklist=_is_there(checklist),
            is_question=id(call) in asked,
            is_calm=kind in CALM,
        )


def _asks(call: ast.Call) -> bool:
    return last_name(call.func) == "ask" and bool(call.args)


def _arguments(
    call: ast.Call, name: str
) -> tuple[str, list[ast.expr | None], ast.expr | None] | None:
    """The kind of a message, the words of its title and sentence, and its checklist."""
    if name in _errors():
        return "error", [_argument(call, 0, "sentence")], _argument(call, None, "checklist")
    if name == "Message":
        words = [_argument(call, 1, "title"), _argument(call, 2, "sentence")]
        kind = _words(_argument(call, 0, "kind"))
        return kind, words, _argument(call, 3, "checklist")
    if name in ("Problem", "Diagnostic"):
        first = _argument(call, 0, "title")
        if isinstance(first, ast.Constant) and first.value in PROBLEM_OF_BLOCKS:
            words = [_argument(call, 4, "sentence")]
            return str(first.value), words, _argument(call, 5, "checklist")
        words = [first, _argument(call, 1, "sentence")]
        return "error", words, _argument(call, 2, "checklist")
    if name == "Sort":  # of diagnostics, which are the same at each block
        return _words(call.args[0]), [call.args[1]], call.args[2]
    if name == "refuse":
        return "warning", [_argument(call, 0, "reason")], _argument(call, 1, "checklist")
    if name == "confirm" and "essages" in ast.unparse(call.func):
        return "success", [_argument(call, 0, "title")], None
    if name == "Explanation" and len(call.args) == 4:  # of nodes/cognitive/failures.py
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
    """A text, or that of ``tr(...)``; nothing for what is only known when it runs."""
    if isinstance(node, ast.Call) and last_name(node.func) in TAKE_WORDS and node.args:
        return _text(node.args[0])
    return "" if node is None else literal(node)
