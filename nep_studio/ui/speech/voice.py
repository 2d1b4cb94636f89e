"""What every voice can do, and which this computer has."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QObject, SignalInstance

from .child_voice import ChildVoice
from .qt_voice import qt_voice
from .system_voices import find_system_voice
from .utterance import Utterance


class Voice(Protocol):
    """Says one thing at a time; nothing in here waits. ``fell_silent`` tells of each end."""

    @property
    def fell_silent(self) -> SignalInstance:
        """It has said all, was stopped, or could not speak."""

    @property
    def is_speaking(self) -> bool:
        """Whether it is heard now."""

    @property
    def is_broken(self) -> bool:
        """Whether it could not speak again and again."""

    def say(self, utterance: Utterance) -> None:
        """Begin to say something; what it says now ends."""

    def stop(self) -> None:
        """Be silent at once."""

    def deleteLater(self) -> None:
        """Be silent, and go."""


def find_voice(parent: QObject) -> Voice | None:
    """A voice of this computer: Qt's own, else that of the system; None when it cannot speak."""
    own = qt_voice(parent)
    if own is not None:
        return own
    system = find_system_voice()
    return ChildVoice(system, parent) if system is not None else None
