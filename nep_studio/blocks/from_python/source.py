"""The text of a Python file by lines, with its comments, and the tree of it."""

from __future__ import annotations

import ast
import io
import itertools
import textwrap
import tokenize
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from nep_studio.blocks.code_text import as_names, bodies_of, lines_inside_texts, outside_functions
from nep_studio.blocks.generate.expressions import comment_line, comment_text

from .learning import CodeUnread
from .mistakes import checklist_of, too_deep
from .scoping import with_beginnings
from .simpler import simplify

LONGEST_PROGRAM = 2_000_000


@dataclass(frozen=True, slots=True)
class Source:
    """A Python text; ``comments`` are the comments by line, ``alone`` the lines of only one.

    ``inside_texts`` are the lines that begin inside a text of several lines, ``set_aside`` those
    of “global” statements, which blocks write by themselves, each with what is left of it: comments
    stay in any case, and “pass” where nothing else is done.
    """

    lines: tuple[str, ...]
    tree: ast.Module
    comments: dict[int, str]
    alone: frozenset[int]
    inside_texts: frozenset[int]
    set_aside: Mapping[int, str] = field(default_factory=dict)

    def first_line(self, node: ast.stmt, after: int) -> int:
        """Where a statement begins with its decorators and the comments above it."""
        first = line = begin_of(node)
        while line - 1 > after and (self._is_empty(line - 1) or self._is_above(line - 1, node)):
            line -= 1
            first = line if line in self.alone else first
        return first

    def right_above(self, node: ast.stmt) -> int:
        """The line above a statement and the comments that touch it."""
        line = begin_of(node) - 1
        while line in self.alone:
            line -= 1
        return line

    def line_before(self, body: Sequence[ast.stmt]) -> int:
        """The line after which comments belong to statements that are moved in."""
        line, margin = begin_of(body[0]) - 1, body[0].col_offset
        margin = 0 if self.margin(line + 1) == margin else margin
        while line and (self._is_empty(line) or self._is_alone(line, margin)):
            line -= 1
        return line

    def last_line(self, body: Sequence[ast.stmt]) -> int:
        """The last line of comments that stand below statements as far in as those do."""
        return self._last_line(end_of(body), body[0].col_offset)

    def end_inside(self, node: ast.stmt) -> int:
        """The last line of a statement, with the comments below it that are further in than it."""
        return self._last_line(end_of([node]), node.col_offset + 1)

    def _last_line(self, line: int, margin: int) -> int:
        last = line
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
        first, begin = self.first_line(node, after), begin_of(node)
        said = [self.comments[line] for line in range(first, begin) if line in self.comments]
        if node.lineno in self.comments and node.lineno not in self.alone:
            said.append(self.comments[node.lineno])
        return "\n".join(said).strip("\n")

    def comment_of_function(self, node: ast.FunctionDef, after: int) -> str:
        """The comments above a function and in the lines before its body."""
        numbers = range(self.first_line(node, after), self.line_before(node.body) + 1)
        said = [self.comments[line] for line in numbers if line in self.comments]
        return "\n".join(said).strip("\n")

    def comments_between(self, first: int, last: int, margin: int) -> list[str]:
        """The comments on lines of their own from one line to another, so far in."""
        lines = [line for line in range(first, last + 1) if line in self.alone]
        return [self.comments[line] for line in lines if self.margin(line) == margin]

    def text(self, first: int, last: int) -> str:
        """Lines of the text, without the margin of the first; long texts keep theirs."""
        numbers = [n for n in range(first, last + 1) if not self._is_aside(n)]
        code = {n for n in numbers if n not in self.inside_texts and not self._is_empty(n)}
        # the first statement is the least far in: comments and lines in brackets stand anywhere
        begin = min(code - self.alone or code, default=first)
        margins = {n: min(self.margin(begin), self.margin(n)) for n in code}
        lines = [self._line(n)[margins.get(n, 0) :] for n in numbers]
        return "\n".join(lines).rstrip()

    def whole(self, first: int, last: int) -> str:
        """Lines of the text as they are, but for spaces at their ends."""
        return "\n".join(
            self.lines[n - 1] if n + 1 in self.inside_texts else self.lines[n - 1].rstrip()
            for n in range(first, last + 1)
        )

    def line_at(self, first: int, number: int) -> int:
        """Which line of the source a line is in the text of lines from one on, counted from 1."""
        lines = (n for n in range(first, len(self.lines)) if not self._is_aside(n))
        return next(itertools.islice(lines, number - 1, None), len(self.lines))

    def _line(self, line: int) -> str:
        """A line, of one that is set aside what is left of it."""
        text = self.lines[line - 1]
        if line not in self.set_aside:
            return self.whole(line, line)
        said = comment_line(self.comments[line]) if line in self.comments else ""
        return text[: self.margin(line)] + "  ".join(filter(None, [self.set_aside[line], said]))

    def _is_aside(self, line: int) -> bool:
        return self.set_aside.get(line) == "" and line not in self.comments

    def _is_above(self, line: int, node: ast.stmt) -> bool:
        return line in self.alone and self.margin(line) <= node.col_offset

    def _is_alone(self, line: int, margin: int) -> bool:
        return line in self.alone and self.margin(line) >= margin

    def _is_empty(self, line: int) -> bool:
        return not self.lines[line - 1].strip() or self._is_aside(line)


