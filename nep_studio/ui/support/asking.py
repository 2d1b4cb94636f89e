"""Asks for the newest version in a thread of its own; the window never waits for the answer."""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer, QUrl, Signal
from PySide6.QtGui import QDesktopServices

from nep_studio import __version__
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr
from nep_studio.updates import Newest, UpdateChoice, ask

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


LONGEST_MS = 15_000
"""Longer nobody waits, however slowly somebody answers."""


class Asking(QObject):
    """One question at a time; ``answered`` gives the Newest, or None, in the window's thread."""

    answered = Signal(object)
    _heard = Signal(int, object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._number = 0
        self._heard.connect(self._on_heard, Qt.ConnectionType.QueuedConnection)
        self._patience = QTimer(self, interval=LONGEST_MS, singleShot=True)
        self._patience.timeout.connect(lambda: self._on_heard(self._number, None))

    def begin(self, address: str) -> None:
        """Ask; at the end of the program nobody waits."""
        self.cancel()
        self._patience.start()
        words = (address, self._number)
        threading.Thread(target=self._ask, args=words, name="updates", daemon=True).start()

    def cancel(self) -> None:
        """Want no answer any more."""
        self._number += 1
        self._patience.stop()

    def _ask(self, address: str, number: int) -> None:
        newest = ask(address)
        with suppress(RuntimeError):  # the window has gone meanwhile
            self._heard.emit(number, newest)

    def _on_heard(self, number: int, newest: Newest | None) -> None:
        if number == self._number:
            self.cancel()
            self.answered.emit(newest)


def ask_if_due(window: MainWindow) -> Asking | None:
    """Ask if the person wants that, and it was not asked today."""
    choice = UpdateChoice(window.settings)
    if not choice.is_due(time.time()):
        return None
    choice.note_asked()
    asking = Asking(window)
    asking.answered.connect(lambda newest: _tell(window, choice, newest))
    asking.begin(choice.address)
    return asking


def _tell(window: MainWindow, choice: UpdateChoice, newest: Newest | None) -> None:
    """Tell of a newer version, of each only once."""
    if newest is None or not newest.is_newer or newest.version == choice.told:
        return
    choice.told = newest.version
    title = tr("There is a new version of NEP Studio: {version}", version=newest.version)
    sentence = tr("You have {version}. Nothing changes unless you get it.", version=__version__)
    show = Answer(tr("Show its page"), lambda: show_page(newest.page))
    window.messages.tell(Message("info", title, sentence, answers=(show,) if newest.page else ()))


def show_page(page: str) -> None:
    """Show a page in the person's browser."""
    QDesktopServices.openUrl(QUrl(page))
