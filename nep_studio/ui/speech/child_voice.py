"""A voice of the system: a program that speaks, in a process of its own."""

from __future__ import annotations

import logging
from functools import partial

from PySide6.QtCore import QObject, QProcess, Signal

from .system_voices import Command, SystemVoice
from .utterance import Utterance

log = logging.getLogger(__name__)

MOST_FAILURES = 3
"""After so many in a row it is not tried again: there may be no loudspeaker."""
END_MS = 1000


class ChildVoice(QObject):
    """Starts the program for each text, and ends it to be silent."""

    fell_silent = Signal()

    def __init__(self, system: SystemVoice, parent: QObject) -> None:
        super().__init__(parent)
        self.name = system.name
        self._system = system
        self._process: QProcess | None = None
        self._failures = 0
        parent.destroyed.connect(self.stop)

    @property
    def is_speaking(self) -> bool:
        """Whether the program runs."""
        return self._process is not None

    @property
    def is_broken(self) -> bool:
        """Whether the program could not speak again and again."""
        return self._failures >= MOST_FAILURES

    def say(self, utterance: Utterance) -> None:
        """Begin to say something; what it says now ends."""
        self.stop()
        if self.is_broken or not utterance.text:
            return
        command = self._system.command(utterance)
        process = self._process = QProcess(self)
        process.finished.connect(partial(self._on_finished, process))
        process.errorOccurred.connect(partial(self._on_error, process))
        process.setStandardOutputFile(QProcess.nullDevice())
        process.start(command.words[0], list(command.words[1:]))
        self._write(process, command)

    def stop(self) -> None:
        """End the program, which is silent at once."""
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.waitForFinished(END_MS)  # a killed program ends within milliseconds
        process.deleteLater()
        if self._system.stopping:
            QProcess.startDetached(self._system.stopping[0], list(self._system.stopping[1:]))
        self.fell_silent.emit()

    def _write(self, process: QProcess, command: Command) -> None:
        if command.text:
            process.write(command.text.encode())
        process.closeWriteChannel()

    def _on_finished(self, process: QProcess, code: int, status: QProcess.ExitStatus) -> None:
        if process is not self._process:
            return
        is_well = code == 0 and status == QProcess.ExitStatus.NormalExit
        told = bytes(process.readAllStandardError().data()).decode(errors="replace")
        self._end(process, told, is_well)

    def _on_error(self, process: QProcess, error: QProcess.ProcessError) -> None:
        if process is self._process and error == QProcess.ProcessError.FailedToStart:
            self._end(process, process.errorString(), False)

    def _end(self, process: QProcess, told: str, is_well: bool) -> None:
        self._process = None
        process.deleteLater()
        self._failures = 0 if is_well else self._failures + 1
        if self.is_broken:
            log.warning("%s cannot speak: %s", self.name, told.strip()[:300])
        self.fell_silent.emit()
