"""Run without a window: the states that a program goes through, and what is told of it."""

from __future__ import annotations

import contextlib
import queue
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from nep_core.wire import messages as m
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.run.controller import (
    PREPARING,
    BecameStale,
    Checked,
    Ended,
    Event,
    Refused,
    RunController,
    StateChanged,
    Subject,
)
from nep_studio.run.installation import studio_language
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import PlannedNode
from tests.blocks.block_building import B, build

pytestmark = pytest.mark.long

WAIT_S = 30.0
LONG_WAIT = B("control.wait", {"seconds": 600})


class Owner:
    """Who owns a controller: does what is posted, in order, and gives it time to prepare."""

    def __init__(self, folder: Path, language: Language) -> None:
        self.language = language
        self.editor: Editor | None = None
        self.is_in_order = False
        self.code: Code | None = None
        self.known: list[PlannedNode] | None = None
        self.network = LocalNetwork(logs=folder / "logs")
        self.events: list[Event] = []
        self.heard: list[m.ProgramState] = []
        self._posted: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.controller = RunController(
            lambda: self.network, self.subject, self._posted.put, self.events.append
        )
        self.network.listen(self._on_message)

    def subject(self) -> Subject | None:
        if self.editor is None:
            return None
        subject = Subject(self.editor.project, self.language, Path.cwd())
        made = {"is_in_order": self.is_in_order, "code": self.code, "known": self.known}
        return replace(subject, **made)

    def open(self, *stacks: list[B]) -> None:
        """Open a program of these stacks, with NAO."""
        self.editor = build(self.language, *stacks)
        build(self.language, [B("robots.robot")], page="robots", editor=self.editor)
        self.editor.history.listen(self.controller.edited)

    def turn(self) -> None:
        """One turn of an event loop."""
        if self.controller.state in PREPARING:
            self.controller.work(0.0)
        with contextlib.suppress(queue.Empty):
            self._posted.get(timeout=0.002)()

    def until(self, is_so: Callable[[], bool]) -> None:
        deadline_s = time.monotonic() + WAIT_S
        while not is_so():
            assert time.monotonic() < deadline_s, self.events
            self.turn()

    def until_state(self, state: str) -> None:
        self.until(lambda: self.controller.state == state)

    def states(self) -> list[str]:
        return [event.state for event in self.events if isinstance(event, StateChanged)]

    def last(self, kind: type[Event]) -> Event:
        return [event for event in self.events if isinstance(event, kind)][-1]

    def _on_message(self, _topic: str, message: object) -> None:
        if isinstance(message, m.ProgramState):
            self.heard.append(message)
            self._posted.put(lambda: self.controller.heard(message))


@pytest.fixture
def owner(tmp_path: Path) -> Iterator[Owner]:
    made = Owner(tmp_path, studio_language())
    yield made
    made.controller.close()
    made.network.close()


def test_a_program_goes_through_all_states_and_ends_by_itself(owner: Owner) -> None:
    owner.open([B("event.started"), B("control.wait", {"seconds": 0.05})])

    owner.controller.run()
    owner.until(lambda: any(isinstance(event, Ended) for event in owner.events))

    assert owner.states() == ["checking", "generating", "starting", "running", "idle"]
    end = owner.last(Ended)
    assert (end.ending.problem, end.was_stopped, end.had_begun) == (None, False, True)


def test_a_program_that_nothing_starts_is_not_run(owner: Owner) -> None:
    owner.open([B("control.wait")])

    owner.controller.run()
    owner.until_state("idle")

    checked = owner.last(Checked)
    assert not checked.can_run
    assert "no_rule" in [problem.kind for problem in checked.problems]
    assert owner.states() == ["checking", "idle"]


