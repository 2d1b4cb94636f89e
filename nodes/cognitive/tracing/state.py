"""The threads of a program, and the lines of its file that each of them is in."""

from __future__ import annotations

import ast
import math
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from nep_core.program.robot import Robot
from nep_core.program.tasks import Task, current_task, frames_of_threads
from nep_core.program.values import as_text
from nep_core.program.variables import SHARED_OBJECTS, variables_in

MOST_CALLS = 50
"""So many calls of a thread are told."""


@dataclass(eq=False)
class ProgramThread:
    """A thread that has been asked where it is; only the thread itself makes one of it."""

    name: str
    task: Task
    is_stepped: bool = False
    """Whether it runs one line more of a paused program."""
    is_cancelled: bool = False
    """Whether it has been told, by Cancelled, to end."""


class ProgramThreads:
    """Who is where in ``file``: seen by looking at the calls that Python has of every thread.

    So a call costs nothing. Python keeps those of a thread that waits or is held as they are; a
    look at one that runs meanwhile is made again.
    """

    def __init__(self, file: str) -> None:
        self._file = file
        self._asked = threading.local()

    def this(self) -> ProgramThread:
        """The thread that asks."""
        thread: ProgramThread | None = self.asked_before()
        if thread is None:
            thread = ProgramThread(threading.current_thread().name, current_task())
            self._asked.thread = thread
        return thread

    def asked_before(self) -> ProgramThread | None:
        """The thread that asks, None when it never has."""
        return getattr(self._asked, "thread", None)

    def line_here(self) -> int:
        """The line of the file in which the thread is that asks, 0 when it is in none."""
        return next((frame.f_lineno or 0 for frame in self._calls(sys._getframe())), 0)

    def frames(self) -> list[FrameType]:
        """All calls that have not ended yet."""
        return [one for frame in frames_of_threads().values() for one in self._calls(frame)]

    def lines(self) -> dict[str, list[int]]:
        """The lines that each thread is in now, the outermost call first."""
        names = {thread.ident: thread.name for thread in threading.enumerate()}
        found = {}
        for ident, innermost in frames_of_threads().items():
            if lines := self._lines_of(ident, innermost):
                found[names.get(ident, str(ident))] = lines
        return found

    def _lines_of(self, ident: int, innermost: FrameType) -> list[int]:
        """The lines of a thread; of very many calls the outermost and the innermost."""
        for _ in range(_LOOKS):
            frames = list(self._calls(innermost))
            now = frames_of_threads().get(ident)
            if now is innermost:
                break
            if now is None:
                return []
            innermost = now
        if len(frames) > MOST_CALLS:
            frames = frames[: MOST_CALLS // 2] + frames[-MOST_CALLS // 2 :]
        return [frame.f_lineno or 0 for frame in reversed(frames)]

    def _calls(self, innermost: FrameType | None) -> Iterator[FrameType]:
        """The calls of the file in which a thread is, the innermost first."""
        while innermost is not None:
            code = innermost.f_code
            if code.co_filename == self._file and not is_part_of_line(code):
                yield innermost
            innermost = innermost.f_back


_LOOKS = 3
"""So often is looked at a thread that goes on meanwhile."""


def is_part_of_line(code: CodeType) -> bool:
    """Whether code is only a piece of a line, such as the condition of a wait."""
    return code.co_name.startswith("<") and code.co_name != "<module>"


# What the text of a program tells before it runs: its variables, and which lines are no step.

_FRAMEWORKS = {"Behavior", "robot_behaviors"}
_Function = ast.FunctionDef | ast.AsyncFunctionDef
_Block = _Function | ast.ClassDef
_SILENT = (ast.Global, ast.Nonlocal, ast.Import, ast.ImportFrom)


@dataclass(frozen=True)
class ProgramSource:
    """What is known of a program before it runs; lines count from 1.

    ``variables`` are the names that it gives values to, ``rules`` those of the functions that are
    rules, or in them, and ``functions`` of all functions. ``quiet_lines`` are no steps of it: heads
    of functions, imports and, where rules are the program, all that makes them. ``moved`` tells
    for the head of a rule or of an own block the line where its body begins.
    """

    variables: frozenset[str] = frozenset()
    functions: frozenset[str] = frozenset()
    rules: frozenset[str] = frozenset()
    quiet_lines: frozenset[int] = frozenset()
    moved: dict[int, int] = field(default_factory=dict)


def read_source(file: Path) -> ProgramSource:
    """Read a program; one that is not Python has nothing, as it will not run either."""
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError, RecursionError):
        return ProgramSource()
    return ProgramSource(
        _variables(tree),
        frozenset(node.name for node in ast.walk(tree) if isinstance(node, _Function)),
        frozenset(_rules(tree)),
        frozenset(_quiet_lines(tree)),
        _moved(tree),
    )


