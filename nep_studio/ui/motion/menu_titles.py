"""Titles inside menus: those that Qt has of its own are not painted in our style."""

from __future__ import annotations

from PySide6.QtWidgets import QMenu


def add_title(menu: QMenu, words: str) -> None:
    """Begin a part of a menu with words that cannot be chosen."""
    if not menu.isEmpty():
        menu.addSeparator()
    menu.addAction(words.replace("&", "&&")).setEnabled(False)
