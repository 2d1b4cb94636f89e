"""The list of problems below the canvas: each with what to try, and a button where one helps."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStyle,
    QStyleOption,
    QVBoxLayout,
    QWidget,
)

from faults import text_of
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.ui.labels import labelled
from nep_studio.ui.message_cards import ChecklistStep, MessageText
from nep_studio.ui.messages import KIND_ICONS, Message
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint, room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

SEVERITIES = {"error": "Error", "warning": "Warning", "info": "Note"}
"""How bad it is, in a word."""


def fix_button(problem: Diagnostic) -> QPushButton | None:
    """The button for what the program can do about it."""
    if problem.fix is None:
        return None
    button = labelled(QPushButton(), text=problem.fix.label, description=problem.sentence)
    button.setProperty("kind", "primary")
    return button


MOST_ROWS = 50
"""More problems than a person reads at once are counted, not shown."""


class ProblemsPanel(QScrollArea):
    """Shows problems; ``opened`` asks to see the place of one, ``fix_asked`` to put it right.

    The rows are made once somebody looks.
    """

    opened = Signal(object)
    fix_asked = Signal(object)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.shown: Sequence[Diagnostic] = ()
        """What is not right, and why the program stopped."""
        self.rows: list[ProblemRow] = []
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        labelled(self, name="Problems")
        self._is_old = True
        look.theme_changed.connect(self._refresh)

    def show_problems(self, problems: Sequence[Diagnostic]) -> None:
        """Show these; nothing is drawn again when they are the same."""
        if list(problems) != list(self.shown):
            self.shown = tuple(problems)
            self._refresh()

    def showEvent(self, event: QShowEvent) -> None:
        """Show what is new since somebody looked last."""
        if self._is_old:
            self._fill()
        super().showEvent(event)

    def sizeHint(self) -> QSize:
        """Room for three problems."""
        line = self.fontMetrics().height()
        return QSize(line * 20, line * 8)

    def _refresh(self) -> None:
        self._is_old = True
        if self.isVisible():
            self._fill()

    def _fill(self) -> None:
        self._is_old = False
        inner = QWidget()
        shown = self.shown[:MOST_ROWS]
        self.rows = [ProblemRow(problem, self._look, self) for problem in shown]
        box = in_column(*self.rows, of=inner)
        hidden = len(self.shown) - len(shown)
        if hidden:
            box.addWidget(hint("and 1 more" if hidden == 1 else text_of("and {n} more", n=hidden)))
        if not self.shown:
            box.addWidget(_all_well(self._look))
        box.addStretch(1)
        self.setWidget(inner)


class ProblemRow(QFrame):
    """One problem. A click or Enter shows its block."""

    def __init__(self, problem: Diagnostic, look: Look, panel: ProblemsPanel) -> None:
        super().__init__(panel)
        self.problem, self._panel = problem, panel
        self.setProperty("kind", problem.severity)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        kind, sentence = text_of(SEVERITIES[problem.severity]), text_of(problem.sentence)
        labelled(self, name=text_of("{name}: {kind}", name=kind, kind=sentence))
        row = in_row((_sign(problem, look, self), 0, Qt.AlignmentFlag.AlignTop), of=self)
        label = labelled(QLabel(textFormat=Qt.TextFormat.PlainText, wordWrap=True), text=sentence)
        label.setProperty("role", "heading")
        words = in_column(label)
        for step in problem.checklist:
            words.addWidget(ChecklistStep(step))
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


def _sign(problem: Diagnostic, look: Look, widget: QWidget) -> QLabel:
    label, size = QLabel(), round(widget.fontMetrics().height() * 1.2)
    colour, ratio = look.theme.colour(problem.severity), widget.devicePixelRatioF()
    label.setPixmap(icon_pixmap(KIND_ICONS[problem.severity], colour, size, ratio))
    return labelled(label, tip=SEVERITIES[problem.severity])


def _all_well(look: Look) -> QWidget:
    """What stands here when there is no problem."""
    row, sign = QWidget(), QLabel()
    size = round(row.fontMetrics().height() * 1.3)
    sign.setPixmap(icon_pixmap("circle-check", look.theme.colour("success"), size))
    words = hint("Nothing to correct. The program is checked while you work.")
    in_row(sign, (words, 1), of=row)
    return row


# The bubble at a block's badge: what is not right there, what to try, a button that helps.

WIDTH_LETTERS = 38


class ProblemBubble(QFrame):
    """Shows the problems of one block; a click elsewhere or Esc takes it away."""

    fix_asked = Signal(object)

    def __init__(self, problems: list[Diagnostic], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
        self.setProperty("kind", problems[0].severity)
        self.setAccessibleName(" ".join(tr(problem.sentence) for problem in problems))
        self.setFixedWidth(self.fontMetrics().averageCharWidth() * WIDTH_LETTERS)
        self.buttons: list[QPushButton] = []
        box = self._box = QVBoxLayout(self)
        for problem in problems:
            checklist = tuple(map(tr, problem.checklist))
            box.addWidget(
                MessageText(Message(problem.severity, tr(problem.sentence), "", checklist))
            )
            if (button := fix_button(problem)) is not None:
                button.clicked.connect(self.close)
                button.clicked.connect(lambda _=False, one=problem: self.fix_asked.emit(one))
                self.buttons.append(button)
                box.addLayout(in_row(button, 1))

    def show_at(self, badge: QRect) -> None:
        """Show it below a badge, given on the screen, but never outside of the screen."""
        width = self.width()
        height = max(self._box.totalHeightForWidth(width), self.minimumSizeHint().height())
        self.resize(width, height)
        room = room_around(self.parentWidget())
        x = min(max(badge.left(), room.left()), room.right() - width)
        below, above = badge.bottom() + 6, badge.top() - height - 6
        self.move(QPoint(x, below if below + height <= room.bottom() else above))
        self.show()
        (self.buttons[0] if self.buttons else self).setFocus(Qt.FocusReason.PopupFocusReason)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the rounded panel: Qt leaves it out of a window whose corners are see-through."""
        option = QStyleOption()
        option.initFrom(self)
        with QPainter(self) as painter:
            self.style().drawPrimitive(QStyle.PrimitiveElement.PE_Widget, option, painter, self)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc takes it away."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)
