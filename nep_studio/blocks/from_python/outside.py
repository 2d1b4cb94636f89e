"""What stands outside of the functions of a text: what the program writes, what is one's own."""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Set
from dataclasses import dataclass, field

from nep_studio.blocks.code_text import CodeTextRefused, read_outside
from nep_studio.blocks.generate.expressions import comment_line
from nep_studio.blocks.generate.names import API, MODULES
from nep_studio.blocks.generate.program import runs

from .learning import CodeUnread
from .scoping import is_beginning
from .source import Source, begin_of, end_of
from .told_names import is_taken_over

HEADERS = ("Robot", "Behavior")
"""What the lines before the functions make."""

TOP, HERE, END = "top", "here", "end"
"""The places of own Python: see the block that holds it."""


@dataclass(frozen=True, slots=True)
class Part:
    """A function that becomes blocks, or own Python outside of these.

    ``line`` is the line after which the comments of a function begin, or the first one of ``text``.
    Of a function, ``text`` are comments that stand further above it, and belong to nothing else.
    """

    line: int
    function: ast.FunctionDef | None = None
    text: str = ""
    place: str = HERE


def is_frame(node: ast.stmt) -> bool:
    """Whether a statement is written by the program itself, around the rules.

    What a variable holds first, and the modules that are imported, may be so: it depends on the
    blocks.
    """
    match node:
        case ast.ImportFrom(module="nep_core", level=0, names=names):
            return all(name.name in API and not name.asname for name in names)
        case ast.Import(names=names):
            return all(name.name in MODULES and not name.asname for name in names)
        case ast.Assign(targets=[ast.Name()], value=ast.Call(func=ast.Name(id=made))):
            return made in HEADERS
        case ast.Assign(targets=[ast.Name()], value=ast.Constant(value=first)):
            return first is False or (type(first) in (int, str) and first in (0, ""))
        case ast.Assign(targets=[ast.Name()], value=ast.List(elts=[]) | ast.Dict(keys=[])):
            return True
    return is_run(node)


def _is_head(node: ast.stmt) -> bool:
    """Whether a statement is of those that the program writes in any case, not for its blocks."""
    match node:
        case ast.Assign(targets=[ast.Name()], value=ast.Call(func=ast.Name(id=made))):
            return made in HEADERS
    return is_beginning(node) or (isinstance(node, ast.ImportFrom) and is_frame(node))


def is_run(node: ast.stmt) -> bool:
    """Whether this is the line that lets the behaviour run."""
    match node:
        case ast.Expr(
            value=ast.Call(
                func=ast.Attribute(value=ast.Name(id="behavior"), attr="run"), args=[], keywords=[]
            )
        ):
            return True
    return False


def parts_of(
    source: Source, kept: Collection[int] = (), begun: Set[str] = frozenset()
) -> list[Part]:
    """The parts of a text in their order, without what the program writes by itself.

    The statements that begin in the lines ``kept`` are own Python in any case, and so is what the
    variables ``begun`` begin with. Raises CodeUnread.
    """
    return _Splitter(source, kept, begun).split()


