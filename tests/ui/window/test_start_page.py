"""The start page: three ways to begin, and a gallery that is searched, tried and opened."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.project.examples import examples
from nep_studio.ui.shell.gallery import Card
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.start_page import StartPage
from nep_studio.ui.words import PSEUDO

LEFT = Qt.MouseButton.LeftButton
KARATE, QUIZ = (paths.examples() / f"{name}.nep" for name in ("karate_greeting", "quiz"))


@pytest.fixture
def page(window: MainWindow, qtbot: QtBot) -> StartPage:
    """The start page with all its cards."""
    qtbot.waitUntil(lambda: window.start_page.gallery.is_complete)
    return window.start_page


def click(widget: QWidget) -> None:
    QTest.mouseClick(widget, LEFT)


def titles(page: StartPage) -> list[str]:
    return [card.example.title for card in page.gallery.shown]


def seen(page: StartPage, widget: QWidget) -> bool:
    """Whether a widget is wholly in view."""
    place = QRect(widget.mapTo(page.viewport(), widget.rect().topLeft()), widget.size())
    return page.viewport().rect().contains(place)


# Beginning


def test_try_an_example_leads_to_the_first_example(page: StartPage) -> None:
    click(page.example_button)

    first = page.gallery.shown[0]
    assert first.hasFocus() and seen(page, first)
    assert first.example.path == KARATE


def test_a_recent_project_opens_by_a_click(
    window: MainWindow, page: StartPage, tmp_path: Path, qtbot: QtBot
) -> None:
    mine = tmp_path / "mine.nep"
    mine.write_bytes(QUIZ.read_bytes())
    window.settings.add_recent(mine)
    window.files.recent_changed.emit()

    click(page.recent_buttons[mine])

    qtbot.waitUntil(lambda: window.files.document is not None)
    assert window.files.document.path == mine


# The gallery


def test_every_example_has_a_card_with_what_it_needs(page: StartPage) -> None:
    assert list(page.cards) == [example.path for example in examples()]
    card = page.cards[QUIZ]
    words = "Next step. Somebody who touches it. Somebody who answers. 1 minute"
    assert card.accessibleName().startswith("Question and answer. NAO asks")
    assert card.accessibleDescription() == words
    assert "Say “eight”" in card.toolTip()


def test_the_pictures_are_painted_one_after_the_other(page: StartPage, qtbot: QtBot) -> None:
    cards = list(page.cards.values())

    qtbot.waitUntil(lambda: all(card.is_painted() for card in cards))


def test_a_picture_follows_the_width_of_its_card(
    window: MainWindow, page: StartPage, qtbot: QtBot
) -> None:
    card = page.cards[KARATE]
    qtbot.waitUntil(card.is_painted)
    before = card.width()

    window.resize(900, 700)

    assert card.width() != before
    qtbot.waitUntil(card.is_painted)


def test_try_asks_for_the_example_to_be_run_and_open_opens_it(
    window: MainWindow, page: StartPage, qtbot: QtBot
) -> None:
    card = page.cards[KARATE]

    with qtbot.waitSignal(page.try_requested) as asked:
        click(card.try_button)
    assert asked.args == [KARATE]
    if window.files.document is None:
        click(card.open_button)

    qtbot.waitUntil(lambda: window.files.document is not None)
    assert window.files.document.project.name == "Karate greeting"


def test_words_find_examples_by_what_they_are_about(page: StartPage) -> None:
    QTest.keyClicks(page.gallery.search, "watch museum")
    found = titles(page)
    QTest.keyClick(page.gallery.search, Qt.Key.Key_Escape)

    assert found == ["Karate greeting", "Robot coach of a museum"]
    assert len(titles(page)) == len(page.cards)


def test_where_nothing_is_found_it_says_so(page: StartPage) -> None:
    page.gallery.search.setText("submarine")

    assert titles(page) == []
    assert page.gallery.nothing.isVisible()


def test_a_tag_shows_its_examples_and_once_more_all(page: StartPage) -> None:
    games, theatre = (page.gallery.tag_buttons[tag] for tag in ("games", "theatre"))

    click(theatre)
    click(games)
    found = titles(page)
    click(games)

    assert found == ["Question and answer", "Touch game"]
    assert len(titles(page)) == len(page.cards)
    assert not theatre.isChecked()


def test_arrows_lead_from_the_search_through_the_cards(page: StartPage) -> None:
    gallery = page.gallery
    gallery.search.setFocus()
    shown, columns = gallery.shown, gallery._columns

    QTest.keyClick(gallery.search, Qt.Key.Key_Down)
    at_first = shown[0].hasFocus()
    QTest.keyClick(shown[0], Qt.Key.Key_Right)
    at_second = shown[1].hasFocus()
    QTest.keyClick(shown[1], Qt.Key.Key_Down)
    below = shown[1 + columns]

    assert at_first and at_second and below.hasFocus()
    assert seen(page, below)
    QTest.keyClick(below, Qt.Key.Key_Up)
    QTest.keyClick(shown[1], Qt.Key.Key_Up)
    assert gallery.search.hasFocus()


def test_enter_opens_a_card(window: MainWindow, page: StartPage, qtbot: QtBot) -> None:
    page.cards[QUIZ].setFocus()

    QTest.keyClick(page.cards[QUIZ], Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: window.files.document is not None)
    assert window.files.document.project.name == "Question and answer"


def test_tab_reaches_both_buttons_of_a_card(page: StartPage) -> None:
    card = page.gallery.shown[0]
    card.setFocus()

    reached = []
    for _ in range(2):
        QTest.keyClick(page.window().focusWidget(), Qt.Key.Key_Tab)
        reached.append(page.window().focusWidget())

    assert reached == [card.try_button, card.open_button]
    assert card.try_button.accessibleName() == "Try “Karate greeting” on the simulator"


# In every shape


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_cards_fill_the_page_and_nothing_in_them_is_cut(
    window: MainWindow, page: StartPage, scale: float, qtbot: QtBot
) -> None:
    window.studio.choose_text_scale(scale)

    for width in (420, 700, 1280, 1900):
        window.resize(width, 800)
        qtbot.wait(0)  # let the page follow: before, nothing of it is cut either

        qtbot.waitUntil(lambda: cut(page) == [])


def cut(page: StartPage) -> list[str]:
    """What reaches out of the page, or out of its card."""
    found = []
    for card in page.gallery.shown:
        room = QRect(card.mapTo(page.viewport(), QPoint(0, 0)), card.size())
        if room.left() < 0 or room.right() > page.viewport().width():
            found.append(f"{card.example.title}: {room}")
        for inside in card.findChildren(QLabel) + card.findChildren(QPushButton):
            place = QRect(inside.mapTo(card, QPoint(0, 0)), inside.size())
            if not card.rect().contains(place):
                found.append(f"{card.example.title}, {inside.text()}: {place} in {card.size()}")
    return found


def test_mirrored_the_first_card_is_on_the_right(window: MainWindow, qtbot: QtBot) -> None:
    window.studio.choose_language(PSEUDO)
    shown: list[Card] = window.start_page.gallery.shown
    qtbot.waitUntil(lambda: shown[0].width() > 0 and shown[0].x() > shown[1].x())

    QTest.keyClick(shown[0], Qt.Key.Key_Left)

    assert window.focusWidget() is shown[1]
