"""The block language of one session: the definitions, and the choices that their slots offer."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from faults import Text, text_of

from .definition_files import RobotProfile
from .definitions import Category, Definition, Group, Part, SentenceError, Slot, groups_of, tokens
from .own_animations import choices_with
from .own_gestures import gestures_with
from .procedures import definitions_of
from .program import ROBOT_BLOCK, Block, Project, split_slot

Tables = Mapping[str, Mapping[str, str]]
"""Choices by table: value to label."""


class RobotChoices(NamedTuple):
    """What one robot of a project can be asked: the title of its kind, and its choices."""

    title: str
    tables: Tables


@dataclass(slots=True)
class _Own:
    """The language of one project, and the revisions of what it was made for.

    ``procedures`` are the project's own blocks; ``offered`` what it keeps, and its robots.
    """

    language: Language
    procedures: int = -1
    offered: object = None


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Language:
    """Definitions by block type and choices by table (value to label).

    A table that is absent or empty is not known here (no node manifests were given, say), and
    then any value passes. ``profiles`` are the kinds of robots that there are; the first is what
    a project without robots is offered. ``words`` are other words of sentences in the language of
    the person, by the English ones; ``code`` is that of this language. ``robots`` are those of the
    project whose language it is, by name; ``choices`` is then what any of them can.
    """

    definitions: Mapping[str, Definition] = field(repr=False)
    categories: tuple[Category, ...] = field(repr=False)
    choices: Tables = field(repr=False)
    profiles: tuple[RobotProfile, ...]
    words: Mapping[str, str] = field(default_factory=dict, repr=False)
    code: str = "en"
    robots: Mapping[str, RobotChoices] = field(default_factory=dict, repr=False)
    _base: Language | None = field(default=None, repr=False, compare=False)
    _own: WeakKeyDictionary[Project, _Own] = field(
        default_factory=WeakKeyDictionary, repr=False, compare=False
    )
    _joined: dict[tuple[str, ...], Tables] = field(default_factory=dict, repr=False, compare=False)

    @property
    def profile(self) -> RobotProfile:
        """The kind of robot that a project has which names none."""
        return self.profiles[0]

    @property
    def standing(self) -> frozenset[str]:
        """The postures from which a robot can walk."""
        return frozenset().union(*(profile.standing for profile in self.profiles))

    def of(self, project: Project) -> Language:
        """This language with the own blocks, animations and robots of a project, as they are now.

        For one project it is always the same object; its definitions and choices follow the
        project.
        """
        base = self._base or self
        own = base._own.get(project)
        if own is None:
            fresh = replace(base, definitions={}, choices={}, robots={}, _base=base)
            own = base._own[project] = _Own(fresh)
        if own.procedures != project.procedure_revision:
            own.procedures = project.procedure_revision
            definitions = own.language.definitions
            assert isinstance(definitions, dict)
            definitions.clear()
            definitions |= base.definitions
            definitions |= definitions_of(project.procedures.values(), base.words, base.code)
        robots = [(stack.id, project.revisions.get(stack.id)) for stack in project.pages["robots"]]
        if own.offered != (offered := (project.extra_revision, robots)):
            own.offered = offered
            base._offer(own.language, project)
        return own.language

    def _offer(self, own: Language, project: Project) -> None:
        """Let the language of a project offer what its robots can."""

        def with_own(kinds: Iterable[str]) -> dict[str, Mapping[str, str]]:
            return gestures_with(choices_with(self._tables(tuple(kinds)), project), project)

        kinds = self._kinds_of_robots(project)
        choices, robots = own.choices, own.robots
        assert isinstance(choices, dict) and isinstance(robots, dict)
        offered = with_own(dict.fromkeys(kind.name for kind in kinds.values()))
        choices.update(offered)
        for table in choices.keys() - offered.keys():
            del choices[table]
        robots.clear()
        for name, kind in kinds.items():
            robots[name] = RobotChoices(kind.title, with_own([kind.name]))

    def _kinds_of_robots(self, project: Project) -> dict[str, RobotProfile]:
        """The kind of each robot of a project, by the robot's name."""
        kinds = {}
        for stack in project.pages["robots"]:
            for block in map(project.blocks.__getitem__, stack.body):
                definition = self.definitions.get(block.type)
                if block.type == ROBOT_BLOCK and definition is not None and not block.disabled:
                    driver = str(definition.value(block, "driver"))
                    driven = (p for p in self.profiles if driver in p.choices.get(DRIVERS, {}))
                    kinds[str(definition.value(block, "name"))] = next(driven, self.profile)
        return kinds

    def _tables(self, kinds: tuple[str, ...]) -> Tables:
        """What robots of some kinds are offered together; the same objects for the same kinds."""
        if not kinds or kinds == (self.profile.name,):
            return self.choices
        if kinds not in self._joined:
            tables = [self._of_kind(kind) for kind in self.profiles if kind.name in kinds]
            self._joined[kinds] = together(tables) if len(tables) > 1 else tables[0]
        return self._joined[kinds]

    def _of_kind(self, kind: RobotProfile) -> Tables:
        """A table that a kind of robot does not have is as for the first kind."""
        own = {name: table for name, table in kind.choices.items() if name != DRIVERS}
        return {**self.choices, **own}

    def word(self, english: str) -> str:
        """A word of the sentences in the language of the person."""
        return self.words.get(english, english)

    def table_of(self, slot: Slot, block: Block | None = None, key: str = "") -> str:
        """The name of the table of choices of a slot; ``key`` is its key where it is numbered.

        For a slot that depends on another, it is by what the block's other slot holds.
        """
        if not slot.master or block is None:
            return slot.kind.table or slot.table
        number = split_slot(key)[1]
        definition = self.definitions[block.type]
        is_beside = number and definition.slots[slot.master].group
        master = f"{slot.master}.{number}" if is_beside else slot.master
        return f"{slot.table}.{definition.value(block, master)}"

    def choices_of(
        self, slot: Slot, block: Block | None = None, key: str = ""
    ) -> Mapping[str, str]:
        """The values that a slot of a block offers with their labels; empty when not known.

        They are what the block's robot can; what any can, where it names none or all of them.
        """
        tables = self.choices
        if block is not None and len(self.robots) > 1:
            robot = self.robots.get(self.robot_of(block))
            tables = tables if robot is None else robot.tables
        return tables.get(self.table_of(slot, block, key), {})

    def robot_of(self, block: Block) -> str:
        """The name of the robot that a block asks; "" when it asks none, or a block says which."""
        definition = self.definitions.get(block.type)
        slots = definition.slots.values() if definition is not None else ()
        robot = next((slot for slot in slots if slot.kind.name == "robot"), None)
        if definition is None or robot is None or robot.name in block.inputs:
            return ""
        return str(definition.value(block, robot.name))

    def label_of(self, slot: Slot, value: object, block: Block | None = None, key: str = "") -> str:
        """What a value of a slot is called, also one that the block's robot does not have."""
        offered, told = self.choices_of(slot, block, key), str(value)
        if slot.kind.name == "state":
            return told.replace("_", " ")
        if not offered or told in offered:
            return offered.get(told, told)
        return self.known(self.table_of(slot, block, key)).get(told, told)

    def known(self, table: str) -> Mapping[str, str]:
        """The values of a table that any kind of robot has."""
        kinds = [self.choices, *(kind.choices for kind in self.profiles)]
        return together({table: of_kind.get(table, {})} for of_kind in kinds)[table]

    def why_not_choice(
        self, slot: Slot, value: object, block: Block | None = None, key: str = ""
    ) -> Text | None:
        """Why a choice slot cannot hold this value, or None when it can.

        It can hold what any kind of robot has: a check tells of what the block's own one lacks.
        """
        if slot.kind.name != "choice":
            return None
        offered = self.choices_of(slot, block, key)
        if not offered or value in offered or value in self.known(self.table_of(slot, block, key)):
            return None
        return text_of(
            "“{value}” is not one of: {offered}.", value=value, offered=", ".join(offered)
        )


