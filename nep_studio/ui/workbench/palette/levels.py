"""How much the palette shows: the first blocks, which a lesson may choose, more of them, or all."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, cast

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QFrame, QSizePolicy, QToolButton, QWidget

from nep_studio import paths
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import OWN_CATEGORY, procedure_of
from nep_studio.blocks.program import FIRST_BLOCKS, Project
from nep_studio.settings import Settings
from nep_studio.ui.labels import labelled
from nep_studio.ui.widgets.layouts import in_row

Level = Literal["first", "more", "all"]

LEVELS: Mapping[Level, str] = {"first": "First blocks", "more": "More", "all": "All"}
"""From few blocks to all, with their names."""


# Which blocks belong to which level: resources/palette.toml, and what the project says.


@dataclass(frozen=True)
class Heading:
    """A part of the first blocks: it looks like a category, and has blocks of several."""

    category: str
    joins: tuple[str, ...]
    blocks: tuple[str, ...]


@dataclass(frozen=True)
class Offer:
    """What resources/palette.toml says."""

    headings: tuple[Heading, ...]
    rare_categories: frozenset[str]
    rare_blocks: frozenset[str]

    @property
    def usual(self) -> tuple[str, ...]:
        """The first blocks of a project that says nothing of them."""
        return tuple(block for heading in self.headings for block in heading.blocks)

    def is_rare(self, definition: Definition) -> bool:
        """Whether a block is only among all of them."""
        is_of_rare = definition.category.id in self.rare_categories
        return is_of_rare or definition.id in self.rare_blocks

    def heading_of(self, category: str) -> str:
        """The category whose heading stands above the first blocks of a category."""
        joining = (one.category for one in self.headings if category in one.joins)
        return next(joining, category)


@cache
def offer() -> Offer:
    """What the palette offers at its levels."""
    data = tomllib.loads((paths.resources() / "palette.toml").read_text(encoding="utf-8"))
    headings = tuple(
        Heading(one["category"], tuple(one["joins"]), tuple(one["blocks"])) for one in data["first"]
    )
    rare = data["rare"]
    return Offer(headings, frozenset(rare["categories"]), frozenset(rare["blocks"]))


def first_types(project: Project, language: Language) -> tuple[str, ...]:
    """The types of the first blocks: those of the project that are known here, else the usual."""
    own = tuple(block for block in project.first_blocks if can_be_first(language, block))
    return own or tuple(block for block in offer().usual if block in language.definitions)


def can_be_first(language: Language, block: str) -> bool:
    """Whether blocks of a type may be among the first: they are in every program, and known."""
    definition = language.definitions.get(block)
    if definition is None or definition.category.id == OWN_CATEGORY.id:
        return False
    return definition.page == "behaviour"


def first_by_heading(project: Project, language: Language) -> dict[str, list[str]]:
    """The first blocks by the category of their heading, in the order of the palette."""
    found: dict[str, list[str]] = {}
    for block in first_types(project, language):
        category = language.definitions[block].category.id
        found.setdefault(offer().heading_of(category), []).append(block)
    known = [heading.category for heading in offer().headings]
    order = [*known, *(one.id for one in language.categories if one.id not in known)]
    return {category: found[category] for category in order if category in found}


def level_of(project: Project, language: Language, block: str) -> Level:
    """The first level at which a block is shown."""
    if procedure_of(block) or block in first_types(project, language):
        return "first"
    return "all" if offer().is_rare(language.definitions[block]) else "more"


def is_within(one: Level, other: Level) -> bool:
    """Whether all that is shown at a level is shown at another one."""
    levels = list(LEVELS)
    return levels.index(one) <= levels.index(other)


def changed_first(project: Project, language: Language, block: str) -> SetExtra | None:
    """Put a type among the project's first blocks, or take it away; the last one stays."""
    first = first_types(project, language)
    after = [one for one in first if one != block] if block in first else [*first, block]
    return SetExtra(FIRST_BLOCKS, after) if after else None


def chosen_level(settings: Settings) -> Level:
    """The level that the person left the palette at; a new person begins with the first blocks."""
    kept = settings.palette_level
    return cast(Level, kept) if kept in LEVELS else "first"


# The switch between the levels.


class LevelBar(QFrame):
    """One button for each level, side by side; ``chosen`` brings the level that was pressed."""

    chosen = Signal(str)

    def __init__(self, level: Level, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "segments")
        self.buttons: dict[Level, QToolButton] = {}
        self._group = QButtonGroup(self)
        for name, words in LEVELS.items():
            button = labelled(QToolButton(self), text=words)
            button.setCheckable(True)
            button.setChecked(name == level)
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            button.setSizePolicy(QSizePolicy.Policy.MinimumExpanding, QSizePolicy.Policy.Fixed)
            button.clicked.connect(lambda _on, name=name: self.chosen.emit(name))
            self._group.addButton(button)
            self.buttons[name] = button
        in_row(*self.buttons.values(), of=self, margins=2, spacing=2)
        labelled(self, name="How many blocks are shown")

    def show_level(self, level: Level) -> None:
        """Let this level be the one that is shown."""
        self.buttons[level].setChecked(True)
