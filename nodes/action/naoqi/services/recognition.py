"""ALSpeechRecognition: hears the words of a vocabulary."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nep_core.words import plain
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.extractor import PausableExtractor
from nodes.action.naoqi.services.languages import CODES, code_of
from nodes.action.naoqi.services.module import kept
from nodes.action.naoqi.services.scripts import Asked
from nodes.action.naoqi.serving import ServedRobot

LISTENING_S = 3600.0
SURE = 0.9
Tell = Callable[[str, Any], None]


class ALSpeechRecognition(PausableExtractor):
    """Listens while somebody has subscribed; what it is told to hear is recognized."""

    events = ("WordRecognized", "LastWordRecognized", "SpeechDetected")
    set_audio, audio = kept("setAudioExpression::v(b)", "getAudioExpression::b()", True)

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._words: list[str] = []
        self._is_spotting = False
        self._language = "English"
        self._parameters: dict[str, float] = {"Sensitivity": 0.3}
        self._listening: Asked | None = None

    def hear(self, heard: str, tell: Tell) -> None:
        """Take in what is said, and tell it when it is in the vocabulary."""
        if not self.is_on:
            return
        tell("SpeechDetected", 1)
        words = [word for word in self._words if self._fits(word, heard)]
        if words:
            word = f"<...> {words[0]} <...>" if self._is_spotting else words[0]
            tell("WordRecognized", [word, SURE])
            tell("LastWordRecognized", [word, SURE])
        tell("SpeechDetected", 0)

    @method("setVocabulary::v([s]b)")
    def set_vocabulary(self, words: list[str], spotting: bool) -> None:
        """Choose the words; ``spotting``: also in the middle of a sentence."""
        self._words, self._is_spotting = list(words), spotting
        self._changed()

    @method("setWordListAsVocabulary::v([s])")
    def set_word_list(self, words: list[str]) -> None:
        """Choose the words."""
        self.set_vocabulary(words, False)

    @method("setLanguage::v(s)")
    def set_language(self, language: str) -> None:
        """Choose the language."""
        code_of(language)
        self._language = language

    @method("getLanguage::s()")
    def language(self) -> str:
        """Return the language that it understands."""
        return self._language

    @method("getAvailableLanguages::[s]()")
    def available_languages(self) -> list[str]:
        """Return the languages that it understands."""
        return list(CODES)

    @method("setVisualExpression::v(b)")
    def set_visual_expression(self, is_on: bool) -> None:
        """Remember whether the eyes show that it listens."""
        self._kept["visual"] = is_on

    @method("setParameter::v(sf)")
    def set_parameter(self, name: str, value: float) -> None:
        """Set how it listens, such as Sensitivity."""
        self._parameters[name] = value

    @method("getParameter::f(s)")
    def parameter(self, name: str) -> float:
        """Return how it listens."""
        if name not in self._parameters:
            known = ", ".join(self._parameters)
            raise CallFailed(f"There is no parameter “{name}”. Possible: {known}.")
        return self._parameters[name]

    @method("removeAllContext::v()")
    def remove_all_context(self) -> None:
        """Forget the words."""
        self.set_vocabulary([], False)

    def _fits(self, word: str, heard: str) -> bool:
        if self._is_spotting:
            return f" {plain(word)} ".replace("_", " ") in f" {plain(heard)} ".replace("_", " ")
        return plain(word) == plain(heard)

    def _changed(self) -> None:
        """Let the robot listen, so that people see which words it waits for."""
        if self._listening is not None:
            self._listening.stop()
            self._listening = None
        if self.is_on:
            self._listening = Asked(self._robot, "listen", words=self._words, seconds=LISTENING_S)