def read_source(text: str, *, is_program: bool = False) -> Source:
    """Parse a text; raises CodeUnread with the line.

    A program has everything around it that its lines need, such as the loop of a “break”.
    """
    if len(text) > LONGEST_PROGRAM:
        raise CodeUnread(
            "This is too long to become blocks.", 1, checklist=("Take a part of it at a time.",)
        )
    text = _plain(text)
    lines = tuple(text.split("\n"))
    try:
        with warnings.catch_warnings(action="ignore"):
            tree = ast.parse(text)
            if is_program:
                _require_whole(text, tree, lines)
            with_beginnings(as_names(tree))
        comments, alone = _comments(text)
    except SyntaxError as error:
        raise CodeUnread(
            "Python does not understand this: {msg}.",
            min(error.lineno or 1, len(lines)),
            checklist=checklist_of(error, lines),
            msg=error.msg,
        ) from error
    except (RecursionError, MemoryError) as error:
        raise too_deep(None, lines) from error
    except (ValueError, tokenize.TokenError) as error:
        raise CodeUnread(
            "Python cannot read this.", 1, checklist=("Undo the last change of the code.",)
        ) from error
    inside = frozenset(lines_inside_texts(tree))
    aside = dict(_set_aside(tree, lines))
    simplify(tree)
    alone |= aside.keys() & comments.keys()
    return Source(lines, tree, comments, frozenset(alone), inside, aside)


def without_margin(text: str) -> str:
    """A text without the margin of all its lines, such as lines of a function have.

    The first line may lack it, as when it is selected from its first sign on. What is inside texts
    of several lines stays as it is.
    """
    lines = _plain(text).split("\n")
    code = [n for n, line in enumerate(lines) if line.strip() and line.lstrip()[0] != "#"]
    if len(text) > LONGEST_PROGRAM or not code or _tree(text) is not None:
        return text
    others = (_margin_of(lines[n]) for n in code[1:])
    margin = _margin_of(lines[code[0]]) or min(others, default="", key=len)
    lines[code[0]] = margin + lines[code[0]].lstrip()
    tree = _tree("\n".join(["if True:", *lines]))
    if not margin or tree is None:
        return textwrap.dedent(text)
    inside = {number - 2 for number in lines_inside_texts(tree)}
    cut = [0 if n in inside else len(_margin_of(line)) for n, line in enumerate(lines)]
    return "\n".join(line[min(n, len(margin)) :] for n, line in zip(cut, lines, strict=True))


def _tree(text: str) -> ast.Module | None:
    """The tree of a text; none when Python does not understand it."""
    try:
        with warnings.catch_warnings(action="ignore"):
            return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _plain(text: str) -> str:
    return text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")


def _margin_of(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def _require_whole(text: str, tree: ast.Module, lines: Sequence[str]) -> None:
    """Let Python look at a whole program, without running it; raises SyntaxError, CodeUnread."""
    try:
        compile(text, "program.py", "exec", dont_inherit=True)
    except (RecursionError, MemoryError) as error:
        raise too_deep(tree, lines) from error


def _set_aside(tree: ast.Module, lines: Sequence[str]) -> Iterator[tuple[int, str]]:
    """The lines of “global” statements in functions of the text, with what is left of each.

    Those of functions in functions, and lines with something else, stay.
    """
    for function in tree.body:
        if not isinstance(function, ast.FunctionDef):
            continue
        inside = (n for one in function.body for n in outside_functions(one) if not _is_scope(n))
        for node in itertools.chain([function], inside):
            for body in bodies_of(node):
                found = [one.lineno for one in body if _is_plain_global(one, lines)]
                left = "pass" if len(found) == len(body) else ""
                yield from ((line, left if line == found[0] else "") for line in found)


def _is_scope(node: ast.AST) -> bool:
    return isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda)


def _is_plain_global(node: ast.stmt, lines: Sequence[str]) -> bool:
    if not isinstance(node, ast.Global) or node.lineno != node.end_lineno:
        return False
    code = lines[node.lineno - 1].partition("#")[0]
    return code.split()[:1] == ["global"] and ";" not in code


def end_of(nodes: Sequence[ast.stmt]) -> int:
    """The last line of statements."""
    return nodes[-1].end_lineno or nodes[-1].lineno


def begin_of(node: ast.stmt) -> int:
    """The first line of a statement, with its decorators."""
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    lines = [decorator.lineno for decorator in decorators]
    return min(lines, default=node.lineno)


def _comments(text: str) -> tuple[dict[int, str], set[int]]:
    comments: dict[int, str] = {}
    alone: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comments[token.start[0]] = comment_text(token.string)
            if not token.line[: token.start[1]].strip():
                alone.add(token.start[0])
    return comments, alone
