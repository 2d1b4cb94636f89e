"""The words by which a program chooses what a robot can do: postures, animations, sensors, ...

A word that a program works out may be what the robot is asked with ("posture_stand"), or what
blocks call it, in English or in the language of the program ("stand"), if that means one thing.
"""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Mapping
from difflib import get_close_matches
from functools import lru_cache
from pathlib import Path
from typing import Any

from nep_core.errors import RobotError
from nep_core.places import resource_folders

from .values import shown, spoken_language

NAO = "nao"
MOST_TOLD = 60
"""So many words are told in one sentence."""
EMOTIONS = {
    "happy": "happy",
    "sad": "sad",
    "angry": "angry",
    "surprised": "surprised",
    "neutral": "calm",
}
"""How people look, by the ends of the states that tell so, with what blocks call it."""


def chosen(
    word: object,
    table: str,
    model: str = "",
    *,
    also: Collection[str] = (),
    is_open: bool = False,
) -> str:
    """What a robot is asked with for a word of a table of choices, such as "animations".

    ``model`` is the robot's, as in RobotState; ``also`` are words that it knows besides. Where
    ``is_open``, the robot itself refuses what it does not know. Raises RobotError.
    """
    known = _tables(model).get(table, {})
    return _chosen(word, known, table, model, also=also, is_open=is_open)


def emotion_state(emotion: object) -> str:
    """The human state of somebody who looks "happy", "sad", "angry", "surprised" or "neutral"."""
    return f"emotion_{_chosen(emotion, EMOTIONS, 'emotions', '')}"


def _chosen(
    word: object,
    known: Mapping[str, str],
    table: str,
    model: str,
    *,
    also: Collection[str] = (),
    is_open: bool = False,
) -> str:
    if isinstance(word, str):
        if word in known or word in also:
            return word
        found = _called(word, known, table, model)
        if len(found) == 1:
            return found.pop()
        if is_open or not known:  # a computer without those tables
            return word
    raise _unknown(word, [*(known or also)])


def _called(word: str, known: Mapping[str, str], table: str, model: str) -> set[str]:
    """The values that people call so, in English or the language of the program."""
    said = _folded(word)
    found = {value for value, label in known.items() if said in map(_folded, (value, label))}
    if found or spoken_language() == "en":
        return found
    own = _labels(spoken_language(), f"{model}.{table}") if model else {}
    labels = {**_labels(spoken_language(), table), **own}
    return {value for value in known if said == _folded(labels.get(value, ""))}


def _unknown(word: object, known: list[str]) -> RobotError:
    near = get_close_matches(word if isinstance(word, str) else "", known, 1)
    steps = ["Did you mean “{near}”?"] if near else []
    return RobotError(
        "{word} is not known here. Known: {known}.",
        checklist=(*steps, "Look at the block that is marked: what does it get?"),
        word=shown(word),
        known=", ".join(known[:MOST_TOLD]),
        near="".join(near),
    )


def _folded(word: str) -> str:
    return " ".join(word.casefold().split())


# The tables, read when a word is looked up for the first time.


@lru_cache(maxsize=16)
def _tables(model: str) -> Mapping[str, Mapping[str, str]]:
    """The choices of a kind of robot that comes with us: value and English label, by table.

    None of another one: a message from anybody must not say which files are read.
    """
    name = model or NAO
    if not name.isidentifier():
        return {}
    choices = _read([folder / "robots" / name for folder in resource_folders()], "robot.toml")
    return {table: _flat(entries) for table, entries in choices.items()}


@lru_cache(maxsize=64)
def _labels(language: str, table: str) -> Mapping[str, str]:
    """What the choices of a table are called in a language."""
    choices = _read([folder / "translations" for folder in resource_folders()], f"{language}.toml")
    found = choices.get(table, {})
    if not found:  # the tables in a table, such as "joints.head"
        inner = (entries for name, entries in choices.items() if name.startswith(f"{table}."))
        found = {value: label for entries in inner for value, label in entries.items()}
    return _flat(found)


def _read(folders: list[Path], file: str) -> dict[str, Any]:
    """The choices in the first of these files that is there; none where none is."""
    for folder in folders:
        try:
            with (folder / file).open("rb") as opened:
                choices = tomllib.load(opened).get("choices", {})
        except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
            continue
        return choices if isinstance(choices, dict) else {}
    return {}


def _flat(entries: object) -> dict[str, str]:
    """A table of value and label, those of the tables in it too."""
    found: dict[str, str] = {}
    for value, entry in entries.items() if isinstance(entries, dict) else ():
        if isinstance(entry, str):
            found[value] = entry
        elif isinstance(entry, dict):
            label = entry.get("label")
            found |= {value: label} if isinstance(label, str) else _flat(entry)
    return found
