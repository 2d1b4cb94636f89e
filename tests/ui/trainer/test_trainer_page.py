"""The panel in the window, used as a person does: with mouse, keys, menus and drags."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt
from PySide6.QtGui import QAction, QDropEvent
from PySide6.QtWidgets import QMenu, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.hint import hint_words, next_step
from nep_studio.ui.trainer.page import TrainerPage
from nep_studio.ui.trainer.shape import shape_for
from nep_studio.ui.trainer.takes_list import TAKES_MIME
from tests.ui.trainer.test_trainer_desk import samples
from tests.ui.trainer.trainer_data import rest, takes


def with_takes(page: TrainerPage, title: str, count: int = 3) -> str:
    name = page.keeping.new_gesture(title)
    spans = [(0.5 + at, 1.2 + at) for at in range(count)]
    page.keeping.keep_session(name, samples(count + 1.0), spans)
    page.cards.refresh()
    return name


def choose(menu: QMenu, words: str) -> None:
    """Choose an entry of a menu."""
    entries: list[QAction] = [one for one in menu.actions() if one.text() == words]
    assert entries, [one.text() for one in menu.actions()]
    entries[0].trigger()
    menu.deleteLater()


def test_from_the_name_to_five_takes_with_keys_alone(
    page: TrainerPage, desk: TrainerDesk, push, qtbot: QtBot
) -> None:
    assert next_step(desk) == ("connect", "")
    push(*rest(2.0))
    assert next_step(desk) == ("name", "")

    page.cards.new_name.setFocus()
    qtbot.keyClicks(page.cards.new_name, "Wave")
    qtbot.keyClick(page.cards.new_name, Qt.Key.Key_Return)
    assert next_step(desk) == ("record", "wave")
    assert page.bar.button.text() == "Record “Wave”"

    page.strip.setFocus()
    qtbot.keyClick(page.strip, Qt.Key.Key_Space)
    assert page.session.state == "countdown"
    assert page.strip.big_words == "3"
    assert not page.head.isVisible()
    page.session.skip_countdown()
    push(*takes(2))
    assert page.strip.big_words == "2 of 5"
    page.strip.grab()
    qtbot.keyClick(page.strip, Qt.Key.Key_Escape)

    assert len(desk.gestures["wave"].takes) == 2
    assert page.bar.words.text() == "2 takes are kept."
    assert next_step(desk) == ("more", "wave")
    assert hint_words(desk) == "Record “Wave” once more."
    assert page.head.isVisible()


def test_without_a_watch_record_says_what_is_missing(page: TrainerPage, qtbot: QtBot) -> None:
    name = with_takes(page, "Wave")
    page.cards.cards[name].record.click()

    assert page.bar.words.text().startswith("Nothing is heard yet.")
    assert not page.session.is_on


def test_the_connect_button_asks_for_a_watch(page: TrainerPage, qtbot: QtBot) -> None:
    with qtbot.waitSignal(page.connect_asked):
        qtbot.mouseClick(page.head.watch.button, Qt.MouseButton.LeftButton)


def test_a_take_is_looked_at_trimmed_by_mouse_and_keys_and_played(
    page: TrainerPage, desk: TrainerDesk, qtbot: QtBot
) -> None:
    name = with_takes(page, "Wave")
    card, strip = page.cards.cards[name], page.strip
    take = desk.gestures[name].takes[0]

    qtbot.mouseClick(card.takes, Qt.MouseButton.LeftButton, pos=card.takes.grid.rect(0).center())
    assert desk.chosen_take == take.id
    page.grab()

    window = strip.window_shown
    y = strip.height() // 2
    qtbot.mousePress(strip, Qt.MouseButton.LeftButton, pos=QPoint(round(window.x(take.end_s)), y))
    qtbot.mouseMove(strip, QPoint(round(window.x(take.end_s - 0.2)), y))
    qtbot.mouseRelease(
        strip, Qt.MouseButton.LeftButton, pos=QPoint(round(window.x(take.end_s - 0.2)), y)
    )
    assert desk.gestures[name].takes[0].end_s == pytest.approx(take.end_s - 0.2, abs=0.02)

    strip.setFocus()
    qtbot.keyClick(strip, Qt.Key.Key_Home)
    qtbot.keyClick(strip, Qt.Key.Key_Right)
    assert desk.gestures[name].takes[0].start_s == pytest.approx(take.start_s + 0.02)
    qtbot.keyClick(strip, Qt.Key.Key_Space)
    assert page.take.cursor_s is not None
    qtbot.waitUntil(lambda: page.take.cursor_s is None)
    qtbot.keyClick(strip, Qt.Key.Key_Escape)
    assert not desk.chosen_take
    desk.editor.history.undo()
    desk.editor.history.undo()
    desk.refresh()
    assert desk.gestures[name].takes[0] == take


def test_takes_are_chosen_and_deleted_by_keys(
    page: TrainerPage, desk: TrainerDesk, qtbot: QtBot
) -> None:
    name = with_takes(page, "Wave")
    listed, ids = page.cards.cards[name].takes, [t.id for t in desk.gestures[name].takes]
    listed.setFocus()

    qtbot.keyClick(listed, Qt.Key.Key_Right)
    assert listed.chosen == [ids[1]]
    assert listed.item_text(1).startswith("Take 2, 0.7 s, Me")
    qtbot.keyClick(listed, Qt.Key.Key_Return)
    assert desk.chosen_take == ids[1]
    qtbot.keyClick(listed, Qt.Key.Key_Delete)

    assert [t.id for t in desk.gestures[name].takes] == [ids[0], ids[2]]
    assert not desk.chosen_take


def test_menus_leave_out_relabel_and_delete(page: TrainerPage, desk: TrainerDesk) -> None:
    wave, blow = with_takes(page, "Wave"), with_takes(page, "Blow", 1)
    listed = page.cards.cards[wave].takes
    listed._go_to(0)
    take = listed.chosen[0]

    choose(page.menus.of_take(wave), "Do not learn from it")
    assert desk.gestures[wave].takes[0].left_out
    choose(page.menus.of_take(wave), "Blow")
    assert take in [one.id for one in desk.gestures[blow].takes]
    choose(page.menus.of_gesture(wave), "Delete the gesture with its takes")
    assert list(desk.gestures) == [blow]
    page.cards.refresh()
    assert list(page.cards.cards) == [blow]


def test_takes_dropped_on_a_card_are_of_its_gesture(page: TrainerPage, desk: TrainerDesk) -> None:
    wave, blow = with_takes(page, "Wave"), with_takes(page, "Blow", 1)
    take, card = desk.gestures[wave].takes[0].id, page.cards.cards[blow]
    data = QMimeData()
    data.setData(TAKES_MIME, take.encode())

    card.dropEvent(
        QDropEvent(
            QPointF(5, 5),
            Qt.DropAction.MoveAction,
            data,
            Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.NoModifier,
        )
    )

    assert desk.find_take(take)[0] == blow


def test_a_name_is_typed_on_the_card(page: TrainerPage, desk: TrainerDesk, qtbot: QtBot) -> None:
    name = with_takes(page, "Wave")
    title = page.cards.cards[name].title

    page.cards.cards[name].edit_title()
    qtbot.keyClicks(title, "Hello there")
    qtbot.keyClick(title, Qt.Key.Key_Return)

    assert desk.gestures[name].title == "Hello there"
    title.clear()
    qtbot.keyClick(title, Qt.Key.Key_Return)
    assert title.text() == "Hello there"


def test_the_chip_is_dragged_onto_the_canvas_and_a_click_adds_the_block(
    page: TrainerPage, canvas: Canvas, qtbot: QtBot
) -> None:
    name = with_takes(page, "Wave")
    chip = page.cards.cards[name].chip
    start, viewport = chip.rect().center(), canvas.viewport()
    target = chip.mapFromGlobal(viewport.mapToGlobal(QPoint(120, 100)))

    qtbot.mousePress(chip, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 9):
        qtbot.mouseMove(chip, start + (target - start) * step / 8)
    qtbot.mouseRelease(chip, Qt.MouseButton.LeftButton, pos=target)

    def blocks() -> list[object]:
        return [one.fields.get("gesture") for one in canvas.editor.project.blocks.values()]

    assert blocks() == [name]
    chip.setFocus()
    qtbot.keyClick(chip, Qt.Key.Key_Space)
    assert blocks() == [name, name]
    qtbot.mouseClick(chip, Qt.MouseButton.LeftButton)
    assert blocks() == [name, name, name]


def test_people_are_added_renamed_and_deleted(
    page: TrainerPage, desk: TrainerDesk, qtbot: QtBot
) -> None:
    with_takes(page, "Wave")
    wearer = page.bar.wearer

    wearer.add_person("Ana")
    assert desk.person == "Ana"
    with_takes(page, "Blow")
    assert [wearer.person.itemText(row) for row in range(wearer.person.count())] == ["Ana", "Me"]
    wearer.wrist.setCurrentIndex(2)
    wearer.wrist.activated.emit(2)
    assert desk.wrist == "hand"
    choose(wearer.menu(), "Delete Ana with all takes")

    assert desk.people == ["Me"]
    assert not desk.gestures["blow"].takes


def test_everyday_movement_is_recorded_from_its_menu(
    page: TrainerPage, desk: TrainerDesk, push
) -> None:
    push(*rest(1.0))

    choose(page.menus.of_everyday(page.record_everyday), "Record 30 seconds")
    page.session.skip_countdown()
    push(*rest(15.0))
    assert page.bar.progress.value() == pytest.approx(50, abs=3)
    page.bar.button.click()

    assert "of everyday movement are kept" in page.bar.words.text()
    assert [one.everyday for one in desk.recordings.values()] == [True]


def test_what_the_results_ask_for_is_done(page: TrainerPage, desk: TrainerDesk, push) -> None:
    name = with_takes(page, "Wave")
    take = desk.gestures[name].takes[1].id

    page.results.takes_asked.emit((take,))
    assert desk.chosen_take == take
    push(*rest(1.0))
    page.results.record_asked.emit(name)
    assert page.session.gesture == name
    assert not desk.chosen_take


@pytest.mark.parametrize(
    ("wide", "high", "is_tabbed", "is_beside", "has_cards_beside"),
    [
        (100, 20, False, True, True),
        (60, 50, False, True, False),
        (35, 20, True, False, True),
        (20, 60, True, False, False),
    ],
)
def test_the_parts_are_arranged_by_the_room(
    wide: float, high: float, is_tabbed: bool, is_beside: bool, has_cards_beside: bool
) -> None:
    shape = shape_for(wide, high)

    assert (shape.is_tabbed, shape.is_beside) == (is_tabbed, is_beside)
    assert shape.has_cards_beside == has_cards_beside


def test_the_page_can_be_made_narrow_and_wide(page: TrainerPage, qtbot: QtBot) -> None:
    with_takes(page, "A gesture with quite a long name, longer than there is room")
    outer = QWidget()
    qtbot.addWidget(outer)
    page.setParent(outer)
    line = page.fontMetrics().height()

    for wide, high in ((16, 60), (100, 20), (60, 60), (32, 20)):
        page.resize(wide * line, high * line)
        outer.resize(page.size())
        outer.show()
        page.show()
        page.grab()

    assert page.tabs.indexOf(page.inner) == 0


def test_forty_gestures_with_twenty_takes_are_shown_at_once(
    page: TrainerPage, desk: TrainerDesk, qtbot: QtBot
) -> None:
    spans = [(0.5 + at, 1.2 + at) for at in range(20)]
    with desk.editor.transaction("many"):
        for number in range(40):
            name = page.keeping.new_gesture(f"Gesture {number}")
            page.keeping.keep_session(name, samples(21.0, rate_hz=20), spans)
    page.cards.refresh()

    page.grab()

    assert len(page.cards.cards) == 40
    assert len(page.cards._pictures._kept) < 200  # only those in view were painted


def test_a_recording_ends_with_its_project_and_says_when_its_gesture_is_gone(
    page: TrainerPage, desk: TrainerDesk, push
) -> None:
    name = page.keeping.new_gesture("Wave")
    push(*rest(2.0))
    page.record(name)
    page.session.skip_countdown()
    push(*takes(2))

    page.keeping.delete_gesture(name)
    page.record_or_stop()
    assert page.bar.words.text().startswith("The takes could not be kept.")

    again = page.keeping.new_gesture("Wave")
    page.cards.refresh()
    page.record(again)
    desk.files.new()
    assert not page.session.is_on
    assert not desk.recordings


def test_the_menu_with_more_imports_exports_and_beeps(page: TrainerPage) -> None:
    class Asked:
        """Notes what was asked for."""

        def __init__(self) -> None:
            self.asked: list[str] = []

        def choose_file(self, *_what: object) -> None:
            self.asked.append("file")

        def choose_folder(self, *_what: object) -> None:
            self.asked.append("folder")

        def choose_place(self, *_what: object) -> None:
            self.asked.append("place")

    page.exchange.files = Asked()
    page.desk.files.document.folder, page.desk.files.document.title = "", "Mine"
    page.exchange._folder = lambda: Path()
    assert [is_possible for *_, is_possible in page.exchange.entries()] == [
        True,
        True,
        False,
        False,
    ]
    with_takes(page, "Wave")

    for _sign, _words, do, is_possible in page.exchange.entries():
        assert is_possible
        do()
    page._on_beep_chosen(True)

    assert page.exchange.files.asked == ["file", "folder", "folder", "place"]
    assert page.beeps
