"""Words that stay on a widget: told again, in place, when the language of the window changes.

Enters what has words and outlives a change of language. A dialog does not: it is made anew each
time that it is opened, and says ``tr`` where it is made.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from types import MethodType
from typing import TYPE_CHECKING, Any, TypeVar, cast
from weakref import WeakKeyDictionary, WeakMethod

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QApplication, QTabWidget
from shiboken6 import isValid

from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from faults import Words

Owner = TypeVar("Owner", bound=QObject)
Tabs = TypeVar("Tabs", bound=QTabWidget)
Tell = Callable[[], object]

SETTERS = {
    "text": "setText",
    "title": "setTitle",
    "window_title": "setWindowTitle",
    "tip": "setToolTip",
    "name": "setAccessibleName",
    "description": "setAccessibleDescription",
    "placeholder": "setPlaceholderText",
}
"""What of a widget words can be, and how Qt is told."""

_labels: WeakKeyDictionary[QObject, dict[str | int, Words]] = WeakKeyDictionary()
_followers: WeakKeyDictionary[QObject, list[WeakMethod[Tell]]] = WeakKeyDictionary()


def labelled(owner: Owner, /, **words: Words) -> Owner:
    """Put words on a widget or an action, now and in each language that is chosen later.

    ``words`` by the keys of ``SETTERS``: English templates, or a ``Text`` with its values. What
    is labelled again has the new words; empty words are put there as they are.
    """
    known = _labels.setdefault(owner, {})
    for key, said in words.items():
        known[key] = said
        _put(owner, key, said)
    return owner


def explained(owner: Owner, words: Words) -> Owner:
    """Put the same words on what has only a picture: as its tool tip, and for screen readers."""
    return labelled(owner, tip=words, name=words)


def labelled_items(owner: Tabs, /, *words: Words) -> Tabs:
    """Put words on the tabs that are there, as ``labelled`` does."""
    known = _labels.setdefault(owner, {})
    for place, said in enumerate(words):
        known[place] = said
        _put(owner, place, said)
    return owner


def follow_words(owner: QObject, tell: Tell) -> None:
    """Call a method of ``owner`` now and after each change of language.

    It is for words that depend on more than the language, and for lists of them.
    """
    _followers.setdefault(owner, []).append(WeakMethod(cast("MethodType", tell)))
    tell()


def tell_again() -> None:
    """Put all words on their widgets in the language that is used now; Qt's own widgets, too."""
    for owner, words in list(_labels.items()):
        if isValid(owner):
            for key, said in words.items():
                _put(owner, key, said)
    for owner, methods in list(_followers.items()):
        for method in methods:
            tell = method()
            if tell is not None and isValid(owner):
                tell()
    for window in QApplication.topLevelWidgets():
        QApplication.sendEvent(window, QEvent(QEvent.Type.LanguageChange))
        window.update()  # for what paints its words itself


def _put(owner: Any, key: str | int, said: Words) -> None:
    if isinstance(key, int):
        owner.setTabText(key, tr(said))
    else:
        words = tr(said)
        getattr(owner, SETTERS[key])(plain_tip(words) if key == "tip" else words)


def plain_tip(text: str) -> str:
    """A tip with a text of others: Qt would take it for a page, and fetch the pictures it names."""
    return f"<p style='white-space: pre-wrap'>{escape(text)}</p>" if "<" in text else text