def _variables(tree: ast.Module) -> frozenset[str]:
    return frozenset(_names_set(tree))


def _names_set(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.Assign(targets=[ast.Name(id=owner)], value=ast.Call(keywords=given)) if (
                owner in SHARED_OBJECTS
            ):
                yield from (f"{owner}.{one.arg}" for one in given)
            case ast.Attribute(value=ast.Name(id=owner), attr=name, ctx=ast.Store()):
                yield f"{owner}.{name}"


def _rules(tree: ast.Module) -> Iterator[str]:
    """The names of functions that something else calls than the program itself, and of parts."""
    for node in tree.body:
        if isinstance(node, _Function):
            inside = (inner for inner in ast.walk(node) if isinstance(inner, _Function))
            yield from (inner.name for inner in inside if inner is not node or node.decorator_list)


def _quiet_lines(tree: ast.Module) -> Iterator[int]:
    for node in ast.walk(tree):
        if isinstance(node, _Block):
            yield from _head(node)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            yield from range(node.lineno, (node.end_lineno or node.lineno) + 1)
    if _has_rules(tree):
        for statement in tree.body:
            if not isinstance(statement, _Block):
                yield from range(statement.lineno, (statement.end_lineno or 0) + 1)


def _has_rules(tree: ast.Module) -> bool:
    """Whether functions are the program, and the lines beside them only make rules of them."""
    return any(
        isinstance(statement, ast.Assign)
        and isinstance(statement.value, ast.Call)
        and isinstance(statement.value.func, ast.Name)
        and statement.value.func.id in _FRAMEWORKS
        for statement in tree.body
    )


def _moved(tree: ast.Module) -> dict[int, int]:
    return {
        line: _first_step(node)
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
        for line in _head(node)
    }


def _head(node: _Block) -> range:
    """The lines of decorators and of the def itself."""
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return range(first, max(node.body[0].lineno, node.lineno + 1))


def _first_step(node: ast.FunctionDef) -> int:
    """The first line of a function's body at which Python stops by."""
    for statement in node.body:
        is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
        if not is_text and not isinstance(statement, _SILENT):
            return statement.lineno
    return node.body[-1].lineno


# What the variables of a program hold, as short texts, and which have changed.

LONGEST = 60
"""Letters of a value that are shown."""
MOST_DIGITS = 40
MOST_REPORTS = 2000
"""So many places of a program tell what they gave last."""

CUT = "…"
_ENDS: dict[type, str] = {list: "[]", tuple: "()", set: "{}", frozenset: "{}", dict: "{}"}
_DEEPEST = 3


def is_plain(value: object) -> bool:
    """Whether a value is a number, a text, true or false, nothing, or a collection of values."""
    return value is None or type(value) in (bool, int, float, str) or type(value) in _ENDS


def shown(value: Any, depth: int = 0) -> str:
    """A plain value as the program tells it, clipped; texts and lists show that they are some.

    No code of the program is run for it.
    """
    if type(value) is str:
        return _quoted(value) if len(value) < LONGEST else _quoted(value[: LONGEST - 2]) + CUT
    if type(value) is int:
        return _whole(value)
    if type(value) is bool or (type(value) is float and math.isfinite(value)):
        return as_text(value)
    if value is None or type(value) is float:
        return repr(value)
    if type(value) is Robot:
        return as_text(value)
    if type(value) in _ENDS and depth < _DEEPEST:
        kind = type(value)
        opening, closing = _ENDS[kind][0], _ENDS[kind][1]
        text = ""
        for item in islice(value.items() if kind is dict else value, LONGEST):
            told = _pair(item, depth) if kind is dict else shown(item, depth + 1)
            text += f", {told}" if text else told
            if len(text) > LONGEST - 2:
                return f"{opening}{text[: LONGEST - 3]}{CUT}{closing}"
        if kind in (set, frozenset) and not text:
            return f"{kind.__name__}()"
        return f"{opening}{text}{',' if kind is tuple and len(value) == 1 else ''}{closing}"
    return CUT


def _quoted(text: str) -> str:
    """A text on one line, in the same marks in every language."""
    inner = "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in text)
    return f'"{inner}"'


def _whole(value: int) -> str:
    digits = int(value.bit_length() * math.log10(2))
    if digits <= MOST_DIGITS:
        return repr(value)
    return f"{'-' if value < 0 else ''}1e+{digits}"  # to write all digits could take minutes


def _pair(item: tuple[object, object], depth: int) -> str:
    return f"{shown(item[0], depth + 1)}: {shown(item[1], depth + 1)}"


class ProgramValues:
    """The variables of a program, and what the calls in its lines gave last.

    ``namespace`` is where the program keeps its variables, once it has begun. Those of the whole
    program are called as in its text, ``program.score``. ``frames`` gives the calls that have not
    ended, which have some for themselves.
    """

    def __init__(
        self, names: frozenset[str], frames: Callable[[], Iterable[FrameType]] = tuple
    ) -> None:
        self._frames = frames
        self._names = names
        self._last_sent: dict[str, str] = {}
        self._reports: dict[str, object] = {}
        self.namespace: Mapping[str, object] = {}
        self._ended: dict[str, object] = {}

    def report(self, place: str, value: object) -> None:
        """Note what the call at a place of the file gave."""
        is_told = is_plain(value) or type(value) is Robot
        if is_told and (place in self._reports or len(self._reports) < MOST_REPORTS):
            self._reports[place] = value

    def end_of(self, frame: FrameType) -> None:
        """Note what a call held that ends now."""
        if _has_own(frame):
            held = frame.f_locals
            self._ended.update({name: held[name] for name in self._names & held.keys()})

    def changed(self) -> dict[str, str]:
        """The values that are not as they were when this was asked last."""
        try:
            now = self._now()
        except RuntimeError:  # a collection grew while it was read: the next time will tell
            return {}
        changed = {name: text for name, text in now.items() if self._last_sent.get(name) != text}
        self._last_sent |= changed
        return changed

    def _now(self) -> dict[str, str]:
        now = {place: shown(value) for place, value in self._reports.copy().items()}
        for names in self._places():
            for name in self._names & names.keys():
                if is_plain(names[name]) or name in self._last_sent:
                    now[name] = shown(names[name])
        return now

    def _places(self) -> Iterator[Mapping[str, object]]:
        """Where variables are; what a function has for itself hides what is so called outside."""
        yield self.namespace
        for owner in SHARED_OBJECTS:
            held = variables_in(self.namespace.get(owner)).copy()
            yield {f"{owner}.{name}": value for name, value in held.items()}
        yield self._ended.copy()
        yield from (frame.f_locals for frame in self._frames() if _has_own(frame))


def _has_own(frame: FrameType) -> bool:
    """Whether a call has variables for itself besides what it is given."""
    code = frame.f_code
    return code.co_nlocals + len(code.co_cellvars) > code.co_argcount and code.co_name != "<module>"
