"""A change of language tells all words of the window again, in place: nothing is made anew."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QComboBox, QTabBar, QTabWidget, QWidget

from nep_studio import paths
from nep_studio.ui.shell.main_window import MainWindow

KARATE = paths.examples() / "karate_greeting.nep"
LEFT_OUT = ("nep_studio.ui.plugins",)
"""What is in these does not tell its words again yet, in place."""

TEXTS = (
    "text",
    "title",
    "windowTitle",
    "iconText",
    "toolTip",
    "statusTip",
    "placeholderText",
    "accessibleName",
    "accessibleDescription",
)
Words = list[tuple[str, str, str]]


def words_of(window: MainWindow) -> Words:
    """All words of a window: where they are, what they are, and how they go."""
    return sorted(_words(window, type(window).__name__))


def _words(thing: QObject, place: str) -> Iterator[tuple[str, str, str]]:
    for kind in TEXTS:
        said = getattr(thing, kind, None)
        if callable(said) and isinstance(words := said(), str) and words:
            yield place, kind, words
    yield from ((place, "item", words) for words in _items(thing))
    for number, child in enumerate(_children(thing)):
        name = child.objectName() or str(number)
        yield from _words(child, f"{place}/{type(child).__name__}:{name}")


def _items(thing: QObject) -> Iterator[str]:
    if isinstance(thing, QTabBar | QTabWidget):
        for index in range(thing.count()):
            yield from (thing.tabText(index), thing.tabToolTip(index))
    elif isinstance(thing, QComboBox):
        yield from (thing.itemText(index) for index in range(thing.count()))


def _children(thing: QObject) -> list[QObject]:
    """The parts that have words; a list's rows are no objects."""
    found = [one for one in thing.children() if isinstance(one, QWidget | QAction)]
    found += [
        one
        for inner in thing.children()
        if not isinstance(inner, QWidget | QAction)
        for one in inner.children()
        if isinstance(one, QAction)
    ]
    return [one for one in found if not type(one).__module__.startswith(LEFT_OUT)]
