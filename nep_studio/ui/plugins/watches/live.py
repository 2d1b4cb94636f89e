"""What arrives, live: a dot that answers movement, a curve, numbers, and what to try in silence."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QVBoxLayout, QWidget

from nep_core.wire.messages import Imu
from nep_studio.problems import Problem
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.watch_view.indicators import (
    SILENT_S,
    Figure,
    LittleCurve,
    MoveDot,
    Moving,
    WatchListener,
    figures,
)
from nep_studio.ui.watch_view.status import SIGNS
from nep_studio.ui.widgets.forms import quiet_button
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

MOST_FIGURES = 5


class LiveView(QFrame):
    """A card; ``show_state`` says what it is about, the ear gives the rest."""

    def __init__(
        self,
        listener: WatchListener,
        look: Look,
        has_columns: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        """``has_columns``: what arrives are lines, of which the columns can be corrected."""
        super().__init__(parent)
        self._has_columns = has_columns
        self.setProperty("kind", "card")
        self._listener, self._look = listener, look
        self.dot, self.curve = MoveDot(look), LittleCurve(look)
        self.title, self.sentence, self.understood = QLabel(), QLabel(), QLabel()
        self.correct_button = quiet_button(tr("Correct the columns…"))
        self.advice = QLabel()
        self.advice_card = QFrame()
        self.rows = [(QLabel(), QLabel(), QLabel(), QLabel()) for _ in range(MOST_FIGURES)]
        self._understood: list[str] = []
        self._grades: list[str] = [""] * MOST_FIGURES
        self._lay_out()
        listener.heard.connect(self._on_heard)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.title.setProperty("role", "heading")
        self.understood.setProperty("role", "hint")
        for label in (self.title, self.sentence, self.understood, self.advice):
            label.setWordWrap(True)
            label.setTextFormat(Qt.TextFormat.PlainText)
        for label in (self.sentence, self.understood, self.advice):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        words = in_column(self.title, self.sentence, 1)
        head = in_row((self.dot, 0, Qt.AlignmentFlag.AlignTop), (words, 1), spacing=line // 2)
        self.advice_card.setProperty("kind", "warning")
        in_column(self.advice, of=self.advice_card)
        box = QVBoxLayout(self)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
        box.setSpacing(line // 2)
        box.addLayout(head)
        box.addWidget(self.curve)
        box.addLayout(self._figures(line))
        box.addWidget(self.understood)
        box.addWidget(self.correct_button, 0, Qt.AlignmentFlag.AlignLeading)
        box.addWidget(self.advice_card)

    def _figures(self, line: int) -> QGridLayout:
        grid = QGridLayout()
        grid.setColumnStretch(3, 1)
        grid.setHorizontalSpacing(line // 2)
        grid.setVerticalSpacing(line // 6)
        for at, row in enumerate(self.rows):
            row[3].setWordWrap(True)
            row[3].setProperty("role", "hint")
            for column, label in enumerate(row):
                grid.addWidget(label, at, column, Qt.AlignmentFlag.AlignTop)
        return grid

    def show_waiting(self, title: str, sentence: str, advice: Sequence[str] = ()) -> None:
        """Nothing has arrived yet; ``advice``: what to look at."""
        self._show("waiting", title, sentence)
        self._advise(advice)

    def show_problem(self, problem: Problem) -> None:
        """It does not go, and what to try."""
        self._show("failed", tr(problem.title), tr(problem.sentence))
        self._advise([tr(step) for step in problem.checklist])

    def show_arriving(self, advice: Sequence[str] = ()) -> None:
        """Samples come, or came until a moment ago: ``advice`` is for the latter."""
        receiving = self._listener.receiving
        if self._listener.silent_s >= SILENT_S:
            words = tr("Nothing has come for {n} s.", n=round(self._listener.silent_s))
            self._show("waiting", tr("It has fallen silent"), words)
        elif receiving.has_moved:
            self._show("moved", tr("It moves: all is well"), self._counted())
        else:
            words = tr("Turn it over, or wave it once: the dot becomes green.")
            self._show("still", tr("It sends. Now move it"), words)
        self._advise(advice)
        self._show_figures(figures(self._listener.flow) if self._listener.is_sending else [])
        self.understood.setText("\n".join(self._told()))
        self.understood.setVisible(bool(self.understood.text()))
        self.correct_button.setVisible(self._has_columns and self.understood.isVisibleTo(self))

    def _told(self) -> list[str]:
        """How the node understands what arrives, and what it warns of."""
        status = self._listener.status
        if status is None or not status.fault.sentence:
            return []
        told = tr(status.fault.sentence)
        if status.event == "warning":
            return [*self._understood, told]
        self._understood = [told]
        return self._understood

    def _counted(self) -> str:
        receiving = self._listener.receiving
        if receiving.has_rotation:
            return tr("Acceleration and rotation arrive.")
        return tr("Acceleration arrives; it has no gyroscope, which is enough.")

    def _show(self, state: Moving, title: str, sentence: str) -> None:
        is_there = state in ("still", "moved")
        self.dot.show_movement(state, self._listener.receiving.movement_m_s2 if is_there else 0.0)
        if title != self.title.text():
            self.title.setText(title)
            announce(self, title)
        self.sentence.setText(sentence)
        self.sentence.setVisible(bool(sentence))
        self.curve.setVisible(is_there)
        if not is_there:
            self._show_figures([])
            self.understood.hide()
            self.correct_button.hide()

    def _advise(self, advice: Sequence[str]) -> None:
        lines = [tr("Try this, in this order:"), *(f"•  {step}" for step in advice)]
        self.advice.setText("\n".join(lines))
        self.advice_card.setVisible(bool(advice))

    def _show_figures(self, told: Sequence[Figure]) -> None:
        for at, (sign, name, number, words) in enumerate(self.rows):
            figure = told[at] if at < len(told) else None
            for label in (sign, name, number, words):
                label.setVisible(figure is not None)
            if figure is None:
                continue
            name.setText(figure.name)
            number.setText(figure.number)
            words.setText(figure.words)
            number.setAccessibleName(f"{figure.name}: {figure.number}, {figure.words}")
            if self._grades[at] != figure.grade:
                self._grades[at] = figure.grade
                self._draw_sign(sign, figure.grade)

    def redraw(self) -> None:
        """Draw the signs in another theme."""
        for at, row in enumerate(self.rows):
            if self._grades[at]:
                self._draw_sign(row[0], self._grades[at])

    def _draw_sign(self, sign: QLabel, grade: str) -> None:
        name, colour = SIGNS[grade]
        side = round(self.fontMetrics().height() * 0.95)
        picture = icon(name, self._look.theme.colour(colour))
        sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))

    def _on_heard(self, batch: list[Imu]) -> None:
        self.curve.take(batch)
        receiving = self._listener.receiving
        if self.dot.state in ("still", "moved"):
            self.dot.show_movement(self.dot.state, receiving.movement_m_s2)
