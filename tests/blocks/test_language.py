"""Random programs do what docs/language.md says: generated Python against another interpreter.

The Python runs with a stand-in for the robot, which keeps what is said; what else it calls is ours.
Python that reads back gives the same text again.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from block_building import B, build, read_program
from random_language import Maker
from reference_interpreter import GivenUp, Interpreter

import nep_core
from nep_core.program import behavior
from nep_core.program.facts import FACTS
from nep_core.program.messages import Run, heard_by
from nep_core.program.tasks import Part, RuleStopped, Task
from nep_core.program.values import speak
from nep_core.program.variables import Variables
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nodes.cognitive.failures import failure_of

pytestmark = pytest.mark.long

PROGRAMS = int(os.environ.get("NEP_RANDOM_PROGRAMS", "300"))
"""How many programs are tried; 3,000 by hand, before the language is changed."""
PARTS = 10
"""Tests, among which they are divided."""

LONGEST_S = 10.0


class Listener:
    """Stands in for a robot: keeps what it is told to say."""

    said: list[str]

    def __init__(self, _name: object) -> None:
        pass

    def one_by_one(self) -> list[Listener]:
        return [self]

    def say(self, text: object, **_options: object) -> None:
        assert type(text) is str, f"a robot says texts, not {text!r}"
        self.said.append(text)


class Runner:
    """Stands in for the behaviour: runs what starts when the program starts, in a task."""

    error: BaseException | None

    def __init__(self, _name: str, language: str = "en", **_options: object) -> None:
        speak(language)
        self._starts: list[Callable[[], object]] = []
        self._rules: dict[str, tuple[Callable[[], object], str]] = {}
        self._running: dict[str, Run] = {}

    def when_started(self, action: Callable[[], object]) -> Callable[[], object]:
        self._starts.append(action)
        return action

    def when_told(self, message: str, *, again: str = "ignore") -> Callable[..., object]:
        def decorate(action: Callable[[], object]) -> Callable[[], object]:
            self._rules[message] = action, again
            return action

        return decorate

    def last_run(self, message: str) -> Iterator[tuple[str, Run | None]]:
        if message in self._rules:
            yield self._rules[message][1], self._running.get(message)

    def hear(self, message: str, value: object) -> Iterator[Run]:
        if message in self._rules and message not in self._running:
            run = self._running[message] = Run(self._rules[message][0], value)
            Part(lambda: self._play(message, run), message, Task()).start()
            yield run

    def _play(self, message: str, run: Run) -> None:
        run.begin()
        try:
            run.action()
        finally:
            del self._running[message]
            run.end()

    def run(self) -> None:
        (action,) = self._starts
        with heard_by(self):
            part = Part(action, "rule", Task()).start()
            part.join(LONGEST_S)
        assert not part.is_running, "the program does not end"
        type(self).error = part.error


@contextmanager
def stand_ins(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with monkeypatch.context() as patched:
        patched.setattr(nep_core, "Robot", Listener, raising=False)
        patched.setattr(nep_core, "Behavior", Runner, raising=False)
        patched.setattr(nep_core, "Kept", Variables, raising=False)  # writes no files
        yield
    speak("en")


def played(text: str) -> list[str]:
    """What the Python says, with “error” at the end if its rule ends by one."""
    Listener.said, Runner.error = [], None
    behavior._turns.clear()  # another program may have a block at the same place
    names: dict[str, Any] = {"__name__": "__main__"}
    FACTS.clear()  # those of the program before
    exec(compile(text, "program.py", "exec"), names)
    if Runner.error is None or isinstance(Runner.error, RuleStopped):
        return Listener.said
    assert str(failure_of(Runner.error)), f"{Runner.error!r} is told in no words"
    return [*Listener.said, "error"]


def difference(seed: int, language: Language) -> str | None:
    """What the Python of a random program does otherwise, or None."""
    project = Maker(seed, language).project()
    try:
        text = generate_program(project, language).text
    except CodeRefused:
        return None
    try:
        expected = Interpreter(project, language).run()
    except GivenUp:
        return None
    found = played(text)
    if found == expected:
        return None
    pairs = enumerate(zip(found, expected, strict=False))
    at = next((n for n, (one, other) in pairs if one != other), min(len(found), len(expected)))
    return f"program {seed}: says {found[at : at + 1]}, not {expected[at : at + 1]}:\n{text}"


@pytest.mark.parametrize("part", range(PARTS))
def test_random_programs_do_what_the_page_says(
    part: int, language: Language, monkeypatch: pytest.MonkeyPatch
) -> None:
    with stand_ins(monkeypatch):
        found = [difference(seed, language) for seed in range(part, PROGRAMS, PARTS)]
    different = [told for told in found if told is not None]
    assert not different, f"{len(different)} of {len(found)} differ, such as " + different[0]


@pytest.mark.parametrize("part", range(PARTS))
def test_their_python_reads_back_to_the_same(part: int, language: Language) -> None:
    for seed in range(part, PROGRAMS, PARTS):
        project = Maker(seed, language).project()
        try:
            text = generate_program(project, language).text
        except CodeRefused:
            continue
        read = read_program(text, language, Project())
        assert generate_program(read, language).text == text, f"program {seed}"
        written = {b.type for b in read.blocks.values() if b.type.startswith("code.")}
        assert not written, f"program {seed} keeps Python that blocks made"


def test_most_random_programs_can_be_judged(language: Language) -> None:
    outcomes = {"judged": 0, "ended well": 0, "given up": 0, "refused": 0}
    for seed in range(100):
        project = Maker(seed, language).project()
        try:
            generate_program(project, language)
            said = Interpreter(project, language).run()
        except CodeRefused:
            outcomes["refused"] += 1
        except GivenUp:
            outcomes["given up"] += 1
        else:
            outcomes["judged"] += 1
            outcomes["ended well"] += said[-1:] != ["error"]
    assert outcomes["judged"] >= 70 and outcomes["ended well"] >= 35, outcomes


@pytest.mark.parametrize("value", ["list.create", "table.create"])
def test_a_list_or_a_table_in_a_fact_is_an_error_to_both(
    value: str, language: Language, monkeypatch: pytest.MonkeyPatch
) -> None:
    fact = B("plan.now_true", {"fact": "held"}, {"value.1": B(value)}, groups={"of": 1})
    project = build(language, [B("event.started"), fact]).project
    with stand_ins(monkeypatch):
        assert played(generate_program(project, language).text) == ["error"]
        assert Interpreter(project, language).run() == ["error"]


def test_a_planted_difference_is_found(language: Language, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test can fail: Python that counts wrongly differs."""
    with stand_ins(monkeypatch):
        project = Maker(2, language).project()
        expected = Interpreter(project, language).run()
        text = generate_program(project, language).text
        assert "nao.say(" in text
        assert played(text.replace("nao.say(", 'nao.say("" + ')) == played(text)
        assert played(text.replace("nao.say(", 'nao.say("!" + ', 1)) != expected
