"""One child process: started with a life line, its output kept, stopped with all its children."""

from __future__ import annotations

import contextlib
import ctypes
import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from ctypes import wintypes
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from queue import SimpleQueue
from typing import Any, TypeVar

import psutil

from faults import Fault, Text, reason_of, text_of, verbatim
from nep_core.errors import NodeStartError
from nep_core.wire.messages import PROCESS_ENDED, PROCESS_RESTARTS, PROCESS_STOPPED

from . import handover, lifeline
from .lifeline import ORPHANED
from .node_log import NodeLog

log = logging.getLogger(__name__)


# The processes that a process started, as far as the system lets us see and end them.

VARIABLE = "NEP_TREE"
"""In the environment of a launched process and all that it starts: the marks of those it is of."""


def descendants(pid: int) -> frozenset[psutil.Process]:
    """The processes that a running one started, and theirs."""
    with contextlib.suppress(psutil.Error):
        return frozenset(psutil.Process(pid).children(recursive=True))
    return frozenset()


def marked(marks: str) -> frozenset[psutil.Process]:
    """Other processes with the last of these marks, also those whose parents are long gone.

    That is how one is found that went into the background, into a group of its own.
    """
    mark, found = marks.rpartition(" ")[2], set()
    for process in psutil.process_iter() if mark else ():
        with contextlib.suppress(psutil.Error, OSError):  # another user's, or gone
            if process.pid != os.getpid() and mark in process.environ().get(VARIABLE, "").split():
                found.add(process)
    return frozenset(found)


def kill(processes: Iterable[psutil.Process]) -> None:
    """End those that still run and that we may end; never another with the same number."""
    for process in processes:
        with contextlib.suppress(psutil.Error):
            process.kill()


ASKED = 71
"""The exit code of a launched node that somebody in the network asked to stop."""

_SIGNALS = {
    "SIGKILL": "{node} was killed",
    "SIGTERM": "{node} was asked to stop before it could answer",
    "SIGINT": "{node} was interrupted",
    "SIGSEGV": "{node} crashed (it used memory that is not its own)",
    "SIGABRT": "{node} crashed (it aborted itself)",
}

_UNKNOWN_SIGNAL = "{node} was ended by signal {number}"
_ENDED_WITH = {
    0: "{node} ended by itself",
    ASKED: "{node} was asked to stop",
    ORPHANED: "{node} ended because the program that started it is gone",
}


@dataclass(frozen=True)
class Outcome:
    """How a node's process ended.

    ``code`` is its exit code, negative for a signal; ``asked`` whether the launcher stopped it;
    ``refusal`` why it would not go on, where it handed that over; ``last_words`` the last line
    that it wrote.
    """

    node: str
    code: int
    asked: bool = False
    last_words: str = ""
    refusal: Fault | None = None

    @property
    def was_successful(self) -> bool:
        """Whether it ended as it should."""
        return self.asked or self.code in (0, ASKED)

    @property
    def text(self) -> Text:
        """How it ended, without the final full stop."""
        name = next((one.name for one in signal.Signals if one == -self.code), "")
        if self.refusal is not None and self.refusal.sentence:
            reason = self.refusal.sentence
        elif self.refusal is None and self.last_words:
            reason = verbatim(self.last_words.rstrip("."))
        else:
            reason = text_of("exit code {code}", code=self.code)
        if self.asked:
            words = "{node} was stopped"
        elif self.code < 0:
            unknown = "{node} was ended by {name}" if name else _UNKNOWN_SIGNAL
            words = _SIGNALS.get(name, unknown)
        else:
            words = _ENDED_WITH.get(self.code, "{node} ended with an error: {reason}")
        return text_of(words, node=self.node, number=-self.code, name=name, reason=reason)

    @property
    def checklist(self) -> tuple[Text, ...]:
        """What to try, where the node knew that."""
        return self.refusal.checklist if self.refusal is not None else ()

    @property
    def why(self) -> Text:
        """Why it ended, in its own words; nothing when it said none."""
        return self.refusal.sentence if self.refusal is not None else verbatim(self.last_words)

    def fault(self, *, again: bool = False) -> Fault:
        """What is told for the node; ``again``: it is started again."""
        if again:
            words = "{outcome}; it is started again"
            return Fault(PROCESS_RESTARTS, text_of(words, outcome=self.text))
        code = PROCESS_STOPPED if self.asked else PROCESS_ENDED
        return Fault(code, self.text, self.checklist)

    def __str__(self) -> str:
        return str(self.text)


