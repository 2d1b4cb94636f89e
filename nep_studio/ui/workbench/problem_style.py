"""How a problem is shown: its icon, its words, the button that puts it right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QPushButton

from nep_studio.ui.theme import Theme, icon
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from nep_studio.blocks.checks import Problem


def severity_word(problem: Problem) -> str:
    """How bad it is, in a word."""
    words = {"error": tr("Error"), "warning": tr("Warning"), "info": tr("Note")}
    return words[problem.severity]


def summary(problems: Sequence[Problem]) -> str:
    """How many problems there are, in a few words."""
    if not problems:
        return tr("Nothing to correct")
    return count_words(len(problems), "1 problem", "{n} problems")


def style_check(
    check: QAction, problems: Sequence[Problem], theme: Theme, *, is_open: bool
) -> None:
    """Let the action that checks say how many problems there are, and how bad they are."""
    worst = next(iter(problems), None)
    colour = "success" if worst is None else worst.severity
    sign = "circle-check" if worst is None else "triangle-alert"
    check.setIcon(icon(sign, theme.colour(colour)) if is_open else icon(sign, theme))
    check.setIconText(summary(problems) if problems else tr("Check"))
    check.setToolTip(summary(problems))


def fix_button(problem: Problem) -> QPushButton | None:
    """The button for what the program can do about it."""
    if problem.fix is None:
        return None
    button = QPushButton(tr(problem.fix.label))
    button.setProperty("kind", "primary")
    button.setAccessibleDescription(tr(problem.sentence))
    return button
