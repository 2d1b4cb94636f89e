"""ALTextToSpeech: the voice."""

from __future__ import annotations

from typing import Any

from nodes.action.naobody.limbs import Limb
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import number, within
from nodes.action.naoqi.services.languages import CODES, NAMES, code_of
from nodes.action.naoqi.services.module import Module
from nodes.action.naoqi.services.scripts import Asked, Begin, Plot, Script, play_script
from nodes.action.naoqi.services.spoken_text import Pause, Voice, Words, percent, read_text
from nodes.action.naoqi.serving import ServedRobot

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
        self._voice = VOICE

    @property
    def voice(self) -> Voice:
        """How it speaks, as it was set."""
        shift = self._parameters["pitchShift"] or 1.0  # NAOqi: 0 is no shift
        return Voice(percent(self._parameters["speed"]), percent(100.0 * shift))

    @method("say::v(s)")
    def say(self, text: str) -> Any:
        """Say a text; wait until it is said."""
        return play_script(self._robot, self._saying(text, ""))

    @method("say::v(ss)")
    def say_in(self, text: str, language: str) -> Any:
        """Say a text in a language."""
        return play_script(self._robot, self._saying(text, code_of(language)))

    @method("sayToFile::v(ss)")
    def say_to_file(self, text: str, file: str) -> None:
        """Raise CallFailed: this robot has no files."""
        raise CallFailed("The robot on the screen has no files to speak into. A real NAO has.")

    @method("stopAll::v()")
    def stop_all(self) -> None:
        """Stop saying anything."""
        self._robot.stop(lambda command: Limb.VOICE in command.limbs)

    @method("setLanguage::v(s)")
    def set_language(self, language: str) -> Any:
        """Choose the language."""
        return self._do("language", language=code_of(language))

    @method("getLanguage::s()")
    def language(self) -> str:
        """Return the language that it speaks."""
        return NAMES.get(str(self._robot.state().settings["language"]), "English")

    @method("getAvailableLanguages::[s]()")
    def available_languages(self) -> list[str]:
        """Return the languages that it speaks."""
        return list(CODES)

    @method("getSupportedLanguages::[s]()")
    def supported_languages(self) -> list[str]:
        """Return the languages that there are."""
        return list(CODES)

    @method("locale::s()")
    def locale(self) -> str:
        """Return the code of the language that it speaks."""
        return str(self._robot.state().settings["language"])

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
        if name not in self._parameters:
            known = ", ".join(self._parameters)
            raise CallFailed(f"The voice has no parameter “{name}”. Possible: {known}.")
        return self._parameters[name]

    @method("resetSpeed::v()")
    def reset_speed(self) -> None:
        """Speak at the usual speed."""
        self._parameters["speed"] = PARAMETERS["speed"]

    @method("reset::v()")
    def reset(self) -> None:
        """Let the voice sound as at the start."""
        self._parameters = dict(PARAMETERS)

    @method("getAvailableVoices::[s]()")
    def available_voices(self) -> list[str]:
        """Return the voices that there are."""
        return [VOICE]

    @method("getVoice::s()")
    def voice_name(self) -> str:
        """Return the voice that speaks."""
        return self._voice

    @method("setVoice::v(s)")
    def set_voice(self, name: str) -> None:
        """Choose the voice."""
        if name != VOICE:
            raise CallFailed(f"There is no voice “{name}”. Possible: {VOICE}.")

    def _saying(self, text: str, language: str) -> Plot:
        def play(begin: Begin) -> Script:
            for part in read_text(text, self.voice, with_instructions=False):
                if isinstance(part, Pause):
                    yield begin("silence", seconds=part.seconds)
                elif isinstance(part, Words):
                    yield say_words(begin, part, language=language)

        return play


def say_words(
    begin: Begin, words: Words, *, gesture: str = "no_gesture", language: str = ""
) -> Asked:
    """Let the robot say words."""
    voice = words.voice
    return begin(
        "say",
        text=words.text,
        gesture=gesture,
        language=language,
        speed=voice.speed,
        pitch=voice.pitch,
    )