# The one thread in which processes are started.
#
# Linux tells a child of its parent's end when the *thread* ends that started it; so it must be one
# that lives as long as the program.

T = TypeVar("T")

_lock = threading.Lock()
_thread: threading.Thread | None = None
_wishes: SimpleQueue[tuple[Callable[[], Any], Future[Any]]] = SimpleQueue()


def in_lasting_thread(start: Callable[[], T]) -> T:
    """Call ``start`` in that thread; what it returns or raises."""
    global _thread, _wishes
    result: Future[T] = Future()
    with _lock:
        if _thread is None or not _thread.is_alive():  # a fork of this program has no threads
            _wishes = SimpleQueue()
            _thread = threading.Thread(target=_work, args=(_wishes,), name="nep-start", daemon=True)
            _thread.start()
    _wishes.put((start, result))
    return result.result()


def _work(wishes: SimpleQueue[tuple[Callable[[], Any], Future[Any]]]) -> None:
    while True:
        start, result = wishes.get()
        try:
            result.set_result(start())
        except BaseException as error:
            result.set_exception(error)
        del start, result  # a process that nobody waits for any more loses its life line


ON_WINDOWS = sys.platform == "win32"
STOPPING_LOOK_S = 0.1
"""So often is looked whether what takes its time to stop still lives."""
STOP_SIGNAL: int = getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM)
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

    ``name`` is told to people, ``command`` what is run, ``environment`` all of its variables;
    ``log_file`` gets what it writes.
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
        marks = f"{environment.get(VARIABLE, '')} {self._mark}".strip()
        self._refusal = Path(tempfile.gettempdir()) / f"nep-fault-{uuid.uuid4().hex}.json"
        environment = {**environment, VARIABLE: marks, handover.VARIABLE: str(self._refusal)}
        self._popen, self._job = in_lasting_thread(partial(_start, name, command, environment))
        self.pid = self._popen.pid
        self._reader = threading.Thread(target=self._read, name=f"nep-log-{name}", daemon=True)
        self._reader.start()
        threading.Thread(target=self._await_end, name=f"nep-wait-{name}", daemon=True).start()

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
        """Send SIGTERM (Windows: Ctrl-Break), or else let go of its life line; once."""
        if self._asked:  # a second signal could end it while it is leaving in good order
            return
        self._asked = True
        with contextlib.suppress(OSError):
            if _can_send_signals():
                self._popen.send_signal(STOP_SIGNAL)
            elif self._popen.stdin is not None:
                self._popen.stdin.close()

    def stop(
        self,
        grace_s: float = 2.0,
        *,
        longest_s: float = 0.0,
        lives: Callable[[], bool] = lambda: True,
    ) -> None:
        """Ask it to stop, and end the whole process tree after ``grace_s``.

        While it ``lives``, it may take ``longest_s``.
        """
        if self.poll() is None:  # when it has ended, another process may have its number
            self.ask_to_stop()
            begun_s = time.monotonic()
            code = self.wait(grace_s)
            while code is None and time.monotonic() - begun_s < longest_s and lives():
                code = self.wait(STOPPING_LOOK_S)
            if code is None:
                waited_s = time.monotonic() - begun_s
                log.warning("%s did not stop within %.0f s and was ended", self.name, waited_s)
                with contextlib.suppress(OSError):
                    self._popen.kill()
        self._children_ended.wait(KILL_S)

    def _read(self) -> None:
        assert self._popen.stdout is not None
        node_log = NodeLog(self._log_file, goes_on=self._goes_on)
        with self._popen.stdout as output, node_log as kept:
            while piece := output.readline(LINE_BYTES):
                self._last_lines.append(piece.decode(errors="replace").rstrip())
                kept.write(piece)

    def _await_end(self) -> None:
        code = self._popen.wait()
        # Its children too, at once, while no other process has its number
        if self._job is not None:
            self._job.end()
        if not ON_WINDOWS:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, signal.SIGKILL)
        for _ in range(MOST_LOOKS):
            if not (left := marked(self._mark)):
                break
            kill(left)  # what they started meanwhile is seen at the next look
            psutil.wait_procs(left, timeout=LOOK_S)
        self._children_ended.set()
        self._reader.join(1.0)  # one that we may not end may hold the pipe open
        if self._popen.stdin is not None:
            self._popen.stdin.close()
        # The last line that says something, one without an indent if there is any
        said = [line for line in self.last_lines if line.strip()] or [""]
        words = ([line for line in said if not line[:1].isspace()] or said)[-1].strip()
        refusal = handover.take(self._refusal)
        self._on_end(Outcome(self.name, code, self._asked, words, refusal))


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
        raise NodeStartError(
            "{name} cannot be started: {command}: {reason}.",
            checklist=("Is {command} installed, and can it be found?",),
            name=name,
            command=command[0],
            reason=reason_of(error) if isinstance(error, OSError) else error,
        ) from error
    if ON_WINDOWS:
        try:  # there is no other way to its handle
            return popen, Job(int(popen._handle))  # type: ignore[attr-defined]
        except OSError as error:  # its life line and its mark are still there
            log.warning("A process is in no job: %s", error)
    return popen, None


