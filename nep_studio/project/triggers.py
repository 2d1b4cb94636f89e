"""What can happen around the robots that a program waits for or asks about."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Literal

import msgspec

from nep_core.wire.states import plain, state_of_thing, state_of_word, word_of_state
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.deployment import chains, rules
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.slots import ARM_STATE, GESTURE_STATE, why_not_line
from nep_studio.blocks.text import field_text

Kind = Literal[
    "word", "face", "distance", "touch", "gesture", "ball", "mark", "sound", "emotion", "state",
    "sensor", "joint", "posture", "doing", "idle", "arm",
]  # fmt: skip

REMEMBER = "sensing.remember"
"""The block that names a state without waiting for it."""


@dataclass(frozen=True)
class Occurrence:
    """Something that can happen, and to which robot ("*": whichever).

    ``value`` is the word, the name of a face ("": anybody), the number of a mark, the part that is
    touched, a state, the name of a sensor. ``words`` is what it is about, for people. ``amount``
    is what a sensor must measure, or for how many seconds nothing may happen; None: anything.
    ``state`` is the human state that tells a program of it; "" when it only asks or measures.
    """

    kind: Kind
    value: str = ""
    words: str = ""
    robot: str = ALL_ROBOTS
    amount: float | None = None
    state: str = field(default="", compare=False)

    @property
    def key(self) -> tuple[Kind, str, str, float | None]:
        """What tells it from the others: not how it is worded."""
        return self.kind, plain(self.value), self.robot, self.amount


def occurrences_of(project: Project, language: Language) -> list[Occurrence]:
    """What the program waits for, then what it asks about; each once, in its order."""
    waited_for = _waited_for(project, language, leave_out=REMEMBER)
    found = {one.key: one for one in reversed(list(waited_for))}
    return list(found.values())[::-1]


def _waited_for(project: Project, language: Language, leave_out: str = "") -> Iterator[Occurrence]:
    """What the rules begin with comes first, then what they ask about."""
    hats = [chain[0] for chain in rules(project, language)]
    for hat in hats:
        yield from _of_block(project, project.blocks[hat], language)
    for chain in chains(project, language):
        for block in project.within(chain, enabled=True):
            if block.id not in hats and block.type != leave_out:
                yield from _of_block(project, block, language)


def _of_block(project: Project, block: Block, language: Language) -> Iterator[Occurrence]:
    definition = language.of(project).definitions.get(block.type)
    if definition is None:
        return
    asked, name = _Asked(project, block, definition, language), _name_of(definition)
    if is_of := _BY_BLOCK.get(name):
        found = is_of(asked)
        if found.value or found.kind not in _OF_A_CHOICE:  # else only the running program knows it
            yield replace(found, state=state_of(found)) if _is_told(name, found) else found
    for key, slot in definition.keys(block.groups):
        if slot.name in _WORD_SLOTS.get(name, ()):
            yield from asked.word(key)
        elif slot.kind.name == "state" and asked.value(key):
            yield of_state(asked.value(key), language)
        elif slot.kind.name == "gesture":
            value = asked.value(key)
            state = f"{GESTURE_STATE}{value}" if value else ""
            yield Occurrence("gesture", value, asked.label(key), state=state)


def of_state(state: str, language: Language) -> Occurrence:
    """What must happen for a human state to be told: a touch, a word, ..., else the state itself.

    Of the look of a person and of distances robots tell as they notice them.
    """
    return replace(_told_by(state, language), state=state)


def _told_by(state: str, language: Language) -> Occurrence:
    if state.startswith(GESTURE_STATE):
        name = state.removeprefix(GESTURE_STATE)
        known = language.choices.get("gestures", {}).get(name, name.replace("_", " "))
        return Occurrence("gesture", name, known)
    for beginning, kind, table in _STATES:
        value = state.removeprefix(beginning)
        if state.startswith(beginning) and value in language.choices.get(table, {}):
            return Occurrence(kind, value, language.choices[table][value])
    for kind in _THINGS:
        beginning = state_of_thing(kind)
        if state == beginning or state.startswith(f"{beginning}_"):
            name = state.removeprefix(beginning).strip("_").replace("_", " ")
            return Occurrence(kind, name, name)
    if word := word_of_state(state):
        return Occurrence("word", word, word)
    return Occurrence("state", state, state.replace("_", " "))


def state_of(occurrence: Occurrence) -> str:
    """The human state that tells of something."""
    value = occurrence.value
    match occurrence.kind:
        case "word":
            return state_of_word(value or "hello")
        case "face" | "ball" | "mark" | "sound":
            return state_of_thing(occurrence.kind, value)
        case "touch":
            return f"touched_{value}"
        case "distance":
            return f"person_{value}"
        case "emotion":
            return f"emotion_{value}"
        case "gesture":
            return f"{GESTURE_STATE}{value}"
        case "arm":
            return f"{ARM_STATE}{value}"
    return value or "touched_head"


_OF_A_CHOICE: frozenset[Kind] = frozenset(
    ("touch", "distance", "emotion", "sensor", "joint", "posture", "doing", "arm")
)
"""What is always one of a table: it makes nothing without one."""
_THINGS: tuple[Kind, ...] = ("face", "ball", "mark", "sound")
_STATES: tuple[tuple[str, Kind, str], ...] = (
    ("touched_", "touch", "touch_parts"),
    ("emotion_", "emotion", "emotions"),
    ("person_", "distance", "distances"),
    (ARM_STATE, "arm", "arm_postures"),
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

    def of(self, kind: Kind, key: str = "", amount: float | None = None) -> Occurrence:
        robot = self.value("robot") or ALL_ROBOTS
        return Occurrence(kind, self.value(key), self.label(key), robot, amount)

    def word(self, key: str) -> Iterator[Occurrence]:
        if plain(self.value(key)):
            word = self.value(key)
            yield Occurrence("word", word, word, state=state_of_word(word))

    def thing(self) -> Occurrence:
        thing = self.value("thing")
        return self.of(next((kind for kind in _THINGS if kind == thing), "face"))

    def sensor(self) -> Occurrence:
        """One that it waits for is a little past what is asked."""
        amount = self.number("value")
        if amount is None or "side" not in self._keys():
            return self.of("sensor", "sensor")
        past = max(abs(amount) * 0.2, 0.5)
        is_under = self.value("side") == "under"
        return self.of("sensor", "sensor", amount - past if is_under else amount + past)

    def current(self) -> Occurrence:
        joint, name = self.value("joint"), self.label("joint")
        return replace(self.of("sensor"), value=f"current_{joint}" if joint else "", words=name)

    def _keys(self) -> dict[str, Slot]:
        return dict(self.definition.keys(self.block.groups))


def _name_of(definition: Definition) -> str:
    return definition.generator or (definition.call.name if definition.call else "")


_BY_BLOCK: dict[str, Callable[[_Asked], Occurrence]] = {
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
    "when_idle": lambda asked: Occurrence("idle", amount=asked.number("seconds")),
    "human_state": lambda asked: Occurrence("state"),
    "heard_word": lambda asked: Occurrence("word"),
}
"""What the blocks wait for or ask about, by what makes their code."""

_TOLD = {
    "when_touched": True,
    "when_sees": False,
    "when_sees_face_of": True,
    "when_sees_mark": True,
    "when_person": True,
    "when_emotion": True,
    "emotion": True,
}
"""The blocks that a human state tells of, by what makes their code, and whether of one by name."""


def _is_told(name: str, found: Occurrence) -> bool:
    return name in _TOLD and (not _TOLD[name] or bool(plain(found.value)))


_WORD_SLOTS = {"when_heard": ("word",), "ask": ("word",), "wait_for_word": ("word", "other")}


# The cues of a project: what its operator can send by hand in place of a sensor or a person.

KEY = "cues"
"""Where a project's file keeps what its operator has arranged."""

