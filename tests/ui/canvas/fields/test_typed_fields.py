"""Fields that are typed in a line over the block: numbers, texts, several lines, anything."""

from __future__ import annotations

import pytest
from field_desk import Desk
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QHelpEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QToolTip

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.places import InStack
from nep_studio.blocks.procedures import header_of
from nep_studio.ui.canvas.fields.line_editor import LineEditor


def retype(desk: Desk, text: str) -> None:
    desk.widget.selectAll()
    QTest.keyClicks(desk.widget, text)


def test_a_click_opens_a_number_and_typing_sets_it_in_one_step(controller_of) -> None:
    desk = controller_of("math.number", number=5)

    desk.click("number")
    retype(desk, "42")
    QTest.keyClick(desk.widget, Qt.Key.Key_Return)

    assert desk.value("number") == 42
    assert desk.new_steps() == 1
    assert desk.widget is None
    desk.editor.history.undo()
    assert desk.value("number") == 5


def test_a_number_is_set_at_each_key(controller_of) -> None:
    desk = controller_of("math.number")

    desk.click("number")
    retype(desk, "4")

    assert desk.value("number") == 4


@pytest.mark.parametrize(("typed", "value"), [("1.5", 1.5), ("1,5", 1.5), ("-3", -3), ("2.0", 2)])
def test_numbers_are_read_with_a_point_or_a_comma(controller_of, typed, value) -> None:
    desk = controller_of("math.number")

    desk.click("number")
    retype(desk, typed)

    assert desk.value("number") == value


def test_arithmetic_stays_as_typed_and_shows_what_it_comes_to(controller_of) -> None:
    desk = controller_of("math.number")

    desk.click("number")
    retype(desk, "2*pi/3")

    assert desk.value("number") == "2*pi/3"
    assert desk.widget.result.text() == "= 2.094"
    assert desk.widget.result.isVisible()


def test_what_is_no_number_keeps_the_last_good_one_and_says_why(controller_of) -> None:
    desk = controller_of("math.number", number=7)
    said = []
    desk.canvas.news.announced.connect(said.append)

    desk.click("number")
    retype(desk, "seven")

    assert desk.value("number") == 7
    assert "not a number" in desk.widget.reason.text
    assert desk.widget.reason.isVisible()
    assert desk.widget.reason.geometry().top() >= desk.widget.geometry().bottom()
    assert said[-1] == desk.widget.reason.text


def test_escape_takes_the_typing_back_as_if_it_had_never_been(controller_of) -> None:
    desk = controller_of("math.number", number=7)

    desk.click("number")
    retype(desk, "12")
    QTest.keyClick(desk.widget, Qt.Key.Key_Escape)

    assert desk.value("number") == 7
    assert desk.new_steps() == 0
    assert desk.editor.history.redo_label == ""
    assert desk.widget is None


