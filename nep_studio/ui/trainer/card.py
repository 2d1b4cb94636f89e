"""The card of one gesture: its name, its block, what records it, and its takes."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
)

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import icon
from nep_studio.ui.trainer.chip import GestureChip
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.take_pictures import TakePictures
from nep_studio.ui.trainer.takes_list import TAKES_MIME, TakesList, takes_in
from nep_studio.ui.words import count_words, tr


class GestureCard(QFrame):
    """Shows a gesture; everything that is wanted of it is told by signals.

    ``menu_asked`` and ``take_menu_asked`` give a place of the screen; ``takes_dropped`` the ids of
    takes that are of this gesture from now on.
    """

    renamed = Signal(str)
    record_asked = Signal()
    activated = Signal()
    menu_asked = Signal(QPoint)
    take_menu_asked = Signal(QPoint)
    takes_dropped = Signal(list)

    def __init__(
        self, name: str, desk: TrainerDesk, canvas: Canvas, pictures: TakePictures
    ) -> None:
        super().__init__()
        self.name, self._desk = name, desk
        self._is_current = self._is_target = self._is_recording = False
        self.title = QLineEdit()
        self.count = QLabel()
        self.record = QPushButton(tr("Record"))
        self.chip = GestureChip(canvas)
        self.menu = QToolButton()
        self.takes = TakesList(desk, pictures)
        self.setProperty("kind", "card")
        self.setAcceptDrops(True)
        self._lay_out()
        self._connect()
        self.dress()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.title.setMaxLength(60)
        self.title.setAccessibleName(tr("Name of the gesture"))
        self.count.setProperty("role", "hint")
        self.record.setAutoDefault(False)
        self.menu.setToolTip(tr("More"))
        self.menu.setAccessibleName(tr("More"))
        above = QHBoxLayout()
        above.addWidget(self.title, 1)
        above.addWidget(self.count)
        above.addWidget(self.menu)
        between = FlowLayout(gap=line // 3)
        for widget in (self.record, self.chip):
            between.addWidget(widget)
        box = QVBoxLayout(self)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 3)
        box.setSpacing(line // 3)
        box.addLayout(above)
        box.addLayout(between)
        box.addWidget(self.takes)

    def _connect(self) -> None:
        self.title.editingFinished.connect(self._on_title_edited)
        self.record.clicked.connect(self.record_asked)
        self.menu.clicked.connect(lambda: self.menu_asked.emit(_below(self.menu)))
        self.takes.menu_asked.connect(self.take_menu_asked)
        self.takes.current_changed.connect(self.activated)

    # What is shown

    def show_gesture(self, gesture: OwnGesture, badges: Mapping[str, str]) -> None:
        """Show the gesture as it is now."""
        if not self.title.hasFocus() or not self.title.isModified():
            self._show_title(gesture.title)
        self.chip.show_gesture(self.name, gesture.title)
        self.count.setText(count_words(len(gesture.takes), "1 take", "{n} takes"))
        words = tr("Record “{gesture}”", gesture=gesture.title)
        self.record.setAccessibleName(words)
        self.record.setToolTip(words)
        self.setAccessibleName(gesture.title)
        self.takes.setAccessibleName(tr("Takes of {gesture}", gesture=gesture.title))
        self.takes.show_takes(gesture.takes, badges)
        self.takes.setVisible(bool(gesture.takes))

    def show_state(self, *, is_current: bool, is_recording: bool) -> None:
        """Show whether Space records this gesture, and whether it is being recorded."""
        if (is_current, is_recording) == (self._is_current, self._is_recording):
            return
        if is_recording != self._is_recording:
            self.record.setText(tr("Stop") if is_recording else tr("Record"))
        self._is_current, self._is_recording = is_current, is_recording
        self.dress()
        self.update()

    def dress(self) -> None:
        """Take the theme."""
        theme, line = self._desk.look.theme, self.fontMetrics().height()
        name = "square" if self._is_recording else "circle-dot"
        self.record.setIcon(icon(name, theme.colour("stop")))
        self.record.setIconSize(icon_room(line))
        self.menu.setIcon(icon("ellipsis", theme))
        self.menu.setIconSize(QSize(line, line))
        self.chip.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Mark the card that Space records, and the one that takes are dropped on."""
        super().paintEvent(event)
        if self._is_current or self._is_target:
            with QPainter(self) as painter:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                colour = "focus" if self._is_target else "accent"
                painter.setPen(QPen(self._desk.look.theme.colour(colour), 2))
                corner = self.fontMetrics().height() * 0.42
                painter.drawRoundedRect(self.rect().adjusted(1, 1, -1, -1), corner, corner)

    def edit_title(self) -> None:
        """Let the name be typed."""
        self.title.setFocus(Qt.FocusReason.OtherFocusReason)
        self.title.selectAll()

    # What happens

    def _show_title(self, title: str) -> None:
        if title != self.title.text():
            self.title.setText(title)
            self.title.setCursorPosition(0)

    def _on_title_edited(self) -> None:
        text = self.title.text().strip()
        if not self.title.isModified():
            return
        self.title.setModified(False)
        if text:
            self.renamed.emit(text)
        gesture = self._desk.gestures.get(self.name)
        if gesture is not None:
            self._show_title(gesture.title)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take the takes of other gestures."""
        if event.mimeData().hasFormat(TAKES_MIME):
            event.acceptProposedAction()
            self._is_target = True
            self.update()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """They went elsewhere."""
        self._is_target = False
        self.update()

    def dropEvent(self, event: QDropEvent) -> None:
        """Say that they are of this gesture."""
        self._is_target = False
        self.update()
        event.acceptProposedAction()
        self.takes_dropped.emit(list(takes_in(event.mimeData())))


def _below(widget: QToolButton) -> QPoint:
    return widget.mapToGlobal(QPoint(0, widget.height()))
