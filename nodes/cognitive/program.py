"""The cognitive node that runs a program and tells how it goes."""

from __future__ import annotations

import runpy
import threading
import traceback
from pathlib import Path

from nep_core.default_network import set_default_network
from nep_core.messages import (
    PROGRAM_CONTROL,
    PROGRAM_STATE,
    ProgramControl,
    ProgramEvent,
    ProgramState,
)
from nep_core.node import Node
from nep_core.tasks import PROGRAM, Cancelled
from nodes.cognitive.failures import ProgramFailed, describe, line_of

ONE_HOUR_S = 3600.0


def run(node: Node, *, file: str) -> None:
    """Run the Python program ``file`` until it ends, fails or is stopped."""
    if not Path(file).is_file():
        raise ProgramFailed(
            f"There is no program {file}.", checklist=("Check the name of the file.",)
        )
    states = node.publisher(PROGRAM_STATE)

    def tell(event: ProgramEvent, description: str = "", line: int = 0) -> None:
        states.send(
            ProgramState(program=node.name, event=event, description=description, line=line)
        )

    node.subscriber(PROGRAM_CONTROL, ProgramControl, callback=lambda order: _obey(order, node))
    threading.Thread(target=_cancel_on_stop, args=(node,), daemon=True).start()
    set_default_network(node.network)
    node.ready(f"runs {Path(file).name}")
    tell("started")
    try:
        runpy.run_path(file, run_name="__main__")
    except (Cancelled, SystemExit):
        tell("finished", "stopped")
    except BaseException as error:
        if node.stopping:
            return
        traceback.print_exc()  # into the node's log
        sentence = describe(error)
        tell("failed", sentence, line_of(error, file))
        raise ProgramFailed(sentence, checklist=getattr(error, "checklist", ())) from error
    else:
        tell("finished")


def _obey(order: ProgramControl, node: Node) -> None:
    if order.program in ("", node.name):
        PROGRAM.cancel()


def _cancel_on_stop(node: Node) -> None:
    while not node.wait(ONE_HOUR_S):
        pass
    PROGRAM.cancel()