def test_up_and_down_count_and_with_shift_by_ten(controller_of) -> None:
    desk = controller_of("math.number", number=0.1)

    desk.click("number")
    QTest.keyClick(desk.widget, Qt.Key.Key_Up)
    QTest.keyClick(desk.widget, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    QTest.keyClick(desk.widget, Qt.Key.Key_Down)

    assert desk.value("number") == 10.1
    assert desk.widget.text() == "10.1"
    assert desk.new_steps() == 1


def test_a_click_elsewhere_keeps_what_was_typed(controller_of) -> None:
    desk = controller_of("text.text")

    desk.click("text")
    QTest.keyClicks(desk.widget, "good day")
    desk.click_elsewhere()

    assert desk.value("text") == "good day"
    assert desk.widget is None


def test_two_fields_typed_after_each_other_are_two_steps(controller_of) -> None:
    desk = controller_of("math.arithmetic", a=1, b=2)

    desk.click("a")
    retype(desk, "10")
    desk.click("b")
    retype(desk, "20")
    desk.fields.close()

    assert (desk.value("a"), desk.value("b")) == (10, 20)
    assert desk.new_steps() == 2


def test_a_field_opened_twice_gives_two_steps(controller_of) -> None:
    desk = controller_of("math.number")

    for text in ("1", "2"):
        desk.click("number")
        retype(desk, text)
        desk.fields.close()

    assert desk.new_steps() == 2


def test_any_value_is_a_number_where_it_looks_like_one(controller_of) -> None:
    desk = controller_of("variable.set")

    desk.click("value")
    retype(desk, "3")
    as_number = desk.value("value")
    retype(desk, "three")

    assert as_number == 3
    assert desk.value("value") == "three"


def test_one_line_takes_a_name(controller_of) -> None:
    desk = controller_of("robots.robot")

    desk.click("name")
    retype(desk, "Pepe")

    assert desk.value("name") == "Pepe"


def test_tab_goes_to_the_next_field_and_shift_tab_back(controller_of) -> None:
    desk = controller_of("math.arithmetic", a=1, b=2)

    desk.click("a")
    QTest.keyClick(desk.widget, Qt.Key.Key_Tab)
    QTest.keyClick(desk.widget, Qt.Key.Key_Tab)
    after_two = desk.fields.place
    QTest.keyClick(desk.widget, Qt.Key.Key_Backtab, Qt.KeyboardModifier.ShiftModifier)

    assert after_two == (desk.block, "b")
    assert desk.fields.place == (desk.block, "operation")


def test_tab_goes_on_in_the_next_block_and_ends_after_the_last(controller_of) -> None:
    desk = controller_of("control.wait")
    stack = desk.editor.project.stack_of(desk.block).id
    below = desk.editor.create("control.wait", InStack(stack, 1))

    desk.click("seconds")
    QTest.keyClick(desk.widget, Qt.Key.Key_Tab)
    there = desk.fields.place
    QTest.keyClick(desk.widget, Qt.Key.Key_Tab)

    assert there == (below, "seconds")
    assert desk.fields.place is None


def test_the_editor_follows_zooming_and_scrolling(controller_of) -> None:
    desk = controller_of("math.number", number=5)
    desk.click("number")
    height, at = desk.widget.height(), desk.widget.pos()

    desk.canvas.sight.zoom(2.0)
    desk.canvas.sight.pan(30, 10)

    assert desk.widget.height() > 1.7 * height
    assert desk.widget.pos() != at
    assert abs(desk.widget.geometry().center().y() - desk.place("number").y()) <= 2


def test_the_editor_goes_away_with_its_block(controller_of) -> None:
    desk = controller_of("math.number")
    desk.click("number")

    desk.editor.history.undo()

    assert desk.block in desk.editor.project.blocks or desk.widget is None


def test_an_editor_that_grows_stays_inside_the_view(controller_of) -> None:
    desk = controller_of("text.text")

    desk.click("text")
    QTest.keyClicks(desk.widget, "a long story " * 20)

    assert desk.canvas.viewport().rect().contains(desk.widget.geometry())


def test_a_mirrored_field_grows_to_the_left(controller_of) -> None:
    desk = controller_of("robot.say", is_mirrored=True, text="x")
    desk.click("text")
    right = desk.widget.geometry().right()

    QTest.keyClicks(desk.widget, "some more words")

    assert isinstance(desk.widget, LineEditor)
    assert abs(desk.widget.geometry().right() - right) <= 3


def test_several_lines_are_typed_and_ended_with_control_enter(controller_of) -> None:
    desk = controller_of("kinds.lines")

    desk.click("text")
    QTest.keyClicks(desk.widget, "first")
    QTest.keyClick(desk.widget, Qt.Key.Key_Return)
    QTest.keyClicks(desk.widget, "second")
    QTest.keyClick(desk.widget, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)

    assert desk.value("text") == "first\nsecond"
    assert desk.new_steps() == 1
    assert desk.widget is None


def test_an_editor_of_lines_grows_with_its_text(controller_of) -> None:
    desk = controller_of("kinds.lines")
    desk.click("text")
    height = desk.widget.height()

    for _ in range(7):
        QTest.keyClick(desk.widget, Qt.Key.Key_Return)

    assert desk.widget.height() > height


def test_escape_restores_several_lines(controller_of) -> None:
    desk = controller_of("kinds.lines")

    desk.click("text")
    QTest.keyClicks(desk.widget, "gone")
    QTest.keyClick(desk.widget, Qt.Key.Key_Escape)

    assert desk.value("text") == ""
    assert desk.new_steps() == 0


def test_a_checkbox_changes_at_once(controller_of) -> None:
    desk = controller_of("robot_moves.breathing")

    desk.click("on")

    assert desk.value("on") is False
    assert desk.new_steps() == 1
    desk.click("on")
    assert desk.value("on") is True


def test_resting_over_a_field_tells_what_it_takes(controller_of) -> None:
    desk = controller_of("control.repeat")
    at = desk.place("times")
    event = QHelpEvent(QEvent.Type.ToolTip, at, desk.canvas.viewport().mapToGlobal(at))
    QApplication.sendEvent(desk.canvas.viewport(), event)

    assert QToolTip.text() == "times: a number"
    QToolTip.hideText()


def test_a_robot_is_renamed_with_all_that_names_it_in_one_step(controller_of) -> None:
    desk = controller_of("robots.robot", name="NAO")
    editor = desk.editor
    rule = editor.create("event.started", editor.new_stack("behaviour", 0, 0))
    stack = editor.project.stack_of(rule).id
    say = editor.create("robot.say", InStack(stack, 1))
    code = editor.create("code.lines", InStack(stack, 2))
    editor.apply(SetField(code, "code", "nao.say('nao')"))
    desk.steps = editor.history.steps

    desk.click("name")
    desk.widget.setText("")
    QTest.keyClicks(desk.widget, "Otto")
    desk.click_elsewhere()

    assert (desk.value("name"), desk.value("robot", say)) == ("Otto", "Otto")
    assert desk.value("code", code) == "otto.say('nao')"
    assert desk.new_steps() == 1


def test_a_robot_that_python_cannot_follow_keeps_its_name_and_the_person_is_told(
    controller_of,
) -> None:
    desk = controller_of("robots.robot", name="NAO")
    editor, told = desk.editor, []
    rule = editor.create("event.started", editor.new_stack("behaviour", 0, 0))
    code = editor.create("code.lines", InStack(editor.project.stack_of(rule).id, 1))
    editor.apply(SetField(code, "code", "otto = nao.say('nao')"))
    desk.canvas.news.refused.connect(lambda sentence: told.append(str(sentence)))
    desk.steps = editor.history.steps

    desk.click("name")
    desk.widget.setText("")
    QTest.keyClicks(desk.widget, "Otto")
    desk.click_elsewhere()

    assert desk.value("name") == "NAO" and desk.new_steps() == 0
    assert ["otto" in sentence for sentence in told] == [True]


def test_the_page_stays_under_the_pointer_when_a_field_at_the_edge_is_pressed(
    controller_of,
) -> None:
    desk = controller_of("robot.say")
    place = desk.place("text")
    desk.canvas.sight.pan(0, place.y() - 8)
    before = desk.canvas.sight.camera.y

    desk.click("text")

    assert desk.widget is not None
    assert desk.canvas.sight.camera.y == before
    assert desk.widget.geometry().top() >= 0


def test_a_press_means_what_was_seen_when_leaving_a_field_makes_its_block_wider(
    controller_of,
) -> None:
    desk = controller_of("robot.say")
    first, second = (desk.editor.new_parameter(name, "text") for name in "ab")
    parts, place = ("greet", first, second), desk.editor.new_stack("behaviour", 40, 200)
    header = header_of(desk.editor.project, desk.editor.add_procedure(parts, place=place))
    desk.click(first.id, header)
    retype(desk, "the name of somebody")
    seen = desk.place(second.id, header)

    desk.fields.widget.move(0, 0)  # it may lie over what is pressed
    QTest.mouseClick(desk.canvas.viewport(), Qt.MouseButton.LeftButton, pos=seen)

    assert desk.fields.place == (header, second.id)
