"""How a problem is shown: its icon, its words, the button that puts it right."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QPushButton

from nep_studio.blocks.checks import Problem
from nep_studio.ui.messages import KIND_ICONS
from nep_studio.ui.theme import Theme, icon
from nep_studio.ui.words import count_words, tr


def problem_icon(problem: Problem, theme: Theme) -> QIcon:
    """The icon of how bad it is."""
    return icon(KIND_ICONS[problem.severity], theme.colour(problem.severity))


def severity_word(problem: Problem) -> str:
    """How bad it is, in a word."""
    words = {"error": tr("Error"), "warning": tr("Warning"), "info": tr("Note")}
    return words[problem.severity]


def summary(problems: Sequence[Problem]) -> str:
    """How many problems there are, in a few words."""
    if not problems:
        return tr("Nothing to correct")
    return count_words(len(problems), "1 problem", "{n} problems")


def fix_button(problem: Problem) -> QPushButton | None:
    """The button for what the program can do about it."""
    if problem.fix is None:
        return None
    button = QPushButton(tr(problem.fix.label))
    button.setProperty("kind", "primary")
    button.setAccessibleDescription(tr(problem.sentence))
    return button
