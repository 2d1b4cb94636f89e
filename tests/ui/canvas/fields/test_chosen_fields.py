"""Fields that are chosen in a popup, one test for each kind and for each way to choose."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog

from nep_studio.blocks.deployment import robot_entries
from nep_studio.ui.canvas.fields.angle_popup import angle_at
from nep_studio.ui.canvas.fields.colour_popup import COLOURS

PLAIN = Qt.KeyboardModifier.NoModifier
LEFT = Qt.MouseButton.LeftButton


def labels(popup) -> list[str]:
    return [popup.list.item(row).text() for row in range(popup.list.count())]


def choose(popup, label: str) -> None:
    """Press the row of a list."""
    row = labels(popup).index(label)
    place = popup.list.visualItemRect(popup.list.item(row)).center()
    QTest.mouseClick(popup.list.viewport(), LEFT, PLAIN, place)


def test_typing_filters_the_choices_and_enter_takes_the_first(desk_of) -> None:
    desk = desk_of("robot.do")

    desk.click("posture")
    QTest.keyClicks(desk.widget.search, "sit")
    shown = labels(desk.widget)
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Return)

    assert shown == ["sit", "sit and relax"]
    assert desk.value("posture") == "posture_sit"
    assert desk.new_steps() == 1
    assert desk.widget is None


def test_a_choice_is_made_with_the_arrows(desk_of) -> None:
    desk = desk_of("logic.compare", comparison="equal")

    desk.click("comparison")
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Down)
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Return)

    assert desk.value("comparison") == "not_equal"


def test_a_choice_is_made_with_the_mouse(desk_of) -> None:
    desk = desk_of("logic.compare", comparison="equal")

    desk.click("comparison")
    choose(desk.widget, "≥")

    assert desk.value("comparison") == "greater_or_equal"


def test_nothing_found_is_said_and_escape_leaves_the_choice(desk_of) -> None:
    desk = desk_of("robot.do")
    before = desk.value("posture")

    desk.click("posture")
    QTest.keyClicks(desk.widget.search, "qqq")
    said = labels(desk.widget)
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Escape)

    assert said == ["Nothing is called “qqq”."]
    assert desk.value("posture") == before
    assert desk.new_steps() == 0


def test_a_press_elsewhere_closes_the_list(desk_of, qtbot) -> None:
    desk = desk_of("robot.do")
    desk.click("posture")

    desk.widget.close()

    assert desk.widget is None
    assert desk.new_steps() == 0


def test_choices_depend_on_another_field(desk_of) -> None:
    desk = desk_of("robot_moves.move_joint", part="left_arm")

    desk.click("joint")

    assert "elbow, bent" in labels(desk.widget)


def test_a_gesture_is_chosen_by_its_name(desk_of) -> None:
    desk = desk_of("event.gesture")

    desk.click("gesture")
    QTest.keyClicks(desk.widget.search, "hand")
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Return)

    assert desk.value("gesture") == "hand_up"


def test_all_robots_can_be_chosen(desk_of) -> None:
    desk = desk_of("robot.say")

    desk.click("robot")
    choose(desk.widget, "all robots")

    assert desk.value("robot") == "*"


def test_a_new_robot_is_put_on_the_robots_page_in_one_step(desk_of) -> None:
    desk = desk_of("robot.say")

    desk.click("robot")
    choose(desk.widget, "new robot…")
    question = desk.widget.question
    QTest.keyClicks(question.name, "Pepe")
    QTest.keyClick(question.name, Qt.Key.Key_Return)

    project, language = desk.editor.project, desk.editor.language
    assert [entry.name for entry in robot_entries(project, language)] == ["Pepe"]
    assert desk.value("robot") == "Pepe"
    assert desk.new_steps() == 1


def test_variables_are_found_without_their_accents(desk_of) -> None:
    desk = desk_of("variable.set")
    added = desk.editor.add_variable("Größe")

    desk.click("variable")
    QTest.keyClicks(desk.widget.search, "grosse")
    found = labels(desk.widget)[0]
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Return)

    assert found == "Größe"
    assert desk.value("variable") == added


def test_a_new_variable_is_made_and_chosen_in_one_step(desk_of) -> None:
    desk = desk_of("variable.set")

    desk.click("variable")
    choose(desk.widget, "new variable…")
    QTest.keyClicks(desk.widget.question.name, "lives")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    variable = desk.editor.project.variable(str(desk.value("variable")))
    assert variable is not None and variable.name == "lives"
    assert desk.new_steps() == 1


def test_a_variable_name_that_is_taken_is_refused_in_words(desk_of) -> None:
    desk = desk_of("variable.set")

    desk.click("variable")
    choose(desk.widget, "new variable…")
    QTest.keyClicks(desk.widget.question.name, "score")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    assert "already" in desk.widget.reason.text
    assert desk.new_steps() == 0


def test_a_variable_is_renamed_everywhere(desk_of) -> None:
    desk = desk_of("variable.set", variable="v1")

    desk.click("variable")
    choose(desk.widget, "rename “score”…")
    desk.widget.question.name.selectAll()
    QTest.keyClicks(desk.widget.question.name, "points")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    assert desk.editor.project.variables[0].name == "points"
    assert desk.new_steps() == 1


def test_deleting_a_variable_first_says_who_uses_it(desk_of) -> None:
    desk = desk_of("variable.set", variable="v1")

    desk.click("variable")
    choose(desk.widget, "delete “score”…")
    words = desk.widget.question.words
    QTest.keyClick(desk.widget.question.no, Qt.Key.Key_Return)
    kept = len(desk.editor.project.variables)
    choose(desk.widget, "delete “score”…")
    QTest.mouseClick(desk.widget.question.yes, LEFT)

    assert words == "One block uses the variable “score”. It stays, without a variable."
    assert kept == 2
    assert [v.name for v in desk.editor.project.variables] == ["count"]


def test_a_state_is_typed_freely_or_chosen(desk_of) -> None:
    desk = desk_of("event.human_state")

    desk.click("state")
    desk.widget.search.selectAll()
    QTest.keyClicks(desk.widget.search, "waves_hello")
    typed = desk.value("state")
    desk.fields.close()
    desk.click("state")
    desk.widget.search.clear()
    desk.widget.fill("")
    choose(desk.widget, "karate")

    assert typed == "waves_hello"
    assert desk.value("state") == "gesture_karate"
    assert desk.new_steps() == 2


def test_a_colour_is_chosen_with_the_arrow_keys(desk_of) -> None:
    desk = desk_of("kinds.colour", colour=COLOURS[0][1])

    desk.click("colour")
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Right)
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Down)
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Return)

    assert desk.value("colour") == COLOURS[7][1]
    assert desk.new_steps() == 1
    assert desk.widget is None


def test_a_colour_is_chosen_with_the_mouse_and_offered_again(desk_of) -> None:
    desk = desk_of("kinds.colour")

    desk.click("colour")
    grid = desk.widget.palette_grid
    QTest.mouseClick(grid, LEFT, PLAIN, grid.rect_of(4).center())
    desk.click("colour")

    assert desk.value("colour") == COLOURS[4][1]
    assert desk.widget.recent.codes == [COLOURS[4][1]]


def test_a_colour_is_typed_as_a_number_and_a_wrong_one_is_told(desk_of) -> None:
    desk = desk_of("kinds.colour")

    desk.click("colour")
    desk.widget.code.selectAll()
    QTest.keyClicks(desk.widget.code, "#12345")
    reason = desk.widget.reason.text
    QTest.keyClicks(desk.widget.code, "6")

    assert "A colour is written like" in reason
    assert desk.value("colour") == "#123456"
    assert desk.widget.reason.text == ""


def test_an_angle_is_turned_in_steps_of_fifteen_unless_shift_is_held(desk_of) -> None:
    desk = desk_of("kinds.angle")

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


def test_an_angle_is_typed_and_counted(desk_of) -> None:
    desk = desk_of("kinds.angle")

    desk.click("angle")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "45")
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)

    assert desk.value("angle") == 55


def test_a_slider_moves_between_its_ends(desk_of) -> None:
    desk = desk_of("kinds.slider")

    desk.click("much")
    desk.widget.slider.setValue(desk.widget.slider.maximum())
    at_end = desk.value("much")
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Up)

    assert at_end == 100
    assert desk.value("much") == 100
    assert desk.widget.number.text() == "100"


def test_a_number_outside_a_slider_is_refused_in_words(desk_of) -> None:
    desk = desk_of("kinds.slider", much=50)

    desk.click("much")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "101")

    assert desk.value("much") == 10
    assert desk.widget.reason.text == "This number must be from 0 to 100."
    QTest.keyClick(desk.widget.number, Qt.Key.Key_Escape)
    assert desk.value("much") == 50
    assert desk.new_steps() == 0


def test_a_duration_has_quick_choices(desk_of) -> None:
    desk = desk_of("kinds.duration")

    desk.click("time")
    QTest.mouseClick(desk.widget.quick[5], LEFT)

    assert desk.value("time") == 10
    assert desk.widget is None


def test_a_duration_is_not_less_than_nothing(desk_of) -> None:
    desk = desk_of("kinds.duration")

    desk.click("time")
    desk.widget.number.selectAll()
    QTest.keyClicks(desk.widget.number, "-2")

    assert desk.value("time") == 1
    assert desk.widget.reason.text == "A time cannot be less than 0 seconds."


def test_a_date_is_chosen_in_the_calendar_or_written(desk_of) -> None:
    desk = desk_of("kinds.date")

    desk.click("day")
    desk.widget.written.selectAll()
    QTest.keyClicks(desk.widget.written, "2026-03-05")
    written = desk.value("day")
    shown = desk.widget.calendar.selectedDate().toString("yyyy-MM-dd")
    desk.widget.calendar.clicked.emit(desk.widget.calendar.selectedDate().addDays(1))

    assert written == shown == "2026-03-05"
    assert desk.value("day") == "2026-03-06"
    assert desk.new_steps() == 1


def test_a_file_inside_the_project_folder_is_kept_short(
    desk_of, qtbot, tmp_path, monkeypatch
) -> None:
    desk = desk_of("kinds.file")
    desk.fields.project_folder = tmp_path
    wanted = tmp_path / "sounds" / "hello.wav"
    answer = (str(wanted), "")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: answer)

    desk.click("path")
    QTest.mouseClick(desk.widget.browse, LEFT)
    qtbot.waitUntil(lambda: desk.value("path") != "")

    assert desk.value("path") == "sounds/hello.wav"
    assert desk.new_steps() == 1


def test_a_file_is_typed(desk_of) -> None:
    desk = desk_of("kinds.file")

    desk.click("path")
    QTest.keyClicks(desk.widget.path, "a.wav")

    assert desk.value("path") == "a.wav"


def test_settings_come_from_the_manifest_of_the_node(desk_of) -> None:
    desk = desk_of("nodes.launch")

    desk.click("parameters")
    QTest.keyClicks(desk.widget.input("gesture"), "karate")
    desk.widget.input("method").setCurrentText("gmr")
    QTest.keyClicks(desk.widget.input("certainty"), "0.5")

    assert desk.value("parameters") == {"gesture": "karate", "method": "gmr", "certainty": 0.5}
    assert desk.new_steps() == 1


def test_a_setting_out_of_its_range_is_told_and_another_can_be_added(desk_of) -> None:
    desk = desk_of("nodes.launch")

    desk.click("parameters")
    QTest.keyClicks(desk.widget.input("certainty"), "7")
    reason = desk.widget.reason.text
    desk.widget.input("certainty").clear()
    QTest.keyClicks(desk.widget.new_name, "colour")
    QTest.keyClick(desk.widget.new_name, Qt.Key.Key_Return)
    QTest.keyClicks(desk.widget.input("colour"), "blue")

    assert "certainty" in reason
    assert desk.value("parameters") == {"colour": "blue"}


def test_a_parameter_is_renamed_in_the_header_and_in_all_calls(desk_of) -> None:
    desk = desk_of("control.wait")
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


def test_a_popup_stays_inside_the_screen_and_is_mirrored(desk_of) -> None:
    desk = desk_of("robot.do", is_mirrored=True)

    desk.click("posture")
    popup = desk.widget

    assert popup.layoutDirection() == Qt.LayoutDirection.RightToLeft
    assert desk.canvas.screen().availableGeometry().contains(popup.geometry())
    assert popup.accessibleName() == "posture: one of a list"


def test_tab_leaves_a_popup_for_the_next_field(desk_of) -> None:
    desk = desk_of("robot.say")

    desk.click("robot")
    QTest.keyClick(desk.widget.search, Qt.Key.Key_Tab)
    QApplication.processEvents()

    assert desk.fields.place == (desk.block, "text")
