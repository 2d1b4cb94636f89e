"""The panel in the window, used as a person does: with mouse, keys, menus and drags."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.gestures import menus
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.page import TrainerPage, hint_words, next_step, shape_for
from tests.ui.trainer.test_gesture_controller import samples
from tests.ui.trainer.test_trainer_by_hand import choose, with_takes
from tests.ui.trainer.trainer_data import rest, takes

pytestmark = pytest.mark.long


def test_from_the_name_to_five_takes_with_keys_alone(
    page: TrainerPage, desk: GestureController, push, qtbot: QtBot
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
    page.record(name)

    assert page.bar.words.text().startswith("Nothing is heard yet.")
    assert not page.session.is_on


def test_the_connect_button_asks_for_a_watch(page: TrainerPage, qtbot: QtBot) -> None:
    with qtbot.waitSignal(page.connect_asked):
        qtbot.mouseClick(page.head.watch.button, Qt.MouseButton.LeftButton)


def test_everyday_movement_is_recorded_from_its_menu(
    page: TrainerPage, desk: GestureController, push
) -> None:
    push(*rest(1.0))

    choose(page.menus.of_everyday(page.record_everyday), "Record 30 seconds")
    page.session.skip_countdown()
    push(*rest(15.0))
    assert page.bar.progress.value() == pytest.approx(50, abs=3)
    page.bar.button.click()

    assert "of everyday movement are kept" in page.bar.words.text()
    assert [one.everyday for one in desk.recordings.values()] == [True]


def test_what_the_results_ask_for_is_done(page: TrainerPage, desk: GestureController, push) -> None:
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
    page: TrainerPage, desk: GestureController, qtbot: QtBot
) -> None:
    spans = [(0.5 + at, 1.2 + at) for at in range(20)]
    with desk.editor.transaction("many"):
        for number in range(40):
            name = page.keeping.new_gesture(f"Gesture {number}")
            page.keeping.keep_session(name, samples(21.0, rate_hz=20), spans)
    page.cards.refresh()

    page.grab()

    assert len(page.cards.cards) == 40
    assert (
        page.cards._pictures.picture.cache_info().currsize < 200
    )  # only those in view were painted


def test_a_recording_ends_with_its_project_and_says_when_its_gesture_is_gone(
    page: TrainerPage, desk: GestureController, push
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


def test_the_menu_with_more_imports_exports_and_beeps(
    page: TrainerPage, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[Path, str]] = []

    def ask_for_path(
        _over: object,
        _title: str,
        start: Path,
        _then: object,
        mode: str = "open",
        kinds: object = (),
    ) -> None:
        asked.append((start, mode))

    monkeypatch.setattr(menus, "ask_for_path", ask_for_path)
    page.controller.files.document.folder, page.controller.files.document.title = "", "Mine"
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

    assert [mode for _, mode in asked] == ["open", "folder", "folder", "save"]
    assert asked[-1][0].name == "Mine.mcap"
    assert page.beeps
