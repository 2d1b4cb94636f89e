"""Where the frozen program begins: the same jobs as ``nep-studio`` and ``nep`` from source."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path

SET_FOR_US = ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "LIBPATH")


def give_back_environment() -> None:
    """Let programs that we start, such as another Python, find their own libraries, not ours."""
    for name in SET_FOR_US:
        before = os.environ.pop(f"{name}_ORIG", None)
        if before is not None:
            os.environ[name] = before
        else:
            os.environ.pop(name, None)


def write_at_once() -> None:
    """Do as Python does with PYTHONUNBUFFERED, which the launcher sets: a node's log is whole."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(write_through=True)


def start() -> int:
    """Do the job; the exit code. Under its second name it is the command ``nep``."""
    give_back_environment()
    if os.environ.get("PYTHONUNBUFFERED"):
        write_at_once()
    if Path(sys.argv[0]).stem == "nep":
        from nep_core.cli import main as nep
        from nep_studio.support import portable

        portable.begin()
        return nep(sys.argv[1:])
    from nep_studio.__main__ import main

    return main()


if __name__ == "__main__":
    sys.exit(start())