@dataclass(slots=True)
class _Splitter:
    """Goes through a text; ``lines`` are those of own Python that was read last, ``end`` its end.

    ``waiting`` are the lines of comments that belong to what comes next.
    """

    source: Source
    kept: Collection[int]
    begun: Set[str]
    parts: list[Part] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    first: int = 0
    end: int = 0
    place: str = TOP
    waiting: list[int] = field(default_factory=list)
    names: Counter[str] = field(default_factory=Counter)
    run: ast.stmt | None = None
    end_from: int = 0

    def split(self) -> list[Part]:
        """The parts in their order."""
        body = self.source.tree.body
        self.names = Counter(name for node in body for name in _named(node))
        self.run, self.end_from = self._find_end()
        head, after = _end_of_head(body), 0
        for number, node in enumerate(body):
            begin = begin_of(node)
            self._require_no_comment_inside(node)
            if isinstance(node, ast.FunctionDef) and self._is_function(node):
                if number >= self.end_from:
                    raise _below_the_end(node)
                self._wait_for(after, self.source.first_line(node, after))
                self._add_waiting(HERE)
                above = self._take_comments()
                self._flush()
                self.parts.append(Part(after, node, above))
                after = self.source.last_line(node.body)
                continue
            self._wait_for(after, begin)
            place = END if number >= self.end_from else TOP if begin <= head else HERE
            if self._is_own(node, number):
                can_be_top = isinstance(node, ast.Import | ast.ImportFrom) or _is_text(node)
                place = HERE if place == TOP and not can_be_top else place
                self._add_waiting(place)
                after = self._add(node, number, place)
                continue
            after = end_of([node])
            if _is_head(node) and number < self.end_from:
                place = TOP  # what is said of it is of the whole program, and of no rule
            self._add_waiting(HERE if node is self.run else place)
            self.waiting += self._comments_of(number)
            self._add_waiting(place)
        self._wait_for(after, len(self.source.lines) + 1)
        self._add_waiting(END if self.end_from < len(body) else HERE)
        self._flush()
        return self.parts

    def _find_end(self) -> tuple[ast.stmt | None, int]:
        """The line that lets the behaviour run, when it is the usual one, and the number of the

        statement from which on all is written as it is: that one, or the first that runs the
        behaviour, also by what is defined above.
        """
        body = self.source.tree.body
        mentions = [node for node in body if _runs(node)]
        if len(mentions) == 1 and is_run(mentions[0]) and mentions[0].lineno not in self.kept:
            return mentions[0], body.index(mentions[0])
        running = set[str]()
        for number, node in enumerate(body):
            if not (_runs(node) or running & _read(node)):
                continue
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                return None, number
            running.add(node.name)
        return None, len(body)

    def _is_function(self, node: ast.FunctionDef) -> bool:
        """Whether a function becomes blocks: a rule, or an own block."""
        if any(map(_is_of_behavior, node.decorator_list)):
            return True
        plain = not (node.decorator_list or node.returns) and _takes_plain_values(node.args)
        own = plain and node.lineno not in self.kept and self.names[node.name] == 1
        return own and node.name not in API and _gives_at_once(node) and not _runs(node)

    def _is_own(self, node: ast.stmt, number: int) -> bool:
        """Whether a statement is kept as it is written."""
        if node is self.run:
            return False
        if is_beginning(node):
            return not self.begun.isdisjoint(_named(node))
        if number >= self.end_from or (begin_of(node) in self.kept and not _is_head(node)):
            return True
        if is_taken_over(node):
            return bool(self._comments_of(number))
        if number == 0 and _is_text(node):
            return not is_made_docstring(node)
        if _is_beginning(node) and (self.parts or self.lines) and self.place != TOP:
            return True  # what variables begin with is written above all else: it stays where it is
        if _is_beginning(node) and self.waiting:
            return True  # a comment above it stays there
        if isinstance(node, ast.Import) or _is_beginning(node):
            return bool(self._comments_of(number)) or not is_frame(node)
        return not is_frame(node)

    def _require_no_comment_inside(self, node: ast.stmt) -> None:
        """What the program writes in several lines has no place for comments between these."""
        if not (is_beginning(node) or is_frame(node)):
            return
        for line in range(node.lineno, end_of([node])):
            if line in self.source.comments:
                raise CodeUnread(
                    "A comment has no place here, between lines that the program writes by itself.",
                    line,
                    checklist=("Put the comment above these lines.",),
                )

    def _wait_for(self, after: int, before: int) -> None:
        """Note the comments between two lines."""
        self.waiting += [n for n in range(after + 1, before) if n in self.source.alone]

    def _add_waiting(self, place: str) -> None:
        for line in self.waiting:
            comment = self.source.lines[line - 1].strip()
            is_behind = line not in self.source.alone
            said = comment_line(self.source.comments[line]) if is_behind else comment
            self._put(line, [said], place)
        self.waiting.clear()

    def _add(self, node: ast.stmt, number: int, place: str) -> int:
        """Add a statement as it is written, with comments behind it, and last in it.

        Gives the last line that was added.
        """
        begin, end = begin_of(node), end_of([node])
        above, below = self._ends_around(number)
        if is_beginning(node):
            self._put(begin, [ast.unparse(node)], place)
            return end
        if above < begin and end < below:
            end = self.source.end_inside(node)
            self._put(begin, self.source.whole(begin, end).split("\n"), place)
            return end
        text = ast.get_source_segment(self.source.whole(1, end), node) or ast.unparse(node)
        if end < below and end in self.source.comments:
            text += f"  {comment_line(self.source.comments[end])}"
        self._put(begin, text.split("\n"), place)
        return end

    def _comments_of(self, number: int) -> list[int]:
        """The lines of the comments in and behind a statement, and not behind its neighbours."""
        node = self.source.tree.body[number]
        begin, end = begin_of(node), end_of([node])
        _, below = self._ends_around(number)
        return [n for n in range(begin, min(end + 1, below)) if n in self.source.comments]

    def _ends_around(self, number: int) -> tuple[int, int]:
        """The line where the statement above one ends, and that where the one below begins."""
        body = self.source.tree.body
        above = end_of([body[number - 1]]) if number else 0
        return above, begin_of(body[number + 1]) if number + 1 < len(body) else sys.maxsize

    def _put(self, line: int, lines: list[str], place: str) -> None:
        if place != self.place:
            self._flush()
        gap = line - self.end - 1
        if self.lines and gap > 0 and not "".join(self.source.lines[self.end : line - 1]).strip():
            self.lines += [""] * min(gap, 2)
        if not self.lines:
            self.first, self.place = line, place
        self.lines += lines
        self.end = max(self.end, line + len(lines) - 1)

    def _take_comments(self) -> str:
        """What was read last when it is nothing but comments, which the next function gets."""
        said = [line for line in self.lines if line]
        if self.place != HERE or not all(line.startswith("#") for line in said):
            return ""
        self.lines = []
        return "\n".join(said)

    def _flush(self) -> None:
        if self.lines:
            text = "\n".join(self.lines)
            try:
                read_outside(text)
            except CodeTextRefused as refused:
                line = min(self.first + refused.line - 1, len(self.source.lines))
                checklist = ("Correct this line.",)
                raise CodeUnread(refused.reason, line, checklist=checklist) from refused
            self.parts.append(Part(self.first, None, text, self.place))
            self.lines = []


