"""The words that a robot listens for: those that rules wait for, and those asked for just now.

NAOqi has one vocabulary for all; it is changed when what is wanted differs from what it has.
"""

from __future__ import annotations

import logging

from nep_core.errors import ActionFailed
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.running import Task
from nodes.action.naoqi.driver.calls import waited
from nodes.action.naoqi.driver.common_words import common_words
from nodes.action.naoqi.driver.real import RealRobot

log = logging.getLogger(__name__)

SERVICE = "ALSpeechRecognition"
EARS = "NEP_Studio"
"""By this name the robot knows who listens."""
VOCABULARY_S = 10.0


class Hearing:
    """``expected`` are the words of rules, which are listened for all the time."""

    def __init__(self, robot: RealRobot, expected: tuple[str, ...] = ()) -> None:
        self.expected = expected
        self._robot = robot
        self._asked: list[tuple[str, ...]] = []
        self._has: tuple[str, ...] = ()
        self._change: Task | None = None
        self._refused: tuple[str, ...] = ()
        self._problem = ""

    def step(self) -> None:
        """Go on changing what the robot listens for, if that is wanted."""
        wanted = self._wanted()
        if self._change is None and wanted not in (self._has, self._refused):
            self._problem, self._refused = "", ()
            self._change = self._changing(wanted)
        if self._change is None:
            return
        try:
            next(self._change)
        except StopIteration:
            self._change = None
        except ActionFailed as problem:
            self._change, self._refused, self._problem = None, wanted, problem.sentence
            log.warning("%s does not listen: %s", self._robot.name, problem.sentence)

    def listen(self, action: s.Listen) -> Task:
        """Listen for words for some seconds; they come as human states. No words: common ones."""
        language = str(self._robot.known.settings.get("language", "en"))
        words = tuple(action.words) or common_words(language)
        self._asked.append(words)
        try:
            while not set(words) <= set(self._has):
                if self._problem:
                    raise ActionFailed(self._problem)
                yield
            self._robot.known.listening = tuple(action.words) or ("",)
            yield from waited(action.seconds)
        finally:
            self._asked.remove(words)
            self._robot.known.listening = ()
        return ""

    def _wanted(self) -> tuple[str, ...]:
        return tuple(
            dict.fromkeys(word for words in (self.expected, *self._asked) for word in words)
        )

    def _changing(self, words: tuple[str, ...]) -> Task:
        robot = self._robot
        if self._has:
            yield from robot.call(SERVICE, "unsubscribe", EARS)
        self._has = ()
        if not words:
            return ""
        yield from robot.call(SERVICE, "pause", True)
        yield from robot.call(SERVICE, "setVocabulary", list(words), True, limit_s=VOCABULARY_S)
        yield from robot.call(SERVICE, "pause", False)
        yield from robot.call(SERVICE, "subscribe", EARS)
        self._has = words
        return ""
