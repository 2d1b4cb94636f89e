"""Widgets flow into rows, from the side on which reading begins; columns share the width."""

from __future__ import annotations

import gc
import random

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QApplication, QFrame, QHBoxLayout, QLayout, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.ui.widgets.layouts import COLUMN_LINES, Columns, Flow, FlowLayout


@pytest.fixture
def row(qtbot: QtBot) -> QWidget:
    made = QWidget()
    qtbot.addWidget(made)
    flow = FlowLayout(made, 4)
    for _ in range(6):
        word = QFrame()
        word.setFixedSize(100, 30)
        flow.addWidget(word)
    return made


@pytest.mark.parametrize(("width", "rows"), [(640, 1), (320, 2), (210, 3), (50, 6)])
def test_a_row_that_is_full_is_followed_by_the_next(row: QWidget, width: int, rows: int) -> None:
    assert row.layout().heightForWidth(width) == rows * 30 + (rows - 1) * 4


def test_where_people_read_from_right_to_left_the_first_is_on_the_right(row: QWidget) -> None:
    row.setLayoutDirection(Qt.LayoutDirection.RightToLeft)
    row.resize(320, 100)
    row.show()

    first = row.findChildren(QFrame)[0]
    assert first.geometry().right() == row.width() - 1


def test_a_hidden_widget_takes_no_room(row: QWidget) -> None:
    row.show()
    for word in row.findChildren(QFrame)[1:]:
        word.hide()

    assert row.layout().heightForWidth(210) == 30


def test_columns_are_as_many_as_fit_and_keep_the_order(qtbot: QtBot) -> None:
    widgets = [QWidget() for _ in range(6)]
    for widget in widgets:
        widget.setFixedHeight(100)
    columns = Columns(widgets)
    qtbot.addWidget(columns)
    line = columns.fontMetrics().height()
    columns.show()

    columns.resize(line * COLUMN_LINES * 3, 400)

    assert columns.count == 3
    qtbot.waitUntil(
        lambda: len({widget.mapTo(columns, widget.pos()).x() for widget in widgets}) > 1
    )
    places = [widgets[number].parentWidget().x() for number in range(6)]
    assert places == sorted(places)
    assert len(set(places)) == 3


def test_widgets_that_come_and_go_leave_the_others_in_their_places(qtbot: QtBot) -> None:
    """Qt makes and throws away so many items that one is where another one was in memory."""
    chance = random.Random(1)
    holders: list[tuple[QWidget, QLayout]] = []
    for number in range(300):
        holder = QWidget()
        if chance.random() < 0.5:
            layout: QLayout = Flow(holder, 4, [QPushButton("x") for _ in range(3)])
        else:
            layout = QHBoxLayout(holder)
            for _ in range(2):
                layout.addWidget(QPushButton("y"))
            chance.choice([layout.itemAt(0), layout.itemAt(1)]).widget().deleteLater()
        holders.append((holder, layout))
        if len(holders) > 20:
            holders.pop(chance.randrange(len(holders)))[0].deleteLater()
        for _, flow in holders:
            if isinstance(flow, Flow) and chance.random() < 0.3:
                gone = flow.itemAt(0).widget()
                flow.removeWidget(gone)
                gone.deleteLater()
                flow.addWidget(QPushButton("new"))
                assert flow.minimumSize().height() > 0
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        if number % 50 == 0:
            gc.collect()

    flows = [flow for _, flow in holders if isinstance(flow, Flow)]
    assert flows and all(flow.count() == 3 for flow in flows)
    for holder, _ in holders:
        holder.deleteLater()
