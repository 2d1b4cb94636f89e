"""The program node in a process of its own: what it tells, and the orders that it obeys."""

from __future__ import annotations

import queue
import sys
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import psutil
import pytest
from program_following import WAIT_S, Heard

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    HUMAN_BEHAVIOR,
    PROGRAM_CONTROL,
    PROGRAM_STATE,
    ActionRequest,
    ActionResult,
    HumanBehavior,
    ProgramControl,
    ProgramState,
)
from nep_core.wire.pubsub import Publisher, Subscriber

RULES = """
    from nep_core import Behavior, wait

    behavior = Behavior("Many")
    count = 0

    @behavior.when("gesture_karate")
    def karate():
        global count
        count += 1
        wait(600)

    behavior.run()
    """


class Studio:
    """Starts programs as the window does, gives them orders, and hears them."""

    def __init__(self, network: PeerNetwork, launcher: Launcher, folder: Path) -> None:
        self.heard = Heard()
        self._launcher = launcher
        self._file = folder / "program.py"
        self._control = Publisher(PROGRAM_CONTROL, network=network)
        self._person = Publisher(HUMAN_BEHAVIOR, network=network)
        Subscriber(PROGRAM_STATE, ProgramState, network=network, callback=self.heard)

    def open(self, source: str, *, trace: bool = True) -> LaunchedNode:
        """Start the node of a program, which waits until it is told to start."""
        self._file.write_text(dedent(source).lstrip(), encoding="utf-8")
        settings = {"file": str(self._file), "hold": True, "trace": trace}
        launched = self._launcher.launch(
            "cognitive/program", "program", settings, restart="on-kill"
        )
        launched.wait_ready(WAIT_S)
        return launched

    def order(self, command: Any, **settings: Any) -> None:
        self._control.send(ProgramControl(command=command, program="program", **settings))

    def does(self, state: str) -> None:
        self._person.send(HumanBehavior(human_state=state))

    def ended(self, event: str) -> ProgramState:
        return self.heard.until(lambda s: s.event == event)


@pytest.fixture
def studio(network: PeerNetwork, tmp_path: Path) -> Iterator[Studio]:
    with Launcher(logs=tmp_path / "logs", master=network.master) as launcher:
        launcher.hear(network)
        yield Studio(network, launcher, tmp_path)


def of_rules(lines: dict[str, list[int]]) -> dict[str, list[int]]:
    return {name: stack for name, stack in lines.items() if name != "MainThread"}


def test_a_rule_is_at_its_line_until_it_ends(studio: Studio) -> None:
    studio.open(RULES)
    studio.order("start")
    studio.heard.lines(lambda lines: lines == {"MainThread": [12]})

    studio.does("gesture_karate")

    studio.heard.lines(lambda lines: of_rules(lines) == {"nep-gesture_karate": [10]})
    studio.heard.value("count", "1")
    studio.order("stop")
    studio.heard.lines(lambda lines: not lines)
    assert studio.ended("finished")


def test_breakpoints_that_are_set_before_the_start_hold_the_first_run(studio: Studio) -> None:
    launched = studio.open(RULES)
    studio.order("set", breakpoints=[6])
    studio.order("start")
    studio.heard.lines(lambda lines: lines == {"MainThread": [12]})
    studio.does("gesture_karate")

    assert studio.heard.paused("karate") == (9, "breakpoint")
    studio.order("step", thread="nep-gesture_karate")
    assert studio.heard.paused("karate") == (10, "step")

    studio.order("stop")
    assert studio.ended("finished")
    assert launched.ended.wait(WAIT_S)
    assert launched.outcome is not None
    assert launched.outcome.was_successful


def test_twenty_rules_at_once_are_told_together(studio: Studio) -> None:
    rules = "\n".join(f'@behavior.when("wave")\ndef wave{n}():\n    wait(600)\n' for n in range(20))
    head = 'from nep_core import Behavior, wait\nbehavior = Behavior("Many")\n'
    studio.open(f"{head}{rules}\nbehavior.run()")
    studio.order("start")
    studio.heard.lines(lambda lines: "MainThread" in lines and not of_rules(lines))

    studio.does("wave")

    lines = of_rules(studio.heard.lines(lambda lines: len(of_rules(lines)) == 20))
    assert {"nep-wave", "nep-wave-20"} <= set(lines)
    assert {tuple(stack) for stack in lines.values()} == {(5 + 4 * n,) for n in range(20)}


