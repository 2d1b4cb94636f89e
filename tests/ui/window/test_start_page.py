"""The start page: three ways to begin, and a gallery that is searched, tried and opened."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QImageReader
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.project.examples import examples
from nep_studio.ui.shell.acting import ActingPicture, picture_file
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


def test_one_press_plays_an_example(window: MainWindow, page: StartPage, qtbot: QtBot) -> None:
    assert seen(page, page.big_picture) and seen(page, page.example_button)

    click(page.example_button)

    qtbot.waitUntil(lambda: window.running.runner.controller.state == "running", timeout=30_000)
    assert window.files.document.project.name == "Karate greeting"
    assert window.workbench.canvas.isVisible()


def test_a_press_on_the_big_picture_plays_it_too(page: StartPage, qtbot: QtBot) -> None:
    page.try_requested.disconnect()

    with qtbot.waitSignal(page.try_requested) as asked:
        QTest.mouseClick(page.big_picture, LEFT, pos=QPoint(30, 30))

    assert asked.args == [KARATE]


def test_there_are_no_tools_before_a_project_is_open(window: MainWindow, page: StartPage) -> None:
    at_start = window.toolbar.isVisible()

    click(page.new_button)
    with_project = window.toolbar.isVisible()
    window.files.close()

    assert (at_start, with_project, window.toolbar.isVisible()) == (False, True, False)
    assert window.menuBar().isVisible()


@pytest.mark.parametrize("size", [(1280, 760), (1366, 728), (1920, 1040)])
def test_the_first_sight_is_the_robot_and_what_can_be_done(
    window: MainWindow, page: StartPage, size: tuple[int, int], qtbot: QtBot
) -> None:
    window.resize(*size)
    qtbot.waitUntil(lambda: seen(page, page.big_picture))

    for widget in (page.example_button, page.new_button, page.open_button, page.tour_offer):
        assert seen(page, widget)


# What moves


def hash_of(picture: ActingPicture) -> int:
    frame = picture._frame
    assert frame is not None
    return hash(bytes(frame.constBits()))


def test_the_robot_of_the_big_picture_acts_while_somebody_sees_it(
    window: MainWindow, page: StartPage, qtbot: QtBot
) -> None:
    picture = page.big_picture.picture
    qtbot.waitUntil(lambda: picture.is_acting)
    before = hash_of(picture)

    qtbot.waitUntil(lambda: hash_of(picture) != before)
    click(page.new_button)
    assert not picture.is_acting
    window.files.close()
    qtbot.waitUntil(lambda: picture.is_acting)

    page.verticalScrollBar().setValue(page.verticalScrollBar().maximum())
    qtbot.waitUntil(lambda: not picture.is_acting)


def test_the_robots_of_a_card_act_under_the_pointer(page: StartPage, qtbot: QtBot) -> None:
    card, other = page.gallery.shown[0], page.gallery.shown[1]
    page.ensureWidgetVisible(card)
    qtbot.waitUntil(lambda: not card.picture.visibleRegion().isEmpty())

    QTest.mouseMove(card, QPoint(30, 20))
    qtbot.waitUntil(lambda: card.picture.is_acting)
    QTest.mouseMove(other, QPoint(30, 20))

    qtbot.waitUntil(lambda: not card.picture.is_acting and other.picture.is_acting)


def test_the_robots_of_a_card_act_with_the_keyboard_on_it(page: StartPage, qtbot: QtBot) -> None:
    page.gallery.search.setFocus()

    QTest.keyClick(page.gallery.search, Qt.Key.Key_Down)
    first, second = page.gallery.shown[:2]
    qtbot.waitUntil(lambda: first.picture.is_acting)
    QTest.keyClick(first, Qt.Key.Key_Right)

    qtbot.waitUntil(lambda: second.picture.is_acting and not first.picture.is_acting)


def test_nothing_moves_where_the_computer_is_set_to_move_little(
    window: MainWindow, page: StartPage, qtbot: QtBot
) -> None:
    picture = page.big_picture.picture
    qtbot.waitUntil(lambda: picture.is_acting)
    picture.act(False)
    picture.setStyleSheet("* { widget-animation-duration: 0; }")  # as the system's style says it

    picture.act()
    QTest.qWait(200)

    assert not picture.is_acting


def test_every_example_has_robots_that_act_and_all_are_small() -> None:
    files = [picture_file(example.path.stem) for example in examples()]

    for file in files:
        reader = QImageReader(str(file))
        assert reader.imageCount() > 10 and reader.read().hasAlphaChannel(), file.name
    assert sum(file.stat().st_size for file in files) < 167_000 * len(files)
    assert {file.name for file in files} == {one.name for one in files[0].parent.iterdir()}


# The person's own


@pytest.fixture
def mine(window: MainWindow, page: StartPage, tmp_path: Path) -> Path:
    """A project of the person, opened before, beside one that is gone."""
    mine = tmp_path / "mine.nep"
    mine.write_bytes(QUIZ.read_bytes())
    window.settings.add_recent(tmp_path / "gone.nep")
    window.settings.add_recent(mine)
    window.files.recent_changed.emit()
    return mine


def test_a_recent_project_opens_by_a_click(
    window: MainWindow, page: StartPage, mine: Path, qtbot: QtBot
) -> None:
    click(page.recent_cards[mine])

    qtbot.waitUntil(lambda: window.files.document is not None)
    assert window.files.document.path == mine


def test_a_recent_project_shows_its_blocks_and_when_it_was_changed(
    page: StartPage, mine: Path, qtbot: QtBot
) -> None:
    card = page.recent_cards[mine]

    qtbot.waitUntil(lambda: card.picture.pixmap().width() >= card.picture_size().width())
    assert card.when.text().startswith("Changed ")
    assert card.accessibleName().startswith("mine. Changed ")


def test_a_project_that_is_gone_says_so_and_can_be_removed(
    window: MainWindow, page: StartPage, mine: Path, qtbot: QtBot
) -> None:
    gone = mine.with_name("gone.nep")
    card = page.recent_cards[gone]
    qtbot.waitUntil(lambda: card.remove_button.isVisible())
    assert card.when.text() == "Not there any more"
    click(card)
    assert window.files.document is None

    click(card.remove_button)

    assert list(page.recent_cards) == [mine]
    assert window.settings.recent_files == [mine]


# The gallery


def test_every_example_has_a_card_with_what_it_needs(page: StartPage) -> None:
    assert list(page.cards) == [example.path for example in examples()]
    card = page.cards[QUIZ]
    words = "Next step. Somebody who touches it. Somebody who answers. 1 minute"
    assert card.accessibleName().startswith("Question and answer. NAO asks")
    assert card.accessibleDescription() == words
    assert "Say “eight”" in card.toolTip()


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

    assert found == ["Question and answer", "Quiz from a table", "Touch game"]
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
