"""The palette: what it lists, and how blocks are found in it and come out of it."""

from __future__ import annotations

import time

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible, QPixmap
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.blocks.writing import to_bytes
from nep_studio.ui import words
from nep_studio.ui.palette.entries import Entry
from nep_studio.ui.palette.palette import Palette
from nep_studio.ui.palette.shelf import Shelf
from nep_studio.ui.palette.tips import tip
from nep_studio.ui.theme import load_theme

LEFT = Qt.MouseButton.LeftButton


def number_of(palette: Palette, block_type: str) -> int:
    entries, stock = palette.shelf.entries, palette.shelf._stock
    for number, entry in enumerate(entries):
        if entry.sample and stock.project.blocks[entry.sample].type == block_type:
            return number
    raise AssertionError(f"no {block_type} in the palette")


def entry_of(palette: Palette, block_type: str) -> Entry:
    return palette.shelf.entries[number_of(palette, block_type)]


def grip(shelf: Shelf, number: int) -> QPoint:
    """A place on the block of an entry, scrolled into view."""
    shelf._go_to(number)
    rect = shelf.rect_of(number)
    return QPoint(rect.left() + 12, rect.top() + 12)


def types(palette: Palette) -> list[str]:
    return [block.type for block in palette.canvas.editor.project.blocks.values()]


def test_the_palette_lists_every_block_of_the_page_that_is_shown(palette):
    language = palette.canvas.editor.language
    wanted = {d.id for d in language.definitions.values() if d.page == "behaviour"}

    listed = {palette.shelf._stock.project.blocks[e.sample].type for e in palette.shelf.entries if e.sample}

    assert listed == wanted


def test_the_palette_follows_the_page(palette):
    palette.canvas.show_page("nodes")

    assert entry_of(palette, "nodes.launch" if False else "node.launch" if False else first_type(palette, "nodes"))
    assert "robot" not in palette.categories.buttons
