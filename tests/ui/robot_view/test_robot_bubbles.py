"""Speech bubbles stay in the picture, near their heads, and off each other."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFont
from pytestqt.qtbot import QtBot

from nep_studio.ui.robot_view.painter import Said, placed_bubbles

LONG = "Once upon a time there was a robot that liked to tell stories, and it told them all. " * 8


def test_all_of_a_bubble_is_inside_the_picture(qtbot: QtBot) -> None:
    @given(
        st.floats(-50, 700),
        st.floats(-50, 500),
        st.floats(5, 150),
        st.sampled_from(["Hi", LONG, "Donaudampfschifffahrtsgesellschaft"]),
        st.sampled_from([(640, 480), (320, 240)]),
    )
    def check(x: float, y: float, half: float, words: str, size: tuple[int, int]) -> None:
        (bubble,) = placed_bubbles([Said(words, QPointF(x, y), half)], QFont(), *size)
        assert QRectF(0, 0, *size).contains(bubble.box)

    check()


def test_long_words_end_with_dots(qtbot: QtBot) -> None:
    (bubble,) = placed_bubbles([Said(LONG, QPointF(320, 200), 40)], QFont(), 640, 480)

    assert bubble.words.endswith("…")
    assert len(bubble.words) < len(LONG)


def test_a_bubble_is_above_the_head_when_there_is_room(qtbot: QtBot) -> None:
    (bubble,) = placed_bubbles([Said("Hello", QPointF(320, 300), 40)], QFont(), 640, 480)

    assert bubble.box.bottom() < 300 - 40


def test_a_bubble_is_beside_a_head_at_the_top(qtbot: QtBot) -> None:
    (bubble,) = placed_bubbles([Said("Hello", QPointF(200, 50), 40)], QFont(), 640, 480)

    assert bubble.box.left() > 240


def test_two_that_talk_do_not_cover_each_others_words(qtbot: QtBot) -> None:
    said = [Said("Hello, how are you?", QPointF(300 + 40 * i, 300), 40) for i in range(2)]

    one, other = placed_bubbles(said, QFont(), 640, 480)

    assert not one.box.intersects(other.box)


@pytest.mark.parametrize("words", ["Hello", "Hi", "abcd", "abcde", "a b c", "….….", "", LONG])
def test_a_picture_without_room_for_a_bubble_is_painted_all_the_same(words: str) -> None:
    (bubble,) = placed_bubbles([Said(words, QPointF(8, 6), 4)], QFont(), 16, 12)

    assert len(bubble.words) <= max(4, len(words))
