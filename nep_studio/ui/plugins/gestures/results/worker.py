"""The process that learns: started early, so that it is warm when somebody wants to train."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from PySide6.QtCore import QObject, QProcess, Signal

from faults import Fault
from nep_core.wire.frames import CANNOT_DECODE

log = logging.getLogger(__name__)


# What the training process says, line by line, as data.


class Ready(msgspec.Struct, frozen=True):
    """It has loaded what it needs."""

    ready: bool


class Progress(msgspec.Struct, frozen=True):
    """How much is done, from 0 to 1, and what it does, in an English sentence."""

    progress: float
    step: str = ""


class Done(msgspec.Struct, frozen=True):
    """The model is in the file ``done``; ``remarks`` are on the recordings."""

    done: str
    seconds: float = 0.0
    report: dict[str, Any] = {}
    remarks: tuple[Fault, ...] = ()


class Failed(msgspec.Struct, frozen=True):
    """It did not go, and why."""

    fault: Fault


@dataclass(frozen=True)
class Ended:
    """It has ended by itself: its exit code, or the signal that ended it, and its last words."""

    code: int
    words: str = ""


Line = Ready | Progress | Done | Failed
_KINDS: tuple[tuple[str, type[Line]], ...] = (
    ("ready", Ready),
    ("progress", Progress),
    ("done", Done),
    ("fault", Failed),
)


def read_line(line: bytes) -> Line | None:
    """What a line says; None for one that says nothing known, such as a library's warning."""
    try:
        told = msgspec.json.decode(line)
        kind = next((kind for key, kind in _KINDS if key in told), None)
        return None if kind is None else msgspec.convert(told, kind)
    except CANNOT_DECODE:
        return None


def order(recordings: Path, model: Path, *, everyday: bool) -> bytes:
    """The line that asks for a training; ``everyday``: simulated everyday movement is added."""
    asked = {
        "train": str(recordings),
        "output": str(model),
        "methods": ["trees", "gmr"],
        "everyday": everyday,
    }
    return msgspec.json.encode(asked) + b"\n"


END_MS = 3000
LONGEST_LINE = 20_000_000
_MOST_WORDS = 4000


class Worker(QObject):
    """One process at a time.

    ``told`` gives each line that means something, ``ended`` how the process ended by itself: its
    Ended. ``command`` gives what starts it.
    """

    told = Signal(object)
    ended = Signal(object)

    def __init__(self, command: Callable[[], Sequence[str]], parent: QObject) -> None:
        super().__init__(parent)
        self.is_ready = False
        self.was_ready = False
        """Whether the process, or the one before it, had loaded what it needs."""
        self._command = command
        self._process: QProcess | None = None
        self._begun = b""
        parent.destroyed.connect(self.stop)

    @property
    def is_running(self) -> bool:
        """Whether there is a process."""
        return self._process is not None

    def start(self) -> None:
        """Start a process where there is none."""
        if self._process is not None:
            return
        self.was_ready = False
        process = self._process = QProcess(self)
        process.readyReadStandardOutput.connect(partial(self._on_output, process))
        process.finished.connect(partial(self._on_finished, process))
        process.errorOccurred.connect(partial(self._on_error, process))
        words = list(self._command())
        process.start(words[0], words[1:])

    def write(self, line: bytes) -> None:
        """Tell the process something."""
        if self._process is not None:
            self._process.write(line)

    def stop(self) -> None:
        """End the process at once; nothing is told of it any more."""
        process = self._forget()
        if process is not None:
            process.kill()
            process.waitForFinished(END_MS)  # a killed process ends within milliseconds
            process.deleteLater()

    def _forget(self) -> QProcess | None:
        process, self._process = self._process, None
        self.is_ready, self._begun = False, b""
        return process

    def _on_output(self, process: QProcess) -> None:
        if process is not self._process:
            return
        text = self._begun + bytes(process.readAllStandardOutput().data())
        *lines, self._begun = text.split(b"\n")
        self._begun = self._begun[:LONGEST_LINE]
        for line in lines:
            said = read_line(line)
            if said is not None and process is self._process:
                self._tell(said)

    def _tell(self, said: Line) -> None:
        if isinstance(said, Ready):
            self.is_ready = self.was_ready = True
        self.told.emit(said)

    def _on_finished(self, process: QProcess, code: int, _status: QProcess.ExitStatus) -> None:
        if process is not self._process:
            return
        words = bytes(process.readAllStandardError().data()).decode(errors="replace").strip()
        log.info("the training process ended with %s: %s", code, words[-_MOST_WORDS:])
        self._end(Ended(code, words[-_MOST_WORDS:]))

    def _on_error(self, process: QProcess, error: QProcess.ProcessError) -> None:
        if process is self._process and error == QProcess.ProcessError.FailedToStart:
            self._end(Ended(-1, process.errorString()))

    def _end(self, how: Ended) -> None:
        process = self._forget()
        if process is not None:
            process.deleteLater()
        self.ended.emit(how)
