"""The small parts of forms: words before a field, hints, cards, a line that can be copied."""

from __future__ import annotations

import re
from typing import Any, TypeVar

from PySide6.QtCore import QPoint, QRect, QSize, Qt, QTimer
from PySide6.QtGui import QFont, QFontMetrics, QGuiApplication, QResizeEvent, QScreen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QMenu,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from faults import Words
from nep_studio.ui import labels
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import Part, in_column

Styled = TypeVar("Styled", bound=QWidget)

UNKNOWN = "…"
"""Stands where an address is not known."""
COPIED_MS = 2000
"""So long the button says that it is done."""


class CopyLine(QWidget):
    """A text that is written somewhere else, with the button that copies it.

    Of a long one all letters must be seen: people type them. Its button is below it.
    """

    def __init__(
        self, look: Look, words: Words, is_long: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.text = labels.labelled(QLineEdit(), name=words)
        self.text.setReadOnly(True)
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.text.setAlignment(Qt.AlignmentFlag.AlignLeft)
        self._look = look
        self.button = labels.labelled(QPushButton(), text=words)
        self.redraw()
        self.button.setAutoDefault(False)
        line = self.fontMetrics().height()
        self.button.setIconSize(QSize(line, line))
        self._again = QTimer(self, singleShot=True, interval=COPIED_MS)
        self._again.timeout.connect(lambda: labels.labelled(self.button, text=words))
        row = QVBoxLayout(self) if is_long else QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.text, 1)
        row.addWidget(self.button, 0, Qt.AlignmentFlag.AlignLeading)
        self.button.clicked.connect(self._on_copy)

    def redraw(self) -> None:
        """Draw the icon in another theme."""
        self.button.setIcon(icon("copy", self._look.theme))

    def show_text(self, text: str) -> None:
        """Show this; what is long shows its beginning."""
        if text != self.text.text():
            self.text.setText(text)
            self.text.setCursorPosition(0)
            self.text.setToolTip(plain_tip(text))
            self.setEnabled(UNKNOWN not in text)

    def _on_copy(self) -> None:
        QGuiApplication.clipboard().setText(self.text.text())
        labels.labelled(self.button, text="Copied")
        self._again.start()


def styled(widget: Styled, **looks: str) -> Styled:
    """Give a widget what the style sheet of a theme asks for: its ``role``, or its ``kind``."""
    for name, look in looks.items():
        widget.setProperty(name, look)
    return widget


def hint(words: Words) -> QLabel:
    """Words that explain, in a quiet colour; in English, as all labels."""
    return labels.labelled(styled(QLabel(wordWrap=True), role="hint"), text=words)


class EmptyHint(QLabel):
    """Words in a list, tree or table as long as that has no rows; in English, as all labels."""

    def __init__(self, view: QAbstractItemView, words: Words) -> None:
        super().__init__(view.viewport(), wordWrap=True, alignment=Qt.AlignmentFlag.AlignCenter)
        labels.labelled(styled(self, role="hint"), text=words)
        # the rows below it have what the mouse does
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        in_column(self, of=view.viewport())
        self._view = view
        self.follow()

    def follow(self) -> None:
        """Follow the rows of the view, also when these are of another model than before."""
        model = self._view.model()
        for changed in (model.rowsInserted, model.rowsRemoved, model.modelReset):
            changed.connect(self._look)
        self._look()

    def _look(self) -> None:
        self.setVisible(self._view.model().rowCount() == 0)


def label_of(words: Words, buddy: QWidget) -> QLabel:
    """The words before a field, in English; screen readers say them there."""
    label = labels.labelled(QLabel(), text=words)
    label.setBuddy(labels.labelled(buddy, name=words))
    return label


def labelled(words: Words, field: QWidget) -> QWidget:
    """A field with its words, in English."""
    both = QWidget()
    form = QFormLayout(both)
    form.setContentsMargins(0, 0, 0, 0)
    form.addRow(label_of(words, field), field)
    return both


def quiet_button(words: Words) -> QPushButton:
    """A button that does not call for attention, and never is what Enter presses."""
    return labels.labelled(styled(QPushButton(autoDefault=False), kind="quiet"), text=words)


