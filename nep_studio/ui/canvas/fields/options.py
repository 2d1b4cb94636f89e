"""What a field offers to choose from, as data."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from nep_studio.blocks.deployment import GESTURE_STATE, robot_entries
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ALL_ROBOTS, Project
from nep_studio.blocks.sentence import Slot
from nep_studio.ui.words import tr

from .field_edit import Editing


@dataclass(frozen=True, slots=True)
class Option:
    """A row of the list: the value it sets, or the ``action`` that it begins."""

    label: str
    value: str = ""
    icon: str = ""
    section: str = ""
    action: str = ""


SHIPPED_STATES = (
    "touched_head",
    "touched_hand",
    "touched_foot",
    "seen_face",
    "heard_word",
    "sonar_close",
)
"""Human states that a robot tells of whatever the program is."""


def options_of(project: Project, language: Language, edit: Editing) -> list[Option]:
    """What the field of an editing offers."""
    kind = edit.slot.kind.name
    if kind == "robot":
        return _robots(project, language)
    if kind == "variable":
        return [Option(v.name, v.id, "variable") for v in project.variables]
    if kind == "state":
        return _states(project, language)
    block = project.blocks[edit.block]
    offered = language.choices_of(edit.slot, block, edit.key)
    icon = {"gesture": "hand"}.get(kind, "")
    return [Option(label, value, icon) for value, label in offered.items()]


def matching(options: Iterable[Option], typed: str) -> list[Option]:
    """The options that hold what is typed, whatever its case and accents; beginnings first."""
    wanted = plain(typed).split()
    found = [o for o in options if all(w in plain(f"{o.label} {o.value}") for w in wanted)]
    if wanted:
        found.sort(key=lambda option: not plain(option.label).startswith(wanted[0]))
    return found


def plain(text: str) -> str:
    """A text in small letters without accents, and with spaces for underlines."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    bare = "".join(c for c in apart if not unicodedata.combining(c))
    return unicodedata.normalize("NFKC", bare).replace("_", " ")


def _robots(project: Project, language: Language) -> list[Option]:
    names = dict.fromkeys(entry.name for entry in robot_entries(project, language))
    found = [Option(name, name, "bot") for name in names if name != ALL_ROBOTS]
    return [*found, Option(tr("all robots"), ALL_ROBOTS, "users")]


def _states(project: Project, language: Language) -> list[Option]:
    gestures = language.choices.get("gestures", {})
    known = dict.fromkeys(language.choices.get("states", ()) or SHIPPED_STATES)
    used = {state: None for state in _used_states(project, language) if state not in known}
    found = [
        Option(label, GESTURE_STATE + name, "hand", tr("Gestures"))
        for name, label in gestures.items()
    ]
    gesture_states = {option.value for option in found}
    found += [Option(_words(s), s, "eye", tr("What the robot notices")) for s in known]
    rest = (s for s in used if s not in gesture_states)
    return found + [Option(_words(s), s, "user", tr("In this project")) for s in rest]


def _words(state: str) -> str:
    return state.replace("_", " ")


def _used_states(project: Project, language: Language) -> Iterator[str]:
    slots: dict[str, list[tuple[str, Slot]]] = {}
    for block in project.blocks.values():
        definition = language.definitions.get(block.type)
        if definition is None:
            continue
        if block.type not in slots:
            slots[block.type] = [
                (s.name, s) for s in definition.slots.values() if s.kind.name == "state"
            ]
        for name, _ in slots[block.type]:
            value = definition.value(block, name)
            if isinstance(value, str) and value:
                yield value
