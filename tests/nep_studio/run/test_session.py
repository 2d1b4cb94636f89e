"""A session: how it ends, and how it stops."""

from __future__ import annotations

import queue
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import msgspec
import psutil
import pytest

from nep_core.processes import launcher
from nep_core.processes.process import Outcome
from nep_core.wire import messages as m
from nep_studio.run import session as sessions
from nep_studio.run.local_network import LocalNetwork, free_endpoint
from nep_studio.run.plan import PROGRAM, REPLAY, PlannedNode
from nep_studio.run.session import Session

pytestmark = pytest.mark.long

WAIT_S = 20.0
FOR_EVER = "from nep_core import wait\nwait(600)"


class Heard:
    """What a session's listener heard, and a way to wait for it."""

    def __init__(self) -> None:
        self.states: list[m.NodeState] = []
        self._came = threading.Condition()

    def __call__(self, _topic: str, message: msgspec.Struct) -> None:
        if isinstance(message, m.NodeState):
            with self._came:
                self.states.append(message)
                self._came.notify_all()

    def wait_for(self, node: str, event: str) -> m.NodeState:
        def found() -> list[m.NodeState]:
            return [one for one in self.states if (one.node, one.event) == (node, event)]

        with self._came:
            assert self._came.wait_for(found, WAIT_S), self.states
            return found()[0]


@contextmanager
def session(folder: Path, program: str, *nodes: PlannedNode) -> Iterator[tuple[Session, Heard]]:
    file = folder / "program.py"
    file.write_text(program, encoding="utf-8")
    heard = Heard()
    network = LocalNetwork(logs=folder)
    network.listen(heard)
    with closing(network), Session(nodes, network, program=file) as running:
        yield running, heard


def test_a_programs_problem_has_the_checklist_of_its_error(tmp_path: Path) -> None:
    program = """
from nep_core.errors import RobotNotAnswering
raise RobotNotAnswering("NAO does not answer.", checklist=("Is NAO switched on?", "Is it near?"))
"""
    with session(tmp_path, program) as (running, _):
        ending = running.wait(WAIT_S)

    steps = ("Is NAO switched on?", "Is it near?")
    sentence = "NAO does not answer."
    assert ending.line == 3
    assert ending.problem is not None
    assert ending.problem.title == "The program stopped with an error"
    assert str(ending.problem.sentence) == sentence
    assert tuple(map(str, ending.problem.checklist)) == steps


def test_only_the_programs_own_failure_is_its_problem(tmp_path: Path) -> None:
    program = """
import os
from nep_core import Publisher
from nep_core.networks.transports import default_network
from nep_core.wire.messages import PROGRAM_STATE, ProgramState
Publisher(PROGRAM_STATE).send(ProgramState(program="another", event="failed", description="No."))
default_network().close()
os._exit(3)
"""
    with session(tmp_path, program) as (running, _):
        ending = running.wait(WAIT_S)

    assert ending.problem is not None
    assert str(ending.problem.sentence) == "program ended with an error: exit code 3."


def test_a_failure_that_comes_after_the_programs_end_still_names_its_line(tmp_path: Path) -> None:
    waiting = Session([], LocalNetwork(logs=tmp_path))
    late = m.ProgramState(program=PROGRAM, event="failed", description="Late.", line=7)

    class Late(threading.Condition):
        def wait_for(self, is_true: object, timeout: float | None = None) -> bool:
            assert timeout
            waiting._on_message(m.PROGRAM_STATE, late)
            return True

    waiting._changed = Late()
    ending = waiting._program_ending(Outcome(PROGRAM, 1))

    assert (ending.problem and str(ending.problem.sentence), ending.line) == ("Late.", 7)


def test_a_recording_that_is_given_up_is_a_problem(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(launcher, "MOST_RESTARTS", 0)
    monkeypatch.setattr(sessions, "LAST_RULES_S", 0.0)
    table = "t,ax,ay,az\n" + "".join(f"{i / 50},0.1,0.2,9.8\n" for i in range(3000))
    (tmp_path / "mine.csv").write_text(table, encoding="utf-8")
    settings = {"recording": str(tmp_path / "mine.csv"), "quit_at_end": True}

    replay = PlannedNode(REPLAY, "recording", settings)
    with session(tmp_path, FOR_EVER, replay) as (running, heard):
        psutil.Process(heard.wait_for("recording", "ready").pid).kill()
        ending = running.wait(WAIT_S)

    assert str(ending.problem) == "The recording stopped\nrecording was killed."


def test_a_stopped_node_is_heard_to_stop_and_a_session_may_be_stopped_twice(
    tmp_path: Path,
) -> None:
    robot = PlannedNode("action/nao", "NAO", {"robot": "NAO", "driver": "virtual"})

    with session(tmp_path, FOR_EVER, robot) as (running, heard):
        heard.wait_for("NAO", "ready")
        running.stop()

    assert heard.wait_for("NAO", "stopped")


@pytest.mark.parametrize("elsewhere", ["tcp://192.0.2.1:7100", "tcp://[::1]:7100"])
def test_a_masters_place_that_is_not_here_is_exchanged_for_one_that_is(elsewhere: str) -> None:
    assert free_endpoint(elsewhere).startswith("tcp://127.0.0.1:")


def test_a_free_place_is_taken_and_a_used_one_exchanged_for_its_neighbour(free_port: int) -> None:
    wanted = f"tcp://127.0.0.1:{free_port}"
    assert free_endpoint(wanted) == wanted

    with socket.socket() as other:
        other.bind(("127.0.0.1", free_port))
        other.listen()
        found = free_endpoint(wanted)

    assert found != wanted
    assert found.startswith("tcp://127.0.0.1:")


HANGS = """
from nep_core import Behavior, wait
behavior = Behavior("Hangs")

@behavior.when_started
def patient():
    wait(600)

@behavior.when_started
def hasty():
    9 ** 9 ** 9

behavior.run()
"""


def test_a_call_that_holds_up_the_program_is_told_with_its_line_and_can_be_stopped(
    tmp_path: Path,
) -> None:
    told = queue.SimpleQueue[m.ProgramState]()

    def hear(_topic: str, message: msgspec.Struct) -> None:
        if isinstance(message, m.ProgramState) and message.event == "warning":
            told.put(message)

    with session(tmp_path, HANGS) as (running, _):
        running.network.listen(hear)
        warning = told.get(timeout=3 * WAIT_S)
        begun_s = time.monotonic()

    assert (warning.line, warning.fault.code) == (11, "busy")
    assert time.monotonic() - begun_s < WAIT_S
