"""Fields that are measured or filled in a popup: angles, times, settings."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.ui.canvas.fields.angle import angle_at

PLAIN = Qt.KeyboardModifier.NoModifier
LEFT = Qt.MouseButton.LeftButton


def test_an_angle_is_turned_in_steps_of_fifteen_unless_shift_is_held(controller_of) -> None:
    desk = controller_of("kinds.angle")

    desk.click("angle")
    dial = desk.widget.dial
    side = dial.width()
    QTest.mouseClick(dial, LEFT, PLAIN, QPoint(side // 10, side // 2 - 3))
    snapped = desk.value("angle")
    shift = Qt.KeyboardModifier.ShiftModifier
    QTest.mouseClick(dial, LEFT, shift, QPoint(side // 10, side // 2 - 10))

    assert snapped == 90
    assert 70 < desk.value("angle") < 90
    assert desk.new_steps() == 1


@pytest.mark.parametrize(
    ("x", "y", "degrees"), [(0, -9, 0), (-9, 0, 90), (9, 0, -90), (0, 9, 180), (1, -9, 0)]
)
def test_ahead_is_nought_and_left_is_positive(x, y, degrees) -> None:
    assert angle_at(x, y, is_free=False) == degrees


def test_an_angle_is_typed_and_counted(controller_of) -> None:
    desk = controller_of("kinds.angle")

    desk.click("angle")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "45")
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)

    assert desk.value("angle") == 55


def test_a_slider_moves_between_its_ends(controller_of) -> None:
    desk = controller_of("kinds.slider")

    desk.click("much")
    desk.widget.slider.setValue(desk.widget.slider.maximum())
    at_end = desk.value("much")
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Up)

    assert at_end == 100
    assert desk.value("much") == 100
    assert desk.widget.number.text() == "100"


def test_a_number_outside_a_slider_is_refused_in_words(controller_of) -> None:
    desk = controller_of("kinds.slider", much=50)

    desk.click("much")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "101")

    assert desk.value("much") == 10
    assert desk.widget.reason.text == "This number must be from 0 to 100."
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Escape)
    assert desk.value("much") == 50
    assert desk.new_steps() == 0


def test_a_duration_has_quick_choices(controller_of) -> None:
    desk = controller_of("kinds.duration")

    desk.click("time")
    QTest.mouseClick(desk.widget.quick[5], LEFT)

    assert desk.value("time") == 10
    assert desk.widget is None


def test_a_duration_is_not_less_than_nothing(controller_of) -> None:
    desk = controller_of("kinds.duration")

    desk.click("time")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "-2")

    assert desk.value("time") == 1
    assert desk.widget.reason.text == "A time cannot be less than 0 seconds."


def test_settings_come_from_the_manifest_of_the_node(controller_of) -> None:
    desk = controller_of("nodes.launch")

    desk.click("parameters")
    QTest.keyClicks(desk.widget.input("gesture"), "karate")
    desk.widget.input("method").setCurrentText("gmr")
    QTest.keyClicks(desk.widget.input("certainty"), "0.5")

    assert desk.value("parameters") == {"gesture": "karate", "method": "gmr", "certainty": 0.5}
    assert desk.new_steps() == 1


def test_a_setting_out_of_its_range_is_told_and_another_can_be_added(controller_of) -> None:
    desk = controller_of("nodes.launch")

    desk.click("parameters")
    QTest.keyClicks(desk.widget.input("certainty"), "7")
    reason = desk.widget.reason.text
    desk.widget.input("certainty").clear()
    QTest.keyClicks(desk.widget.new_name, "colour")
    QTest.keyClick(desk.widget.new_name, Qt.Key.Key_Return)
    QTest.keyClicks(desk.widget.input("colour"), "blue")

    assert "certainty" in reason
    assert desk.value("parameters") == {"colour": "blue"}


def test_a_parameter_is_renamed_in_the_header_and_in_all_calls(controller_of) -> None:
    desk = controller_of("control.wait")
    parameter = desk.editor.new_parameter("name", "text")
    place = desk.editor.new_stack("behaviour", 300, 200)
    own = desk.editor.add_procedure(["greet", parameter], place=place)
    header = desk.editor.project.stacks[place.stack].body[0]
    steps = desk.editor.history.steps

    desk.click(parameter.id, header)
    desk.widget.selectAll()
    QTest.keyClicks(desk.widget, "person")
    QTest.keyClick(desk.widget, Qt.Key.Key_Return)

    assert desk.editor.project.procedures[own].parts[1].name == "person"
    assert desk.editor.history.steps == steps + 1


def test_a_popup_stays_inside_the_screen_and_is_mirrored(controller_of) -> None:
    desk = controller_of("robot.do", is_mirrored=True)

    desk.click("posture")
    popup = desk.widget

    assert popup.layoutDirection() == Qt.LayoutDirection.RightToLeft
    assert desk.canvas.screen().availableGeometry().contains(popup.geometry())
    assert popup.accessibleName() == "posture: one of a list"


def test_tab_leaves_a_popup_for_the_next_field(controller_of) -> None:
    desk = controller_of("robot.say")

    desk.click("robot")
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Tab)
    QApplication.processEvents()

    assert desk.fields.place == (desk.block, "text")
