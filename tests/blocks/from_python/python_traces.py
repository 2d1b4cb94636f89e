"""What a program does, told by stand-ins: two texts that do the same give the same trace."""

from __future__ import annotations

import inspect
import random
from collections.abc import Callable
from typing import Any

import pytest

import nep_core
from nep_core.program.tasks import Part, RuleStopped, Task

ROBOT = nep_core.Robot
LONGEST_S = 20.0
MOST = 400
"""What a trace holds: a loop that has no end fills it, and is ended."""


class Full(Exception):
    """Enough has been seen."""


class Trace(list[str]):
    """What is done, one line for each."""

    def note(self, what: str, *values: object, **named: object) -> None:
        if len(self) >= MOST:
            raise Full
        given = [*map(told, values), *(f"{name}={told(one)}" for name, one in named.items())]
        self.append(f"{what}({', '.join(given)})")


def told(value: object) -> str:
    """A value in words that are the same in every run."""
    if isinstance(value, list | tuple):
        return f"{type(value).__name__}[{', '.join(map(told, value))}]"
    is_plain = value is None or isinstance(value, str | int | float | bool)
    return repr(value) if is_plain else type(value).__name__


def as_given(
    method: str, values: tuple[object, ...], named: dict[str, object]
) -> tuple[tuple[object, ...], dict[str, object]]:
    """What a robot is given, the same by place or by name; it tells what it says itself."""
    known = getattr(ROBOT, method, None)
    if known is None:
        return values, named
    bound = inspect.signature(known).bind(None, *values, **named)
    bound.apply_defaults()
    if method == "say":
        bound.arguments["text"] = str(bound.arguments["text"])
    return bound.args[1:], bound.kwargs


def trace_of(text: str, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What a program does when each of its rules is begun once, in the order of the text."""
    trace = Trace()

    class StandIn:
        def __init__(self, name: object, **_options: object) -> None:
            self._name = name

        def __getattr__(self, method: str) -> Callable[..., str]:
            def act(*values: object, **named: object) -> str:
                given = as_given(method, values, named)
                trace.note(f"{told(self._name)}.{method}", *given[0], **given[1])
                return "yes"

            return act

    class Runner(StandIn):
        def __init__(self, name: object, **options: object) -> None:
            super().__init__(name, **options)
            self._rules: list[Callable[[], object]] = []

        def when_started(self, rule: Callable[[], object]) -> Callable[[], object]:
            self._rules.append(rule)
            return rule

        def __getattr__(self, hat: str) -> Callable[..., Any]:
            def given(*values: object, **named: object) -> Callable[..., Any]:
                trace.note(hat, *values, **named)
                return self.when_started

            return given

        def run(self) -> None:
            for rule in self._rules:
                part = Part(rule, "rule", Task()).start()
                part.join(LONGEST_S)
                assert not part.is_running, f"the program does not end:\n{text}"
                if part.error is not None and not isinstance(part.error, RuleStopped):
                    trace.append(type(part.error).__name__)

    names: dict[str, Any] = {"__name__": "__main__"}
    names["print"] = lambda *values, **named: trace.note("print", *values, **named)
    names["input"] = lambda *values: trace.note("input", *values) or "7"
    random.seed(1)
    with monkeypatch.context() as patched:
        patched.setattr(nep_core, "Robot", StandIn, raising=False)
        patched.setattr(nep_core, "Behavior", Runner, raising=False)
        for function in ("wait", "wait_until"):
            named = lambda *values, function=function: trace.note(function, *values)  # noqa: E731
            patched.setattr(nep_core, function, named)
        try:
            exec(compile(text.lstrip("\ufeff"), "program.py", "exec"), names)
        except Exception as error:
            trace.append(f"{type(error).__name__} at once")
    return trace


def assert_does_the_same(made: str, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two texts give the same trace; but a variable that nobody begins is 0 among blocks."""
    was = trace_of(text, monkeypatch)
    if "NameError" not in was:
        assert trace_of(made, monkeypatch) == was
