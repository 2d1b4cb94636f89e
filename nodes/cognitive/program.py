"""The cognitive node that runs a program and tells how it goes."""

from __future__ import annotations

import contextlib
import faulthandler
import runpy
import signal
import sys
import threading
import time
import traceback
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import psutil

from faults import Fault, fault_of
from nep_core.networks.transports import set_default_network
from nep_core.processes.node import STOP_SIGNALS, Node
from nep_core.processes.node_log import BUSY_S, GOES_ON
from nep_core.program.behavior import explain_by, translate_by
from nep_core.program.human import human_listener
from nep_core.program.kept import keep_in
from nep_core.program.tasks import PROGRAM, Cancelled, RuleStopped, wait_until
from nep_core.wire.messages import (
    PROGRAM_CONTROL,
    PROGRAM_STATE,
    ProgramControl,
    ProgramEvent,
    ProgramState,
    told,
)
from nep_core.wire.pubsub import Publisher
from nodes.cognitive.failures import ProgramFailed, failure_of, in_spoken_language, line_of

if TYPE_CHECKING:
    from nodes.cognitive.tracing.tracer import Tracer

ONE_HOUR_S = 3600.0
LOOK_S = 1.0
PART_OF_MEMORY = 0.5
"""A program that would take more than that of the computer's memory gets a MemoryError."""


def run(node: Node, *, file: str, kept: str, hold: bool, trace: bool) -> None:
    """Run the Python program ``file`` until it ends, fails or is stopped.

    ``node`` is this node. With ``hold`` it is ready first, and begins when the studio says start.
    ``kept`` is the file of its variables that are kept, if it is another than the usual one. With
    ``trace`` it tells where it is, and can be paused.
    """
    if not Path(file).is_file():
        raise ProgramFailed(
            "There is no program {file}.", checklist=("Check the name of the file.",), file=file
        )
    if not file.endswith(".py") or zipfile.is_zipfile(file):
        # runpy runs what is packed inside, also of a picture that looks like one
        raise ProgramFailed(
            "{file} is no text in Python.",
            checklist=("Choose a file whose name ends in .py.",),
            file=file,
        )
    if kept:
        keep_in(Path(kept))
    states = node.publisher(PROGRAM_STATE)
    tracer = _tracer(states, node, file) if trace else None
    begin = threading.Event()
    _listen_for_orders(node, begin, tracer)
    set_default_network(node.network)
    _keep_memory_for_others()
    failures: list[BaseException] = []

    def explain(error: BaseException) -> tuple[Fault, int]:
        failures.append(error)
        return failure_of(error), line_of(error, file)

    explain_by(explain)
    translate_by(in_spoken_language)
    human = human_listener(node.network)  # what the person does from now on reaches the rules
    node.follow(human.subscriber)  # what does not is told
    node.ready("runs {name}", name=Path(file).name)
    try:
        if hold:
            wait_until(begin.is_set)
        _tell(states, node, "started")
        with _traced(tracer), _telling_of_hangs():
            runpy.run_path(file, run_name="__main__")
    except Cancelled:
        _tell(states, node, "finished", fault_of("stopped", code="stopped"))
    except RuleStopped:  # in a program without rules, which is one
        _tell(states, node, "finished")
    except SystemExit as error:
        if error.code not in (None, 0):
            _fail(states, node, file, error)
        _tell(states, node, "finished")
    except BaseException as error:
        if node.stopping:
            return
        traceback.print_exc()  # into the node's log
        _fail(states, node, file, error)
    else:
        _tell(states, node, "finished")
    finally:
        node.stop_on_signals()  # the program is over: end the node in the usual way
    if failures:  # rules of a program that went on, and was stopped in the end
        raise SystemExit(1)


def _keep_memory_for_others() -> None:
    """Let Python refuse a text or a list that doubles in a loop, before it fills the computer.

    Without a limit Linux would end some program then, maybe the window. macOS and Windows have none
    that counts what a process really uses.
    """
    if sys.platform != "linux":
        return
    import resource

    most = int(psutil.virtual_memory().total * PART_OF_MEMORY)
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    given = [one for one in (soft, hard) if one != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_DATA, (min(most, *given) if given else most, hard))


def _tracer(states: Publisher, node: Node, file: str) -> Tracer:
    from nodes.cognitive.tracing.tracer import Tracer  # costs time, and is seldom needed

    return Tracer(node.name, file, states.send)


@contextlib.contextmanager
def _traced(tracer: Tracer | None) -> Iterator[None]:
    if tracer is None:
        yield
        return
    tracer.begin()
    try:
        yield
    finally:
        tracer.end()


@contextlib.contextmanager
def _telling_of_hangs() -> Iterator[None]:
    """Let Python write where the program is when it does nothing else for BUSY_S.

    A single call, such as a very large power, holds up all threads of this process, also the one
    that tells of lines. So who started the node reads it in its log: nep_core.processes.node_log.
    """
    over, written = threading.Event(), sys.__stderr__

    def keep_off(file: TextIO) -> None:
        looked_s = time.monotonic()
        while not over.is_set():
            faulthandler.dump_traceback_later(BUSY_S, file=file)
            if time.monotonic() - looked_s > BUSY_S:
                print(GOES_ON, file=file, flush=True)
            looked_s = time.monotonic()
            over.wait(LOOK_S)
        faulthandler.cancel_dump_traceback_later()

    if written is not None:
        threading.Thread(target=keep_off, args=[written], name="nep-hangs", daemon=True).start()
    try:
        yield
    finally:
        over.set()


def _tell(
    states: Publisher, node: Node, event: ProgramEvent, fault: Fault | None = None, line: int = 0
) -> None:
    states.send(ProgramState(program=node.name, event=event, line=line, **told(fault)))


def _fail(states: Publisher, node: Node, file: str, error: BaseException) -> None:
    failure = failure_of(error)
    _tell(states, node, "failed", failure, line_of(error, file))
    raise ProgramFailed.of(failure) from error


def _listen_for_orders(node: Node, begin: threading.Event, tracer: Tracer | None) -> None:
    """End the program on signals, when the node is stopped, and when the studio asks."""

    def obey(order: ProgramControl) -> None:
        if order.program not in ("", node.name):
            return
        if order.command == "start":
            begin.set()
        elif order.command == "stop":
            cancel()
        elif tracer is not None:
            tracer.obey(order)

    def cancel() -> None:
        PROGRAM.cancel()
        if tracer is not None:
            tracer.wake()

    def cancel_on_stop() -> None:
        while not node.wait(ONE_HOUR_S):
            pass
        cancel()

    def on_signal(*_: Any) -> None:
        node.stop()
        raise Cancelled  # programs run in the main thread, as signals do

    node.subscriber(PROGRAM_CONTROL, ProgramControl, callback=obey)
    threading.Thread(target=cancel_on_stop, name="nep-program-stop", daemon=True).start()
    for number in STOP_SIGNALS:
        signal.signal(number, on_signal)