def _below_the_end(node: ast.stmt) -> CodeUnread:
    return CodeUnread(
        "This stands below “behavior.run()”: it would begin only after the program has ended.",
        node.lineno,
        checklist=("Move it above the line “behavior.run()”.",),
    )


def _end_of_head(body: list[ast.stmt]) -> int:
    """The last line of the imports at the top of a text."""
    last = 0
    for node in body:
        if isinstance(node, ast.ImportFrom) and node.module == "nep_core":
            return node.end_lineno or node.lineno
        if not isinstance(node, ast.Import | ast.ImportFrom) and not _is_text(node):
            break
        last = node.end_lineno or node.lineno
    return last


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and (
        isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
    )


def is_made_docstring(node: ast.stmt) -> bool:
    """Whether a text on top is the one that the program writes."""
    match node:
        case ast.Expr(value=ast.Constant(value=str(text))):
            return text.endswith(". Made with NEP Studio.") and "\n" not in text
    return False


def _is_beginning(node: ast.stmt) -> bool:
    """Whether this says what a name stands for first."""
    return isinstance(node, ast.Assign) and isinstance(
        node.value, ast.Constant | ast.List | ast.Dict
    )


def _is_of_behavior(decorator: ast.expr) -> bool:
    node: ast.expr = decorator
    while isinstance(node, ast.Call | ast.Attribute):
        node = node.func if isinstance(node, ast.Call) else node.value
    return isinstance(node, ast.Name) and node.id == "behavior"


def _takes_plain_values(given: ast.arguments) -> bool:
    more = given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs or given.defaults
    return not more and not any(argument.annotation for argument in given.args)


def _gives_at_once(function: ast.FunctionDef) -> bool:
    """Whether a function is a plain one, without “yield”."""
    return not any(isinstance(node, ast.Yield | ast.YieldFrom) for node in ast.walk(function))


def _runs(node: ast.stmt) -> bool:
    """Whether the behaviour is run in a statement."""
    return any(isinstance(n, ast.Attribute) and n.attr == "run" for n in ast.walk(node)) and runs(
        (ast.unparse(node),)
    )


def _read(node: ast.stmt) -> set[str]:
    """The names that a statement reads."""
    named = (n for n in ast.walk(node) if isinstance(n, ast.Name))
    return {n.id for n in named if isinstance(n.ctx, ast.Load)}


def _named(node: ast.stmt) -> Iterator[str]:
    """The names that a statement of the text makes, but those of rules."""
    match node:
        case ast.FunctionDef(name=name, decorator_list=decorators):
            if not any(map(_is_of_behavior, decorators)):
                yield name
        case ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            yield from ((alias.asname or alias.name).partition(".")[0] for alias in names)
        case ast.Assign(targets=targets):
            yield from (target.id for target in targets if isinstance(target, ast.Name))
