"""Messages to the person: cards over the canvas, never in the way, always with what to do."""

from __future__ import annotations

import sys
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QPlainTextEdit, QPushButton
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.project import RenameProject
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.shell.crash_handler import LastResort
from nep_studio.ui.shell.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def cards(window: MainWindow):
    return window.message_area.cards


def test_a_refusal_is_told_and_goes_with_the_next_edit(karate: MainWindow) -> None:
    karate.workbench.canvas.news.refused.emit("Nothing goes below this block.")
    told = [card.message.sentence for card in cards(karate)]

    karate.files.document.editor.apply(RenameProject("Next"))

    assert told == ["Nothing goes below this block."]
    assert cards(karate) == []


def test_the_same_refusal_is_shown_once(karate: MainWindow) -> None:
    for _ in range(3):
        karate.messages.refuse("Nothing goes below this block.")

    assert len(cards(karate)) == 1


def test_a_message_is_closed_by_its_cross(karate: MainWindow, qtbot: QtBot) -> None:
    karate.messages.tell(Message("error", "NAO does not answer"))

    qtbot.mouseClick(cards(karate)[0].close_button, LEFT)

    assert cards(karate) == []
    assert not karate.message_area.isVisible()


def test_an_answer_does_what_it_says(karate: MainWindow, qtbot: QtBot) -> None:
    done = []
    karate.messages.tell(Message("info", "Ready", answers=(Answer("Go", lambda: done.append(1)),)))

    qtbot.mouseClick(cards(karate)[0].buttons[0], LEFT)

    assert done == [1]


def test_details_are_shown_and_copied_when_asked_for(karate: MainWindow, qtbot: QtBot) -> None:
    karate.messages.tell(Message("error", "Something went wrong", details="line 7"))
    [card] = cards(karate)
    text = card.findChild(QPlainTextEdit)
    show, copy = card.findChildren(QPushButton)
    was_shown = text.isVisible()

    qtbot.mouseClick(show, LEFT)
    qtbot.mouseClick(copy, LEFT)

    assert not was_shown
    assert text.isVisible()
    assert QGuiApplication.clipboard().text() == "line 7"


def test_an_older_message_waits_where_there_is_no_room_for_both(
    karate: MainWindow, qtbot: QtBot
) -> None:
    sentence = "It is far away. " * 80
    for title in ("NAO does not answer", "Pepper does not answer"):
        karate.messages.tell(Message("error", title, sentence))
    shown = [card.isVisible() for card in cards(karate)]

    qtbot.mouseClick(cards(karate)[1].close_button, LEFT)

    assert shown == [False, True]
    [older] = cards(karate)
    assert older.isVisible()
    qtbot.waitUntil(lambda: older.height() >= older.heightForWidth(older.width()))


def test_a_message_takes_no_room_from_the_canvas(karate: MainWindow, qtbot: QtBot) -> None:
    before = karate.workbench.canvas.geometry()

    karate.messages.tell(Message("error", "NAO does not answer", "It is far away. " * 20))

    assert karate.workbench.canvas.geometry() == before


def test_an_unexpected_error_is_told_once_logged_and_the_work_goes_on(
    karate: MainWindow, tmp_path: Path
) -> None:
    log = tmp_path / "logs" / "studio.log"
    karate.files.document.editor.apply(RenameProject("Kept"))
    with LastResort(log) as last_resort:
        last_resort.watch(karate)
        for _ in range(2):
            try:
                raise ZeroDivisionError("by a fault of ours")
            except ZeroDivisionError as error:
                sys.excepthook(type(error), error, error.__traceback__)

    [card] = cards(karate)
    assert "Your work is kept" in card.message.sentence
    assert "by a fault of ours" in card.message.details
    assert "ZeroDivisionError" in log.read_text(encoding="utf-8")
