"""What a look at a robot is, and what such looks ask for."""

from __future__ import annotations

import math
import tempfile
import wave
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from nep_core.wire.messages import RobotState, Thing
from nep_core.wire.states import plain
from tests.stories.robot_theatre import B

SOUND_S = 5
NEAR_RAD, NEAR_M = 0.06, 0.04
LONG = "This is what I have been asked to say to you"
Sense = tuple[str, float, dict[str, Any]]


@dataclass
class Seen:
    """The robot before and after, all its states in between, what a reporter gave, a refusal."""

    before: RobotState
    states: list[RobotState] = field(default_factory=list)
    value: Any = None
    refused: str = ""

    @property
    def after(self) -> RobotState:
        return self.states[-1] if self.states else self.before

    @property
    def said(self) -> set[str]:
        return {state.saying for state in self.states}

    def way(self) -> tuple[float, float, float]:
        """How far it went forward, to the left, and how far it turned."""
        x, y, theta = self.before.base
        to_x, to_y, to_theta = self.after.base
        cosine, sine = math.cos(theta), math.sin(theta)
        east, north = to_x - x, to_y - y
        turn = math.remainder(to_theta - theta, math.tau)
        return east * cosine + north * sine, north * cosine - east * sine, turn

    def moved(self, joint: str) -> float:
        """The most that a joint was away from where it was before."""
        start = self.before.joints[joint]
        return max((abs(state.joints[joint] - start) for state in self.states), default=0.0)


@dataclass(frozen=True)
class Look:
    """``what``: what is looked at, in words; ``holds``: whether it is so."""

    what: str
    holds: Callable[[Seen], object]
    fields: dict[str, Any] = field(default_factory=dict)
    first: tuple[B, ...] = ()
    then: tuple[B, ...] = ()
    senses: tuple[Sense, ...] = ()
    state: str = ""
    """What the person does, for rules that wait for that."""
    things: tuple[Thing, ...] = ()
    """What stands around, where it is before the robot."""

    @property
    def in_sight(self) -> frozenset[str]:
        """What the robot says that it sees then."""
        return frozenset(name for one in self.senses for name in _in_sight(one))


def joint(name: str, degrees: float) -> Callable[[Seen], bool]:
    return lambda seen: abs(seen.after.joints[name] - math.radians(degrees)) < NEAR_RAD


def went(forward: float, left: float, turn_deg: float) -> Callable[[Seen], bool]:
    def has_gone(seen: Seen) -> bool:
        ahead, aside, turn = seen.way()
        return (
            abs(ahead - forward) < NEAR_M
            and abs(aside - left) < NEAR_M
            and abs(math.remainder(turn - math.radians(turn_deg), math.tau)) < NEAR_RAD
        )

    return has_gone


def setting(name: str, value: object) -> Callable[[Seen], bool]:
    return lambda seen: seen.after.settings.get(name) == value


def light(name: str, colour: int) -> Callable[[Seen], bool]:
    return lambda seen: seen.after.leds.get(name) == colour


def value_near(value: float, by: float = 1.0) -> Callable[[Seen], bool]:
    return lambda seen: isinstance(seen.value, int | float) and abs(seen.value - value) <= by


def value_is(value: object) -> Callable[[Seen], bool]:
    return lambda seen: seen.value == value


def rule(what: str, *senses: Sense, state: str = "", **fields: Any) -> Look:
    words = f"the rule runs when {what}"
    return Look(words, lambda seen: LONG in seen.said, fields, senses=senses, state=state)


def sound_file() -> str:
    """Some seconds of silence, in a file of their own: as long as robots that live fast need."""
    path = Path(tempfile.gettempdir()) / "robot_blocks_sound.wav"
    with wave.open(str(path), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(8000)
        sound.writeframes(bytes(SOUND_S * 16000))
    return str(path)


def _in_sight(one: Sense) -> list[str]:
    kind, _, more = one
    named = [f"{kind}_{plain(more['name'])}"] if "name" in more else []
    return [kind, *named] if kind in ("face", "mark") else []


def sense(what: str, value: float = 1.0, **more: Any) -> Sense:
    return what, value, more