def column_in(widget: QWidget, *parts: Part) -> QVBoxLayout:
    """A column without margins."""
    return in_column(*parts, of=widget, margins=0, spacing=widget.fontMetrics().height() // 3)


def card_around(label: QLabel, kind: str) -> QFrame:
    """Put words into a card of a colour."""
    card = styled(QFrame(), kind=kind)
    in_column(label, of=card, margins=label.fontMetrics().height() // 2)
    return card


# A line of words that ends in … where there is no room for all of them.

FEWEST_LETTERS = 10
"""With fewer than these the rest cannot be guessed, and nothing is shown."""


class ElidedLabel(QLabel):
    """Shows as much of its words as it can; its tool tip and screen readers have all of them.

    With ``all_or_none`` words that lack the end are not shown at all.
    """

    def __init__(self, parent: QWidget | None = None, *, all_or_none: bool = False) -> None:
        super().__init__(parent)
        self.words, self._all_or_none = "", all_or_none
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def set_words(self, words: str) -> None:
        """Show these words."""
        self.words = words
        self.setAccessibleName(words)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show more or less of the words."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        room, mode = self.contentsRect().width(), Qt.TextElideMode.ElideRight
        shown = self.fontMetrics().elidedText(self.words, mode, room)
        fewest = len(self.words) if self._all_or_none else FEWEST_LETTERS
        if shown != self.words and len(shown) <= fewest:
            shown = ""
        self.setText(shown)
        self.setToolTip("" if shown == self.words else plain_tip(self.words))


def keep_bold_room(button: QPushButton) -> None:
    """Give the default button room for its bold letters, of which Qt's size knows nothing."""
    button.ensurePolished()
    bold = button.font()
    bold.setWeight(QFont.Weight.Bold)
    more = QFontMetrics(bold).horizontalAdvance(button.text())
    more -= button.fontMetrics().horizontalAdvance(button.text())
    button.setMinimumWidth(button.sizeHint().width() + max(more, 0))


def plain_label(words: str = "", /, **look: Any) -> QLabel:
    """A label for words of others: Qt would take one that begins with < for a page."""
    return QLabel(words, wordWrap=True, textFormat=Qt.TextFormat.PlainText, **look)


def breakable(text: str) -> str:
    """A text of others that a label can break: a name without an end would push all off the screen.

    Behind so many letters without a space comes one that takes no room.
    """
    return _LONG_WORD.sub("\\g<0>\u200b", text)


_LONG_WORD = re.compile(r"\S{30}(?=\S)")


# Which part of the screen a widget may use.


def room_around(widget: QWidget | None) -> QRect:
    """What may be used of the screen that a widget is on; without one, of the main screen."""
    return _screen_of(widget).availableGeometry()


def screen_around(widget: QWidget | None) -> QRect:
    """The whole screen that a widget is on; without one, the main screen."""
    return _screen_of(widget).geometry()


def fit_on_screen(dialog: QWidget, lines_wide: float, lines_high: float) -> None:
    """Give a dialog so many lines of text of room, and no more than most of the screen."""
    line, room = dialog.fontMetrics().height(), room_around(dialog.parentWidget()).size()
    dialog.resize(
        min(round(line * lines_wide), round(room.width() * 0.95)),
        min(round(line * lines_high), round(room.height() * 0.88)),
    )


def _screen_of(widget: QWidget | None) -> QScreen:
    """The screen of a widget.

    WORKAROUND for ``QWidget.screen()`` of PySide6 6.11: it makes the screen a child of the
    widget in Python's eyes. When the widget is collected as garbage, Qt's only screen is
    deleted with it, and the next widget that is made crashes the program.
    """
    middle = widget.mapToGlobal(widget.rect().center()) if widget is not None else QPoint()
    return QGuiApplication.screenAt(middle) or QGuiApplication.primaryScreen()


# Titles inside menus: those that Qt has of its own are not painted in our style.


def add_title(menu: QMenu, words: str) -> None:
    """Begin a part of a menu with words that cannot be chosen."""
    if not menu.isEmpty():
        menu.addSeparator()
    menu.addAction(words.replace("&", "&&")).setEnabled(False)
