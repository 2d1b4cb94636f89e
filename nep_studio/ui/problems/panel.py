"""The list of problems below the canvas: each with what to try, and a button where one helps."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.checks import Problem
from nep_studio.ui.messages import KIND_ICONS
from nep_studio.ui.messages_card import ChecklistStep
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import count_words, tr

from .looks import fix_button, severity_word

MOST_ROWS = 50
"""More problems than a person reads at once are counted, not shown."""


class ProblemsPanel(QScrollArea):
    """Shows problems; ``opened`` asks to see the place of one, ``fix_asked`` to put it right."""

    opened = Signal(object)
    fix_asked = Signal(object)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._problems: Sequence[Problem] = ()
        self.rows: list[ProblemRow] = []
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setAccessibleName(tr("Problems"))
        look.theme_changed.connect(self._fill)
        self._fill()

    def show_problems(self, problems: Sequence[Problem]) -> None:
        """Show these; nothing is drawn again when they are the same."""
        if list(problems) != list(self._problems):
            self._problems = tuple(problems)
            self._fill()

    def sizeHint(self) -> QSize:
        """Room for three problems."""
        line = self.fontMetrics().height()
        return QSize(line * 20, line * 8)

    def _fill(self) -> None:
        inner = QWidget()
        box = QVBoxLayout(inner)
        shown = self._problems[:MOST_ROWS]
        self.rows = [ProblemRow(problem, self._look, self) for problem in shown]
        for row in self.rows:
            box.addWidget(row)
        hidden = len(self._problems) - len(shown)
        if hidden:
            box.addWidget(_hint(count_words(hidden, "and 1 more", "and {n} more")))
        if not self._problems:
            box.addWidget(_all_well(self._look))
        box.addStretch(1)
        self.setWidget(inner)


class ProblemRow(QFrame):
    """One problem. A click or Enter shows its block."""

    def __init__(self, problem: Problem, look: Look, panel: ProblemsPanel) -> None:
        super().__init__(panel)
        self.problem, self._panel = problem, panel
        self.setProperty("kind", problem.severity)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        sentence = tr(problem.sentence)
        self.setAccessibleName(f"{severity_word(problem)}: {sentence}")
        row = QHBoxLayout(self)
        row.addWidget(_sign(problem, look, self), 0, Qt.AlignmentFlag.AlignTop)
        words = QVBoxLayout()
        words.addWidget(_words(sentence))
        for step in problem.checklist:
            words.addWidget(ChecklistStep(tr(step)))
        row.addLayout(words, 1)
        self.fix_button: QPushButton | None = fix_button(problem)
        if self.fix_button is not None:
            self.fix_button.clicked.connect(lambda: panel.fix_asked.emit(problem))
            row.addWidget(self.fix_button, 0, Qt.AlignmentFlag.AlignVCenter)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Show the block."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._panel.opened.emit(self.problem)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Space show the block."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self._panel.opened.emit(self.problem)
        else:
            super().keyPressEvent(event)


def _sign(problem: Problem, look: Look, widget: QWidget) -> QLabel:
    label, size = QLabel(), round(widget.fontMetrics().height() * 1.2)
    colour, ratio = look.theme.colour(problem.severity), widget.devicePixelRatioF()
    label.setPixmap(icon_pixmap(KIND_ICONS[problem.severity], colour, size, ratio))
    label.setToolTip(severity_word(problem))
    return label


def _words(text: str) -> QLabel:
    label = QLabel(text)
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(True)
    label.setProperty("role", "heading")
    return label


def _hint(text: str) -> QLabel:
    label = QLabel(text)
    label.setProperty("role", "hint")
    label.setWordWrap(True)
    return label


def _all_well(look: Look) -> QWidget:
    """What stands here when there is no problem."""
    row = QWidget()
    box = QHBoxLayout(row)
    sign, size = QLabel(), round(row.fontMetrics().height() * 1.3)
    sign.setPixmap(icon_pixmap("circle-check", look.theme.colour("success"), size))
    box.addWidget(sign)
    box.addWidget(_hint(tr("Nothing to correct. The program is checked while you work.")), 1)
    return row
