"""ALAnimatedSpeech: speaks with the body, and does what stands between the words."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

from nodes.action.naobody.animations import NO_GESTURE
from nodes.action.naobody.body_language import BODY_LANGUAGES, UPPER_BODY
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.animation_names import AnimationNames
from nodes.action.naoqi.services.arguments import texts, words
from nodes.action.naoqi.services.module import Module
from nodes.action.naoqi.services.scripts import Asked, Begin, Plot, Script, play_script
from nodes.action.naoqi.services.speech import say_words
from nodes.action.naoqi.services.spoken_text import (
    Instruction,
    Part,
    Pause,
    Voice,
    Words,
    read_text,
)
from nodes.action.naoqi.serving import ServedRobot

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

    @method("say::v(s)")
    def say(self, text: str) -> Any:
        """Say a text with the body; wait until it is said."""
        return self._say(text, self._mode)

    @method("say::v(sm)")
    def say_with(self, text: str, configuration: Any) -> Any:
        """Say a text with settings: {"bodyLanguageMode": "disabled"}."""
        settings = words(configuration, "The settings of speech")
        return self._say(text, _mode(settings.get("bodyLanguageMode", self._mode)))

    @method("setBodyLanguageModeFromStr::v(s)")
    def set_mode_name(self, mode: str) -> None:
        """Choose how it moves while it speaks: disabled, random, contextual."""
        self._mode = _mode(mode)

    @method("getBodyLanguageModeToStr::s()")
    def mode_name(self) -> str:
        """Return how it moves while it speaks."""
        return self._mode

    @method("setBodyLanguageMode::v(I)")
    def set_mode(self, mode: int) -> None:
        """Choose how it moves while it speaks: 0 disabled, 1 random, 2 contextual."""
        if not 0 <= mode < len(MODES):
            raise CallFailed(f"There is no mode {mode}. Possible: 0, 1, 2.")
        self._mode = MODES[mode]

    @method("getBodyLanguageMode::I()")
    def mode(self) -> int:
        """Return how it moves while it speaks, as a number."""
        return MODES.index(self._mode)

    @method("setBodyLanguageEnabled::v(b)")
    def set_body_language(self, is_on: bool) -> None:
        """Let it move while it speaks, or not."""
        self._mode = "contextual" if is_on else "disabled"

    @method("isBodyLanguageEnabled::b()")
    def body_language(self) -> bool:
        """Return whether it moves while it speaks."""
        return self._mode != "disabled"

    @method("setBodyTalkEnabled::v(b)")
    def set_body_talk(self, is_on: bool) -> None:
        """Let it move while it speaks, or not."""
        self.set_body_language(is_on)

    @method("isBodyTalkEnabled::b()")
    def body_talk(self) -> bool:
        """Return whether it moves while it speaks."""
        return self.body_language()

    @method("declareTagForAnimations::v(m)")
    def declare_tags(self, tags: Any) -> None:
        """Give animations more tags."""
        for tag, paths in words(tags, "The tags of animations").items():
            self._names.tags.setdefault(tag, []).extend(texts(paths))

    def _say(self, text: str, mode: str) -> Any:
        parts = read_text(text, self._voice(), with_instructions=True)
        for part in parts:  # an unknown animation is told before it begins to speak
            if isinstance(part, Instruction):
                self._check(part)
        return play_script(self._robot, self._telling(parts, mode))

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
    if name not in MODES:
        raise CallFailed(f"There is no mode “{name}”. Possible: {', '.join(MODES)}.")
    return str(name)
