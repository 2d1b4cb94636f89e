"""Numbered steps in plain words, each with what is copied for it and what is asked there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QFont, QGuiApplication, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr

from .ways import UNKNOWN, Step

COPIED_MS = 2000
MOST_LETTERS = 24
"""So many letters fit beside the button."""


class StepNumber(QWidget):
    """A number in a disc."""

    def __init__(self, number: int, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._number, self._look = number, look
        self.setFixedSize(self.sizeHint())

    def sizeHint(self) -> QSize:
        """As high as one line and a half."""
        side = round(self.fontMetrics().height() * 1.5)
        return QSize(side, side)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, font = self._look.theme, QFont(self.font())
        font.setWeight(QFont.Weight.DemiBold)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("accent"))
            painter.drawEllipse(QRectF(self.rect()))
            painter.setPen(theme.colour("accent_text"))
            painter.setFont(font)
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, str(self._number))


class CopyLine(QWidget):
    """A text that is written somewhere else, with the button that copies it.

    Of a long one all letters must be seen: people type them. Its button is below it.
    """

    def __init__(
        self, look: Look, words: str, is_long: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.text = QLineEdit()
        self.text.setReadOnly(True)
        self.text.setAccessibleName(words)
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.text.setAlignment(Qt.AlignmentFlag.AlignLeft)
        self._words = words
        self._look = look
        self.button = QPushButton(words)
        self.redraw()
        self.button.setAutoDefault(False)
        line = self.fontMetrics().height()
        self.button.setIconSize(QSize(line, line))
        self._again = QTimer(self, singleShot=True, interval=COPIED_MS)
        self._again.timeout.connect(lambda: self.button.setText(self._words))
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
            self.text.setToolTip(text)
            self.setEnabled(UNKNOWN not in text)

    def _on_copy(self) -> None:
        QGuiApplication.clipboard().setText(self.text.text())
        self.button.setText(tr("Copied"))
        self._again.start()


class StepsList(QWidget):
    """The steps of one way; ``extras`` are the questions that stand below steps, by name."""

    def __init__(
        self,
        steps: Sequence[Step],
        extras: Mapping[str, QWidget],
        look: Look,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.words: list[QLabel] = []
        self.copy_lines: list[CopyLine | None] = []
        self._look = look
        line = self.fontMetrics().height()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        grid.setHorizontalSpacing(line // 2)
        grid.setVerticalSpacing(line // 2)
        for number, step in enumerate(steps):
            if len(steps) > 1:
                badge = StepNumber(number + 1, look)
                grid.addWidget(badge, number, 0, Qt.AlignmentFlag.AlignTop)
            grid.addLayout(self._column(step, extras.get(step.extra)), number, 1)
        self.fill(steps)

    def fill(self, steps: Sequence[Step]) -> None:
        """Show the same steps with other addresses."""
        for step, label, copy_line in zip(steps, self.words, self.copy_lines, strict=True):
            label.setText(step.words)
            if copy_line is not None:
                copy_line.show_text(step.copied)

    def _column(self, step: Step, extra: QWidget | None) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(self.fontMetrics().height() // 3)
        label = QLabel()
        label.setWordWrap(True)
        column.addWidget(label)
        self.words.append(label)
        is_address = step.copied.startswith("http") or "." in step.copied
        words = tr("Copy the address") if is_address else tr("Copy")
        is_long = len(step.copied) > MOST_LETTERS
        copy_line = CopyLine(self._look, words, is_long) if step.copied else None
        self.copy_lines.append(copy_line)
        for below in (copy_line, extra):
            if below is not None:
                column.addWidget(below)
        return column
