"""The voices that computers bring with them: which program speaks, and how it is told what."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from xml.sax.saxutils import escape

from .utterance import Utterance

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


def find_system_voice(
    platform: str = sys.platform, which: Callable[[str], str | None] = shutil.which
) -> SystemVoice | None:
    """The program by which this computer speaks; None when it has none."""
    if importlib.util.find_spec("pyttsx3") is not None and not getattr(sys, "frozen", False):
        return SystemVoice("pyttsx3", _pyttsx3)
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
    language = escape(said.language.replace("_", "-"), {'"': "&quot;"})
    pitch, rate = f"{_percent(said.pitch):+d}%", f"{_percent(said.speed):+d}%"
    ssml = (
        f'<speak version="1.0" xmlns="http://www.w3.org/2001/10/synthesis" xml:lang="{language}">'
        f'<prosody pitch="{pitch}" rate="{rate}">{escape(said.text)}</prosody></speak>'
    )
    script = (
        "[Console]::InputEncoding = [Text.Encoding]::UTF8; "
        "Add-Type -AssemblyName System.Speech; "
        "$voice = New-Object System.Speech.Synthesis.SpeechSynthesizer; "
        f"$voice.Volume = {round(100 * said.volume)}; "
        "$voice.SpeakSsml([Console]::In.ReadToEnd())"
    )
    return Command((program, "-NoProfile", "-NonInteractive", "-Command", script), ssml)


def _pyttsx3(said: Utterance) -> Command:
    """It waits while it speaks, so that it gets a process of its own."""
    numbers = (str(_pace(said)), f"{said.volume:.2f}", said.language)
    return Command((sys.executable, "-c", PYTTSX3, *numbers), said.text)


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
