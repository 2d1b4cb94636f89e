"""What every voice can do, and which this computer has."""

from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import shutil
import sys
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from html import escape
from typing import Any, Protocol

from PySide6.QtCore import QLocale, QObject, QProcess, Signal, SignalInstance

from nep_core.wire.messages import ActionRequest, RobotState

log = logging.getLogger(__name__)


# Something that a robot says, and how its voice is.

LONGEST = 2000
"""So many letters of a text are spoken: nobody listens to more."""
LOWEST_PITCH, HIGHEST_PITCH = 0.5, 2.0
OWN_PITCHES = (1.0, 1.25, 0.8, 1.45, 0.9, 1.12, 0.7)
"""Robots that talk with each other are told apart by these."""
SLOWEST, FASTEST = 0.5, 3.0


@dataclass(frozen=True)
class Utterance:
    """A text, its language ("en", "pt_br"), and how it is said.

    ``volume`` is 0 to 1; ``pitch`` and ``speed`` are 1 as usual, 2 for twice as high or fast.
    """

    text: str
    language: str = "en"
    volume: float = 1.0
    pitch: float = 1.0
    speed: float = 1.0


def own_pitch(robot: str) -> float:
    """The pitch of a robot's voice, the same each time: the first of the usual names is 1."""
    if robot in ("", "NAO"):
        return OWN_PITCHES[0]
    return OWN_PITCHES[1 + zlib.crc32(robot.encode()) % (len(OWN_PITCHES) - 1)]


def utterance_of(state: RobotState) -> Utterance:
    """What a robot says now, as loud and in the language that it is set to."""
    language = state.settings.get("language")
    return Utterance(
        " ".join(state.saying.split())[:LONGEST],
        language if isinstance(language, str) and language else "en",
        _spoken_percent(state.settings.get("volume"), 100.0),
        own_pitch(state.robot),
    )


def spoken_as(utterance: Utterance, request: ActionRequest | None) -> Utterance:
    """The utterance in the language, pitch and speed that were asked for."""
    if request is None:
        return utterance
    language = request.args.get("language") or request.args.get("usual_language")
    pitch = utterance.pitch * _spoken_percent(request.args.get("pitch"), 200.0)
    return replace(
        utterance,
        language=language if isinstance(language, str) and language else utterance.language,
        pitch=min(max(pitch, LOWEST_PITCH), HIGHEST_PITCH),
        speed=min(max(_spoken_percent(request.args.get("speed"), 300.0), SLOWEST), FASTEST),
    )


def _spoken_percent(value: object, most: float) -> float:
    """A number of percent as a share; 1 for what is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
        return 1.0
    return min(max(float(value), 0.0), most) / 100.0


# The voices that computers bring with them: which program speaks, and how it is told what.

WORDS_PER_MINUTE = 165
"""About as fast as NAO speaks, so that its voice and its picture end together."""


@dataclass(frozen=True)
class Command:
    """A program with its arguments, and what it reads."""

    words: tuple[str, ...]
    text: str = ""


@dataclass(frozen=True)
class SystemVoice:
    """A program that speaks; ``stopping`` is what ends a speech that outlives its program."""

    name: str
    command: Callable[[Utterance], Command]
    stopping: tuple[str, ...] = ()


def installed(name: str) -> str | None:
    """Where a program of this computer is; None for one of the folder that we are started in.

    Windows looks there first, and it may be a stranger's.
    """
    found = shutil.which(name)
    return found if found is not None and os.path.isabs(found) else None


def find_system_voice(
    platform: str = sys.platform, which: Callable[[str], str | None] = installed
) -> SystemVoice | None:
    """The program by which this computer speaks; None when it has none."""
    if importlib.util.find_spec("pyttsx3") is not None and not getattr(sys, "frozen", False):
        return SystemVoice("pyttsx3", pyttsx3_command)
    if platform == "darwin" and (say := which("say")):
        return SystemVoice("say", partial(_say, say))
    if platform == "win32" and (shell := which("powershell") or which("pwsh")):
        return SystemVoice("powershell", partial(_powershell, shell))
    for name in ("espeak-ng", "espeak"):
        if espeak := which(name):
            return SystemVoice(name, partial(_espeak, espeak))
    if speaker := which("spd-say"):
        return SystemVoice("spd-say", partial(_spd_say, speaker), (speaker, "--cancel"))
    return None


def _espeak(program: str, said: Utterance) -> Command:
    language = {"zh": "cmn"}.get(said.language, said.language.replace("_", "-"))
    pitch = min(max(round(50 + 50 * (said.pitch - 1.0)), 0), 99)
    words = (program, "-v", language, "-a", str(round(100 * said.volume)), "-p", str(pitch))
    return Command((*words, "-s", str(_pace(said)), "--stdin"), said.text)


def _spd_say(program: str, said: Utterance) -> Command:
    """Its numbers go from -100 to 100; it reads the text, which may begin with a dash, last."""
    volume, pitch = round(200 * said.volume - 100), _percent(said.pitch)
    numbers = ("-i", str(volume), "-p", str(pitch), "-r", str(_percent(said.speed)))
    language = said.language.replace("_", "-")
    return Command((program, "--wait", "-l", language, *numbers, "--", said.text))


def _say(program: str, said: Utterance) -> Command:
    """Volume and pitch of Apple's voice are commands within the text."""
    voice = APPLE_VOICES.get(said.language)
    words = (program, *(("-v", voice) if voice else ()), "-r", str(_pace(said)), "-f", "-")
    how = f"[[volm {said.volume:.2f}]] [[pbas {round(45 + 15 * (said.pitch - 1.0))}]] "
    return Command(words, how + said.text.replace("[[", "[ ["))