def test_a_program_of_5000_blocks_is_traced(studio: Studio) -> None:
    body = "".join(f"    x = x + {n}\n    y = x\n" for n in range(2500))
    studio.open(
        "from nep_core import Behavior, wait\n"
        'behavior = Behavior("Long")\nx = 0\ny = 0\n\n'
        "@behavior.when_started\ndef start():\n    global x, y\n"
        f"{body}    wait(600)\n\nbehavior.run()"
    )
    studio.order("set", breakpoints=[5007])

    studio.order("start")

    assert studio.heard.paused() == (5007, "breakpoint")
    studio.order("resume")
    studio.heard.lines(lambda lines: of_rules(lines) == {"nep-start": [5009]})
    studio.heard.value("y", str(sum(range(2500))))


@pytest.mark.parametrize("trace", [False, True])
def test_a_failure_tells_its_line_and_a_checklist(studio: Studio, trace: bool) -> None:
    launched = studio.open('animals = ["cat", "dog"]\nx = animals[5 - 1]', trace=trace)
    studio.order("start")

    failed = studio.ended("failed")

    sentence = "The list “animals” has 2 items, and item 5 was asked for."
    assert (failed.line, failed.description) == (2, sentence)
    assert launched.ended.wait(WAIT_S)
    assert launched.outcome is not None
    assert str(launched.outcome.checklist[0]) == "Check the number: the first item is number 1."


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits what is really used")
def test_a_program_that_would_fill_the_memory_is_an_error_with_its_line(studio: Studio) -> None:
    most_of_it = int(psutil.virtual_memory().total * 0.6)
    studio.open(f"x = 1\ntext = bytes({most_of_it})", trace=False)
    studio.order("start")

    failed = studio.ended("failed")

    sentence = "The program needs more memory than there is."
    assert (failed.line, failed.description) == (2, sentence)


@pytest.mark.parametrize("command", ["pause", "step", "resume", "set"])
def test_a_program_that_is_not_traced_ignores_what_it_cannot_obey(
    studio: Studio, command: str
) -> None:
    studio.open("x = 1", trace=False)

    studio.order(command, breakpoints=[1])
    studio.order("start")

    assert studio.ended("finished").description == ""
    assert {state.event for state in studio.heard.states} == {"started", "finished"}


def test_a_paused_program_ends_with_its_node(studio: Studio) -> None:
    launched = studio.open("x = 1\nx = 2")
    studio.order("pause")
    studio.order("start")
    studio.heard.paused()

    assert launched.process is not None
    launched.process.ask_to_stop()

    assert launched.ended.wait(WAIT_S)
    assert launched.outcome is not None
    assert launched.outcome.was_successful


def test_a_program_may_end_while_one_of_its_rules_is_paused(studio: Studio) -> None:
    studio.open("""
        from nep_core import Behavior, wait_until, times_seen

        behavior = Behavior("Two", on_error="end")

        @behavior.when("gesture_karate")
        def karate():
            x = 1

        @behavior.when_started
        def start():
            wait_until(lambda: times_seen("gesture_batting"))[0]

        behavior.run()
        """)
    studio.order("set", breakpoints=[7])
    studio.order("start")
    studio.heard.lines(lambda lines: "nep-start" in lines)
    studio.does("gesture_karate")
    studio.heard.paused("karate")

    studio.does("gesture_batting")

    failed = studio.ended("failed")
    assert failed.line == 11
    assert failed.description == "A list belongs here, and this is something else."


def test_nothing_new_begins_when_an_action_was_stopped_with_the_program(
    studio: Studio, network: PeerNetwork
) -> None:
    results = Publisher(ACTION_RESULT, network=network)
    asked: queue.Queue[ActionRequest] = queue.Queue()
    Subscriber(ACTION_REQUEST, ActionRequest, network=network, callback=asked.put)
    studio.open('from nep_core import Robot\nnao = Robot("NAO")\nnao.say("a")\nnao.say("b")')
    studio.order("start")
    request = asked.get(timeout=WAIT_S)

    results.send(ActionResult(id=request.id, robot="NAO", state="cancelled"))
    studio.order("stop")

    studio.ended("finished")
    ids = {request.id, *(asked.get().id for _ in range(asked.qsize()))}
    assert ids == {request.id}
