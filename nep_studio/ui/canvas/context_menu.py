"""The menu of a block, of a note and of the canvas, made of sections to which others can add."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QMenu

from nep_studio.ui.theme import icon

from .menu_entries import MenuEntry, MenuPlace
from .menu_sections import BLOCK_SECTIONS, NOTE_SECTIONS, PAGE_SECTIONS
from .page import Hit

if TYPE_CHECKING:
    from .canvas import Canvas


def menu_for(canvas: Canvas, hit: Hit | None, at: QPointF) -> QMenu:
    """The menu of what was hit; the sections of ``canvas.menu_sections`` come last."""
    note = canvas.notes.hit(at) if hit is None else None
    place = MenuPlace(hit, at, note.id if note is not None else "")
    own = BLOCK_SECTIONS if hit is not None else NOTE_SECTIONS if note else PAGE_SECTIONS
    menu = QMenu(canvas)
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
        for each in entry.entries:
            add(inner, each, canvas)
        action = inner.menuAction()
    else:
        action = menu.addAction(f"{entry.label}\t{entry.shortcut}".rstrip("\t"))
        action.triggered.connect(lambda: entry.run())
    action.setObjectName(entry.id)
    action.setEnabled(entry.is_enabled)
    if entry.icon:
        action.setIcon(icon(entry.icon, canvas.theme))
