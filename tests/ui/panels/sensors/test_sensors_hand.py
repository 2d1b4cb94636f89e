"""Mouse and keys over the plots: pan, zoom, pause, measure."""

import time

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.sensors.curve_list import CurveList
from nep_studio.ui.plugins.sensors.plots import Plots
from nep_studio.ui.theme.look import Look
from tests.ui.panels.sensors.conftest import hear


def turn_wheel(plots: Plots, row: int, notches: int, modifiers: Qt.KeyboardModifier) -> None:
    view = plots.rows[row].view
    middle = QPointF(view.rect().center())
    event = QWheelEvent(
        middle,
        QPointF(view.mapToGlobal(middle)),
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        modifiers,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(view, event)


def test_space_lets_the_picture_stand_still_while_samples_go_on(plots: Plots, qtbot: QtBot) -> None:
    plots.setFocus()
    qtbot.keyClick(plots, Qt.Key.Key_Space)
    shown_s, before = plots.shown_s, next(iter(plots.feed.streams.values())).total

    hear(plots.feed, 1.0)

    assert plots.shown_s == shown_s
    assert not plots.is_drawing
    assert next(iter(plots.feed.streams.values())).total > before
    qtbot.keyClick(plots, Qt.Key.Key_Space)
    assert plots.view.is_live
    assert plots.is_drawing


def test_a_paused_picture_stays_when_its_samples_are_overwritten(plots: Plots) -> None:
    plots.pause()
    key = next(iter(plots.feed.streams))

    plots.feed.streams[key].add(time.time() + np.arange(200_000) / 1e5, np.zeros((8, 200_000)))

    assert plots.samples(key).values[2].max() == 9.8


def test_the_wheel_shows_less_time_around_the_pointer(plots: Plots) -> None:
    plots.pause()
    middle_s = sum(plots.shown_s) / 2
    length_s = plots.view.length_s

    turn_wheel(plots, 0, 2, Qt.KeyboardModifier.NoModifier)

    assert plots.view.length_s < length_s
    assert sum(plots.shown_s) / 2 == pytest.approx(middle_s, abs=0.05)


def test_the_wheel_keeps_a_live_view_live(plots: Plots) -> None:
    turn_wheel(plots, 0, -1, Qt.KeyboardModifier.NoModifier)

    assert plots.view.is_live
    assert plots.view.length_s == 12.5


def test_ctrl_and_the_wheel_zoom_the_values_of_one_plot(plots: Plots) -> None:
    heights = [row.values.height for row in plots.rows]

    turn_wheel(plots, 0, 1, Qt.KeyboardModifier.ControlModifier)
    plots.draw()

    assert plots.rows[0].values.height < heights[0]
    assert plots.rows[1].values.height == heights[1]
    plots.fit()
    assert plots.rows[0].values.height == heights[0]


def test_dragging_pauses_and_shows_what_was_earlier(plots: Plots, qtbot: QtBot) -> None:
    view = plots.rows[0].view
    start_s = plots.shown_s[0]

    qtbot.mousePress(view, Qt.MouseButton.LeftButton, pos=QPoint(100, 50))
    qtbot.mouseMove(view, QPoint(200, 50))
    qtbot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=QPoint(200, 50))

    assert not plots.view.is_live
    moved_s = start_s - plots.shown_s[0]
    assert moved_s == pytest.approx(100 / view.width() * 10.0, abs=0.5)


def test_nobody_gets_lost_in_time(plots: Plots, qtbot: QtBot) -> None:
    plots.setFocus()
    for _ in range(20):
        qtbot.keyClick(plots, Qt.Key.Key_PageUp)

    start_s, end_s = plots.shown_s
    assert start_s <= plots.feed.oldest_s <= end_s
    for _ in range(20):
        qtbot.keyClick(plots, Qt.Key.Key_PageDown)
    start_s, end_s = plots.shown_s
    assert start_s <= plots.feed.newest_s <= end_s


def test_cursors_are_dragged_and_measure(plots: Plots, look: Look, qtbot: QtBot) -> None:
    curves = CurveList(plots, look)
    qtbot.addWidget(curves)
    curves.show()
    plots.hand.measure(True)
    now_s = plots.shown_s[1]
    plots.set_cursors(now_s - 3.5, now_s - 2.5)
    row = plots.rows[0]
    x = round(row.frame(plots.shown_s[0], plots.view.length_s).x(plots.cursors[1]))

    with qtbot.waitSignal(curves.measured) as told:
        qtbot.mousePress(row.view, Qt.MouseButton.LeftButton, pos=QPoint(x, 50))
        qtbot.mouseMove(row.view, QPoint(x + round(row.width / 10), 50))
        qtbot.mouseRelease(row.view, Qt.MouseButton.LeftButton)

    assert told.args[0].startswith("From A to B: 2")
    heading = curves.topLevelItem(0)
    assert [heading.child(0).text(0), heading.child(0).text(7)] == ["x", "2 Hz"]
    assert float(heading.child(2).text(6)) == 9.8
    assert plots.view.end_s == now_s


def test_alt_and_shift_with_arrows_move_the_cursors(plots: Plots, qtbot: QtBot) -> None:
    plots.hand.measure(True)
    first_s, last_s = plots.cursors

    qtbot.keyClick(plots, Qt.Key.Key_Right, Qt.KeyboardModifier.AltModifier)
    qtbot.keyClick(plots, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)

    assert plots.cursors[0] > first_s
    assert plots.cursors[1] < last_s
