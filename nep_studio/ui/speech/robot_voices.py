"""Lets each robot on the screen be heard: what it says, in a voice of its own."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import msgspec
from PySide6.QtCore import QObject

from faults.files import is_elsewhere
from nep_core.wire import messages as m

from .voices import ChildVoice, Command, SystemVoice, Utterance, Voice, spoken_as, utterance_of

MakeVoice = Callable[[QObject], Voice | None]
MOST_SPEECHES = 200
SPEECHES = ("say", "ask")


class RobotVoices(QObject):
    """Hears how robots are, and speaks for them; None for a voice: nothing is heard."""

    def __init__(self, make_voice: MakeVoice, parent: QObject) -> None:
        super().__init__(parent)
        self._make_voice = make_voice
        self._mouths: dict[str, _Mouth] = {}
        self._saying: dict[str, str] = {}
        self._speeches: dict[str, m.ActionRequest] = {}

    def hear_state(self, state: m.RobotState) -> None:
        """Say what a robot has begun to say."""
        before = self._saying.get(state.robot, "")
        self._saying[state.robot] = state.saying
        if state.saying and state.saying != before:
            robot = state.robot
            if robot not in self._mouths:
                self._mouths[robot] = _Mouth(self._make_voice(self))
            self._mouths[robot].say(spoken_as(utterance_of(state), self._asked(state)))

    def _asked(self, state: m.RobotState) -> m.ActionRequest | None:
        """The last request to say what a robot says now, which may tell how."""
        asked = [one for one in self._speeches.values() if one.args.get("text") == state.saying]
        return asked[-1] if asked else None

    def hear(self, message: msgspec.Struct) -> None:
        """Be silent when a robot was stopped, or what it says was."""
        if isinstance(message, m.ActionRequest):
            if message.action == "stop" and not message.args:
                for robot in [name for name in message.robots if name != "all"] or [""]:
                    self.stop_speaking(robot)
            elif message.action in SPEECHES:
                self._speeches[message.id] = message
                if len(self._speeches) > MOST_SPEECHES:
                    del self._speeches[next(iter(self._speeches))]
        elif isinstance(message, m.ActionResult) and message.id in self._speeches:
            if message.state == "cancelled":
                self.stop_speaking(message.robot)
            if message.state in ("done", "failed", "cancelled"):
                self._speeches.pop(message.id, None)

    def stop_speaking(self, robot: str = "") -> None:
        """Let one robot be silent at once, or all."""
        names = [robot] if robot else list(self._mouths)
        for name in names:
            if mouth := self._mouths.get(name):
                mouth.stop_speaking()

    def forget(self) -> None:
        """Be silent; what robots said is said anew when they say it again."""
        self.stop_speaking()
        self._saying.clear()
        self._speeches.clear()

    @property
    def speaking(self) -> list[str]:
        """The robots that are heard now."""
        return [name for name, mouth in self._mouths.items() if mouth.is_speaking]


class _Mouth:
    """A voice, and what it says next: a computer may speak more slowly than the robot."""

    def __init__(self, voice: Voice | None) -> None:
        self._voice = voice
        self._next: Utterance | None = None
        if voice is not None:
            voice.fell_silent.connect(self._on_fell_silent)

    @property
    def is_speaking(self) -> bool:
        return self._voice is not None and self._voice.is_speaking

    def say(self, utterance: Utterance) -> None:
        if self._voice is None:
            return
        if self._voice.is_speaking:
            self._next = utterance  # one that waits already is given up: it would come too late
        else:
            self._voice.say(utterance)

    def stop_speaking(self) -> None:
        self._next = None
        if self._voice is not None:
            self._voice.stop()

    def _on_fell_silent(self) -> None:
        following, self._next = self._next, None
        if following is not None and self._voice is not None:
            self._voice.say(following)


# Lets the sound files be heard that robots on the screen play.

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
        if file and not is_elsewhere(file) and Path(file).is_file():
            self._play(state.robot, file)
        elif player := self._players.get(state.robot):
            player.stop()

    def stop_speaking(self) -> None:
        """Be silent at once."""
        for player in self._players.values():
            player.stop()

    def forget(self) -> None:
        """Be silent; what robots play is begun anew when they are heard again."""
        self.stop_speaking()
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
