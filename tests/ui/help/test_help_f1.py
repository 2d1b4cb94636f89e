"""F1 on anything: blocks, fields, panels, buttons, menus, dialogs."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QCursor
from PySide6.QtWidgets import QApplication, QDialog, QLineEdit, QMainWindow

from nep_core.errors import RobotNotAnswering
from nep_studio.help.texts import HOME
from nep_studio.ui.message_cards import MessageCard
from nep_studio.ui.plugins.help.help_controller import page_of_action
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from nep_studio.ui.workbench.help_card import HelpCard
from tests.ui.help.conftest import centre

KEY, LEFT = Qt.Key, Qt.MouseButton.LeftButton


@pytest.fixture(autouse=True)
def mouse_is_away(qapp):
    """No button is under the mouse unless a test puts it there."""
    QCursor.setPos(QPoint(0, 0))


def shown(desk) -> str:
    return desk.shown_panel.browser.page.name


def press_f1(qtbot) -> None:
    qtbot.keyClick(QApplication.focusWidget(), KEY.Key_F1)


def test_f1_on_a_block_shows_the_card_and_f1_again_its_page(karate, desk, first_of, qtbot):
    karate.workbench.canvas.selection.set([first_of("robot.say")])

    press_f1(qtbot)

    card = QApplication.activePopupWidget()
    assert isinstance(card, HelpCard)
    assert "says a text aloud" in card.text.toPlainText()
    qtbot.keyClick(card.text, KEY.Key_F1)
    qtbot.waitUntil(desk.panel.isVisible)
    assert shown(desk) == "block/robot.say"
    assert QApplication.activePopupWidget() is None


def test_more_on_the_card_leads_to_the_page(karate, desk, first_of, qtbot):
    karate.workbench.canvas.selection.set([first_of("control.together")])
    press_f1(qtbot)

    qtbot.mouseClick(QApplication.activePopupWidget().more, LEFT)

    qtbot.waitUntil(desk.panel.isVisible)
    assert shown(desk) == "block/control.together"


def test_with_the_help_open_f1_on_a_block_shows_its_page_at_once(karate, desk, first_of, qtbot):
    desk.open("howto/words")
    canvas = karate.workbench.canvas
    canvas.setFocus()
    canvas.selection.set([first_of("robot.walk")])

    press_f1(qtbot)

    assert QApplication.activePopupWidget() is None
    assert shown(desk) == "block/robot.walk"


def test_f1_in_a_field_tells_about_the_slot(karate, desk, first_of, qtbot):
    canvas = karate.workbench.canvas
    canvas.fields.open(first_of("robot.say"), "text")
    qtbot.waitUntil(lambda: canvas.isAncestorOf(QApplication.focusWidget()))

    press_f1(qtbot)

    assert shown(desk) == "block/robot.say"
    assert desk.panel.trail.current == "block/robot.say#slot-text"
    cursor = desk.panel.browser.textCursor()
    assert cursor.block().text().strip() == "text"


def test_f1_in_a_list_of_choices_tells_about_the_slot(karate, desk, first_of, qtbot):
    canvas = karate.workbench.canvas
    canvas.fields.open(first_of("robot.do"), "posture")
    focus = QApplication.focusWidget()

    qtbot.keyClick(focus, KEY.Key_F1)

    assert desk.panel.trail.current == "block/robot.do#slot-posture"


def test_f1_on_a_block_of_the_palette_shows_its_page(karate, desk, qtbot):
    palette = karate.workbench.helpers.palette
    palette.search.setFocus()
    qtbot.keyClicks(palette.search, "imitates")
    qtbot.keyClick(palette.search, KEY.Key_Down)
    qtbot.waitUntil(palette.shelf.hasFocus)

    press_f1(qtbot)

    assert shown(desk) == "block/robot.imitate"


def test_f1_in_a_panel_shows_its_page(karate, desk, qtbot):
    workbench = karate.workbench
    workbench.panels.show(workbench.outline)
    workbench.outline.setFocus()
    qtbot.waitUntil(workbench.outline.hasFocus)

    press_f1(qtbot)

    assert desk.panel.trail.current == "howto/window#outline"


def test_f1_on_a_message_tells_about_what_went_wrong(karate, desk, qtbot):
    karate.messages.tell_error(RobotNotAnswering("NAO is silent.", checklist=("Wait.",)))
    card = karate.findChild(MessageCard)
    card.close_button.setFocus()
    qtbot.waitUntil(card.close_button.hasFocus)

    press_f1(qtbot)

    assert desk.panel.trail.current == "howto/problems#error-the-robot-does-not-answer"


def test_escape_in_the_help_leads_back_to_the_canvas(karate, desk, qtbot):
    desk.open("howto/words")
    qtbot.waitUntil(desk.panel.browser.hasFocus)

    qtbot.keyClick(desk.panel.browser, KEY.Key_Escape)

    qtbot.waitUntil(karate.workbench.canvas.hasFocus)
    assert desk.panel.isVisible()


def test_with_the_help_beside_it_the_canvas_keeps_the_keyboard(karate, desk, first_of, qtbot):
    desk.open("howto/words")
    canvas = karate.workbench.canvas
    canvas.setFocus()
    canvas.selection.set([first_of("robot.walk")])

    press_f1(qtbot)

    assert canvas.hasFocus()


def test_a_hidden_help_follows_the_theme_when_it_is_seen_again(karate, desk, studio):
    desk.open("howto/words")
    panel = next(p for p in karate.workbench.panels.all if p.name == "HelpPanel")
    panel.action.setChecked(False)
    before = desk.panel.browser.toHtml()

    studio.look.choose("dark")

    assert desk.panel.browser.toHtml() == before
    panel.action.setChecked(True)
    assert studio.look.theme.colour("text").name() in desk.panel.browser.toHtml()
    studio.look.choose("light")


def test_f1_over_a_button_of_the_toolbar_tells_about_it(karate, desk, qtbot):
    bar = karate.toolbar
    button = bar.widgetForAction(karate.actions_by_name["undo"])
    QCursor.setPos(centre(button))

    press_f1(qtbot)

    assert desk.panel.trail.current == "howto/window#undo"


def test_f1_on_an_entry_of_a_menu_closes_it_and_tells_about_it(karate, desk, qtbot):
    menu = karate.menus["file"]
    menu.popup(karate.mapToGlobal(QPoint(10, 10)))
    qtbot.waitUntil(menu.isVisible)
    menu.setActiveAction(karate.actions_by_name["save"])

    qtbot.keyClick(menu, KEY.Key_F1)

    qtbot.waitUntil(lambda: not menu.isVisible())
    assert desk.panel.trail.current == "howto/window#files"


def test_f1_on_an_entry_of_the_menu_of_a_block_is_answered(karate, desk, first_of, qtbot):
    canvas = karate.workbench.canvas
    canvas.pointing.request_menu(
        canvas.sight.view_rect_of(first_of("robot.say")).topLeft().toPoint() + QPoint(9, 9)
    )
    menu = canvas.menu
    menu.setActiveAction(menu.actions()[0])

    qtbot.keyClick(menu, KEY.Key_F1)

    qtbot.waitUntil(lambda: not menu.isVisible())
    assert desk.panel.isVisible()


def test_f1_where_nothing_is_known_shows_something(karate, desk, qtbot):
    karate.workbench.canvas.selection.clear()

    press_f1(qtbot)

    assert shown(desk) == "howto/window"


def test_f1_on_the_start_page_opens_the_help_in_a_window(window, desk, qtbot):
    window.activateWindow()
    window.start_page.setFocus()

    qtbot.keyClick(window, KEY.Key_F1)

    qtbot.waitUntil(desk.window.isVisible)
    assert shown(desk) in ("howto/first-steps", HOME)
    desk.window.panel.open("block/robot.say")
    assert not desk.window.panel.example.insert.isVisible()
    assert desk.window.panel.example.try_it.isVisible()


def test_f1_in_a_dialog_opens_the_help_beside_it(karate, desk, qtbot):
    karate.open_settings()
    dialog = next(d for d in karate.findChildren(QDialog) if isinstance(d, SettingsDialog))
    qtbot.waitExposed(dialog)
    dialog.activateWindow()
    dialog.focusNextChild()
    qtbot.waitUntil(lambda: dialog.isAncestorOf(QApplication.focusWidget() or dialog.parent()))

    qtbot.keyClick(QApplication.focusWidget(), KEY.Key_F1)

    qtbot.waitUntil(desk.window.isVisible)
    assert desk.window.panel.trail.current == "howto/window#settings"
    dialog.reject()


def test_a_dialog_of_another_window_is_not_ours_to_answer(karate, desk, qtbot):
    other = QMainWindow()
    qtbot.addWidget(other)
    dialog = QDialog(other)
    line = QLineEdit(dialog)
    dialog.show()
    qtbot.waitExposed(dialog)
    dialog.activateWindow()
    line.setFocus()
    qtbot.waitUntil(line.hasFocus)

    qtbot.keyClick(line, KEY.Key_F1)

    assert desk._window is None
    assert desk.shown_panel.trail.current == ""


def test_the_help_menu_leads_to_contents_and_search(karate, desk, qtbot):
    karate.actions_by_name["help_contents"].trigger()
    assert shown(desk) == HOME

    karate.actions_by_name["help_search"].trigger()

    qtbot.waitUntil(desk.panel.search.hasFocus)


def test_every_action_of_the_window_has_a_page_or_is_found_by_its_words(karate, desk):
    book = desk.panel.book
    index = book.new_index()
    for findable in book.findables():
        index.add(findable)

    for name, action in karate.actions_by_name.by_name.items():
        page = page_of_action(action)

        assert book.resolve(page) == page if page else index.search(action.iconText()), name


def test_every_panel_of_the_window_has_a_page(karate, desk):
    from nep_studio.ui.plugins.help.help_controller import page_at

    for panel in karate.workbench.panels.all:
        page = page_at(panel.widget)
        assert page and desk.panel.book.resolve(page) == page, panel.name


def test_person_and_motion_have_pages_of_their_own(karate, desk):
    from nep_studio.ui.plugins.help.help_controller import page_at

    pages = {panel.title: page_at(panel.widget) for panel in karate.workbench.panels.all}

    assert pages["Person"] == "howto/window#person"
    assert pages["Motion"] == "howto/make-a-motion"
    assert pages["Gestures"] == "howto/teach-gestures"


def test_trying_an_example_reaches_the_desk(karate, desk, qtbot):
    desk.open("block/robot.play")

    with qtbot.waitSignal(desk.try_requested):
        qtbot.mouseClick(desk.panel.example.try_it, LEFT)


def test_the_page_about_keys_has_those_of_the_window(karate, desk):
    desk.open("howto/keyboard")

    told = desk.panel.browser.toPlainText()

    assert "Save" in told and "Ctrl+S" in told
    assert "F1" in told


def test_the_help_survives_a_change_of_language(karate, desk, studio):
    desk.open("block/robot.say")

    studio.choose_language("de")

    assert karate.workbench.canvas.editor.project.blocks
    studio.choose_language("en")


def test_who_follows_the_help_hears_of_its_first_page_too(karate, desk):
    followed = []
    karate.host.ask("help.follow", lambda _panel, page: followed.append(page))

    next(p for p in karate.workbench.panels.all if p.name == "HelpPanel").action.setChecked(True)

    assert followed == [HOME]
