"""Sends cues by hand, and remembers which were sent when."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from nep_core.messages import GESTURE_REQUEST, HUMAN_BEHAVIOR, GestureRequest, HumanBehavior
from nep_studio.cues import Cue
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

from .looks import cue_words

if TYPE_CHECKING:
    from collections.abc import Callable

MOST_SENT = 500


@dataclass(frozen=True)
class SentCue:
    """What was sent, and when (time.time())."""

    time_s: float
    words: str


class CueSender(QObject):
    """One door for what an operator sends. ``sent`` tells of each, ``refused`` why not."""

    sent = Signal(object)
    refused = Signal(str)
    changed = Signal()

    def __init__(
        self, runner: Runner, parent: QObject, now: Callable[[], float] = time.time
    ) -> None:
        super().__init__(parent)
        self._runner, self._now = runner, now
        self.log: deque[SentCue] = deque(maxlen=MOST_SENT)
        runner.state_changed.connect(self.changed)
        runner.connected.connect(self.changed)
        runner.disconnected.connect(self.changed)

    @property
    def why_not(self) -> str:
        """Why nothing can be sent now, "" when it can."""
        if self._runner.is_connected and self._runner.state in ("running", "paused"):
            return ""
        if self._runner.state == "starting":
            return tr("The program is starting. It will hear you in a moment.")
        return tr("The program does not run, so that nobody would hear it.")

    def send(self, cue: Cue) -> bool:
        """Send the state of a cue."""
        state = HumanBehavior(human_state=cue.state, source=cue.source)
        return self._send(HUMAN_BEHAVIOR, state, cue_words(cue))

    def make_gesture(self, gesture: str, words: str) -> bool:
        """Let the watch on the screen make a gesture, which is then recognised, or not."""
        request = GestureRequest(gesture=gesture)
        return self._send(GESTURE_REQUEST, request, tr("movement: {gesture}", gesture=words))

    def run(self) -> None:
        """Run the program, so that somebody hears."""
        self._runner.run()

    def _send(self, topic: str, message: HumanBehavior | GestureRequest, words: str) -> bool:
        reason = self.why_not
        if reason or not self._runner.send(topic, message):
            self.refused.emit(reason or tr("The network is down."))
            return False
        sent = SentCue(self._now(), words)
        self.log.append(sent)
        self.sent.emit(sent)
        return True
