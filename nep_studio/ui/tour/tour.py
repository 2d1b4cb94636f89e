"""The tour as it goes: one step after the other, back again, and out at any time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QRect, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QPlainTextEdit, QWidget

from nep_studio.ui.messages import announce
from nep_studio.ui.tour.bubble import Bubble
from nep_studio.ui.tour.steps import FIRST_STEPS, PROJECT, Step, steps
from nep_studio.ui.tour.veil import Veil
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.main_window import MainWindow

LOOK_MS = 100
"""How often it looks where things are now and whether they are done."""


class Tour(QObject):
    """Leads through the steps in a project of its own. ``ended`` comes however it ends."""

    ended = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._steps: list[Step] = []
        self._document: Document | None = None
        self.number = -1
        self._is_opening = self._was_done = False
        self._shown: tuple[QRect, QRect, int] | None = None
        self.veil, self.bubble = Veil(window.look, window), Bubble(window.look, window)
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)
        self.bubble.forth.connect(self.go_on)
        self.bubble.back.connect(self.go_back)
        self.bubble.left.connect(self.end)
        window.files.document_changed.connect(self._on_document_changed)
        window.studio.words_changed.connect(
            self._on_looks_changed, Qt.ConnectionType.QueuedConnection
        )
        window.look.theme_changed.connect(self._on_looks_changed)

    @property
    def is_running(self) -> bool:
        """Whether a step is shown."""
        return self.number >= 0

    def start(self) -> None:
        """Open the project of the tour and begin; work that is not saved is asked about first."""
        self.end()
        self._is_opening = True
        self._window.files.open_example(FIRST_STEPS)

    def go_on(self) -> None:
        """Go to the next step; what this one asks for is done if nobody has."""
        step = self._steps[self.number]
        if step.is_done is not None and not step.is_done(self._window):
            step.do(self._window)
        self._go_to(self.number + 1)

    def go_back(self) -> None:
        """Go to the step before."""
        self._go_to(max(0, self.number - 1))

    def end(self) -> None:
        """Put everything away; it is not offered any more."""
        if not self.is_running:
            return
        self.number, self._document, self._shown = -1, None, None
        self._looking.stop()
        handle = self._window.windowHandle()
        if handle is not None:
            handle.removeEventFilter(self)
        focus = QApplication.focusWidget()
        had_focus = focus is not None and self.bubble.isAncestorOf(focus)
        self.bubble.hide()
        self.veil.hide()
        if had_focus and self._window.workbench.isVisible():
            self._window.workbench.canvas.setFocus()
        self.ended.emit()

    def _begin(self) -> None:
        self._window.settings.tour_done = True
        self._window.start_page.tour_offer.hide()
        self._steps = steps()
        handle = self._window.windowHandle()
        if handle is not None:
            handle.installEventFilter(self)
        self._go_to(0)
        self._looking.start()
        self.bubble.next_button.setFocus(Qt.FocusReason.OtherFocusReason)

    def _go_to(self, number: int) -> None:
        if number >= len(self._steps):
            self.end()
            return
        self.number = number
        step = self._steps[number]
        step.prepare(self._window)
        self._was_done = step.is_done is not None and step.is_done(self._window)
        self.bubble.say(step, number, len(self._steps))
        self._take_place()
        announce(self.bubble, self.bubble.accessibleName())

    def _take_place(self) -> None:
        """Lie over the window as it is now, above all that has come into it since."""
        room = self._window.rect()
        place = self._steps[self.number].target(self._window).intersected(room)
        if self._shown != (place, room, self.number):
            self._shown = (place, QRect(room), self.number)
            self.veil.setGeometry(room)
            self.veil.show_hole(place)
            self.bubble.sit_beside(place, room)
        over = _parts_of(self._window)[-2:]
        if over != [self.veil, self.bubble] or self.bubble.isHidden():
            for part in (self.veil, self.bubble):
                part.show()
                part.raise_()

    def _on_look(self) -> None:
        """Follow what is shown, and go on when it has been done."""
        if not self._window.isVisible():
            return
        self._take_place()
        done = self._steps[self.number].is_done
        if done is None:
            return
        is_done = done(self._window)
        if is_done and not self._was_done:
            self._go_to(self.number + 1)
        else:
            self._was_done = is_done

    def _on_document_changed(self, document: Document | None) -> None:
        """Begin when the project of the tour is there; another one ends the tour."""
        was_opening, self._is_opening = self._is_opening, False
        if was_opening and document is not None and document.project.name == PROJECT:
            self._document = document
            QTimer.singleShot(0, self, self._begin)
        elif document is not self._document:
            self.end()

    def _on_looks_changed(self) -> None:
        if self.is_running:
            self._steps, self._shown = steps(), None
            self.bubble.say(self._steps[self.number], self.number, len(self._steps))
            self._take_place()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Esc ends the tour from everywhere, unless something else in the window needs it."""
        is_escape = (
            event.type() == QEvent.Type.KeyPress
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_Escape
        )
        if is_escape and self.is_running and not self._is_escape_needed():
            self.end()
            return True
        if event.type() == QEvent.Type.Resize and self.is_running:
            QTimer.singleShot(0, self, self._on_resized)
        return super().eventFilter(watched, event)

    def _on_resized(self) -> None:
        if self.is_running:
            self._take_place()

    def _is_escape_needed(self) -> bool:
        """Whether a menu, a field or a drag is open, which Esc ends first."""
        canvas = self._window.workbench.canvas
        return (
            QApplication.activePopupWidget() is not None
            or QApplication.activeModalWidget() is not None
            or isinstance(QApplication.focusWidget(), QLineEdit | QPlainTextEdit)
            or canvas.gesture is not None
            or canvas.fields.widget is not None
        )


def _parts_of(window: QWidget) -> list[QWidget]:
    """What lies in a window, the lowest first; its dialogs are windows of their own."""
    parts = (part for part in window.children() if isinstance(part, QWidget))
    return [part for part in parts if not part.isWindow()]


def add_tour(window: MainWindow) -> Tour:
    """Put the tour into the Help menu; once for each build.

    The window's contents may be made anew while the tour goes on: it stays.
    """
    tour = window.findChild(Tour) or Tour(window)
    action = window.actions_by_name.add(
        "tour", tr("Take the tour"), tour.start, icon_name="footprints"
    )
    help_menu = window.menus["help"]
    first = next(iter(help_menu.actions()), None)
    if first is None:
        help_menu.addAction(action)
    else:
        help_menu.insertAction(first, action)
    return tour
