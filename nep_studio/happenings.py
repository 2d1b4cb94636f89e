"""What can happen around the robots that a program waits for or asks about."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

from nep_core.words import plain, state_of_thing, word_of_state
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.deployment import GESTURE_STATE, chains, rules
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.sentence import Slot
from nep_studio.blocks.text import field_text

Kind = Literal[
    "word",
    "face",
    "distance",
    "touch",
    "gesture",
    "ball",
    "mark",
    "sound",
    "emotion",
    "state",
    "sensor",
    "joint",
    "posture",
    "doing",
    "idle",
]


REMEMBER = "sensing.remember"
"""The block that names a state without waiting for it."""


@dataclass(frozen=True)
class Happening:
    """Something that can happen, and to which robot ("*": whichever).

    ``value`` is the word, the name of a face ("": anybody), the number of a mark, the part that is
    touched, a state, the name of a sensor. ``words`` is what it is about, for people. ``amount``
    is what a sensor must measure, or for how many seconds nothing may happen; None: anything.
    """

    kind: Kind
    value: str = ""
    words: str = ""
    robot: str = ALL_ROBOTS
    amount: float | None = None

    @property
    def key(self) -> tuple[Kind, str, str, float | None]:
        """What tells it from the others: not how it is worded."""
        return self.kind, plain(self.value), self.robot, self.amount


def happenings_of(project: Project, language: Language) -> list[Happening]:
    """What the program waits for, then what it asks about; each once, in its order."""
    found = {one.key: one for one in reversed(list(_waited_for(project, language)))}
    return list(found.values())[::-1]


def _waited_for(project: Project, language: Language) -> Iterator[Happening]:
    hats = [chain[0] for chain in rules(project, language)]
    for hat in hats:
        yield from _of_block(project, project.blocks[hat], language)
    for chain in chains(project, language):
        for block in project.within(chain, enabled=True):
            if block.id not in hats:
                yield from _of_block(project, block, language)


def _of_block(project: Project, block: Block, language: Language) -> Iterator[Happening]:
    definition = language.of(project).definitions.get(block.type)
    if definition is None:
        return
    asked = _Asked(project, block, definition, language)
    if is_of := _BY_BLOCK.get(_name_of(definition)):
        yield is_of(asked)
    for key, slot in definition.keys(block.groups):
        if slot.name in _WORD_SLOTS.get(_name_of(definition), ()):
            yield from asked.word(key)
        elif slot.kind.name == "state" and asked.value(key) and definition.id != REMEMBER:
            yield of_state(asked.value(key), language)
        elif slot.kind.name == "gesture":
            yield Happening("gesture", asked.value(key), asked.label(key))


def of_state(state: str, language: Language) -> Happening:
    """What must happen for a human state to be told: a touch, a word, ..., else the state itself.

    Of the look of a person and of distances robots tell as they notice them.
    """
    if state.startswith(GESTURE_STATE):
        name = state.removeprefix(GESTURE_STATE)
        known = language.choices.get("gestures", {}).get(name, name.replace("_", " "))
        return Happening("gesture", name, known)
    for beginning, kind, table in _STATES:
        value = state.removeprefix(beginning)
        if state.startswith(beginning) and value in language.choices.get(table, {}):
            return Happening(kind, value, language.choices[table][value])
    for thing, kind in _THINGS.items():
        beginning = state_of_thing(thing)
        if state == beginning or state.startswith(f"{beginning}_"):
            name = state.removeprefix(beginning).strip("_").replace("_", " ")
            return Happening(kind, name, name)
    if word := word_of_state(state):
        return Happening("word", word, word)
    return Happening("state", state, state.replace("_", " "))


_THINGS: dict[str, Kind] = {"face": "face", "ball": "ball", "mark": "mark", "sound": "sound"}

_STATES: tuple[tuple[str, Kind, str], ...] = (
    ("touched_", "touch", "touch_parts"),
    ("emotion_", "emotion", "emotions"),
    ("person_", "distance", "distances"),
)


@dataclass(frozen=True)
class _Asked:
    """A block that waits for something, and what is in its slots."""

    project: Project
    block: Block
    definition: Definition
    language: Language

    def value(self, key: str) -> str:
        """What a slot says; "" when only the running program knows."""
        if key in self.block.inputs or key not in self._keys():
            return ""
        return str(self.definition.value(self.block, key))

    def label(self, key: str) -> str:
        """What a slot says, for people."""
        value, slot = self.value(key), self._keys().get(key)
        if not value or slot is None:
            return ""
        return field_text(self.project, self.language, self.block, slot, value, key)

    def number(self, key: str) -> float | None:
        try:
            return float(self.value(key))
        except ValueError:
            return None

    def of(self, kind: Kind, key: str = "", amount: float | None = None) -> Happening:
        robot = self.value("robot") or ALL_ROBOTS
        return Happening(kind, self.value(key), self.label(key), robot, amount)

    def word(self, key: str) -> Iterator[Happening]:
        if plain(self.value(key)):
            yield Happening("word", self.value(key), self.value(key))

    def thing(self) -> Happening:
        return self.of(_THINGS.get(self.value("thing"), "face"))

    def sensor(self) -> Happening:
        """One that it waits for is a little past what is asked."""
        amount = self.number("value")
        if amount is None or "side" not in self._keys():
            return self.of("sensor", "sensor")
        past = max(abs(amount) * 0.2, 0.5)
        is_under = self.value("side") == "under"
        return self.of("sensor", "sensor", amount - past if is_under else amount + past)

    def current(self) -> Happening:
        joint, name = self.value("joint"), self.label("joint")
        return replace(self.of("sensor"), value=f"current_{joint}", words=name)

    def idle(self) -> Happening:
        return Happening("idle", amount=self.number("seconds"))

    def _keys(self) -> dict[str, Slot]:
        return dict(self.definition.keys(self.block.groups))


def _name_of(definition: Definition) -> str:
    return definition.generator or (definition.call.name if definition.call else "")


_BY_BLOCK: dict[str, Callable[[_Asked], Happening]] = {
    "when_touched": lambda asked: asked.of("touch", "part"),
    "is_touched": lambda asked: asked.of("touch", "part"),
    "when_sees": _Asked.thing,
    "sees": _Asked.thing,
    "place_of": _Asked.thing,
    "when_sees_face_of": lambda asked: asked.of("face", "name"),
    "sees_face_of": lambda asked: asked.of("face", "name"),
    "seen_face": lambda asked: asked.of("face"),
    "when_sees_mark": lambda asked: asked.of("mark", "number"),
    "sees_mark": lambda asked: asked.of("mark", "number"),
    "seen_mark": lambda asked: asked.of("mark"),
    "when_person": lambda asked: asked.of("distance", "distance"),
    "person_is": lambda asked: asked.of("distance", "distance"),
    "when_sensor": _Asked.sensor,
    "sensor": _Asked.sensor,
    "current": _Asked.current,
    "angle": lambda asked: asked.of("joint", "joint"),
    "is_doing": lambda asked: asked.of("doing", "doing"),
    "is_in": lambda asked: asked.of("posture", "posture"),
    "when_emotion": lambda asked: asked.of("emotion", "emotion"),
    "emotion": lambda asked: asked.of("emotion", "emotion"),
    "when_idle": _Asked.idle,
    "human_state": lambda asked: Happening("state"),
    "heard_word": lambda asked: Happening("word"),
}
"""What the blocks wait for or ask about, by what makes their code."""

_WORD_SLOTS = {"when_heard": ("word",), "ask": ("word",), "wait_for_word": ("word", "other")}
