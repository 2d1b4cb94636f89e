"""No orphans: a child ends when its parent is gone, on every operating system.

The parent holds the other end of the child's standard input; the child sees it close. Code that
never lets Python run, as a library that keeps the interpreter's lock, cannot see it: there the
system ends the process, on Linux by an alarm (3 s), on Windows by the launcher's job (job.py).
"""

from __future__ import annotations

import atexit
import contextlib
import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable

VARIABLE = "NEP_LIFELINE"
"""Set by the launcher: standard input is a life line."""

GRACE_S = 2.0
LATER_S = 8
"""So much later the system ends a process that does not end by itself."""
ORPHANED = 70
PR_SET_PDEATHSIG = 1


def on_parent_end(stop: Callable[[], None], *, grace_s: float = GRACE_S) -> bool:
    """Call ``stop`` when the parent is gone, and end the process ``grace_s`` later at the latest.

    What it started ends with it. Returns False, and does nothing, in a process that the launcher
    did not start. To be called in the main thread.
    """
    if os.environ.pop(VARIABLE, "") != "1":
        return False
    line = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)  # a user's input() must not read the life line
    os.close(nothing)
    gone = threading.Event()
    atexit.register(_end_all_when, gone)
    if sys.platform == "linux":
        _set_alarm_for_parent_end()

    def watch() -> None:
        # Raw reads: a buffered reader here aborts the interpreter when it shuts down.
        while os.read(line, 1):
            pass
        if sys.platform == "linux":
            _put_off_alarm(grace_s)
        gone.set()
        stop()
        time.sleep(grace_s)
        _end_all_when(gone)
        os._exit(ORPHANED)

    threading.Thread(target=watch, name="nep-lifeline", daemon=True).start()
    return True


def end_with_parent() -> None:
    """Let the system end this process at once when its parent is gone; Linux only."""
    import ctypes

    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _set_alarm_for_parent_end() -> None:
    """Let the system ring an alarm 3 s after the parent's end, which ends whoever still runs.

    It must work without Python, so the handler of the signal is the system's own function
    ``alarm(seconds)``: it is called with the number of the signal, and SIGQUIT is 3.
    """
    import ctypes

    system = ctypes.CDLL(None)
    system.signal.argtypes, system.signal.restype = (ctypes.c_int, ctypes.c_void_p), ctypes.c_void_p
    system.signal(signal.SIGQUIT, ctypes.cast(system.alarm, ctypes.c_void_p))
    system.prctl(PR_SET_PDEATHSIG, signal.SIGQUIT)


def _put_off_alarm(grace_s: float) -> None:
    """Python runs, and ends this process by itself: give it time, should the computer be busy.

    The life line ends a moment before the system sends its SIGQUIT, which is ignored from now on.
    """
    import ctypes

    ignored = ctypes.c_void_p(1)  # SIG_IGN; Python's own call is for the main thread only
    ctypes.CDLL(None).signal(signal.SIGQUIT, ignored)
    signal.alarm(math.ceil(grace_s) + LATER_S)


def _end_all_when(gone: threading.Event) -> None:
    """End all that this process started, and itself, when nobody is there to do it."""
    if not gone.is_set():
        return
    from . import process

    process.kill(process.marked(os.environ.get(process.VARIABLE, "")))
    with contextlib.suppress(OSError, AttributeError):  # Windows has no groups
        if os.getpgrp() == os.getpid():  # the launcher made it a group of its own
            os.killpg(0, signal.SIGKILL)
