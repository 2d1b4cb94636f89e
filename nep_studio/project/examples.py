"""The examples that come with the program, and what the gallery says of them."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

import msgspec

from nep_core.wire.messages import HUMAN_BEHAVIOR, SENSE_REQUEST, HumanBehavior, SenseRequest
from nep_studio import paths

Difficulty = Literal["first", "next", "more"]

TOUCHED = ("head_", "hand_", "bumper_", "chest_")
"""How the names of touch sensors begin: who touches lets go again."""


@dataclass(frozen=True)
class Try:
    """Something to try, and what a hand can send in place of a person who does it.

    That is the human ``state``, or else what ``robot``, a virtual one, notices: see SenseRequest.
    """

    words: str
    state: str = ""
    sense: str = ""
    value: float = 1.0
    name: str = ""
    robot: str = "NAO"

    @property
    def is_touch(self) -> bool:
        """Whether it is a touch, which ends with ``release``."""
        return self.sense.startswith(TOUCHED)

    @property
    def topic(self) -> str:
        """Where its message goes."""
        return HUMAN_BEHAVIOR if self.state else SENSE_REQUEST

    def message(self) -> msgspec.Struct:
        """What to send."""
        if self.state:
            return HumanBehavior(human_state=self.state, source="by hand")
        return self._sensed(self.value)

    def release(self) -> msgspec.Struct:
        """What to send a moment after a touch."""
        return self._sensed(0.0)

    def _sensed(self, value: float) -> SenseRequest:
        return SenseRequest(robot=self.robot, sense=self.sense, value=value, name=self.name)


@dataclass(frozen=True)
class Example:
    """An example; its words are English. ``seconds`` is 0 where it goes on until it is stopped."""

    path: Path
    title: str
    sentence: str = ""
    needs: tuple[str, ...] = ()
    difficulty: Difficulty = "next"
    seconds: float = 0.0
    tags: tuple[str, ...] = ()
    tries: tuple[Try, ...] = ()

    def words(self) -> list[str]:
        """All that is shown of it and wants to be translated."""
        return [self.title, self.sentence, *(each.words for each in self.tries)]


@cache
def examples() -> tuple[Example, ...]:
    """The examples in the order of the gallery; those it says nothing of come last."""
    folder = paths.examples()
    told = tomllib.loads((folder / "examples.toml").read_text(encoding="utf-8"))
    files = {path.stem: path for path in sorted(folder.glob("*.nep"))}
    named = [_example(files[name], table) for name, table in told.items() if name in files]
    return (*named, *(_example(path, {}) for name, path in files.items() if name not in told))


def _example(path: Path, told: Mapping[str, Any]) -> Example:
    usual = {"title": path.stem.replace("_", " ").capitalize()}
    return msgspec.convert({**usual, **told, "path": path}, Example)
