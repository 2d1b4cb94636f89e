"""The block language of one session: the definitions, and the choices that their slots offer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

from .definitions import Category, Definition
from .own_animations import choices_with
from .own_gestures import gestures_with
from .procedures import definitions_of
from .profile import RobotProfile
from .program import Block, Project, split_slot
from .sentence import Slot


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
    ) -> str | None:
        """Why a choice slot cannot hold this value, or None when it can."""
        if slot.kind.name != "choice":
            return None
        offered = self.choices_of(slot, block, key)
        if not offered or value in offered:
            return None
        return f"“{value}” is not one of: {', '.join(offered)}."
