"""Lets the sound files be heard that robots on the screen play."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject

from nep_core import messages as m

from .child_voice import ChildVoice
from .system_voices import Command, SystemVoice
from .utterance import Utterance

PLAYERS = (
    ("pw-play",),
    ("paplay",),
    ("ffplay", "-nodisp", "-autoexit", "-loglevel", "error"),
    ("aplay", "-q"),
)
"""Programs of Linux that play a file, the best first; the last one plays only .wav."""
PLAYING = "playing"


def find_player(
    platform: str = sys.platform, which: Callable[[str], str | None] = shutil.which
) -> SystemVoice | None:
    """The program by which this computer plays sound files; None when it has none."""
    if platform == "win32":
        shell = which("powershell") or which("pwsh")
        return SystemVoice("powershell", partial(_powershell, shell)) if shell else None
    for name, *options in [("afplay",)] if platform == "darwin" else PLAYERS:
        if program := which(name):
            return SystemVoice(name, partial(_player, (program, *options)))
    return None


def _player(words: tuple[str, ...], sound: Utterance) -> Command:
    return Command((*words, sound.text))


def _powershell(shell: str, sound: Utterance) -> Command:
    """It reads the file's name, so that nothing in it is taken as a command; only .wav."""
    script = (
        "[Console]::InputEncoding = [Text.Encoding]::UTF8; "
        "(New-Object System.Media.SoundPlayer ([Console]::In.ReadToEnd())).PlaySync()"
    )
    return Command((shell, "-NoProfile", "-NonInteractive", "-Command", script), sound.text)


class RobotSounds(QObject):
    """Follows which files robots play; one program for each robot."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._players: dict[str, ChildVoice] = {}
        self._playing: dict[str, str] = {}

    def hear_state(self, state: m.RobotState) -> None:
        """Begin the file that a robot has begun to play, end what it plays no more."""
        file = str(state.settings.get(PLAYING, ""))
        if file == self._playing.get(state.robot, ""):
            return
        self._playing[state.robot] = file
        if file and Path(file).is_file():
            self._play(state.robot, file)
        elif player := self._players.get(state.robot):
            player.stop()

    def hush(self) -> None:
        """Be silent at once."""
        for player in self._players.values():
            player.stop()

    def forget(self) -> None:
        """Be silent; what robots play is begun anew when they are heard again."""
        self.hush()
        self._playing.clear()

    @property
    def playing(self) -> list[str]:
        """The robots whose files are heard now."""
        return [robot for robot, player in self._players.items() if player.is_speaking]

    def _play(self, robot: str, file: str) -> None:
        if robot not in self._players:
            program = find_player()
            if program is None:
                return
            self._players[robot] = ChildVoice(program, self)
        self._players[robot].say(Utterance(file))
