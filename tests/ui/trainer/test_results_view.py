"""The results as a person sees them: words, the table, the curves, and what they ask for."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible, QColor
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from faults import Fault, Text
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.results.confusion import ConfusionView
from nep_studio.ui.plugins.gestures.results.labels import contrast, legible
from nep_studio.ui.plugins.gestures.results.training import Training, worker_ended
from nep_studio.ui.plugins.gestures.results.view import ResultsView
from nep_studio.ui.plugins.gestures.results.worker import Ended
from nep_studio.ui.theme.colours import mixed, themes
from nep_studio.ui.words import use_language
from tests.ui.trainer.results_controller import desk, look
from tests.ui.trainer.results_material import put_gestures, report
from tests.ui.window_eye import WindowEye

__all__ = ["desk", "look"]

NAMES = {"karate": "Karate", "katana": "Katana"}
REPORT = report(
    [
        ("karate", "karate", 8),
        ("karate", "katana", 2),
        ("katana", "katana", 9),
        ("katana", "", 1),
        ("", "karate", 1),
    ],
    {"karate": 10, "katana": 10},
    left_out=[("karate", 3, 0.5, "katana"), ("karate", 7, 0.5, "katana")],
    rate=6.0,
)


@pytest.fixture
def view(desk: GestureController, qtbot: QtBot) -> Iterator[ResultsView]:
    training = Training(desk, command=lambda: ["/no/such/program"])
    training.trains_by_itself = False
    made = ResultsView(desk, training)
    qtbot.addWidget(made)
    made.resize(420, 1200)
    made.show()
    yield made
    made.hide()
    training.close()
    use_language("en")


@pytest.fixture
def shown(view: ResultsView, desk: GestureController) -> ResultsView:
    """The results of two gestures, one of which is mistaken for the other."""
    put_gestures(desk, {"trees": REPORT, "gmr": {**REPORT, "confusion": []}}, NAMES)
    return view


def cell(table: ConfusionView, row: int, column: int) -> QPoint:
    return table.visualRect(table.model().index(row, column)).center()


def test_before_anything_was_learned_it_says_what_to_do(view: ResultsView) -> None:
    assert "Add a gesture" in view.bar.status.text()
    assert not view.bar.button.isEnabled()
    assert not view.found.isVisible()


def test_words_come_first_and_their_buttons_ask_for_what_helps(
    shown: ResultsView, qtbot: QtBot
) -> None:
    row = shown.advice.rows[0]

    assert "mistaken for “Katana” 2 times in 10" in row.words.text()
    assert row.accessibleName().startswith("To do better: ")
    with qtbot.waitSignal(shown.record_asked) as asked:
        qtbot.mouseClick(row.button, Qt.MouseButton.LeftButton)
    assert asked.args == ["karate"]
    with qtbot.waitSignal(shown.takes_asked) as asked:
        qtbot.mouseClick(row.show_takes, Qt.MouseButton.LeftButton)
    assert asked.args == [("karate_3", "karate_7")]


def test_the_table_counts_nothing_as_a_class_and_says_each_cell_in_words(
    shown: ResultsView,
) -> None:
    model = shown.table.confusion

    def said(row: int, column: int) -> str:
        return model.sentence(model.index(row, column))

    assert [model.headerData(at, Qt.Orientation.Horizontal) for at in range(3)] == [
        "Karate",
        "Katana",
        "nothing",
    ]
    assert said(0, 0) == "“Karate” was recognised 8 times in 10"
    assert said(0, 1) == "“Karate” was taken for “Katana” 2 times in 10"
    assert said(1, 2) == "“Katana” was missed once in 10"
    assert said(2, 0) == "Nothing was made, but “Karate” was recognised once"
    assert "not counted" in said(2, 2)
    assert model.data(model.index(0, 1)) == "2"
    assert model.data(model.index(1, 0)) == ""


def test_a_click_and_a_key_on_a_cell_ask_for_its_takes(shown: ResultsView, qtbot: QtBot) -> None:
    table = shown.table

    with qtbot.waitSignal(shown.takes_asked) as asked:
        qtbot.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, pos=cell(table, 0, 1))
    assert asked.args == [("karate_3", "karate_7")]
    with qtbot.assertNotEmitted(shown.takes_asked):
        qtbot.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, pos=cell(table, 1, 0))
    table.setCurrentIndex(table.model().index(0, 0))
    qtbot.keyClick(table, Qt.Key.Key_Right)
    with qtbot.waitSignal(table.cell_chosen) as chosen:
        qtbot.keyClick(table, Qt.Key.Key_Return)
    assert chosen.args == ["karate", "katana"]


def test_screen_readers_find_a_table_with_sentences(shown: ResultsView) -> None:
    table = QAccessible.queryAccessibleInterface(shown.table)

    children = [table.child(at) for at in range(table.childCount())]
    words = [child.text(QAccessible.Text.Name) for child in children if child is not None]

    assert table.role() == QAccessible.Role.Table
    assert "“Karate” was taken for “Katana” 2 times in 10" in words
    assert {"Karate", "Katana", "nothing"} <= set(words)


def test_the_other_recogniser_has_its_own_table(shown: ResultsView) -> None:
    shown.method.setCurrentIndex(1)

    assert shown.tuning.method == "gmr"
    assert shown.table.confusion.data(shown.table.confusion.index(0, 0)) == ""


def test_dragging_on_the_curves_shows_both_sides_and_is_one_step(
    shown: ResultsView, desk: GestureController, qtbot: QtBot
) -> None:
    curve, words = shown.points.curve, shown.points.sentence
    middle = round(curve.area().center().y())
    before, steps = words.text(), desk.editor.history.steps

    def at(certainty: float) -> QPoint:
        return QPoint(round(curve.x_of(certainty)), middle)

    qtbot.mousePress(curve, Qt.MouseButton.LeftButton, pos=at(0.75))
    said = set()
    for certainty in (0.7, 0.6, 0.5):
        qtbot.mouseMove(curve, at(certainty))
        said.add(words.text())
    assert desk.editor.history.steps == steps
    qtbot.mouseRelease(curve, Qt.MouseButton.LeftButton, pos=at(0.5))

    assert before == "Caught 5 of 10 — false about 0.9 times an hour"
    assert len(said) == 3
    assert desk.editor.history.steps == steps + 1
    assert abs(desk.gestures["karate"].certainty - 0.5) <= 0.01
    shown.points.reset.click()
    assert desk.gestures["karate"].certainty == 0.75


def test_a_point_that_is_not_dragged_stays(shown: ResultsView, desk: GestureController) -> None:
    steps = desk.editor.history.steps

    shown.points.choose("katana")
    shown.points.slider.keep()

    assert shown.points.slider.accessibleName() == "Recognition point of “Katana”"
    assert desk.editor.history.steps == steps


def test_a_failure_is_shown_with_its_checklist_until_the_next_training(
    view: ResultsView,
) -> None:
    view.training.problem = worker_ended(Ended(1, "MemoryError"))
    view.training.changed.emit()
    assert view.failure.isVisible()

    view.training.problem = None
    view.training.changed.emit()

    assert not view.failure.isVisible()


def test_a_remark_that_the_advice_tells_too_is_left_out_in_any_language(
    shown: ResultsView,
) -> None:
    shown.training.remarks = (
        Fault("few_takes", Text("Zu wenige Durchgänge.")),
        Fault("left_out", Text("{count} Zeilen fehlen.", {"count": 3})),
    )
    shown.training.changed.emit()

    told = [row.advice.words for row in shown.advice.rows]
    shown.advice.more.click()
    told += [row.advice.words for row in shown.advice.rows]

    assert "3 Zeilen fehlen." in told
    assert "Zu wenige Durchgänge." not in told


def test_a_recogniser_without_a_report_shows_no_table(
    view: ResultsView, desk: GestureController
) -> None:
    put_gestures(desk, {}, NAMES)

    assert not view.found.isVisible()
    assert view.training.is_stale


@pytest.mark.parametrize("theme", themes())
def test_numbers_can_be_read_on_every_shade(theme: str, look) -> None:
    look.choose(theme)
    colours = look.theme

    for ground in ("plot_1", "plot_2"):
        for part in range(0, 86, 5):
            fill = mixed(colours.colour("field"), colours.colour(ground), part / 100)
            ink = legible(fill, colours.colour("text"), colours.colour("field"))
            assert contrast(fill, ink) >= 4.5
    assert contrast(QColor("black"), QColor("white")) == pytest.approx(21.0)


def test_twenty_gestures_in_every_look_and_from_the_right(
    view: ResultsView, desk: GestureController, look, qapp: QApplication
) -> None:
    names = {f"g{at}": f"Donaudampfschifffahrt number {at}" for at in range(20)}
    pairs = [(name, name, 8) for name in names]
    many = report([*pairs, ("g1", "g2", 2)], dict.fromkeys(names, 10))

    put_gestures(desk, {"trees": many, "gmr": many}, names)
    for theme in themes():
        look.choose(theme)
        assert not view.grab().isNull()
    look.set_scale(2.0)
    use_language("qps-rtl")
    qapp.setLayoutDirection(Qt.LayoutDirection.RightToLeft)
    view.refresh()
    try:
        assert not view.grab().isNull()
        assert view.table.horizontalScrollBar().maximum() > 0
        assert view.minimumSizeHint().width() < 420
    finally:
        qapp.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        look.set_scale(1.0)


def test_no_part_of_the_results_is_a_window_for_a_moment(
    view: ResultsView, desk: GestureController, qapp: QApplication
) -> None:
    with WindowEye(qapp) as eye:
        put_gestures(desk, {"trees": REPORT}, NAMES)

    assert view.advice.rows
    assert not eye.seen
