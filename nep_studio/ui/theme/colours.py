"""The one table of named colours of a theme, which widgets, canvas and plots all read."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from PySide6.QtGui import QColor

from nep_studio import paths

LIGHT, DARK, HIGH_CONTRAST = "light", "dark", "high_contrast"
PLACEHOLDER, DISABLED = "placeholder", "disabled"
"""The names under which ``Theme.block`` gives the colours of unknown and switched-off blocks."""


class UnknownColour(KeyError):
    """A colour was asked for that the table of the theme does not have."""


@dataclass(frozen=True)
class BlockColours:
    """What a block of one category is painted with; shared, so never changed in place."""

    fill: QColor
    line: QColor
    text: QColor
    field: QColor
    field_text: QColor
    field_line: QColor


@dataclass(frozen=True, eq=False)
class Theme:
    """The named colours of one look."""

    name: str
    title: str
    is_dark: bool
    colours: Mapping[str, QColor]
    blocks: Mapping[str, BlockColours]

    def colour(self, name: str) -> QColor:
        """Return a colour of the table, the caller's own to change; raises UnknownColour."""
        try:
            return QColor(self.colours[name])
        except KeyError:
            raise UnknownColour(f"The theme {self.name} has no colour {name}.") from None

    def block(self, category_colour: str) -> BlockColours:
        """Return the colours of a category's blocks.

        A block pack may name a colour that this program does not have: its blocks look like
        unknown ones then, rather than not at all.
        """
        return self.blocks.get(category_colour) or self.blocks[PLACEHOLDER]


def _folder() -> Path:
    return paths.resources() / "themes"


@cache
def themes() -> tuple[str, ...]:
    """The names of the themes, the usual one first."""
    found = {path.stem for path in _folder().glob("*.toml")}
    first = [name for name in (LIGHT, DARK, HIGH_CONTRAST) if name in found]
    return (*first, *sorted(found.difference(first)))


def to_colour(text: str) -> QColor:
    """Read ``#rrggbb`` or ``#rrggbbaa``, as the tables and style sheets of the web write it."""
    colour = QColor(text[:7])
    if not colour.isValid() or len(text) not in (7, 9):
        raise ValueError(f"A colour is written #rrggbb or #rrggbbaa, not {text!r}.")
    if len(text) == 9:
        colour.setAlpha(int(text[7:], 16))
    return colour


def mixed(one: QColor, other: QColor, share: float) -> QColor:
    """The colour on the way from one to another; also its transparency."""
    parts = (
        a + (b - a) * share
        for a, b in zip(one.getRgbF(), other.getRgbF(), strict=True)  # type: ignore[call-overload]
    )
    return QColor.fromRgbF(*(min(max(part, 0.0), 1.0) for part in parts))


@cache
def load_theme(name: str) -> Theme:
    """Read a theme from its table; raises FileNotFoundError for a name not in ``themes()``."""
    table = tomllib.loads((_folder() / f"{name}.toml").read_text(encoding="utf-8"))
    blocks = {
        category: BlockColours(**{part: to_colour(text) for part, text in parts.items()})
        for category, parts in table["blocks"].items()
    }
    colours = {colour: to_colour(text) for colour, text in table["colours"].items()}
    return Theme(name, table["title"], table["is_dark"], colours, blocks)
