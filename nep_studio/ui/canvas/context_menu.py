"""The menu of a block, and of the canvas: lists of entries to which others can add."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QMenu

from nep_studio.ui.theme import icon

from .page import Hit

if TYPE_CHECKING:
    from .canvas import Canvas


@dataclass(frozen=True)
class MenuEntry:
    """One line of a menu; ``entries`` make it a menu of its own, ``shortcut`` is only shown."""

    id: str
    label: str
    run: Callable[[], object] = lambda: None
    icon: str = ""
    is_enabled: bool = True
    shortcut: str = ""
    entries: tuple[MenuEntry, ...] = ()


@dataclass(frozen=True)
class MenuPlace:
    """What a menu is about: a block that was hit, or none, and the point of the page."""

    hit: Hit | None
    at: QPointF


Section = Callable[["Canvas", MenuPlace], list[MenuEntry]]
"""Gives some entries of a menu; a line separates them from the others. No entries, no section."""


def menu_for(canvas: Canvas, hit: Hit | None, at: QPointF) -> QMenu:
    """The menu of what was hit; the sections of ``canvas.menu_sections`` come last."""
    from .menu_sections import BLOCK_SECTIONS, PAGE_SECTIONS  # they need the names of this module

    place = MenuPlace(hit, at)
    menu = QMenu(canvas)
    own = BLOCK_SECTIONS if hit is not None else PAGE_SECTIONS
    for section in (*own, *canvas.menu_sections):
        entries = section(canvas, place)
        if entries and not menu.isEmpty():
            menu.addSeparator()
        for entry in entries:
            add(menu, entry, canvas)
    return menu


def add(menu: QMenu, entry: MenuEntry, canvas: Canvas) -> None:
    """Put an entry into a menu; the action's object name is the entry's id."""
    if entry.entries:
        inner = menu.addMenu(entry.label)
        inner.setEnabled(entry.is_enabled)
        inner.menuAction().setObjectName(entry.id)
        for each in entry.entries:
            add(inner, each, canvas)
        action = inner.menuAction()
    else:
        action = menu.addAction(entry.label)
        action.triggered.connect(lambda: entry.run())
    action.setObjectName(entry.id)
    action.setEnabled(entry.is_enabled)
    if entry.icon:
        action.setIcon(icon(entry.icon, canvas.theme))
    if entry.shortcut:
        action.setText(f"{entry.label}\t{entry.shortcut}")