DRIVERS = "drivers"
"""The table that says for each kind of robot how the Robots page names it."""


def together(tables: Iterable[Tables]) -> dict[str, Mapping[str, str]]:
    """Choices with those of others after them; the first label of a value counts."""
    found: dict[str, Mapping[str, str]] = {}
    for one in tables:
        for name, table in one.items():
            known = found.get(name, {})
            found[name] = {**known, **{v: label for v, label in table.items() if v not in known}}
    return found


# The block language in the words of another one: sentences, categories and choices by a table.
#
#     [categories]
#     robot = "Roboter"
#     [blocks]
#     "robot.say" = "{robot} sagt {text} mit {gesture}"
#     "control.if" = "wenn {condition} {do} [also: sonst wenn {also_condition} {also_do}] ..."
#     [choices.postures]
#     posture_stand = "stehen"
#     [choices."pepper.postures"]
#     posture_stand_init = "stehen, bereit zum Rollen"
#     [words]
#     define = "lege fest"
#     [texts]
#     "Hello" = "Hallo"
#
# A block may bring its sentences along (``translations`` by language), so that it is one entry of
# one file; a table's own sentence goes before. A translated sentence has the slots and groups of
# the English one, by their names only, each once; they may stand elsewhere. ``texts`` are what a
# new block says at first: a block without the field means the English one, whoever looks at it.
# What a table does not have, or has wrongly, stays English.

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
    titles = _texts(table, "categories")
    categories = {c.id: replace(c, title=titles.get(c.id, c.title)) for c in language.categories}
    return Language(
        {
            block_type: _definition(
                definition,
                categories,
                _sentence(definition, table, code),
                said_in(definition, table),
            )
            for block_type, definition in language.definitions.items()
        },
        tuple(categories.values()),
        {name: _choices(name, known, table) for name, known in language.choices.items()},
        tuple(_profile(profile, table) for profile in language.profiles),
        words=_texts(table, "words"),
        code=code or language.code,
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
    texts_said = _texts(table, "texts")
    spoken = {text for d in language.definitions.values() for _, text in usual_texts(d)}
    yield from (Fault(text, "is not translated") for text in sorted(spoken - texts_said.keys()))
    yield from (Fault(text, "is no text of a block") for text in sorted(texts_said.keys() - spoken))
    yield from (Fault(t, "is no block") for t in texts if t not in language.definitions)
    named = _texts(table, "categories")
    yield from (Fault(c.id, "is not translated") for c in language.categories if c.id not in named)
    for name, known in language.choices.items():
        labels = _labels(name, table)
        yield from (Fault(f"{name}.{v}", "is not translated") for v in known if v not in labels)
    for kind in language.profiles[1:]:
        for name, known in kind.choices.items():
            usual, told = language.choices.get(name, {}), _labels(name, table)
            own = _labels(f"{kind.name}.{name}", table)
            yield from (
                Fault(f"{kind.name}.{name}.{value}", "is not translated")
                for value, label in known.items()
                # What others call otherwise is not translated with their words
                if value not in own and (value not in told or usual.get(value, label) != label)
            )


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
    definition: Definition,
    categories: Mapping[str, Category],
    sentence: str,
    said: Mapping[str, str],
) -> Definition:
    category = categories.get(definition.category.id, definition.category)
    try:
        parts = translated_parts(definition, sentence) if sentence else definition.parts
    except SentenceError:
        parts = definition.parts
    groups = groups_of(parts)  # in the English order: that of the buttons below the block
    known = {name: groups[name] for name in definition.groups}
    return replace(definition, category=category, parts=parts, groups=known, said=said)


