"""The calm page of a show that somebody must look after: what happened, and what to try."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QScrollArea, QVBoxLayout, QWidget

from nep_studio.problems import Problem
from nep_studio.ui.theme import Look
from nep_studio.ui.words import count_words, tr


class AttentionPage(QScrollArea):
    """Large words for who passes, a checklist for who can help."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setStyleSheet("QScrollArea { background: transparent; }")
        self._problem: Problem | None = None
        self._look = look
        self.headline, self.text = _words(), _words()
        inside = QWidget()
        inside.setObjectName("inside")
        inside.setStyleSheet("#inside { background: transparent; }")
        box = QVBoxLayout(inside)
        box.addStretch(1)
        box.addWidget(self.headline)
        box.addWidget(self.text)
        box.addStretch(1)
        self.setWidget(inside)
        self.viewport().setAutoFillBackground(False)

    def show_problem(self, problem: Problem | None, times: int) -> None:
        """Show a problem, and how often it was tried to go on."""
        if problem is None:
            self.text.clear()
            return
        tried = count_words(times, "It was begun again once.", "It was begun again {n} times.")
        steps = [*map(tr, problem.checklist), tr("Then press Run.")]
        lines = [
            "",
            f"{tr(problem.title)}: {tr(problem.sentence)}"
            if problem.sentence
            else tr(problem.title),
            *([tried] if times else []),
            "",
            *(f"\N{WHITE SQUARE} {step}" for step in steps),
        ]
        self.text.setText("\n".join(lines))
        self.headline.setText(tr("The show is having a rest."))
        pixels = max(14, self.window().height() // 28)
        self.headline.setStyleSheet(f"font-size: {2 * pixels}px; font-weight: 600;")
        self.text.setStyleSheet(f"font-size: {pixels}px;")


def _words() -> QLabel:
    label = QLabel()
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(True)
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    return label
