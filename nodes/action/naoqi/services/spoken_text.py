"""Reads text to be said: its tags for the voice, and the instructions of animated speech.

Voice tags stand between backslashes: pau=500 (ms of silence), rspd=80 and vct=120 (speed and pitch
in %), and rst (as usual again); others are left out. Instructions are ^start(path), ^wait(path),
^run(path), ^stop(path) and ^mode(name); the first four also with a tag: ^startTag(hello).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

VOICE_TAG = re.compile(r"\\+(\w+)(?:=([^\\]*))?\\+")
INSTRUCTION = re.compile(r"\^(start|wait|run|stop)(Tag)?\(([^)]*)\)|\^mode\(([^)]*)\)")
PIECE = re.compile(f"{VOICE_TAG.pattern}|{INSTRUCTION.pattern}")
SLOWEST, FASTEST = 50.0, 200.0


@dataclass(frozen=True)
class Voice:
    """How fast and how high it speaks, in percent of the usual."""

    speed: float = 100.0
    pitch: float = 100.0


@dataclass(frozen=True)
class Words:
    """Words to be said in one go."""

    text: str
    voice: Voice


@dataclass(frozen=True)
class Pause:
    """A silence."""

    seconds: float


@dataclass(frozen=True)
class Instruction:
    """What the body is told: start, wait, run or stop an animation, or the mode of the speech."""

    verb: str
    what: str
    is_tag: bool = False


Part = Words | Pause | Instruction


def read_text(text: str, usual: Voice, *, with_instructions: bool) -> list[Part]:
    """Return what a text asks for, in order. ``usual`` is the voice it begins with."""
    parts: list[Part] = []
    voice, place = usual, 0
    for found in (PIECE if with_instructions else VOICE_TAG).finditer(text):
        parts += _words(text[place : found.start()], voice)
        place = found.end()
        if found.group(1):
            voice, pause = _voice(found.group(1), found.group(2) or "", voice, usual)
            parts += [Pause(pause)] if pause else []
        else:
            _, _, verb, tag, what, mode = found.groups()
            parts.append(Instruction(verb or "mode", (what or mode or "").strip(), bool(tag)))
    return parts + _words(text[place:], voice)


def _words(text: str, voice: Voice) -> list[Part]:
    return [Words(text.strip(), voice)] if text.strip() else []


def _voice(name: str, value: str, voice: Voice, usual: Voice) -> tuple[Voice, float]:
    """Return the voice after a tag, and for how long (s) it is silent."""
    try:
        number = float(value)
    except ValueError:
        number = 100.0
    match name.lower():
        case "pau":
            return voice, min(max(number, 0.0), 65535.0) / 1000.0
        case "rspd":
            return replace(voice, speed=percent(number)), 0.0
        case "vct":
            return replace(voice, pitch=percent(number)), 0.0
        case "rst":
            return usual, 0.0
    return voice, 0.0


def percent(number: float) -> float:
    """Return a percentage that this robot's voice can do."""
    return min(max(number, SLOWEST), FASTEST)
