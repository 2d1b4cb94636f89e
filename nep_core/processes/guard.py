"""Stands by a node of any language, and ends it when the program that started it is gone.

Such a node knows nothing of its life line, so the launcher starts this, and this starts the node.
On Linux the node ends also when the guard itself is killed.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
from functools import partial
from typing import Any

import psutil

from . import lifeline, process
from .node import STOP_SIGNALS

GUARD = "guard"
CANNOT_START = 127
GRACE_S = 1.0
"""Less than the guard itself has when it is orphaned."""


def main(words: list[str]) -> int:
    """Run a command to its end, and end as it did; the exit code."""
    try:
        child = _start(words)  # before there is any thread: see _with_guard
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        print(f"{words[0]}: {getattr(error, 'strerror', None) or error}", file=sys.stderr)
        return CANNOT_START
    for number in STOP_SIGNALS:
        signal.signal(number, lambda number, _frame: _pass_on(child, number))
    stopped = threading.Event()
    lifeline.on_parent_end(stopped.set)
    ending = threading.Thread(target=_end_when, args=(stopped, child), daemon=True)
    ending.start()
    code = child.wait()
    if stopped.is_set():
        ending.join()  # else what the node started would outlive us
    # End by the signal that ended the node, so that the launcher knows of it
    if code < 0:
        with contextlib.suppress(OSError, ValueError):
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    return code


def _start(words: list[str]) -> subprocess.Popen[bytes]:
    environment = {name: text for name, text in os.environ.items() if name != lifeline.VARIABLE}
    return subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        env=environment,
        preexec_fn=partial(_with_guard, os.getpid()) if sys.platform == "linux" else None,
    )


def _with_guard(guard: int) -> None:
    """Let the node end with the guard; in the node's process, before it begins."""
    lifeline.end_with_parent()
    if os.getppid() != guard:  # it was killed a moment ago
        os._exit(lifeline.ORPHANED)


def _pass_on(child: subprocess.Popen[bytes], number: int) -> None:
    if sys.platform != "win32":  # there the whole group has it already
        with contextlib.suppress(OSError):
            child.send_signal(number)


def _end_when(stopped: threading.Event, child: subprocess.Popen[bytes]) -> None:
    """Ask the node to stop when nobody is there any more, and end it with all that it started."""
    stopped.wait()
    started: Any = process.descendants(os.getpid())
    child.terminate()
    psutil.wait_procs(started, timeout=GRACE_S)
    process.kill(started | process.descendants(os.getpid()))