SOURCE = "cues"
"""Who tells of a state that was sent by hand."""

PREFIX = "cue_"
"""What the names of states begin with that are only sent by hand; it need not be read."""

MOST_CUES = 200
KEYS = "123456789"

CueKind = Literal["state", "word", "gesture", "touch", "sight", "emotion", "person", "arm"]


class Cue(msgspec.Struct, frozen=True, omit_defaults=True):
    """One button: the human state that it sends, and how it looks.

    ``kind`` is what the state tells of, which gives the button its icon. ``words`` are what it is
    about ("karate", "the head"), ``label`` what a person calls it instead. A rule may hear a state
    from one robot only: ``source`` is that robot. ``is_own``: a person added it, so that it stays
    when no rule waits for it any more.
    """

    state: str
    kind: CueKind = "state"
    words: str = ""
    source: str = SOURCE
    label: str = ""
    colour: str = ""
    key: str = ""
    is_own: bool = False
    is_hidden: bool = False

    @property
    def id(self) -> tuple[str, str]:
        """What tells it from the others: state and source."""
        return self.state, self.source

    @property
    def movement(self) -> str:
        """What a simulated person does so that a watch tells of it, "" when no watch does."""
        if self.kind == "arm":
            return self.state
        is_gesture = self.state.startswith(GESTURE_STATE)
        return self.state.removeprefix(GESTURE_STATE) if is_gesture else ""


