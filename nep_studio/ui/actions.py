"""The actions of a window: each has a name, words, perhaps an icon and keys, and is made once."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QKeyCombination, QObject, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QWidget

from faults import Words
from nep_studio.ui.labels import follow_words
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import tr

Keys = QKeySequence.StandardKey | str


class Actions(QObject):
    """The actions of one window by name; their keys work wherever the focus is in it.

    On a page of the window ``context`` is another: there the page asks what a key means.
    """

    def __init__(
        self,
        window: QWidget,
        look: Look,
        context: Qt.ShortcutContext = Qt.ShortcutContext.WindowShortcut,
    ) -> None:
        super().__init__(window)
        self._context = context
        self._window, self._look = window, look
        self._icons: dict[str, tuple[str, str]] = {}
        self._words: dict[str, tuple[Words, Words]] = {}
        self.by_name: dict[str, QAction] = {}
        follow_words(self, self._say_all)
        look.theme_changed.connect(self._on_theme_changed)

    def __getitem__(self, name: str) -> QAction:
        return self.by_name[name]

    def add(
        self,
        name: str,
        words: Words,
        do: Callable[[], object],
        *,
        icon_name: str = "",
        keys: Keys | tuple[Keys, ...] = (),
        tip: Words = "",
        colour: str = "text",
        menu: QMenu | None = None,
    ) -> QAction:
        """Make an action; ``words`` in English, with an ellipsis where a question follows.

        ``colour`` is the theme's, of an icon that is not on a panel; ``menu`` has it at its end.
        """
        action = QAction(self)
        action.setObjectName(name)
        action.setShortcuts(sequences(keys))
        action.setShortcutContext(self._context)
        action.triggered.connect(lambda: do())
        self._window.addAction(action)
        self.by_name[name] = action
        self.label(name, words, tip)
        if icon_name:
            self._icons[name] = icon_name, colour
            self._dress(name)
        if menu is not None:
            menu.addAction(action)
        return action

    def label(self, name: str, words: Words, tip: Words = "") -> None:
        """Give an action other words, and a tool tip if they do not say it all."""
        self._words[name] = words, tip
        action, said = self.by_name[name], tr(words)
        short = said.removesuffix("…")
        keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        action.setText(said)
        action.setIconText(short)
        action.setToolTip(f"{tr(tip) or short} ({keys})" if keys else tr(tip) or short)

    def _say_all(self) -> None:
        for name, (words, tip) in self._words.items():
            self.label(name, words, tip)

    def enable(self, is_enabled: bool, *names: str) -> None:
        """Let these actions be used, or not."""
        for name in names:
            self.by_name[name].setEnabled(is_enabled)

    def _on_theme_changed(self) -> None:
        for name in self._icons:
            self._dress(name)

    def _dress(self, name: str) -> None:
        icon_name, colour = self._icons[name]
        self.by_name[name].setIcon(icon(icon_name, self._look.theme, colour))


def sequences(keys: Keys | tuple[Keys, ...]) -> list[QKeySequence]:
    """The key sequences of keys; a standard key may have several on this system."""
    found: list[QKeySequence] = []
    for key in keys if isinstance(keys, tuple) else (keys,):
        if isinstance(key, str):
            found.append(QKeySequence(key))
        else:
            found.extend(QKeySequence.keyBindings(key))
    return list(dict.fromkeys(found))  # one that is there twice would be ambiguous


# What the keys of actions do, and the mouse on the canvas, as a list for people.

FIRST_RARE_KEY = Qt.Key.Key_Back
"""From here on come keys such as “Undo” and “Open”, which hardly a keyboard has."""


def shortcuts_of(actions: Iterable[QAction]) -> list[tuple[str, str]]:
    """What the actions with keys do, and the keys that a keyboard has."""
    native = QKeySequence.SequenceFormat.NativeText
    return [
        (
            action.iconText().replace("&", ""),
            ", ".join(dict.fromkeys(key.toString(native) for key in keys)),
        )
        for action in actions
        if (keys := [key for key in action.shortcuts() if _is_on_keyboards(key)])
    ]


def _is_on_keyboards(keys: QKeySequence) -> bool:
    first: QKeyCombination = keys[0]  # type: ignore[index]  # stubs lack __getitem__
    return first.key() < FIRST_RARE_KEY


def on_the_canvas() -> list[tuple[str, str]]:
    """What the mouse does on the canvas."""
    return [
        (tr("Move a block with those below it"), tr("Drag")),
        (tr("Select several blocks"), tr("Drag on the empty page, or Shift and click")),
        (tr("Move the page"), tr("Wheel, or drag with the middle button")),
        (tr("Zoom"), tr("Ctrl and wheel")),
        (tr("What the selected block does"), "F1"),
    ]