def said_in(definition: Definition, table: Table) -> dict[str, str]:
    """The texts that a new block of this type begins with, by slot, as far as a table has them."""
    texts = _texts(table, "texts")
    return {slot: texts[usual] for slot, usual in usual_texts(definition) if texts.get(usual)}


def usual_texts(definition: Definition) -> Iterator[tuple[str, str]]:
    """The texts with letters among the defaults of a block that people say, hear or name."""
    if definition.holds_python or definition.page != "behaviour":
        return  # code, and names that nodes and robots have in every language
    for slot, usual in definition.defaults.items():
        is_text = definition.slots[slot].kind.name in _TEXT_KINDS
        if is_text and isinstance(usual, str) and any(map(str.isalpha, usual)):
            yield slot, usual


_TEXT_KINDS = ("text", "line", "message", "goal", "mode")


def _profile(profile: RobotProfile, table: Table) -> RobotProfile:
    """A kind of robot may have words of its own: they go before those of all kinds."""
    own: dict[str, dict[str, str]] = {}
    for name, known in profile.choices.items():
        labels = _labels(f"{profile.name}.{name}", table)
        mine = {value: label for value, label in labels.items() if value in known}
        own[name] = {**_choices(name, known, table), **mine}
    return replace(profile, choices=own)


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
