"""What a watch tells of a program: calls, lines, ends of calls, and what calls gave."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from functools import cache
from inspect import CO_GENERATOR, isfunction
from types import CodeType, FrameType
from typing import Protocol

WORDS_OF_ROBOTS = ("choosing", "colours", "human", "tasks")
"""Modules of nep_core whose functions programs call."""


class Events(Protocol):
    """What hears of a program; all are called in the program's own threads."""

    def enter(self, frame: FrameType) -> None:
        """Hear that a call of a function of the file begins or goes on."""

    def leave(self, frame: FrameType) -> None:
        """Hear that a call has ended."""

    def line(self, frame: FrameType, line: int) -> bool:
        """Return when the line may run; whether it need not be told until the next refresh."""

    def report(self, caller: FrameType, value: object) -> None:
        """Hear what a call from the file into nep_core gave."""


Lines = frozenset[int] | None
"""Some lines of a file; None is all of them."""


class Watch(Protocol):
    """Tells Events of one file from begin to end."""

    def begin(self) -> None:
        """Watch this thread and those that begin from now on."""

    def set_lines(self, lines: Lines) -> None:
        """Tell of these lines from now on; the functions of the others cost less."""

    def refresh(self) -> None:
        """Tell again of every line."""

    def end(self) -> None:
        """Watch no more."""


def is_part_of_line(code: CodeType) -> bool:
    """Whether code is only a piece of a line, such as the condition of a wait."""
    return code.co_name.startswith("<") and code.co_name != "<module>"


def has_any(code: CodeType, lines: Lines) -> bool:
    """Whether code, without the functions in it, has any of the lines."""
    if not lines:
        return lines is None
    return any(line in lines for _, _, line in code.co_lines())


@cache
def reporting_code() -> frozenset[CodeType]:
    """The functions of nep_core that programs call for a value."""
    return frozenset(code for code in _public_code() if not code.co_flags & CO_GENERATOR)


@cache
def reporting_files() -> frozenset[str]:
    """The files in which these are."""
    return frozenset(code.co_filename for code in reporting_code())


def _public_code() -> Iterator[CodeType]:
    robot = importlib.import_module("nep_core.robot").Robot
    own = [kind for kind in robot.__mro__ if kind.__module__.startswith("nep_core.")]
    homes = [importlib.import_module(f"nep_core.{name}") for name in WORDS_OF_ROBOTS]
    for home in (*own, *homes):
        for name, function in vars(home).items():
            if isfunction(function) and not name.startswith("_"):
                yield function.__code__
