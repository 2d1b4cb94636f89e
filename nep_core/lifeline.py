"""No orphans: a child ends when its parent is gone, on every operating system.

The parent holds the other end of the child's standard input; the child sees it close.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

VARIABLE = "NEP_LIFELINE"
"""Set by the launcher: standard input is a life line."""

GRACE_S = 2.0
ORPHANED = 70


def on_parent_end(stop: Callable[[], None]) -> None:
    """Call ``stop`` when the parent is gone, and end the process 2 s later at the latest.

    Does nothing in a process that the launcher did not start.
    """
    if os.environ.pop(VARIABLE, "") != "1":
        return
    line = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)  # a user's input() must not read the life line
    os.close(nothing)

    def watch() -> None:
        # Raw reads: a buffered reader here aborts the interpreter when it shuts down.
        while os.read(line, 1):
            pass
        stop()
        time.sleep(GRACE_S)
        os._exit(ORPHANED)

    threading.Thread(target=watch, name="nep-lifeline", daemon=True).start()
