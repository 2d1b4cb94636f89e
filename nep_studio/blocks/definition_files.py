"""Read block definitions from a folder of TOML files; whatever is wrong names file and block."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from .closed import Closing
from .definitions import (
    FLAGS,
    CallError,
    Category,
    Definition,
    Part,
    SentenceError,
    Shape,
    groups_of,
    parse,
    read_call,
    slots_of,
)
from .errors import DefinitionError
from .program import PAGES
from .slots import RESULTS, why_not_line

_BLOCK_KEYS = frozenset(
    ("sentence", "shape", "result", "help", "defaults", "minimum", "flags", "call", "generator")
) | {"translations"}


@dataclass(slots=True)
class DefinitionSet:
    """All that a folder defines."""

    definitions: dict[str, Definition] = field(default_factory=dict)
    categories: list[Category] = field(default_factory=list)
    choices: dict[str, dict[str, str]] = field(default_factory=dict)


def load_definitions(folder: Path, generators: Mapping[str, Collection[str]]) -> DefinitionSet:
    """Read every ``*.toml`` of a folder.

    ``generators`` are the names of the generator functions by kind (hat, statement, value), and
    those of the functions of nep_core that a call may name.
    Raises DefinitionError, which names the file and the block.
    """
    found = DefinitionSet()
    for path in sorted(folder.glob("*.toml")):
        _read_file(path, generators, found)
    if not found.definitions:
        raise DefinitionError(
            "There are no block definitions in the folder {folder}.", folder=folder
        )
    found.categories.sort(key=lambda category: (category.order, category.id))
    return found


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file, or raise DefinitionError with the file's name and the line."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise DefinitionError(
            "The file {name} cannot be read: {error}.",
            details=str(path),
            name=path.name,
            error=error,
        ) from error


def read_choices(path: Path, data: object) -> dict[str, dict[str, str]]:
    """Check tables of choices (value = label, or value = {label = ...}) read from a file."""
    if not isinstance(data, dict) or not all(isinstance(table, dict) for table in data.values()):
        raise DefinitionError(
            "In {name}, [choices] must hold tables of value = “label”.", name=path.name
        )
    choices: dict[str, dict[str, str]] = {}
    for name, table in data.items():
        if table and all(isinstance(e, dict) and "label" not in e for e in table.values()):
            for value, inner in table.items():  # tables that depend on the value of a slot
                choices[f"{name}.{value}"] = _read_table(path, f"{name}.{value}", inner)
        else:
            choices[name] = _read_table(path, name, table)
    return choices


def _read_table(path: Path, name: str, table: Mapping[str, Any]) -> dict[str, str]:
    labels: dict[str, str] = {}
    for value, entry in table.items():
        label = entry.get("label") if isinstance(entry, dict) else entry
        if not isinstance(label, str) or why_not_line(value) is not None:
            raise DefinitionError(
                "In {name}, choice “{value}” of {name_2} has no label.",
                name=path.name,
                value=value,
                name_2=name,
            )
        labels[value] = label
    return labels


def _read_file(path: Path, generators: Mapping[str, Collection[str]], found: DefinitionSet) -> None:
    data = read_toml(path)
    category = _read_category(path, data.get("category"))
    choices = read_choices(path, data.get("choices", {}))
    if twice := choices.keys() & found.choices.keys():
        raise DefinitionError(
            "In {name}, the choices “{min}” are defined twice.", name=path.name, min=min(twice)
        )
    found.categories.append(category)
    found.choices.update(choices)
    blocks = data.get("blocks", {})
    if not isinstance(blocks, dict):
        raise DefinitionError("In {name}, [blocks] must be a table of blocks.", name=path.name)
    for name, entry in blocks.items():
        try:
            definition = _read_block(category, name, entry, generators)
        except (SentenceError, CallError) as error:
            raise DefinitionError(
                "In {name}, block “{name_2}”: {error}.", name=path.name, name_2=name, error=error
            ) from error
        if definition.id in found.definitions:
            raise DefinitionError(
                "In {name}, block “{id}” is defined twice.", name=path.name, id=definition.id
            )
        found.definitions[definition.id] = definition


def _read_category(path: Path, data: object) -> Category:
    if not isinstance(data, dict) or not isinstance(data.get("id"), str):
        raise DefinitionError("The file {name} needs a [category] with an id.", name=path.name)
    page = data.get("page", "behaviour")
    if page not in PAGES:
        raise DefinitionError(
            "In {name}, the page is one of {pages}.", name=path.name, pages=", ".join(PAGES)
        )
    title, colour, order = data.get("title"), data.get("colour"), data.get("order")
    if not isinstance(title, str) or not isinstance(colour, str) or not isinstance(order, int):
        raise DefinitionError(
            "In {name}, [category] needs a title, a colour and an order.", name=path.name
        )
    return Category(data["id"], title, colour, order, page)


def _read_block(
    category: Category, name: str, entry: object, generators: Mapping[str, Collection[str]]
) -> Definition:
    if not isinstance(entry, dict) or not isinstance(entry.get("sentence"), str):
        raise SentenceError("it needs a sentence")
    if unknown := set(entry) - _BLOCK_KEYS:
        raise SentenceError(f"it has a key “{min(unknown)}” that is not known")
    tables = ("defaults", "minimum", "translations")
    if not all(isinstance(entry.get(key, {}), dict) for key in tables):
        raise SentenceError("defaults, minimum and translations must be tables")
    translations = entry.get("translations", {})
    if not all(isinstance(words, str) for words in translations.values()):
        raise SentenceError("translations must be sentences by their language")
    parts = _closed(category, entry, parse(entry["sentence"]))
    slots, groups = slots_of(parts), groups_of(parts)
    minimum = entry.get("minimum", {})
    definition = Definition(
        id=f"{category.id}.{name}",
        category=category,
        shape=entry.get("shape", ""),
        parts=parts,
        slots=slots,
        groups=groups,
        minimum={group: minimum.get(group, 0) for group in groups},
        defaults=entry.get("defaults", {}),
        result="boolean" if entry.get("shape") == "boolean" else entry.get("result", ""),
        help=entry.get("help", ""),
        flags=frozenset(entry.get("flags", [])),
        call=read_call(entry["call"], slots) if "call" in entry else None,
        generator=entry.get("generator", ""),
        translations=translations,
    )
    _check_shape(definition)
    _check_defaults(definition, minimum)
    _check_code(definition, generators)
    return definition


def _closed(
    category: Category, entry: Mapping[str, Any], parts: tuple[Part, ...]
) -> tuple[Part, ...]:
    """The parts of a sentence with the places closed that take no block."""
    generator = str(entry.get("generator", ""))
    closing = Closing(
        category.page,
        str(entry.get("shape", "")),
        generator,
        category.id == "code" or generator.startswith("code_"),
        "silent" in entry.get("flags", []),
        frozenset(slot.master for slot in slots_of(parts).values()),
    )
    return tuple(map(closing.close, parts))


def _check_shape(definition: Definition) -> None:
    if definition.shape not in get_args(Shape):
        raise SentenceError(f"its shape is one of {', '.join(get_args(Shape))}")
    if definition.is_value != (definition.result in RESULTS):
        raise SentenceError(f"a reporter, and only that, has a result: {', '.join(RESULTS)}")
    if unknown := definition.flags - set(FLAGS):
        raise SentenceError(f"there is no flag “{min(unknown)}”")
    has_body = any(slot.kind.name == "body" for slot in definition.slots.values())
    if has_body != (definition.shape == "c"):
        raise SentenceError("a block with a body, and only that, has the shape c")
    for slot in definition.slots.values():
        for name in ("variable", "rule"):  # which others look for by that name
            if (slot.kind.name == name) != (slot.name == name):
                raise SentenceError(f"a slot for a {name}, and only that, is called “{name}”")
    if "posture" in definition.flags and "posture" not in definition.slots:
        raise SentenceError("a block with the flag posture needs a slot “posture”")


def _check_defaults(definition: Definition, minimum: Mapping[str, int]) -> None:
    for name, value in definition.defaults.items():
        slot = definition.slots.get(name)
        if slot is None or not slot.kind.typed:
            raise SentenceError(f"default “{name}” is not for a slot of the sentence")
        if (reason := slot.why_not(value)) is not None:
            raise SentenceError(f"default “{name}”: {reason}")
    for slot in definition.slots.values():
        if (
            slot.kind.typed
            and slot.kind.name != "variable"
            and slot.name not in definition.defaults
        ):
            raise SentenceError(f"slot “{slot.name}” needs a default")
    for name, count in minimum.items():
        group = definition.groups.get(name)
        if group is None or not isinstance(count, int) or not 0 <= count <= group.maximum:
            raise SentenceError(f"minimum “{name}” does not fit a group of the sentence")


def _check_code(definition: Definition, generators: Mapping[str, Collection[str]]) -> None:
    if definition.page != "behaviour":
        if definition.call is not None or definition.generator:
            raise CallError("only blocks of the behaviour page have a call or a generator")
        return
    if (definition.call is None) == (definition.generator == ""):
        raise CallError("it needs either a call or a generator")
    kind = "value" if definition.is_value else "hat" if definition.shape == "hat" else "statement"
    if definition.generator and definition.generator not in generators[kind]:
        raise CallError(f"there is no {kind} generator “{definition.generator}”")
    call = definition.call
    if call is not None and call.on and definition.slots[call.on].kind.name != "robot":
        raise CallError("a method is called on a robot slot")
    if call is not None and not call.on and call.name not in generators["function"]:
        raise CallError(f"nep_core has no function “{call.name}” for programs")
    if call is not None and definition.shape == "hat":
        raise CallError("a hat needs a generator")


# A robot profile: the choices that a kind of robot gives to blocks, read from robot.toml.


@dataclass(frozen=True, slots=True)
class RobotProfile:
    """What a kind of robot can do.

    ``node`` is the action node that plays it; ``choices`` are tables of value and label;
    ``standing`` are the postures from which the robot can walk.
    """

    name: str
    title: str
    node: str
    choices: Mapping[str, Mapping[str, str]] = field(repr=False)
    standing: frozenset[str]


def load_profile(path: Path) -> RobotProfile:
    """Read a robot.toml, or raise DefinitionError, which names the file."""
    data = read_toml(path)
    names = [data.get(key) for key in ("name", "title", "node")]
    if not all(isinstance(name, str) and name for name in names):
        raise DefinitionError("The file {name} needs a name, a title and a node.", name=path.name)
    choices = read_choices(path, data.get("choices", {}))
    postures = data.get("choices", {}).get("postures", {})
    standing = frozenset(
        value
        for value, entry in postures.items()
        if isinstance(entry, dict) and entry.get("stands") is True
    )
    return RobotProfile(data["name"], data["title"], data["node"], choices, standing)


def load_profiles(path: Path) -> tuple[RobotProfile, ...]:
    """Read a robot.toml, and those of the robots in the folders beside it, the first one first.

    So a folder with another robot adds it. Raises DefinitionError.
    """
    own = load_profile(path)
    if path.parent.name != own.name:
        return (own,)
    others = sorted(other for other in path.parent.parent.glob("*/robot.toml") if other != path)
    return (own, *map(load_profile, others))
