"""What is done with gestures and takes by hand: mouse, keys, menus and drags."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt
from PySide6.QtGui import QAction, QDropEvent
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.page import TrainerPage
from nep_studio.ui.plugins.gestures.samples import TAKES_MIME
from tests.ui.trainer.test_gesture_controller import samples
from tests.ui.trainer.trainer_data import rest

pytestmark = pytest.mark.long


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


def test_a_take_is_looked_at_trimmed_by_mouse_and_keys_and_played(
    page: TrainerPage, desk: GestureController, qtbot: QtBot
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
    steps = desk.editor.history.steps
    for _ in range(2):
        qtbot.keyPress(strip, Qt.Key.Key_Right)
    qtbot.keyRelease(strip, Qt.Key.Key_Right)
    assert desk.editor.history.steps == steps + 1
    assert desk.gestures[name].takes[0].start_s == pytest.approx(take.start_s + 0.04)
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
    page: TrainerPage, desk: GestureController, qtbot: QtBot
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


def test_menus_leave_out_relabel_and_delete(page: TrainerPage, desk: GestureController) -> None:
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


def test_the_graph_of_a_silent_sensor_is_drawn_once_more_and_then_rests(
    page: TrainerPage, push, clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    push(*rest(1.0))
    page.strip._on_frame()
    drawn: list[str] = []
    monkeypatch.setattr(page.strip, "update", lambda: drawn.append("again"))

    clock.time_s += 10.0
    for _ in range(5):
        page.strip._on_frame()

    assert drawn == ["again"]


def test_another_silent_sensor_is_drawn_once_it_is_chosen(
    page: TrainerPage, desk: GestureController, push, clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    for source in ("watch", "phone"):
        push(*rest(1.0), source=source)
    clock.time_s += 10.0
    page.strip._on_frame()
    drawn: list[str] = []
    monkeypatch.setattr(page.strip, "update", lambda: drawn.append("again"))

    desk.use_source("phone")

    assert drawn


def test_takes_dropped_on_a_card_are_of_its_gesture(
    page: TrainerPage, desk: GestureController
) -> None:
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


def test_a_name_is_typed_on_the_card(
    page: TrainerPage, desk: GestureController, qtbot: QtBot
) -> None:
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
    page: TrainerPage, desk: GestureController, qtbot: QtBot
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
