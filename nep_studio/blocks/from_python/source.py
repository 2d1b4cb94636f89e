"""The text of a Python file by lines, with its comments, and the tree of it."""

from __future__ import annotations

import ast
import io
import tokenize
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

from ..code_text import lines_inside_texts
from .made import CodeUnread

LONGEST_PROGRAM = 2_000_000

_CHECKLIST = (
    "Look at this line, and at the one above: is a bracket, a quote or a colon missing?",
    "Are the lines inside a block moved in by the same number of spaces?",
    "Undo the last change of the code.",
)


@dataclass(frozen=True, slots=True)
class Source:
    """A Python text; ``comments`` are the comments by line, ``alone`` the lines of only one.

    ``inside_texts`` are the lines that begin inside a text of several lines.
    """

    lines: tuple[str, ...]
    tree: ast.Module
    comments: dict[int, str]
    alone: frozenset[int]
    inside_texts: frozenset[int]

    def first_line(self, node: ast.stmt, after: int) -> int:
        """Where a statement begins with its decorators and the comments above it."""
        first = line = _begin(node)
        while line - 1 > after and (self._is_empty(line - 1) or self._is_above(line - 1, node)):
            line -= 1
            first = line if line in self.alone else first
        return first

    def line_before(self, body: Sequence[ast.stmt]) -> int:
        """The line after which comments belong to statements that are moved in."""
        line, margin = _begin(body[0]) - 1, body[0].col_offset
        while line and (self._is_empty(line) or self._is_alone(line, margin)):
            line -= 1
        return line

    def last_line(self, body: Sequence[ast.stmt]) -> int:
        """The last line of comments that stand below statements as far in as those do."""
        last = line = end_of(body)
        margin = body[0].col_offset
        while line < len(self.lines) and (
            self._is_empty(line + 1) or self._is_alone(line + 1, margin)
        ):
            line += 1
            last = line if line in self.alone else last
        return last

    def margin(self, line: int) -> int:
        """How far in a line begins."""
        text = self.lines[line - 1]
        return len(text) - len(text.lstrip())

    def comment_of(self, node: ast.stmt, after: int) -> str:
        """The comments above a statement and behind its first line."""
        first, begin = self.first_line(node, after), _begin(node)
        said = [self.comments[line] for line in range(first, begin) if line in self.comments]
        if node.lineno in self.comments and node.lineno not in self.alone:
            said.append(self.comments[node.lineno])
        return "\n".join(said)

    def comments_between(self, first: int, last: int, margin: int) -> list[str]:
        """The comments on lines of their own from one line to another, so far in."""
        lines = [line for line in range(first, last + 1) if line in self.alone]
        return [self.comments[line] for line in lines if self.margin(line) == margin]

    def text(self, first: int, last: int) -> str:
        """Lines of the text, without their common margin; texts of several lines keep theirs."""
        numbers = range(first, last + 1)
        code = [n for n in numbers if n not in self.inside_texts and not self._is_empty(n)]
        margin = min(map(self.margin, code), default=0)
        lines = [self.lines[n - 1][margin if n in code else 0 :] for n in numbers]
        return "\n".join(lines).rstrip()

    def _is_above(self, line: int, node: ast.stmt) -> bool:
        return line in self.alone and self.margin(line) <= node.col_offset

    def _is_alone(self, line: int, margin: int) -> bool:
        return line in self.alone and self.margin(line) >= margin

    def _is_empty(self, line: int) -> bool:
        return not self.lines[line - 1].strip()


def read_source(text: str) -> Source:
    """Parse a text; raises CodeUnread with the line."""
    if len(text) > LONGEST_PROGRAM:
        raise CodeUnread(
            "This is too long to become blocks.", 1, checklist=("Take a part of it at a time.",)
        )
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text)
        comments, alone = _comments(text)
    except SyntaxError as error:
        raise CodeUnread(
            f"Python does not understand this: {error.msg}.",
            error.lineno or 1,
            checklist=_CHECKLIST,
        ) from error
    except (ValueError, RecursionError, MemoryError, tokenize.TokenError) as error:
        raise CodeUnread("Python cannot read this.", 1, checklist=_CHECKLIST) from error
    inside = frozenset(lines_inside_texts(tree))
    return Source(tuple(text.split("\n")), tree, comments, frozenset(alone), inside)


def end_of(nodes: Sequence[ast.stmt]) -> int:
    """The last line of statements."""
    return nodes[-1].end_lineno or nodes[-1].lineno


def _begin(node: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    lines = [decorator.lineno for decorator in decorators]
    return min(lines, default=node.lineno)


def _comments(text: str) -> tuple[dict[int, str], set[int]]:
    comments: dict[int, str] = {}
    alone: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comments[token.start[0]] = token.string.lstrip("#").strip()
            if not token.line[: token.start[1]].strip():
                alone.add(token.start[0])
    return comments, alone
