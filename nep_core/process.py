"""One child process: started with a life line, its output kept, stopped with all its children."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import subprocess
import sys
import threading
import uuid
from collections import deque
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import psutil

from nep_core import lifeline, process_tree
from nep_core.errors import NodeStartError
from nep_core.lasting_thread import in_lasting_thread
from nep_core.node_log import NodeLog
from nep_core.outcome import Outcome

if TYPE_CHECKING:
    from nep_core.job import Job

log = logging.getLogger(__name__)

ON_WINDOWS = sys.platform == "win32"
STOP_SIGNAL: int = getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM)
STEP = "  [ ] "
"""What a step of a checklist begins with in a node's output."""

KEPT_LINES = 200
LINE_BYTES = 65_536
"""A longer line is read in pieces, so that it cannot fill the memory."""

MOST_LOOKS = 5
LOOK_S = 0.5
"""How often, and how long each, what a process has left behind is looked for."""

KILL_S = 5.0
"""One that even the system cannot end, such as for a disk that is gone, is not waited for."""


class ChildProcess:
    """A running child; ``on_end`` is called with its Outcome, in a thread of its own.

    ``goes_on``: it takes the place of one that crashed, and its log follows the other's.

    Raises NodeStartError when the command cannot be run.
    """

    def __init__(
        self,
        name: str,
        command: list[str],
        *,
        environment: dict[str, str],
        log_file: Path,
        goes_on: bool = False,
        on_end: Callable[[Outcome], None],
    ) -> None:
        self.name = name
        self._asked = False
        self._on_end = on_end
        self._last_lines: deque[str] = deque(maxlen=KEPT_LINES)
        self._log_file, self._goes_on = log_file, goes_on
        self._children_ended = threading.Event()
        self._mark = uuid.uuid4().hex
        marks = f"{environment.get(process_tree.VARIABLE, '')} {self._mark}".strip()
        environment = {**environment, process_tree.VARIABLE: marks}
        self._popen, self._job = in_lasting_thread(partial(_start, name, command, environment))
        self._reader = threading.Thread(target=self._read, name=f"nep-log-{name}", daemon=True)
        self._reader.start()
        threading.Thread(target=self._await_end, name=f"nep-wait-{name}", daemon=True).start()

    @property
    def pid(self) -> int:
        """The process id."""
        return self._popen.pid

    @property
    def last_lines(self) -> list[str]:
        """The last lines that it wrote, at most 200."""
        return list(self._last_lines)

    def poll(self) -> int | None:
        """Its exit code; None while it runs."""
        return self._popen.poll()

    def wait(self, timeout_s: float | None = None) -> int | None:
        """Wait for its end; its exit code, None when the time is over."""
        try:
            return self._popen.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return None

    def ask_to_stop(self) -> None:
        """Send SIGTERM (Windows: Ctrl-Break), or else let go of its life line."""
        self._asked = True
        with contextlib.suppress(OSError):
            if _can_send_signals():
                self._popen.send_signal(STOP_SIGNAL)
            elif self._popen.stdin is not None:
                self._popen.stdin.close()

    def stop(self, grace_s: float = 2.0) -> None:
        """Ask it to stop, and end the whole process tree after ``grace_s``."""
        if self.poll() is None:  # when it has ended, another process may have its number
            self.ask_to_stop()
            if self.wait(grace_s) is None:
                log.warning("%s did not stop within %.0f s and was ended", self.name, grace_s)
                with contextlib.suppress(OSError):
                    self._popen.kill()
        self._children_ended.wait(KILL_S)

    def _end_children(self) -> None:
        if self._job is not None:
            self._job.end()
        if not ON_WINDOWS:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, signal.SIGKILL)
        for _ in range(MOST_LOOKS):
            left = process_tree.marked(self._mark)
            if not left:
                return
            process_tree.kill(left)  # what they started meanwhile is seen at the next look
            psutil.wait_procs(left, timeout=LOOK_S)

    def _read(self) -> None:
        assert self._popen.stdout is not None
        node_log = NodeLog(self._log_file, goes_on=self._goes_on)
        with self._popen.stdout as output, node_log as kept:
            while piece := output.readline(LINE_BYTES):
                self._last_lines.append(piece.decode(errors="replace").rstrip())
                kept.write(piece)

    def _await_end(self) -> None:
        code = self._popen.wait()
        self._end_children()  # at once, while no other process has its number
        self._children_ended.set()
        self._reader.join(1.0)  # one that we may not end may hold the pipe open
        if self._popen.stdin is not None:
            self._popen.stdin.close()
        self._on_end(Outcome(self.name, code, self._asked, *last_words(self.last_lines)))


def _start(
    name: str, command: list[str], environment: dict[str, str]
) -> tuple[subprocess.Popen[bytes], Job | None]:
    try:
        popen = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**environment, lifeline.VARIABLE: "1"},
            start_new_session=not ON_WINDOWS,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
    except (OSError, ValueError) as error:  # ValueError: a letter that no command can have
        reason = getattr(error, "strerror", None) or error
        raise NodeStartError(
            f"{name} cannot be started: {command[0]}: {reason}.",
            checklist=(f"Is {command[0]} installed, and can it be found?",),
        ) from error
    return popen, _job_of(popen) if ON_WINDOWS else None


def _job_of(popen: subprocess.Popen[bytes]) -> Job | None:
    from nep_core.job import Job

    try:
        return Job(int(popen._handle))  # type: ignore[attr-defined]  # there is no other way
    except OSError as error:  # its life line and its mark are still there
        log.warning("A process is in no job: %s", error)
        return None


def _can_send_signals() -> bool:
    """A Windows program without a console, as the frozen one with its window, cannot."""
    if sys.platform != "win32":
        return True
    import ctypes

    return bool(ctypes.windll.kernel32.GetConsoleCP())


def last_words(lines: list[str]) -> tuple[str, tuple[str, ...]]:
    """The last line that says something, and the steps of the checklist below it."""
    steps: list[str] = []
    for line in reversed(lines):
        if line.startswith(STEP):
            steps.insert(0, line.removeprefix(STEP))
        elif line.strip():
            return line.strip(), tuple(steps)
    return "", tuple(steps)


def program_command(*words: str) -> list[str]:
    """The command that starts this program for another job, from source or frozen."""
    if getattr(sys, "frozen", False):
        return [sys.executable, *words]
    return [sys.executable, "-m", "nep_studio", *words]