def test_what_is_in_order_already_is_not_checked_again(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.is_in_order = True

    owner.controller.run()
    owner.until_state("running")

    assert owner.states() == ["generating", "starting", "running"]


def test_code_that_was_made_already_is_run(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.is_in_order = True
    owner.code = generate_program(owner.editor.project, owner.language)

    owner.controller.run()
    owner.until_state("running")

    assert owner.states() == ["starting", "running"]
    assert owner.controller.request.code is owner.code


def test_where_nothing_is_open_nothing_happens(owner: Owner) -> None:
    owner.controller.run()

    assert owner.events == []


def test_a_stop_during_the_checks_gives_them_up(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.controller.run()
    owner.turn()

    owner.controller.stop()

    assert owner.states() == ["checking", "idle"]


def test_a_change_during_the_checks_is_checked_too(owner: Owner) -> None:
    owner.open([B("event.started"), B("robot.say", {"robot": "NAO"})])
    owner.controller.run()
    owner.turn()

    block = next(b.id for b in owner.editor.project.blocks.values() if b.type == "robot.say")
    owner.editor.apply(SetField(block, "robot", "Nobody"))
    owner.until_state("idle")

    assert "robot_missing" in [problem.kind for problem in owner.last(Checked).problems]
    assert owner.states() == ["checking", "idle"]


def test_a_change_while_the_code_is_made_is_in_the_code(owner: Owner) -> None:
    owner.open([B("event.started"), B("control.wait", {"seconds": 600})])
    owner.controller.run()
    owner.until_state("generating")

    wait = next(b.id for b in owner.editor.project.blocks.values() if b.type == "control.wait")
    owner.editor.apply(SetField(wait, "seconds", 0.07))
    owner.until_state("starting")

    assert "0.07" in owner.controller.request.code.text
    assert not owner.controller.is_stale


def test_a_change_while_the_code_is_made_is_checked_and_planned_too(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.is_in_order = True
    owner.known = owner.subject().nodes()
    owner.controller.run()
    assert owner.controller.state == "generating"

    build(owner.language, [B("robots.robot", {"name": "Ann"})], page="robots", editor=owner.editor)
    owner.until_state("starting")

    assert owner.states() == ["generating", "checking", "generating", "starting"]
    assert "Ann" in [node.parameters.get("robot") for node in owner.controller.request.nodes]


def test_a_program_that_cannot_become_code_is_refused(
    owner: Owner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_studio.run.controller.problem_steps", _no_problems)
    owner.open([B("event.started"), B("control.leave_loop")])

    owner.controller.run()
    owner.until(lambda: any(isinstance(event, Refused) for event in owner.events))

    assert owner.controller.state == "idle"


def _no_problems(*_args: object) -> Iterator[None]:
    yield
    return []


def test_a_pressed_run_begins_anew_and_is_not_told_as_an_end(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.controller.run()
    owner.until_state("running")
    wait = next(b.id for b in owner.editor.project.blocks.values() if b.type == "control.wait")
    owner.editor.apply(SetField(wait, "seconds", 500))
    assert isinstance(owner.last(BecameStale), BecameStale)

    owner.controller.run()
    owner.until(lambda: owner.states().count("running") == 2)

    assert owner.last(Ended).runs_again
    assert not owner.controller.is_stale
    assert "500" in owner.controller.request.code.text


def test_a_program_pauses_goes_a_step_and_goes_on(owner: Owner) -> None:
    loop = B("control.forever", bodies={"do": [B("control.wait", {"seconds": 0.02})]})
    owner.open([B("event.started"), loop])
    owner.controller.run()
    owner.until_state("running")

    owner.controller.pause()
    owner.until(lambda: any(one.event == "paused" for one in owner.heard))
    owner.controller.step()
    owner.controller.run()

    assert owner.states()[-2:] == ["paused", "running"]


def test_a_program_pauses_by_itself_at_a_breakpoint(owner: Owner) -> None:
    owner.open([B("event.started"), B("control.wait", {"seconds": 0.01}), LONG_WAIT])
    waits = [b.id for b in owner.editor.project.blocks.values() if b.type == "control.wait"]
    owner.controller.watch(frozenset(waits[:1]), 0.0)

    owner.controller.run()

    owner.until_state("paused")


def test_a_program_that_is_tried_out_pauses_nowhere(owner: Owner) -> None:
    owner.open([B("event.started"), B("control.wait", {"seconds": 0.01})])
    owner.controller.watch(frozenset(owner.editor.project.blocks), 0.0)

    owner.controller.try_out(owner.subject())
    owner.until(lambda: any(isinstance(event, Ended) for event in owner.events))

    assert owner.states() == ["generating", "starting", "running", "idle"]


def test_an_error_of_the_program_is_told_with_its_line(owner: Owner) -> None:
    divide = B("math.arithmetic", {"operation": "divide", "a": 1, "b": 0})
    owner.open([B("event.started"), B("robot.say", {}, {"text": divide})])

    owner.controller.run()
    owner.until(lambda: any(isinstance(event, Ended) for event in owner.events))

    ending = owner.last(Ended).ending
    assert "zero" in str(ending.problem.sentence)
    assert ending.line > 0


def test_nothing_starts_once_it_is_closed(owner: Owner) -> None:
    owner.open([B("event.started"), LONG_WAIT])
    owner.controller.run()
    owner.until_state("starting")

    owner.controller.close()
    owner.until_state("idle")
    owner.controller.run()

    assert owner.controller.state == "idle"
    assert owner.last(Ended).was_stopped


def test_the_controller_knows_no_qt() -> None:
    code = (
        "import sys, nep_studio.run.controller;"
        "sys.exit(any(name.startswith('PySide6') for name in sys.modules))"
    )

    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