def own_cue(text: str, *, is_word: bool = False) -> Cue:
    """A cue for a state, or for words that somebody says; raises EditRefused for no words."""
    reason = why_not_line(text)
    if reason is not None or not plain(text):
        raise EditRefused(reason or "A letter or a digit is needed.")
    if is_word:
        return Cue(state_of_word(text), "word", text.strip(), is_own=True)
    return Cue(text.strip(), words=text.strip(), is_own=True)


def cues_of(project: Project, language: Language) -> list[Cue]:
    """The cues of the states that the rules of a project wait for or ask about, each once."""
    cues = [_cue(one, language) for one in _waited_for(project, language) if one.state]
    return list({cue.id: cue for cue in reversed(cues)}.values())[::-1]


def cues_now(project: Project, language: Language, running: Collection[str]) -> list[Cue]:
    """The cues of what a program waits for at this moment, as its operator has arranged them.

    ``running`` are the blocks that it is in: a rule that is under way begins with nothing, and a
    block that waits in it waits itself.
    """
    found: list[Occurrence] = []
    for chain in rules(project, language):
        inside = {block.id for block in project.within(chain, enabled=True)}
        if inside.isdisjoint(running):
            found += _of_block(project, project.blocks[chain[0]], language)
        for block_id in sorted(inside.intersection(running)):
            for block in _with_reporters(project, block_id):
                found += _of_block(project, block, language)
    cues = {cue.id: cue for cue in (_cue(one, language) for one in found if one.state)}
    known = arranged(cues.values(), kept_cues(project))
    return [cue for cue in known if cue.id in cues and not cue.is_hidden]


def _with_reporters(project: Project, block_id: str) -> Iterator[Block]:
    """A block and what is in its slots, without what it has inside."""
    block = project.blocks[block_id]
    yield block
    for inner in block.inputs.values():
        yield from _with_reporters(project, inner)


def _cue(occurrence: Occurrence, language: Language) -> Cue:
    """The button for something; a rule may hear of it from one robot only."""
    kind, words = _CUE_KINDS.get(occurrence.kind, "state"), occurrence.words
    if kind == "sight" and not words:
        words = language.choices.get("things", {}).get(occurrence.kind, "")
    if kind == "state" or not words:
        words = occurrence.state.removeprefix(PREFIX).replace("_", " ")
    is_of_any = kind == "emotion" or occurrence.robot == ALL_ROBOTS
    return Cue(occurrence.state, kind, words, SOURCE if is_of_any else occurrence.robot)


_CUE_KINDS: dict[Kind, CueKind] = {
    "word": "word",
    "gesture": "gesture",
    "touch": "touch",
    "face": "sight",
    "ball": "sight",
    "mark": "sight",
    "sound": "sight",
    "emotion": "emotion",
    "distance": "person",
    "arm": "arm",
}


def arranged(made: Iterable[Cue], kept: Iterable[Cue]) -> list[Cue]:
    """The cues as the operator has arranged them, then those that nobody has arranged yet.

    Those are pressed by the keys that are left, the first nine of all.
    """
    new = {cue.id: cue for cue in made}
    cues = []
    for cue in kept:
        fresh = new.pop(cue.id, None)
        if fresh is not None:
            cues.append(msgspec.structs.replace(cue, kind=fresh.kind, words=fresh.words))
        elif cue.is_own:
            cues.append(cue)
    taken = {cue.key for cue in cues}
    left = iter([key for key in KEYS if key not in taken])
    return [*cues, *(msgspec.structs.replace(cue, key=next(left, "")) for cue in new.values())]


def kept_cues(project: Project) -> list[Cue]:
    """What the project's file says of cues; what makes no sense there is left out."""
    entries = project.extra.get(KEY)
    found: dict[tuple[str, str], Cue] = {}
    for entry in entries[:MOST_CUES] if isinstance(entries, list) else ():
        try:
            cue = msgspec.convert(entry, Cue)
        except msgspec.ValidationError:
            continue
        if _is_sound(cue):
            found.setdefault(cue.id, cue)
    return list(found.values())


def to_keep(cues: Iterable[Cue]) -> list[dict[str, object]]:
    """Cues as the value that a project's file keeps."""
    return [msgspec.to_builtins(cue) for cue in cues]


def _is_sound(cue: Cue) -> bool:
    texts = (cue.state, cue.words, cue.source, cue.label, cue.colour)
    is_one_line = all(why_not_line(text) is None and len(text) <= 200 for text in texts)
    return bool(cue.state) and is_one_line and (not cue.key or cue.key in KEYS)
