"""The block language of one session: the definitions, and the choices that their slots offer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any
from weakref import WeakKeyDictionary

from faults import Text, text_of

from .definition_files import RobotProfile
from .definitions import Category, Definition
from .own_animations import choices_with
from .own_gestures import gestures_with
from .procedures import definitions_of
from .program import Block, Project, split_slot
from .sentence import Group, Part, SentenceError, Slot, groups_of, tokens


@dataclass(slots=True)
class _Own:
    """The language of one project, and the revision of what it keeps that it was made for."""

    language: Language
    revision: tuple[int, int] = (-1, -1)


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Language:
    """Definitions by block type and choices by table (value to label).

    A table that is absent or empty is not known here (no node manifests were given, say), and
    then any value passes. ``profile`` is the kind of robot. ``words`` are other words of sentences
    in the language of the person, by the English ones.
    """

    definitions: Mapping[str, Definition] = field(repr=False)
    categories: tuple[Category, ...] = field(repr=False)
    choices: Mapping[str, Mapping[str, str]] = field(repr=False)
    profile: RobotProfile
    words: Mapping[str, str] = field(default_factory=dict, repr=False)
    _base: Language | None = field(default=None, repr=False, compare=False)
    _own: WeakKeyDictionary[Project, _Own] = field(
        default_factory=WeakKeyDictionary, repr=False, compare=False
    )

    def of(self, project: Project) -> Language:
        """This language with the own blocks and animations of a project, as they are now.

        For one project it is always the same object; its definitions and choices follow the
        project.
        """
        base = self._base or self
        own = base._own.get(project)
        if own is None:
            own = _Own(
                Language(
                    dict(base.definitions),
                    base.categories,
                    dict(base.choices),
                    base.profile,
                    base.words,
                    base,
                )
            )
            base._own[project] = own
        revision = project.procedure_revision, project.extra_revision
        if own.revision[0] != revision[0]:
            definitions = own.language.definitions
            assert isinstance(definitions, dict)
            definitions.clear()
            definitions |= base.definitions
            definitions |= definitions_of(project.procedures.values(), base.words)
        if own.revision[1] != revision[1]:
            choices = own.language.choices
            assert isinstance(choices, dict)
            choices.update(gestures_with(choices_with(base.choices, project), project))
        own.revision = revision
        return own.language

    def word(self, english: str) -> str:
        """A word of the sentences in the language of the person."""
        return self.words.get(english, english)

    def table_of(self, slot: Slot, block: Block | None = None, key: str = "") -> str:
        """The name of the table of choices of a slot; ``key`` is its key where it is numbered.

        For a slot that depends on another, it is by what the block's other slot holds.
        """
        if slot.kind.name == "gesture":
            return "gestures"
        if not slot.master or block is None:
            return slot.table
        number = split_slot(key)[1]
        definition = self.definitions[block.type]
        is_beside = number and definition.slots[slot.master].group
        master = f"{slot.master}.{number}" if is_beside else slot.master
        return f"{slot.table}.{definition.value(block, master)}"

    def choices_of(
        self, slot: Slot, block: Block | None = None, key: str = ""
    ) -> Mapping[str, str]:
        """The values that a slot of a block offers with their labels; empty when not known."""
        return self.choices.get(self.table_of(slot, block, key), {})

    def why_not_choice(
        self, slot: Slot, value: object, block: Block | None = None, key: str = ""
    ) -> Text | None:
        """Why a choice slot cannot hold this value, or None when it can."""
        if slot.kind.name != "choice":
            return None
        offered = self.choices_of(slot, block, key)
        if not offered or value in offered:
            return None
        return text_of(
            "“{value}” is not one of: {offered}.", value=value, offered=", ".join(offered)
        )


# The block language in the words of another one: sentences, categories and choices by a table.
#
#     [categories]
#     robot = "Roboter"
#     [blocks]
#     "robot.say" = "{robot} sagt {text} mit {gesture}"
#     "control.if" = "wenn {condition} {do} [also: sonst wenn {also_condition} {also_do}] ..."
#     [choices.postures]
#     posture_stand = "stehen"
#     [words]
#     define = "lege fest"
#
# A block may bring its sentences along (``translations`` by language), so that it is one entry of
# one file; a table's own sentence goes before. A translated sentence has the slots and groups of
# the English one, by their names only, each once; they may stand elsewhere. What a table does not
# have, or has wrongly, stays English.

Table = Mapping[str, Any]

_TOKEN = re.compile(
    r"\{(?P<slot>[a-z][a-z0-9_]*)\}|\[(?P<group>[a-z][a-z0-9_]*):|(?P<end>\])|(?P<words>[^{}\[\]]+)"
)


@dataclass(frozen=True, slots=True)
class Fault:
    """An entry of a table that cannot be used, and why."""

    place: str
    sentence: str

    def __str__(self) -> str:
        return f"{self.place}: {self.sentence}"


def translated(language: Language, table: Table, code: str = "") -> Language:
    """The language with the words of a table, and those that blocks bring for ``code``."""
    categories = {c.id: _category(c, table) for c in language.categories}
    return Language(
        {
            block_type: _definition(definition, categories, _sentence(definition, table, code))
            for block_type, definition in language.definitions.items()
        },
        tuple(categories.values()),
        {name: _choices(name, known, table) for name, known in language.choices.items()},
        language.profile,
        words=_texts(table, "words"),
    )


def translated_parts(definition: Definition, sentence: str) -> tuple[Part, ...]:
    """The parts of a translated sentence; raises SentenceError, which says what does not fit."""
    parts: list[Part] = []
    inside: list[str | Slot] = []
    group = ""
    for token in tokens(sentence, _TOKEN):
        if token["group"]:
            if group or token["group"] not in definition.groups:
                raise SentenceError(f"there is no place for the group “{token['group']}”")
            group, inside = token["group"], []
        elif token["end"]:
            if not group:
                raise SentenceError("a “]” without its “[name:”")
            known = definition.groups[group]
            parts.append(Group(group, tuple(inside), known.maximum))
            group = ""
        elif part := _word_or_slot(token, definition):
            (inside if group else parts).append(part)
    _require_same(definition, parts)
    return tuple(parts)


def faults(language: Language, table: Table, code: str = "") -> Iterator[Fault]:
    """What is wrong with a table, and what neither it nor a block has translated."""
    texts = _texts(table, "blocks")
    for block_type, definition in language.definitions.items():
        sentence = _sentence(definition, table, code)
        if not sentence:
            yield Fault(block_type, "is not translated")
            continue
        try:
            translated_parts(definition, sentence)
        except SentenceError as error:
            yield Fault(block_type, str(error))
    yield from (Fault(t, "is no block") for t in texts if t not in language.definitions)
    named = _texts(table, "categories")
    yield from (Fault(c.id, "is not translated") for c in language.categories if c.id not in named)
    for name, known in language.choices.items():
        labels = _labels(name, table)
        yield from (Fault(f"{name}.{v}", "is not translated") for v in known if v not in labels)


def _word_or_slot(token: re.Match[str], definition: Definition) -> str | Slot:
    if not token["slot"]:
        return token["words"].strip()
    if token["slot"] not in definition.slots:
        raise SentenceError(f"there is no slot “{token['slot']}”")
    return definition.slots[token["slot"]]


def _require_same(definition: Definition, parts: list[Part]) -> None:
    """Every slot and group must be there once, in the group that it is in."""
    told = sorted(_places(parts))
    known = sorted(_places(definition.parts))
    if told != known:
        missing = [name for name in known if told.count(name) < 1] or told
        raise SentenceError(f"slots and groups must be there once each: look at “{missing[0]}”")


def _places(parts: tuple[Part, ...] | list[Part]) -> Iterator[str]:
    for part in parts:
        if isinstance(part, Slot):
            yield part.name
        elif isinstance(part, Group):
            yield f"[{part.name}]"
            yield from (f"{part.name}/{p.name}" for p in part.parts if isinstance(p, Slot))


def _sentence(definition: Definition, table: Table, code: str) -> str:
    """The translated sentence of a block: the table's, or its own; empty when there is none."""
    return _texts(table, "blocks").get(definition.id) or definition.translations.get(code, "")


def _definition(
    definition: Definition, categories: Mapping[str, Category], sentence: str
) -> Definition:
    category = categories.get(definition.category.id, definition.category)
    try:
        parts = translated_parts(definition, sentence) if sentence else definition.parts
    except SentenceError:
        parts = definition.parts
    groups = groups_of(parts)  # in the English order: that of the buttons below the block
    known = {name: groups[name] for name in definition.groups}
    return replace(definition, category=category, parts=parts, groups=known)


def _category(category: Category, table: Table) -> Category:
    return replace(category, title=_texts(table, "categories").get(category.id, category.title))


def _choices(name: str, known: Mapping[str, str], table: Table) -> dict[str, str]:
    labels = _labels(name, table)
    return {value: labels.get(value, label) for value, label in known.items()}


def _labels(name: str, table: Table) -> Mapping[str, str]:
    """The labels of one table of choices; "joints.head" may also be a table in a table."""
    choices = table.get("choices", {})
    return _texts(choices, name) if isinstance(choices, dict) else {}


def _texts(table: Table, name: str) -> Mapping[str, str]:
    texts = table.get(name, {})
    if not isinstance(texts, dict):
        return {}
    return {key: text for key, text in texts.items() if isinstance(text, str) and text.strip()}