def _can_send_signals() -> bool:
    """A Windows program without a console, as the frozen one with its window, cannot."""
    return sys.platform != "win32" or bool(ctypes.windll.kernel32.GetConsoleCP())


def program_command(*words: str) -> list[str]:
    """The command that starts this program for another job, from source or frozen."""
    if getattr(sys, "frozen", False):
        return [sys.executable, *words]
    # -P: the folder that we are started in may be a stranger's, with a file called like a library
    return [sys.executable, "-P", "-m", "nep_studio", *words]


# A Windows job: a process and all that it starts, which end when the launcher's handle closes.
#
# Windows closes the handles of a program that is killed, so nothing outlives it, whatever it does.
# Not run yet on Windows; written after the documentation of Job Objects.

EXTENDED_LIMIT_INFORMATION = 9
KILL_ON_JOB_CLOSE = 0x2000


class BasicLimits(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION."""

    _fields_ = (
        ("PerProcessUserTimeLimit", ctypes.c_int64),
        ("PerJobUserTimeLimit", ctypes.c_int64),
        ("LimitFlags", ctypes.c_uint32),
        ("MinimumWorkingSetSize", ctypes.c_size_t),
        ("MaximumWorkingSetSize", ctypes.c_size_t),
        ("ActiveProcessLimit", ctypes.c_uint32),
        ("Affinity", ctypes.c_size_t),
        ("PriorityClass", ctypes.c_uint32),
        ("SchedulingClass", ctypes.c_uint32),
    )


class ExtendedLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION."""

    _fields_ = (
        ("BasicLimitInformation", BasicLimits),
        ("IoInfo", ctypes.c_uint64 * 6),
        ("ProcessMemoryLimit", ctypes.c_size_t),
        ("JobMemoryLimit", ctypes.c_size_t),
        ("PeakProcessMemoryUsed", ctypes.c_size_t),
        ("PeakJobMemoryUsed", ctypes.c_size_t),
    )


class Job:
    """Holds one process, by its handle, and all that it starts; raises OSError."""

    def __init__(self, process: int, system: Any = None) -> None:
        self._system = system or _windows()
        self._job = self._system.CreateJobObjectW(None, None)
        try:
            self._succeeded(self._job)
            limits = ExtendedLimits()
            limits.BasicLimitInformation.LimitFlags = KILL_ON_JOB_CLOSE
            kind, size = EXTENDED_LIMIT_INFORMATION, ctypes.sizeof(limits)
            self._succeeded(
                self._system.SetInformationJobObject(self._job, kind, ctypes.byref(limits), size)
            )
            self._succeeded(self._system.AssignProcessToJobObject(self._job, process))
        except OSError:
            self.end()
            raise

    def end(self) -> None:
        """End all that is still in it, and give it up; may be called again."""
        job, self._job = self._job, None
        if job:
            self._system.CloseHandle(job)

    def _succeeded(self, answer: object) -> None:
        if not answer:
            code = int(self._system.GetLastError())
            raise OSError(code, f"Windows error {code}")


def _windows() -> Any:
    """The functions of kernel32, with the types of what they take: a handle is a pointer."""
    if sys.platform != "win32":
        raise OSError("Jobs are there on Windows only.")
    system = ctypes.WinDLL("kernel32")
    handle, flag, pointer = wintypes.HANDLE, wintypes.BOOL, ctypes.c_void_p
    system.CreateJobObjectW.argtypes = (pointer, wintypes.LPCWSTR)
    system.CreateJobObjectW.restype = handle
    system.SetInformationJobObject.argtypes = (handle, ctypes.c_int, pointer, wintypes.DWORD)
    system.SetInformationJobObject.restype = flag
    system.AssignProcessToJobObject.argtypes = (handle, handle)
    system.AssignProcessToJobObject.restype = flag
    system.CloseHandle.argtypes, system.CloseHandle.restype = (handle,), flag
    return system
