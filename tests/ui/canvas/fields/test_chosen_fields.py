"""Fields that are chosen in a popup, one test for each kind and for each way to choose."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.edits.content import SetField
from nep_studio.ui.canvas.fields.colour import COLOURS

PLAIN = Qt.KeyboardModifier.NoModifier
LEFT = Qt.MouseButton.LeftButton


def labels(popup) -> list[str]:
    return [popup.list.item(row).text() for row in range(popup.list.count())]


def choose(popup, label: str) -> None:
    """Press the row of a list."""
    row = labels(popup).index(label)
    place = popup.list.visualItemRect(popup.list.item(row)).center()
    QTest.mouseClick(popup.list.viewport(), LEFT, PLAIN, place)


def test_typing_filters_the_choices_and_enter_takes_the_first(controller_of) -> None:
    desk = controller_of("robot.do")

    desk.click("posture")
    QTest.keyClicks(desk.widget.first(), "sit")
    shown = labels(desk.widget)
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Return)

    assert shown == ["sit", "sit and relax"]
    assert desk.value("posture") == "posture_sit"
    assert desk.new_steps() == 1
    assert desk.widget is None


def test_a_choice_is_made_with_the_arrows(controller_of) -> None:
    desk = controller_of("logic.compare", comparison="equal")

    desk.click("comparison")
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Down)
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Return)

    assert desk.value("comparison") == "not_equal"


def test_a_choice_is_made_with_the_mouse(controller_of) -> None:
    desk = controller_of("logic.compare", comparison="equal")

    desk.click("comparison")
    choose(desk.widget, "≥")

    assert desk.value("comparison") == "greater_or_equal"


def test_few_choices_have_no_search_box_and_are_chosen_by_a_letter(controller_of) -> None:
    desk = controller_of("variable.set", variable="v1")

    desk.click("variable")
    popup = desk.widget
    has_search = popup.search.isVisible()
    QTest.keyClick(QApplication.focusWidget(), "c")
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)

    assert not has_search
    assert desk.value("variable") == "v2"
    assert desk.widget is None


def test_eight_choices_have_a_search_box(controller_of) -> None:
    desk = controller_of("variable.set")
    for number in range(6):
        desk.editor.add_variable(f"other {number}")

    desk.click("variable")

    assert desk.widget.search.isVisible()
    assert QApplication.focusWidget() is desk.widget.search


def test_nothing_found_is_said_and_escape_leaves_the_choice(controller_of) -> None:
    desk = controller_of("robot.do")
    before = desk.value("posture")

    desk.click("posture")
    QTest.keyClicks(desk.widget.first(), "qqq")
    said = labels(desk.widget)
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Escape)

    assert said == ["Nothing is called “qqq”."]
    assert desk.value("posture") == before
    assert desk.new_steps() == 0


def test_a_press_elsewhere_closes_the_list(controller_of, qtbot) -> None:
    desk = controller_of("robot.do")
    desk.click("posture")

    desk.widget.close()

    assert desk.widget is None
    assert desk.new_steps() == 0


def test_choices_depend_on_another_field(controller_of) -> None:
    desk = controller_of("robot_moves.move_joint", part="left_arm")

    desk.click("joint")

    assert "elbow, bent" in labels(desk.widget)


def test_a_gesture_is_chosen_by_its_name(controller_of) -> None:
    desk = controller_of("event.gesture")

    desk.click("gesture")
    QTest.keyClicks(desk.widget.first(), "hand")
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Return)

    assert desk.value("gesture") == "hand_up"


def test_all_robots_can_be_chosen(controller_of) -> None:
    desk = controller_of("robot.say")

    desk.click("robot")
    choose(desk.widget, "all robots")

    assert desk.value("robot") == "*"


def test_a_new_robot_is_put_on_the_robots_page_in_one_step(controller_of) -> None:
    desk = controller_of("robot.say")

    desk.click("robot")
    choose(desk.widget, "new robot…")
    question = desk.widget.question
    QTest.keyClicks(question.name, "Pepe")
    QTest.keyClick(question.name, Qt.Key.Key_Return)

    project, language = desk.editor.project, desk.editor.language
    assert [entry.name for entry in robot_entries(project, language)] == ["Pepe"]
    assert desk.value("robot") == "Pepe"
    assert desk.new_steps() == 1


def test_variables_are_found_without_their_accents(controller_of) -> None:
    desk = controller_of("variable.set")
    added = desk.editor.add_variable("Größe")
    for number in range(6):
        desk.editor.add_variable(f"other {number}")

    desk.click("variable")
    QTest.keyClicks(desk.widget.first(), "grosse")
    found = labels(desk.widget)[0]
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Return)

    assert found == "Größe"
    assert desk.value("variable") == added


def test_a_new_variable_is_made_and_chosen_in_one_step(controller_of) -> None:
    desk = controller_of("variable.set")

    desk.click("variable")
    choose(desk.widget, "new variable…")
    QTest.keyClicks(desk.widget.question.name, "lives")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    variable = desk.editor.project.variable(str(desk.value("variable")))
    assert variable is not None and variable.name == "lives"
    assert desk.new_steps() == 1


def test_a_variable_name_that_is_taken_is_refused_in_words(controller_of) -> None:
    desk = controller_of("variable.set")

    desk.click("variable")
    choose(desk.widget, "new variable…")
    QTest.keyClicks(desk.widget.question.name, "score")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    assert "already" in desk.widget.reason.text
    assert desk.new_steps() == 0


def test_a_variable_is_renamed_everywhere(controller_of) -> None:
    desk = controller_of("variable.set", variable="v1")

    desk.click("variable")
    choose(desk.widget, "rename “score”…")
    desk.widget.question.name.selectAll()
    QTest.keyClicks(desk.widget.question.name, "points")
    QTest.keyClick(desk.widget.question.name, Qt.Key.Key_Return)

    assert desk.editor.project.variables[0].name == "points"
    assert desk.new_steps() == 1


def test_the_menu_of_a_variable_says_where_it_is_known(controller_of) -> None:
    desk = controller_of("variable.set", variable="v1")
    variable = desk.editor.project.variables[0]

    for words, scope in (
        ("for the whole program", "program"),
        ("kept for the next run", "kept"),
        ("only where it is set first (usual)", ""),
    ):
        desk.click("variable")
        rows = {option.label: option.icon for option in desk.widget.more_rows()}
        assert rows[words] == "" and list(rows.values()).count("check") == 1
        choose(desk.widget, words)
        assert variable.scope == scope

    assert desk.new_steps() == 3
    desk.editor.history.undo()
    assert variable.scope == "kept"


def test_deleting_a_variable_first_says_who_uses_it(controller_of) -> None:
    desk = controller_of("variable.set", variable="v1")

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


def test_a_state_is_typed_freely_or_chosen(controller_of) -> None:
    desk = controller_of("event.human_state")

    desk.click("state")
    desk.widget.first().selectAll()
    QTest.keyClicks(desk.widget.first(), "waves_hello")
    typed = desk.value("state")
    desk.fields.close()
    desk.click("state")
    desk.widget.first().clear()
    desk.widget.fill("")
    choose(desk.widget, "karate")

    assert typed == "waves_hello"
    assert desk.value("state") == "gesture_karate"
    assert desk.new_steps() == 2


def test_a_state_is_read_and_typed_as_words_and_kept_as_the_code_of_nodes(controller_of) -> None:
    desk = controller_of("event.human_state")
    slot = desk.editor.language.definitions["event.human_state"].slots["state"]
    shown = desk.editor.language.label_of(slot, desk.value("state"))

    desk.click("state")
    begun = desk.widget.search.text()
    desk.widget.search.selectAll()
    QTest.keyClicks(desk.widget.search, "the finale begins")

    assert shown == begun == "touched head"
    assert desk.value("state") == "the_finale_begins"


def test_a_message_is_typed_freely_or_chosen_of_those_that_are_there(controller_of) -> None:
    desk = controller_of("event.told", message="sing")
    desk.editor.create("event.tell", desk.editor.new_stack("behaviour", 40, 300))

    desk.click("message")
    desk.widget.fill("")
    offered = labels(desk.widget)
    desk.widget.first().selectAll()
    QTest.keyClicks(desk.widget.first(), "go on  please")
    typed = desk.value("message")
    desk.fields.close()
    desk.click("message")
    desk.widget.first().clear()
    desk.widget.fill("")
    choose(desk.widget, "dance")

    assert offered == ["dance", "sing"]
    assert typed == "go on please"
    assert desk.value("message") == "dance"


def test_a_rule_is_chosen_by_what_it_begins_with_and_follows_that(controller_of) -> None:
    desk = controller_of("control.stop_other_rule")
    hat = desk.editor.create("event.told", desk.editor.new_stack("behaviour", 40, 300))
    desk.editor.create("goal.goal", desk.editor.new_stack("behaviour", 40, 500))

    desk.click("rule")
    offered = labels(desk.widget)
    choose(desk.widget, "when dance is told")
    before = desk.shown("rule")
    desk.editor.apply(SetField(hat, "message", "sing"))

    assert offered == ["when dance is told"]
    assert desk.value("rule") == hat
    assert (before, desk.shown("rule")) == ("when dance is told", "when sing is told")


def test_a_colour_is_chosen_with_the_arrow_keys(controller_of) -> None:
    desk = controller_of("kinds.colour", colour=COLOURS[0][1])

    desk.click("colour")
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Right)
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Down)
    QTest.keyClick(desk.widget.palette_grid, Qt.Key.Key_Return)

    assert desk.value("colour") == COLOURS[7][1]
    assert desk.new_steps() == 1
    assert desk.widget is None


def test_a_colour_is_chosen_with_the_mouse_and_offered_again(controller_of) -> None:
    desk = controller_of("kinds.colour")

    desk.click("colour")
    grid = desk.widget.palette_grid
    QTest.mouseClick(grid, LEFT, PLAIN, grid.rect_of(4).center())
    desk.click("colour")

    assert desk.value("colour") == COLOURS[4][1]
    assert desk.widget.recent.codes == [COLOURS[4][1]]


def test_a_colour_is_typed_as_a_number_and_a_wrong_one_is_told(controller_of) -> None:
    desk = controller_of("kinds.colour")

    desk.click("colour")
    desk.widget.code.selectAll()
    QTest.keyClicks(desk.widget.code, "#12345")
    reason = desk.widget.reason.text
    QTest.keyClicks(desk.widget.code, "6")

    assert "A colour is written like" in reason
    assert desk.value("colour") == "#123456"
    assert desk.widget.reason.text == ""


def test_a_goal_is_one_of_the_program_or_a_name_that_is_typed(controller_of) -> None:
    desk = controller_of("goal.pursue")
    for number, (kind, name) in enumerate(
        (("goal.goal", "tour"), ("goal.goal_asked", "help"), ("goal.goal_when", "help"))
    ):
        place = desk.editor.new_stack("behaviour", 40, 900 + 300 * number)
        goal = desk.editor.create(kind, place)
        desk.editor.apply(SetField(goal, "name", name))

    desk.click("name")
    offered = labels(desk.widget)
    choose(desk.widget, "tour")
    chosen = desk.value("name")
    desk.click("name")
    QTest.keyClicks(desk.widget.first(), "rescue")
    QTest.keyClick(desk.widget.first(), Qt.Key.Key_Return)

    assert offered == ["help", "tour"]
    assert chosen == "tour"
    assert desk.value("name") == "rescue"
