"""The hands of the monkey: what a mouse and a keyboard can do to a window, at random places."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtCore import QEvent, QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QMenu,
    QMenuBar,
    QPlainTextEdit,
    QSlider,
    QTabBar,
    QWidget,
)
from shiboken6 import isValid

SAYINGS = ("hello", "nao says", "when", "repeat 3", "karate", "12", "-0.5", "<b>&", "日本語", "…")
KEYS = (
    *(Qt.Key.Key_Return, Qt.Key.Key_Escape, Qt.Key.Key_Tab, Qt.Key.Key_Backtab, Qt.Key.Key_Space),
    *(Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Home),
    *(Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Slash, Qt.Key.Key_Menu, Qt.Key.Key_F1),
    *(Qt.Key.Key_F2, Qt.Key.Key_F5, Qt.Key.Key_F6, Qt.Key.Key_F8, Qt.Key.Key_F10, Qt.Key.Key_End),
)
WITH_CONTROL = "ZYACVXDFNSPGKLW0+- "
SIZES = ((1280, 800), (1366, 728), (1024, 640), (1920, 1040))
PRESSED = (
    *(QAbstractButton, QComboBox, QLineEdit, QTabBar, QAbstractSpinBox, QSlider, QMenuBar),
    *(QAbstractItemView, QPlainTextEdit),
)
"""What invites a press; each kind is as likely, however many there are."""
NONE, LEFT = Qt.KeyboardModifier.NoModifier, Qt.MouseButton.LeftButton


class Hands:
    """Presses what can be seen; ``note`` is told each thing before it is done.

    ``held`` is the window in which the button is down, and where: a question that opens by a
    press waits in an event loop of its own, in which a person lets the button go.
    """

    def __init__(self, chance: random.Random, note: Callable[[str], None]) -> None:
        self.random, self.note = chance, note
        self.held: tuple[QWidget, QPoint] | None = None

    def press(self, top: QWidget, place: QPoint) -> None:
        """Put the left button down."""
        self.held = (top, place)
        QTest.mousePress(top.windowHandle(), LEFT, pos=place)

    def let_go(self) -> None:
        """Let the button go, if it is down and its window is still there."""
        held, self.held = self.held, None
        if (
            held is not None
            and isValid(held[0])
            and held[0].isVisible()
            and held[0].windowHandle() is not None
        ):
            QTest.mouseRelease(held[0].windowHandle(), LEFT, pos=held[1])

    def within(self, top: QWidget, kinds: Sequence[type[QWidget]]) -> QWidget | None:
        """One of the widgets of these kinds that can be seen and used in a window."""
        found = [
            widget
            for kind in kinds
            for widget in top.findChildren(kind)
            if widget.isVisible()
            and widget.isEnabled()
            and widget.window() is top
            and not widget.visibleRegion().isEmpty()
        ]
        return self.random.choice(found) if found else None

    def place(self, top: QWidget, widget: QWidget) -> QPoint:
        """A place of a widget that can be seen, in its window."""
        seen = widget.visibleRegion().boundingRect()
        if isinstance(widget, QMenuBar) and widget.actions():
            seen = widget.actionGeometry(self.random.choice(widget.actions()))
        if seen.isEmpty():
            seen = widget.rect()
        x = self.random.randint(seen.left(), max(seen.left(), seen.right()))
        y = self.random.randint(seen.top(), max(seen.top(), seen.bottom()))
        inside = top.rect().adjusted(0, 0, -1, -1)
        found = widget.mapTo(top, QPoint(x, y)) if widget is not top else QPoint(x, y)
        return QPoint(
            min(max(found.x(), 0), inside.right()), min(max(found.y(), 0), inside.bottom())
        )

    def click(self, top: QWidget, place: QPoint, what: str) -> None:
        """Press a place and let go."""
        self.note(f"click {what} of {type(top).__name__} at {place.x()},{place.y()}")
        self.press(top, place)
        self.let_go()

    def key(self, top: QWidget, key: Qt.Key, modifier: Qt.KeyboardModifier = NONE) -> None:
        """Press a key, and let it go where it does not close the window.

        WORKAROUND: QTest's own click lets go of Ctrl in a window that is gone, and crashes.
        """
        QTest.keyPress(top.windowHandle(), key, modifier)
        self.let_key_go(top, key)

    def let_key_go(self, top: QWidget, key: Qt.Key) -> None:
        """Let a key go, if its window is still there."""
        if isValid(top) and top.isVisible() and top.windowHandle() is not None:
            QTest.keyRelease(top.windowHandle(), key)

    # What is done at random

    def click_something(self, top: QWidget) -> None:
        """Click what invites it."""
        chosen = self.within(top, (self.random.choice(PRESSED),)) or self.within(top, PRESSED)
        if chosen is None:
            self.click_anywhere(top)
            return
        words = getattr(chosen, "text", str)() if isinstance(chosen, QAbstractButton) else ""
        self.click(top, self.place(top, chosen), f"{type(chosen).__name__} “{words}”")

    def click_anywhere(self, top: QWidget) -> None:
        """Click any place."""
        self.click(top, self.place(top, top), "a place")

    def double_click(self, top: QWidget) -> None:
        """Click any place twice."""
        place = self.place(top, top)
        self.note(f"double click {type(top).__name__} at {place.x()},{place.y()}")
        if not isinstance(top, QMenu):
            QTest.mouseDClick(top.windowHandle(), LEFT, pos=place)
            return
        QTest.mouseClick(top.windowHandle(), LEFT, pos=place)
        if top.isVisible():  # else the second click is for what was under the menu
            QTest.mouseClick(top.windowHandle(), LEFT, pos=place)

    def right_click(self, top: QWidget) -> None:
        """Ask for the menu of any place."""
        place = self.place(top, top)
        self.note(f"menu of {type(top).__name__} at {place.x()},{place.y()}")
        QTest.mouseClick(top.windowHandle(), Qt.MouseButton.RightButton, pos=place)

    def drag(self, top: QWidget) -> None:
        """Drag something from one place to another."""
        self.drag_between(top, self.place(top, top), self.place(top, top))

    def drag_between(self, top: QWidget, start: QPoint, end: QPoint) -> None:
        """Drag in a window; one in ten is given up by Esc."""
        places = f"from {start.x()},{start.y()} to {end.x()},{end.y()}"
        self.note(f"drag in {type(top).__name__} {places}")
        self.press(top, start)
        for part in range(1, 6):
            if self.held is None or not isValid(top) or not top.isVisible():
                return
            self.held = (top, start + (end - start) * part / 5)
            QTest.mouseMove(top.windowHandle(), self.held[1])
        if self.held is not None and self.random.random() < 0.1:
            self.key(top, Qt.Key.Key_Escape)
        self.let_go()

    def type_keys(self, top: QWidget) -> None:
        """Press a key, or one with Ctrl."""
        if self.random.random() < 0.3:
            letter = self.random.choice(WITH_CONTROL)
            self.note(f"Ctrl+{letter} in {type(top).__name__}")
            self.key(top, Qt.Key(ord(letter)), Qt.KeyboardModifier.ControlModifier)
            return
        key = self.random.choice(KEYS)
        if key is Qt.Key.Key_Slash and isinstance(QApplication.focusWidget(), QLineEdit):
            return  # no name of a file may lead out of the monkey's folder
        modifier = Qt.KeyboardModifier.ShiftModifier if self.random.random() < 0.2 else NONE
        self.note(f"{key.name} {modifier.name or ''} in {type(top).__name__}")
        self.key(top, key, modifier)

    def say(self, top: QWidget) -> None:
        """Type some words to where the keyboard is, and often Return."""
        focus = QApplication.focusWidget()
        text = self.random.choice(SAYINGS)
        self.note(f"type “{text}” into {type(focus).__name__}")
        for letter in text:  # QTest knows those of Latin-1 alone
            if not isinstance(focus, QWidget) or focus.window() is not top:
                return
            for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
                QApplication.sendEvent(focus, QKeyEvent(kind, 0, NONE, letter))
            focus = QApplication.focusWidget()
        if self.random.random() < 0.3 and top.windowHandle() is not None:
            self.key(top, Qt.Key.Key_Return)

    def wheel(self, top: QWidget) -> None:
        """Turn the wheel over any place."""
        place = self.place(top, top)
        target = top.childAt(place) or top
        steps = self.random.choice((-120, 120, -360, 360))
        self.note(f"wheel {steps} over {type(target).__name__}")
        local = target.mapFrom(top, place)
        modifier = self.random.choice((NONE, NONE, NONE, Qt.KeyboardModifier.ControlModifier))
        event = QWheelEvent(
            QPointF(local),
            QPointF(target.mapToGlobal(local)),
            QPoint(),
            QPoint(0, steps),
            Qt.MouseButton.NoButton,
            modifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(target, event)

    def resize(self, top: QWidget) -> None:
        """Give a window another size, as by its edge."""
        if top.isFullScreen() or top.windowType() is Qt.WindowType.Popup or isinstance(top, QMenu):
            return
        size = self.random.choice(SIZES)
        self.note(f"resize {type(top).__name__} to {size}")
        top.resize(*size)

    def drop(self, top: QWidget, file: Path) -> None:
        """Drop a file onto any place."""
        place = self.place(top, top)
        target: QWidget | None = top.childAt(place) or top
        self.note(f"drop {file.name} on {type(target).__name__}")
        mime = QMimeData()
        mime.setUrls([QUrl.fromLocalFile(str(file))])
        copy = Qt.DropAction.CopyAction
        while target is not None and not target.acceptDrops():
            target = target.parentWidget()
        if target is None:
            return
        enter = QDragEnterEvent(QPoint(5, 5), copy, mime, LEFT, NONE)
        QApplication.sendEvent(target, enter)
        if enter.isAccepted():
            QApplication.sendEvent(target, QDropEvent(QPointF(5, 5), copy, mime, LEFT, NONE))
