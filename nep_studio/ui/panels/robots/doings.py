"""What each robot is doing now, from what it was asked and what it answered."""

from __future__ import annotations

import msgspec

from nep_core import messages as m
from nep_studio.action_words import action_words
from nep_studio.blocks.language import Language
from nep_studio.plain_words import Tr

MOST_REQUESTS = 200
"""So many are remembered, of which the oldest are forgotten."""


class Doings:
    """The actions that go on, by robot."""

    def __init__(self, language: Language, tr: Tr) -> None:
        self._language = language
        self.tr = tr
        self._requests: dict[str, m.ActionRequest] = {}
        self._going_on: dict[str, dict[str, None]] = {}

    def hear(self, message: msgspec.Struct) -> bool:
        """Take in a message; whether it says what a robot does."""
        if isinstance(message, m.ActionRequest):
            self._requests[message.id] = message
            if len(self._requests) > MOST_REQUESTS:
                del self._requests[next(iter(self._requests))]
        elif isinstance(message, m.ActionResult):
            actions = self._going_on.setdefault(message.robot, {})
            if message.state == "started":
                actions[message.id] = None
            elif message.state in ("done", "failed", "cancelled"):
                actions.pop(message.id, None)
        return isinstance(message, m.ActionRequest | m.ActionResult)

    def words(self, robot: str) -> list[str]:
        """What it does, each as the predicate of a sentence."""
        requests = [self._requests.get(action) for action in self._going_on.get(robot, {})]
        found = [action_words(one, self._language, self.tr) for one in requests if one is not None]
        return list(dict.fromkeys(found))

    def clear(self) -> None:
        """Nothing goes on any more."""
        self._requests.clear()
        self._going_on.clear()
