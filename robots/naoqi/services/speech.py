"""ALTextToSpeech: the voice."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from robots.body.animations import NO_GESTURE
from robots.body.limbs import Limb
from robots.body.speech import BODY_LANGUAGES, UPPER_BODY
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .animations import AnimationNames
from .arguments import CODES, NAMES, code_of, number, one_of, texts, within, words
from .module import Asked, Begin, Module, Plot, Script, always, play_script

# Reads text to be said: its tags for the voice, and the instructions of animated speech.
#
# Voice tags stand between backslashes: pau=500 (ms of silence), rspd=80 and vct=120 (speed and
# pitch in %), and rst (as usual again); others are left out. Instructions are ^start(path),
# ^wait(path), ^run(path), ^stop(path) and ^mode(name); the first four also with a tag:
# ^startTag(hello).

# A text of nothing but beginnings is read once, not once more from each: of backslashes only the
# first begins a tag, and an instruction ends before the next one.
VOICE_TAG = re.compile(r"(?<!\\)\\+(\w+)(?:=([^\\]*))?\\+")
INSTRUCTION = re.compile(r"\^(start|wait|run|stop)(Tag)?\(([^)^]*)\)|\^mode\(([^)^]*)\)")
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


VOICE = "naoenu"
PARAMETERS = {
    "speed": 100.0,
    "pitchShift": 1.0,
    "doubleVoice": 0.0,
    "doubleVoiceLevel": 0.0,
    "doubleVoiceTimeShift": 0.0,
    "volume": 100.0,
    "defaultVoiceSpeed": 100.0,
}
"""What can be set, with its value at the start."""


class ALTextToSpeech(Module):
    """Says texts, with their tags for the voice."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._parameters = dict(PARAMETERS)

    @property
    def voice(self) -> Voice:
        """How it speaks, as it was set."""
        shift = self._parameters["pitchShift"] or 1.0  # NAOqi: 0 is no shift
        return Voice(percent(self._parameters["speed"]), percent(100.0 * shift))

    @method("say::v(s)", "say::v(ss)")
    def say(self, text: str, *language: str) -> Any:
        """Say a text, in a language or as it is set; wait until it is said."""
        code = code_of(language[0]) if language else ""

        def play(begin: Begin) -> Script:
            for part in read_text(text, self.voice, with_instructions=False):
                if isinstance(part, Pause):
                    yield begin("silence", seconds=part.seconds)
                elif isinstance(part, Words):
                    yield say_words(begin, part, language=code)

        return play_script(self._robot, play)

    @method("sayToFile::v(ss)")
    def say_to_file(self, text: str, file: str) -> None:
        """Raise CallFailed: this robot has no files."""
        raise CallFailed("The robot on the screen has no files to speak into. A real NAO has.")

    @method("stopAll::v()")
    def stop_all(self) -> None:
        """Stop saying anything."""
        self._robot.stop(lambda command: Limb.VOICE in command.limbs)

    set_language = method("setLanguage::v(s)")(
        lambda self, language: self._do("language", language=code_of(language))
    )
    language = method("getLanguage::s()")(
        lambda self: NAMES.get(str(self._robot.state().settings["language"]), "English")
    )
    available_languages = always(
        list(CODES), "getAvailableLanguages::[s]()", "getSupportedLanguages::[s]()"
    )
    locale = method("locale::s()")(lambda self: str(self._robot.state().settings["language"]))

    @method("setVolume::v(f)")
    def set_volume(self, volume: float) -> Any:
        """Choose how loud it speaks, 0 to 1."""
        return self._do("volume", percent=100.0 * within(volume, 0.0, 1.0, "The volume"))

    @method("getVolume::f()")
    def volume(self) -> float:
        """Return how loud it speaks, 0 to 1."""
        return float(self._robot.state().settings["volume"]) / 100.0

    @method("setParameter::v(sf)")
    def set_parameter(self, name: str, value: float) -> None:
        """Set how the voice sounds: speed (%), pitchShift (1 to 4), ..."""
        self.parameter(name)
        self._parameters[name] = number(value)

    @method("getParameter::f(s)")
    def parameter(self, name: str) -> float:
        """Return how the voice sounds."""
        one_of(name, self._parameters, "The voice has no parameter “{name}”. Possible: {known}.")
        return self._parameters[name]

    @method("resetSpeed::v()")
    def reset_speed(self) -> None:
        """Speak at the usual speed."""
        self._parameters["speed"] = PARAMETERS["speed"]

    @method("reset::v()")
    def reset(self) -> None:
        """Let the voice sound as at the start."""
        self._parameters = dict(PARAMETERS)

    available_voices = always([VOICE], "getAvailableVoices::[s]()")
    voice_name = always(VOICE, "getVoice::s()")

    @method("setVoice::v(s)")
    def set_voice(self, name: str) -> None:
        """Choose the voice."""
        one_of(name, [VOICE], "There is no voice “{name}”. Possible: {voice}.")


