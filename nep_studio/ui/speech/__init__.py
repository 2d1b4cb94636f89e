"""The voices of the robots on the screen, where the computer can speak."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire import messages as m
from nep_studio.settings import Settings
from nep_studio.ui.running.runner import Heard, Runner, Tap

from .robot_voices import MakeVoice, RobotSounds, RobotVoices
from .voices import find_voice

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


# The voice of a window: it listens to the robots while sound is on and somebody runs them.

LATER_MS = 60


class Sound(QObject):
    """Sound on or off, as the person left it; ``switched`` tells which."""

    switched = Signal(bool)

    def __init__(
        self,
        runner: Runner,
        settings: Settings,
        parent: QObject,
        make_voice: MakeVoice = find_voice,
    ) -> None:
        super().__init__(parent)
        self._runner, self._settings = runner, settings
        self._tap: Tap | None = None
        self._run = 0
        self.voices = RobotVoices(make_voice, self)
        self.sounds = RobotSounds(self)
        runner.connected.connect(self._follow)
        runner.disconnected.connect(self._on_disconnected)
        runner.state_changed.connect(self._on_state_changed)
        runner.arrived.connect(self._on_arrived)
        self._follow()

    @property
    def is_on(self) -> bool:
        """Whether robots are heard."""
        return self._settings.has_sound

    def switch(self, is_on: bool) -> None:
        """Let robots be heard, or not."""
        if is_on != self._settings.has_sound:
            self._settings.has_sound = is_on
            self._follow()
            self.switched.emit(is_on)

    def _follow(self) -> None:
        """Listen while there is something to hear and somebody wants to."""
        is_wanted = self._settings.has_sound and self._runner.is_connected
        if is_wanted and self._tap is None:
            self._tap = self._runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
            self._tap.arrived.connect(self._on_states)
        elif not is_wanted and self._tap is not None:
            self._tap.close()
            self._tap = None
            self._forget()

    def _on_states(self, batch: list[Heard]) -> None:
        """Requests, which tell how something is to be said, come another way, and may be later."""
        QTimer.singleShot(LATER_MS, self, partial(self._hear_states, batch, self._run))

    def _hear_states(self, batch: list[Heard], run: int) -> None:
        real = {
            str(node.parameters.get("robot", node.name))
            for node in list(self._runner.started.values())
            if node.parameters.get("driver") == "naoqi"
        }  # they have a voice of their own
        if run == self._run and self._tap is not None:
            for heard in batch:
                if heard.message.robot not in real:
                    self.voices.hear_state(heard.message)
                    self.sounds.hear_state(heard.message)

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        if self._tap is not None:
            for _, message in batch:
                self.voices.hear(message)

    def _on_state_changed(self, state: str) -> None:
        if state == "stopping":
            self._run += 1
            self.voices.stop_speaking()
            self.sounds.stop_speaking()

    def _on_disconnected(self) -> None:
        self._forget()
        self._follow()

    def _forget(self) -> None:
        self.voices.forget()
        self.sounds.forget()


def sound_of(host: Host) -> Sound:
    """The one sound, made when it is first asked for."""
    settings, runner = host.services.settings, host.services.runner
    return host.shared(Sound, lambda: Sound(runner, settings, runner))
