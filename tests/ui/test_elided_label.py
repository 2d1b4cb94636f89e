"""A line of words that has too little room."""

from __future__ import annotations

from pytestqt.qtbot import QtBot

from nep_studio.ui.widgets.forms import ElidedLabel

WORDS = "Made from the blocks of this program"


def label_of(qtbot: QtBot, share: float) -> ElidedLabel:
    """A label with room for a share of its words."""
    label = ElidedLabel()
    qtbot.addWidget(label)
    label.set_words(WORDS)
    label.resize(round(label.fontMetrics().horizontalAdvance(WORDS) * share) + 4, 30)
    label.show()
    return label


def test_words_with_room_are_shown_whole(qtbot) -> None:
    label = label_of(qtbot, 1.1)

    assert label.text() == WORDS
    assert label.toolTip() == ""


def test_words_without_room_end_in_dots_and_are_told_by_the_tool_tip(qtbot) -> None:
    label = label_of(qtbot, 0.6)

    assert label.text().endswith("…")
    assert label.toolTip() == label.accessibleName() == WORDS


def test_a_few_letters_that_say_nothing_are_not_shown(qtbot) -> None:
    label = label_of(qtbot, 0.1)

    assert label.text() == ""
    assert label.toolTip() == WORDS
