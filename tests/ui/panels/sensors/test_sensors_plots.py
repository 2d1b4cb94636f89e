"""The plots of sensors: what is drawn, live and paused, in every look."""

import time

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QImage
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import HumanBehavior
from nep_studio.ui.plugins.sensors.curve_list import CurveList
from nep_studio.ui.plugins.sensors.feed import Field
from nep_studio.ui.plugins.sensors.plots import Plots
from nep_studio.ui.running.runner import Heard
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.look import Look
from tests.ui.panels.sensors.conftest import hear

pytestmark = pytest.mark.long


def colours_in(plots: Plots, row: int = 0) -> set[str]:
    image = plots.rows[row].view.grab().toImage()
    return {
        QColor(image.pixel(x, y)).name()
        for x in range(image.width())
        for y in range(image.height())
    }


def test_a_sensor_has_a_plot_for_acceleration_and_one_for_rotation(plots: Plots) -> None:
    rows = [row.row for row in plots.rows]

    assert [row.title for row in rows] == ["Acceleration", "Gyroscope"]
    assert [curve.name for curve in rows[0].curves] == ["x", "y", "z", "magnitude"]
    assert [row.unit for row in rows] == ["m/s²", "rad/s"]


@pytest.mark.parametrize("is_live", [True, False])
def test_every_curve_is_drawn_in_its_colour(plots: Plots, is_live: bool) -> None:
    if not is_live:
        plots.pause()

    found = colours_in(plots)

    assert {plots.look.theme.colour(f"plot_{number}").name() for number in (1, 2, 4)} <= found


def test_live_curves_look_like_those_drawn_anew(plots: Plots, qtbot: QtBot) -> None:
    plots.set_view(plots.view.with_length(2.0))
    for _ in range(30):
        hear(plots.feed, 0.1)
        plots.draw()
    plots.pause()

    still = plots.rows[0].view.grab().toImage()
    plots.go_live()
    live = plots.rows[0].view.grab().toImage()

    blue = plots.look.theme.colour("plot_1").rgb()
    counts = [
        sum(_column_has(image, x, blue) for x in range(image.width())) for image in (still, live)
    ]
    assert counts[1] == pytest.approx(counts[0], rel=0.15)


def _column_has(image: QImage, x: int, rgb: int) -> bool:
    return any(image.pixel(x, y) == rgb for y in range(image.height()))


def test_each_curve_of_a_plot_has_a_line_of_its_own_kind(plots: Plots) -> None:
    looks = [curve.look for curve in plots.rows[0].row.curves]
    metrics = plots.rows[0].view.fontMetrics()
    pens = [look.pen(plots.look.theme, metrics) for look in looks]

    assert len({tuple(pen.dashPattern()) for pen in pens}) == len(pens)
    assert len({pen.color().name() for pen in pens}) == len(pens)


def test_a_box_of_the_list_hides_its_curve(plots: Plots, look: Look, qtbot: QtBot) -> None:
    curves = CurveList(plots, look)
    qtbot.addWidget(curves)
    curves.show()

    curves.topLevelItem(0).child(0).setCheckState(0, Qt.CheckState.Unchecked)

    assert look.theme.colour("plot_1").name() not in colours_in(plots)
    curves.topLevelItem(0).child(0).setCheckState(0, Qt.CheckState.Checked)
    assert look.theme.colour("plot_1").name() in colours_in(plots)


def test_a_gesture_is_marked_with_its_certainty(plots: Plots) -> None:
    state = HumanBehavior(human_state="gesture_hand_up", certainty=0.931)
    touch = HumanBehavior(human_state="touched_head")

    plots.feed.hear_marks([Heard(time.time() - 1, state, ""), Heard(time.time() - 2, touch, "")])
    plots.draw()

    picture = plots.rows[0].view.picture
    assert [mark.words for mark in picture.marks] == ["touched head", "hand up 93 %"]
    assert plots.look.theme.colour("accent").name() in colours_in(plots)


def test_numbers_of_a_topic_share_a_plot_when_they_are_joints(plots: Plots) -> None:
    for path in ("joints.HeadYaw", "joints.HeadPitch", "battery"):
        plots.feed.plot(Field("/robot_state", path))
    message = {"robot": "nao", "joints": {"HeadYaw": 0.1, "HeadPitch": 0.2}, "battery": 1}

    plots.feed.hear_field("/robot_state", [Heard(time.time(), message, "node")])

    rows = [(row.row.title, row.row.source, len(row.row.curves)) for row in plots.rows[2:]]
    assert rows == [("joints", "nao", 2), ("battery", "nao", 1)]
    plots.feed.leave(Field("/robot_state", "battery"))
    assert len(plots.rows) == 3


def test_the_look_changes_while_curves_are_drawn(plots: Plots, look: Look, theme: Theme) -> None:
    look.choose(theme.name)

    found = colours_in(plots)

    assert theme.colour("field").name() in found
    assert theme.colour("plot_1").name() in found


def test_hidden_plots_do_nothing(plots: Plots, qtbot: QtBot) -> None:
    assert plots.is_drawing

    plots.hide()

    assert not plots.is_drawing
    before = plots.rows[0].view.picture
    hear(plots.feed, 0.2)
    plots.draw()
    assert plots.rows[0].view.picture is before