def say_words(
    begin: Begin, words: Words, *, gesture: str = "no_gesture", language: str = ""
) -> Asked:
    """Let the robot say ``words`` with a ``gesture``; ``begin`` asks, "" is the usual language."""
    voice = words.voice
    return begin(
        "say",
        text=words.text,
        gesture=gesture,
        language=language,
        speed=voice.speed,
        pitch=voice.pitch,
    )


# ALAnimatedSpeech: speaks with the body, and does what stands between the words.

MODES = ("disabled", "random", "contextual")
"""How it moves while it speaks, by NAOqi's names, in the order of NAOqi's numbers."""


class ALAnimatedSpeech(Module):
    """Says texts with gestures, and with instructions such as ^start(Gestures/Hey_1)."""

    def __init__(
        self, robot: ServedRobot, names: AnimationNames, voice: Callable[[], Voice]
    ) -> None:
        super().__init__(robot)
        self._names = names
        self._voice = voice
        self._mode = "contextual"
        self._chance = random.Random(robot.name)

    @method("say::v(s)", "say::v(sm)")
    def say(self, text: str, configuration: Any = ()) -> Any:
        """Say a text with the body, with settings ({"bodyLanguageMode": "disabled"}); wait."""
        settings = words(configuration, "The settings of speech")
        mode = _mode(settings.get("bodyLanguageMode", self._mode))
        parts = read_text(text, self._voice(), with_instructions=True)
        for part in parts:  # an unknown animation is told before it begins to speak
            if isinstance(part, Instruction):
                self._check(part)
        return play_script(self._robot, self._telling(parts, mode))

    @method("setBodyLanguageModeFromStr::v(s)")
    def set_mode_name(self, mode: str) -> None:
        """Choose how it moves while it speaks: disabled, random, contextual."""
        self._mode = _mode(mode)

    mode_name = method("getBodyLanguageModeToStr::s()")(lambda self: self._mode)

    @method("setBodyLanguageMode::v(I)")
    def set_mode(self, mode: int) -> None:
        """Choose how it moves while it speaks: 0 disabled, 1 random, 2 contextual."""
        if not 0 <= mode < len(MODES):
            raise CallFailed("There is no mode {mode}. Possible: 0, 1, 2.", mode=mode)
        self._mode = MODES[mode]

    # How it moves while it speaks, as a number
    mode = method("getBodyLanguageMode::I()")(lambda self: MODES.index(self._mode))

    @method("setBodyLanguageEnabled::v(b)", "setBodyTalkEnabled::v(b)")
    def set_body_language(self, is_on: bool) -> None:
        """Let it move while it speaks, or not."""
        self._mode = "contextual" if is_on else "disabled"

    body_language = method("isBodyLanguageEnabled::b()", "isBodyTalkEnabled::b()")(
        lambda self: self._mode != "disabled"
    )

    @method("declareTagForAnimations::v(m)")
    def declare_tags(self, tags: Any) -> None:
        """Give animations more tags."""
        for tag, paths in words(tags, "The tags of animations").items():
            self._names.tags.setdefault(tag, []).extend(texts(paths))

    def _check(self, part: Instruction) -> None:
        if part.verb == "mode":
            _mode(part.what)
        elif part.is_tag:
            self._names.with_tag(part.what)
        else:
            self._names.name_of(part.what, self._robot.robot)

    def _telling(self, parts: list[Part], mode: str) -> Plot:
        """Say the words and do the instructions; what still moves after the last word is ended."""

        def play(begin: Begin) -> Script:
            begun: dict[str, Asked] = {}
            now = mode
            for part in parts:
                match part:
                    case Words():
                        yield say_words(begin, part, gesture=self._gesture(now))
                    case Pause():
                        yield begin("silence", seconds=part.seconds)
                    case Instruction(verb="mode"):
                        now = _mode(part.what)
                    case Instruction(verb="start" | "run"):
                        begun[part.what] = begin("play", animation=self._animation(part))
                        if part.verb == "run":
                            yield begun[part.what]
                    case Instruction(verb="wait") if part.what in begun:
                        yield begun[part.what]
                    case Instruction(verb="stop") if part.what in begun:
                        begun.pop(part.what).stop()

        return play

    def _animation(self, part: Instruction) -> str:
        path = self._chance.choice(self._names.with_tag(part.what)) if part.is_tag else part.what
        return self._names.name_of(path, self._robot.robot)

    def _gesture(self, mode: str) -> str:
        """Return how to move while speaking: not at all when the arms do something else."""
        robot = self._robot.robot
        is_free = not self._robot.busy_limbs() & UPPER_BODY and not robot.released
        return mode if mode in BODY_LANGUAGES and is_free else NO_GESTURE


def _mode(name: Any) -> str:
    return str(one_of(name, MODES, "There is no mode “{name}”. Possible: {modes}."))
