"""Messages to the person: cards over the canvas, never in the way, always with what to do."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
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


def test_many_answers_stand_in_rows_and_are_read_whole(karate: MainWindow, qtbot: QtBot) -> None:
    words = ("Use the robot on the screen", "Find it and test the connection", "Show the block")
    karate.resize(900, 600)

    karate.messages.tell(
        Message("error", "NAO does not answer", answers=[Answer(one, print) for one in words])
    )

    [card] = cards(karate)
    qtbot.waitUntil(lambda: len({button.y() for button in card.buttons}) > 1)
    for button in card.buttons:
        assert button.width() >= button.minimumSizeHint().width()
        assert card.rect().contains(button.geometry())


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


def test_a_message_lies_at_the_foot_of_the_canvas_below_the_tabs(karate: MainWindow) -> None:
    karate.resize(1366, 728)
    tabs, canvas = karate.workbench.pages_bar, karate.workbench.canvas.viewport()

    for number in range(3):
        karate.messages.tell(Message("error", f"NAO {number} is away", "It is far away. " * 8))

    area = karate.message_area
    covered = QRect(area.mapTo(karate, QPoint()), area.size())
    ground = QRect(canvas.mapTo(karate, QPoint()), canvas.size())
    assert ground.contains(covered)
    assert covered.bottom() == ground.bottom()
    assert not covered.intersects(QRect(tabs.mapTo(karate, QPoint()), tabs.size()))


def test_a_failing_block_is_scrolled_out_from_under_its_message(karate: MainWindow) -> None:
    karate.resize(1366, 728)
    workbench = karate.workbench
    canvas, editor = workbench.canvas, karate.files.document.editor
    block = editor.create("robot.say", editor.new_stack("behaviour", 60.0, 3000.0))
    workbench.show_block(block)  # it is at the lower edge now

    karate.messages.tell(Message("error", "NAO does not answer", "It is far away. " * 20))

    rect = canvas.sight.view_rect_of(block)
    top = canvas.viewport().mapFromGlobal(karate.message_area.mapToGlobal(QPoint())).y()
    assert rect.top() > 0 and rect.bottom() <= top


def test_esc_closes_the_newest_message_once_it_means_nothing_else(
    karate: MainWindow, qtbot: QtBot
) -> None:
    canvas = karate.workbench.canvas
    canvas.setFocus()
    karate.workbench.show_block(canvas.editor.project.pages["behaviour"][0].body[0])
    karate.messages.tell(Message("error", "NAO does not answer"))
    karate.messages.tell(Message("error", "Pepper does not answer"))

    qtbot.keyClick(canvas, Qt.Key.Key_Escape)
    assert canvas.selection.ids == () and len(cards(karate)) == 2
    qtbot.keyClick(canvas, Qt.Key.Key_Escape)

    assert [card.message.title for card in cards(karate)] == ["NAO does not answer"]


def test_what_is_going_on_is_given_up_by_the_cross(karate: MainWindow, qtbot: QtBot) -> None:
    given_up = []
    stop = Answer("Cancel", lambda: given_up.append(1))
    karate.messages.tell(Message("info", "Opening…", answers=(stop,), is_busy=True))

    qtbot.mouseClick(cards(karate)[0].close_button, LEFT)

    assert given_up == [1] and cards(karate) == []


@pytest.mark.parametrize("leave", ["new", "close"])
def test_messages_go_with_their_project(karate: MainWindow, leave: str) -> None:
    karate.messages.tell(Message("error", "NAO does not answer"))
    karate.messages.tell(Message("info", "There is a new version", outlives_project=True))

    karate.actions_by_name[leave].trigger()

    assert [card.message.title for card in cards(karate)] == ["There is a new version"]


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
