"""The toolbar in narrow windows, the titles of panels, and where Enter leads."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QToolButton

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.ui.actions import sequences, shortcuts_of
from nep_studio.ui.message_cards import QuestionDialog
from nep_studio.ui.messages import Answer, Message

WITH_WORDS = Qt.ToolButtonStyle.ToolButtonTextBesideIcon


def button(window, name: str) -> QToolButton:
    return window.toolbar.widgetForAction(window.actions_by_name[name])


@pytest.mark.parametrize("language", ["en", "de", "ja"])
def test_run_and_stop_keep_their_words_and_no_button_is_hidden(karate, qtbot, language) -> None:
    karate.studio.choose_language(language)

    for width in (1024, 1280, 1600):
        karate.resize(width, 700)

        qtbot.waitUntil(lambda width=width: has_room(karate, width))
        assert {button(karate, name).toolButtonStyle() for name in ("run", "stop")} == {WITH_WORDS}


def has_room(window, width: int) -> bool:
    return window.toolbar.sizeHint().width() <= window.width() == width


def test_stop_does_not_move_when_run_says_something_else(karate, qtbot) -> None:
    run = karate.actions_by_name["run"]
    before = button(karate, "stop").pos(), button(karate, "settings").pos()

    run.setIconText("Run again")
    karate.toolbar.layout().activate()

    assert (button(karate, "stop").pos(), button(karate, "settings").pos()) == before


@pytest.mark.parametrize("width", [1100, 1366])
def test_nothing_moves_on_the_toolbar_while_problems_come_and_go(karate, qtbot, width) -> None:
    karate.resize(width, 700)
    karate.workbench.checks.cancel()
    places = set()

    for count in (0, 1, 3, 12):
        karate._on_problems_found(
            [Diagnostic("error", "x", "behaviour", f"b{n}", "wrong") for n in range(count)]
        )
        karate.toolbar.layout().activate()
        names = ("check", "stop", "settings", "undo")
        places.add(tuple(button(karate, name).geometry().getRect() for name in names))

    assert len(places) == 1


def test_run_is_not_white_on_white_in_its_menu(karate) -> None:
    picture = karate.actions_by_name["run"].icon().pixmap(32).toImage()

    inks = {picture.pixelColor(x, y).name() for x in range(32) for y in range(32)}
    assert karate.look.theme.colour("text").name() in inks


def test_no_title_is_cut_however_many_panels_are_open(karate) -> None:
    area = karate.workbench.panels.areas["right"]
    for panel in karate.workbench.panels.all:
        if panel.area is area:
            karate.workbench.panels.show(panel.widget)

    bar = area.tabBar()
    last = bar.tabRect(area.currentIndex())
    assert bar.tabText(area.currentIndex())
    assert last.right() <= area.width() - area.close_button.width()


def test_enter_means_the_answer_that_is_led_to(karate, qtbot) -> None:
    said: list[str] = []
    answers = tuple(
        Answer(words, lambda words=words: said.append(words), look)
        for words, look in (("Save", "primary"), ("Don't save", ""), ("Cancel", ""))
    )
    dialog = QuestionDialog(Message("warning", "Save?", answers=answers), karate)
    dialog.open()

    qtbot.keyClick(dialog, Qt.Key.Key_Return)

    assert said == ["Save"]


def test_keys_that_no_keyboard_has_are_not_listed(karate) -> None:
    action = QAction("Undo", karate)
    action.setShortcuts(sequences(("Ctrl+Z", "Undo", "F5")))

    assert shortcuts_of([action]) == [("Undo", "Ctrl+Z, F5")]


def test_another_language_shows_the_same_place_and_another_direction_the_beginning(karate) -> None:
    karate.workbench.canvas.sight.zoom(0.8)
    karate.workbench.canvas.sight.pan(60, 90)
    before = replace(karate.workbench.canvas.sight.camera)

    karate.studio.choose_language("de")

    after = karate.workbench.canvas.sight.camera
    assert (after.x, after.y, after.scale) == pytest.approx((before.x, before.y, 0.8), abs=0.5)

    karate.studio.choose_language("qps-rtl")

    canvas = karate.workbench.canvas
    seen, blocks = canvas.sight.visible_page_rect(), canvas.page_layout.index.bounds()
    assert seen.x < blocks.right < seen.right