def _powershell(program: str, said: Utterance) -> Command:
    """The voice of Windows reads SSML, which says the language, pitch and speed."""
    language = escape(said.language.replace("_", "-"))
    pitch, rate = f"{_percent(said.pitch):+d}%", f"{_percent(said.speed):+d}%"
    ssml = (
        f'<speak version="1.0" xmlns="http://www.w3.org/2001/10/synthesis" xml:lang="{language}">'
        f'<prosody pitch="{pitch}" rate="{rate}">{escape(said.text, quote=False)}</prosody></speak>'
    )
    script = (
        "[Console]::InputEncoding = [Text.Encoding]::UTF8; "
        "Add-Type -AssemblyName System.Speech; "
        "$voice = New-Object System.Speech.Synthesis.SpeechSynthesizer; "
        f"$voice.Volume = {round(100 * said.volume)}; "
        "$voice.SpeakSsml([Console]::In.ReadToEnd())"
    )
    return Command((program, "-NoProfile", "-NonInteractive", "-Command", script), ssml)


def pyttsx3_command(said: Utterance) -> Command:
    """It waits while it speaks, so that it gets a process of its own.

    -P: the folder that we are started in may be a stranger's, with a file called like a library.
    """
    numbers = (str(_pace(said)), f"{said.volume:.2f}", said.language)
    return Command((sys.executable, "-P", "-c", PYTTSX3, *numbers), said.text)


def _pace(said: Utterance) -> int:
    return round(WORDS_PER_MINUTE * said.speed)


def _percent(share: float) -> int:
    return min(max(round(100 * (share - 1.0)), -100), 100)


PYTTSX3 = """
import sys
import pyttsx3
sys.stdin.reconfigure(encoding="utf-8")
engine = pyttsx3.init()
pace, volume, language = sys.argv[1:]
engine.setProperty("rate", int(pace))
engine.setProperty("volume", float(volume))
for voice in engine.getProperty("voices"):
    told = " ".join(str(one) for one in [*(voice.languages or []), voice.id]).lower()
    if language[:2] in told.replace("_", "-").replace("-", " ").split():
        engine.setProperty("voice", voice.id)
        break
engine.say(sys.stdin.read())
engine.runAndWait()
"""

APPLE_VOICES = {
    "ar": "Majed",
    "cs": "Zuzana",
    "da": "Sara",
    "de": "Anna",
    "en": "Samantha",
    "es": "Mónica",
    "fi": "Satu",
    "fr": "Thomas",
    "it": "Alice",
    "ja": "Kyoko",
    "ko": "Yuna",
    "nl": "Xander",
    "pl": "Zosia",
    "pt": "Joana",
    "pt_br": "Luciana",
    "ru": "Milena",
    "sv": "Alva",
    "tr": "Yelda",
    "zh": "Tingting",
}
"""The voice of each language that comes with macOS; one that is not there is left out."""


# A voice of the system: a program that speaks, in a process of its own.

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


# The voice that Qt brings, where the add-ons of PySide6 are installed.

MODULE = "PySide6.QtTextToSpeech"
SPEAKS_ALOUD = ("speechd", "sapi", "winrt", "darwin", "macos", "android", "flite")
"""Qt's engines that are heard; "mock" only pretends."""


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
