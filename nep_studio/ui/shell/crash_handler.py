"""The last resort for errors that nobody expected: save the work, note it, say it kindly, go on."""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from io import TextIOWrapper
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from PySide6.QtCore import QMessageLogContext, QObject, QtMsgType, Signal, qInstallMessageHandler

from nep_core.places import opened_privately, private_folder
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr

from .dialogs import show_report

if TYPE_CHECKING:
    from .main_window import MainWindow

log = logging.getLogger(__name__)

LARGEST_LOG = 1_000_000
_LEVELS = {
    QtMsgType.QtDebugMsg: logging.DEBUG,
    QtMsgType.QtInfoMsg: logging.INFO,
    QtMsgType.QtWarningMsg: logging.WARNING,
    QtMsgType.QtCriticalMsg: logging.ERROR,
    QtMsgType.QtFatalMsg: logging.CRITICAL,
}


class PrivateLog(RotatingFileHandler):
    """A log for its owner only, as all that is kept of a person."""

    def _open(self) -> TextIOWrapper:
        encoding, opener = self.encoding, opened_privately
        name, mode = self.baseFilename, self.mode
        file = open(name, mode, encoding=encoding, opener=opener)  # noqa: SIM115  closed by it
        assert isinstance(file, TextIOWrapper)
        return file


class LastResort(QObject):
    """While it is entered, no error ends the program; each kind of error is told once."""

    _happened = Signal(str)  # comes from other threads too

    def __init__(self, log_file: Path) -> None:
        super().__init__()
        self._log_file = log_file
        self._window: MainWindow | None = None
        self._told: set[str] = set()
        self._restore: list[Callable[[], object]] = []
        self._happened.connect(self._on_happened)

    def __enter__(self) -> LastResort:
        # Write to the user's folder; where that cannot be, the program works without
        with suppress(OSError):
            private_folder(self._log_file.parent)
            file = PrivateLog(
                self._log_file, maxBytes=LARGEST_LOG, backupCount=1, encoding="utf-8", delay=True
            )
            file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
            root = logging.getLogger()
            root.addHandler(file)
            self._restore += [file.close, lambda: root.removeHandler(file)]
        for module in (sys, threading):
            self._restore.append(partial(setattr, module, "excepthook", module.excepthook))
        sys.excepthook = self._on_error
        threading.excepthook = self._on_thread_error
        qInstallMessageHandler(_log_qt)
        self._restore.append(lambda: qInstallMessageHandler(None))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if isinstance(error, Exception):
            log.critical("This error ended the program:", exc_info=error)
        self._window = None
        while self._restore:
            self._restore.pop()()

    def watch(self, window: MainWindow) -> None:
        """Save this window's work, and tell the person there, when something happens."""
        self._window = window

    def _on_error(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        details = "".join(traceback.format_exception(kind, error, trace))
        log.error("Nobody expected this:\n%s", details)
        self._happened.emit(details)

    def _on_thread_error(self, arguments: threading.ExceptHookArgs) -> None:
        error = arguments.exc_value
        if error is not None:
            self._on_error(arguments.exc_type, error, arguments.exc_traceback)

    def _on_happened(self, details: str) -> None:
        window, place = self._window, details.rpartition("File ")[2]
        if window is None or place in self._told:
            return
        self._told.add(place)
        try:
            window.flush()
            window.messages.tell(_message(window, details, self._log_file))
        except Exception:  # an error while telling an error is only noted
            log.exception("This error could not be told.")


def _message(window: MainWindow, details: str, log_file: Path) -> Message:
    report = Answer(tr("Report for support…"), lambda: show_report(window))
    return Message(
        "error",
        tr("Something went wrong inside NEP Studio"),
        tr("Your work is kept. You can go on; if something looks odd, save and start again."),
        (
            tr("Save your project now."),
            tr("If it happens again, send the details to those who make NEP Studio."),
        ),
        f"{details}\n{log_file}",
        (report,),
        outlives_project=True,
    )


def _log_qt(kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
    logging.getLogger("qt").log(_LEVELS.get(kind, logging.WARNING), "%s", text)
