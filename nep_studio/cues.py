"""The cues of a project: what its operator can send by hand in place of a sensor or a person."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

import msgspec

from nep_core.words import plain, state_of_thing, state_of_word, word_of_state
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.deployment import GESTURE_STATE, chains, rules
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.text import field_text
from nep_studio.blocks.values import why_not_line

KEY = "cues"
"""Where a project's file keeps what its operator has arranged."""

SOURCE = "cues"
"""Who tells of a state that was sent by hand."""

PREFIX = "cue_"
"""What the names of states begin with that are only sent by hand; it need not be read."""

MOST_CUES = 200
KEYS = "123456789"

Kind = Literal["state", "word", "gesture", "touch", "sight", "emotion", "person"]
_WORD_SLOTS = {"when_heard": ("word",), "ask": ("word",), "wait_for_word": ("word", "other")}


class Cue(msgspec.Struct, frozen=True, omit_defaults=True):
    """One button: the human state that it sends, and how it looks.

    ``kind`` is what the state tells of, which gives the button its icon. ``words`` are what it is
    about ("karate", "the head"), ``label`` what a person calls it instead. A rule may hear a state
    from one robot only: ``source`` is that robot. ``is_own``: a person added it, so that it stays
    when no rule waits for it any more.
    """

    state: str
    kind: Kind = "state"
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
    def gesture(self) -> str:
        """The gesture that it tells of, "" when of none."""
        is_gesture = self.state.startswith(GESTURE_STATE)
        return self.state.removeprefix(GESTURE_STATE) if is_gesture else ""


def own_cue(text: str, *, is_word: bool = False) -> Cue:
    """A cue for a state, or for words that somebody says; raises ValueError for no words."""
    reason = why_not_line(text)
    if reason is not None or not plain(text):
        raise ValueError(reason or "A letter or a digit is needed.")
    if is_word:
        return Cue(state_of_word(text), "word", text.strip(), is_own=True)
    return Cue(text.strip(), words=text.strip(), is_own=True)


def cues_of(project: Project, language: Language) -> list[Cue]:
    """The cues of the states that the rules of a project wait for or ask about, each once."""
    return list({cue.id: cue for cue in reversed(list(_waited_for(project, language)))}.values())[
        ::-1
    ]


def arranged(made: Iterable[Cue], kept: Iterable[Cue]) -> list[Cue]:
    """The cues as the operator has arranged them, then those that nobody has arranged yet."""
    new = {cue.id: cue for cue in made}
    cues = []
    for cue in kept:
        fresh = new.pop(cue.id, None)
        if fresh is not None:
            cues.append(msgspec.structs.replace(cue, kind=fresh.kind, words=fresh.words))
        elif cue.is_own:
            cues.append(cue)
    return [*cues, *new.values()]


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


def _waited_for(project: Project, language: Language) -> Iterator[Cue]:
    """What the rules begin with comes first, then what they ask about."""
    hats = [chain[0] for chain in rules(project, language)]
    for hat in hats:
        yield from _of_block(project, project.blocks[hat], language)
    for chain in chains(project, language):
        for block in project.within(chain, enabled=True):
            if block.id not in hats and block.type in language.of(project).definitions:
                yield from _of_block(project, block, language)


def _of_block(project: Project, block: Block, language: Language) -> Iterator[Cue]:
    definition = language.of(project).definitions[block.type]
    if (cue := _special(project, block, definition, language)) is not None:
        yield cue
    for key, slot in definition.keys(block.groups):
        if key in block.inputs:
            continue  # only the running program knows it
        value = str(definition.value(block, key))
        label = field_text(project, language, block, slot, value, key)
        if slot.kind.name == "gesture":
            yield Cue(f"{GESTURE_STATE}{value}", "gesture", label)
        elif slot.kind.name == "state" and value:
            yield _of_state(value, language)
        elif slot.name in _WORD_SLOTS.get(definition.generator, ()) and plain(value):
            yield Cue(state_of_word(value), "word", value)


def _of_state(state: str, language: Language) -> Cue:
    if state.startswith(GESTURE_STATE):
        name = state.removeprefix(GESTURE_STATE)
        label = language.choices.get("gestures", {}).get(name, name.replace("_", " "))
        return Cue(state, "gesture", label)
    if word := word_of_state(state):
        return Cue(state, "word", word)
    for prefix, table, kind in _TABLES:
        label = language.choices.get(table, {}).get(state.removeprefix(prefix), "")
        if state.startswith(prefix) and label:
            return Cue(state, kind, label)
    return Cue(state, "state", state.removeprefix(PREFIX).replace("_", " "))


_TABLES: tuple[tuple[str, str, Kind], ...] = (
    ("touched_", "touch_parts", "touch"),
    ("emotion_", "emotions", "emotion"),
    ("person_", "distances", "person"),
    ("seen_", "things", "sight"),
)


def _special(
    project: Project, block: Block, definition: Definition, language: Language
) -> Cue | None:
    """The cue of a hat about a robot, which may hear it from that robot only."""

    def value(key: str) -> str:
        return str(definition.value(block, key)) if key not in block.inputs else ""

    def label(key: str) -> str:
        slot = definition.slots[key]
        return field_text(project, language, block, slot, value(key), key)

    robot = value("robot") if "robot" in definition.slots else ALL_ROBOTS
    source = SOURCE if robot == ALL_ROBOTS else robot
    match definition.generator:
        case "when_touched":
            return Cue(f"touched_{value('part')}", "touch", label("part"), source)
        case "when_sees":
            return Cue(state_of_thing(value("thing")), "sight", label("thing"), source)
        case "when_sees_face_of" if plain(value("name")):
            return Cue(state_of_thing("face", value("name")), "sight", value("name"), source)
        case "when_sees_mark" if plain(value("number")):
            return Cue(state_of_thing("mark", value("number")), "sight", value("number"), source)
        case "when_person":
            return Cue(f"person_{value('distance')}", "person", label("distance"), source)
        case "when_emotion" | "emotion":
            return Cue(f"emotion_{value('emotion')}", "emotion", label("emotion"))
    return None
