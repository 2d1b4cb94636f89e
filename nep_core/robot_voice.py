"""The part of Robot that speaks and listens."""

from __future__ import annotations

from nep_core.human import human_listener
from nep_core.robot_requests import RobotRequests
from nep_core.words import LONGEST_WAIT_S, next_word, state_of_word


class RobotVoice(RobotRequests):
    """What a robot does with its voice and its ears."""

    def say(
        self,
        text: object,
        gesture: str = "no_gesture",
        language: str = "",
        *,
        speed: float = 100.0,
        pitch: float = 100.0,
    ) -> None:
        """Say a text aloud, perhaps with a gesture, in a language such as "en".

        ``speed`` and ``pitch`` are percent of the usual ones, 50 to 200.
        """
        voice = {"speed": speed, "pitch": pitch}
        changed = {name: value for name, value in voice.items() if value != 100.0}
        self._perform("say", text=str(text), gesture=gesture, language=language, **changed)

    def ask(self, question: object, words: list[str] | None = None, seconds: float = 10.0) -> str:
        """Ask something, and give the word that is heard; "" when none is in time.

        With ``words``, only those count as an answer.
        """
        with human_listener(self._network).following() as heard:
            self.say(question)
            heard.clear()  # what was said before the question ended answers nothing
            return self._listen(words or [], seconds, heard)

    def wait_for_word(self, *words: str, seconds: float = LONGEST_WAIT_S) -> str:
        """Wait until one of the words is heard, and give it; "" when none is in time."""
        with human_listener(self._network).following() as heard:
            return self._listen(list(words), seconds, heard)

    def set_volume(self, percent: float) -> None:
        """Set how loud it speaks, 0 to 100."""
        self._perform("volume", percent=percent)

    def volume(self) -> float:
        """How loud it speaks, 0 to 100."""
        return float(self._state().settings.get("volume", 0.0))

    def set_language(self, language: str) -> None:
        """Set the language that it speaks and understands, such as "en"."""
        self._perform("language", language=language)

    def language(self) -> str:
        """The language that it speaks and understands."""
        return str(self._state().settings.get("language", ""))

    def _listen(self, words: list[str], seconds: float, heard: list[str]) -> str:
        wanted = {state_of_word(word): word for word in words}
        request = self._begin("listen", words=words, seconds=min(seconds, LONGEST_WAIT_S))
        try:
            return next_word(heard, wanted, seconds)
        finally:
            self._end("listen", request)
