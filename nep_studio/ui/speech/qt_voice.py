"""The voice that Qt brings, where the add-ons of PySide6 are installed."""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any

from PySide6.QtCore import QLocale, QObject, Signal

from .utterance import Utterance

MODULE = "PySide6.QtTextToSpeech"
SPEAKS_ALOUD = ("speechd", "sapi", "winrt", "darwin", "macos", "android", "flite")
"""Qt's engines that are heard; "mock" only pretends."""
MOST_FAILURES = 3


class QtVoice(QObject):
    """Speaks by a QTextToSpeech."""

    fell_silent = Signal()

    def __init__(self, speech: Any, module: Any, parent: QObject) -> None:
        super().__init__(parent)
        self.name = str(speech.engine())
        self._speech, self._states = speech, module.QTextToSpeech.State
        self._failures = 0
        speech.setParent(self)
        speech.stateChanged.connect(self._on_state_changed)

    @property
    def is_speaking(self) -> bool:
        """Whether it is heard now."""
        return self._speech.state() in (self._states.Speaking, self._states.Synthesizing)

    @property
    def is_broken(self) -> bool:
        """Whether it could not speak again and again."""
        return self._failures >= MOST_FAILURES

    def say(self, utterance: Utterance) -> None:
        """Begin to say something; what it says now ends."""
        self.stop()
        if self.is_broken or not utterance.text:
            return
        self._speech.setLocale(QLocale(utterance.language.replace("_", "-")))
        self._speech.setVolume(utterance.volume)
        self._speech.setPitch(min(max(utterance.pitch - 1.0, -1.0), 1.0))
        self._speech.setRate(min(max(utterance.speed - 1.0, -1.0), 1.0))
        self._speech.say(utterance.text)

    def stop(self) -> None:
        """Be silent at once."""
        if self.is_speaking:
            self._speech.stop()

    def _on_state_changed(self, state: Any) -> None:
        if state == self._states.Error:
            self._failures += 1
        elif state == self._states.Speaking:
            self._failures = 0
        if state in (self._states.Ready, self._states.Error):
            self.fell_silent.emit()


def qt_voice(parent: QObject) -> QtVoice | None:
    """Qt's voice, None where it is not installed or cannot speak."""
    if importlib.util.find_spec(MODULE) is None:
        return None
    try:
        module = importlib.import_module(MODULE)
    except ImportError:  # a library of the system that it needs is not there
        return None
    engines = [name for name in module.QTextToSpeech.availableEngines() if name in SPEAKS_ALOUD]
    if not engines:
        return None
    speech = module.QTextToSpeech(engines[0])
    if speech.state() == module.QTextToSpeech.State.Error:
        return None
    return QtVoice(speech, module, parent)
