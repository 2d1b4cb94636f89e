"""The help panel: pages, links, search, ways back, examples that are dragged out and tried."""

from __future__ import annotations

import gc

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QGuiApplication, QWheelEvent
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QApplication, QLineEdit

from nep_studio.ui.plugins.help.panel import HelpPages, print_page
from nep_studio.ui.theme.icons import icon_room
from tests.ui.help.conftest import LANGUAGE

KEY, LEFT = Qt.Key, Qt.MouseButton.LeftButton


def text(panel: HelpPages) -> str:
    return panel.browser.toPlainText()


def listed(panel: HelpPages) -> list[str]:
    found = panel.contents.found
    return [found.item(row).data(Qt.ItemDataRole.UserRole) for row in range(found.count())]


def test_the_panel_opens_with_the_contents_and_every_page_can_be_shown(panel):
    assert "Press F1 on anything" in text(panel)

    for name in panel.book.titles:
        panel.open(name)

        assert panel.browser.page.name == name
        assert len(text(panel)) > 40
        assert "{{" not in text(panel)


def test_pictures_are_as_sharp_as_the_screen_and_no_wider_than_the_page(panel):
    panel.open("block/robot_moves.play_changed")

    look = panel.browser.picture_look()
    picture = panel.browser.loadResource(2, "picture:robot_moves.play_changed")

    assert picture.devicePixelRatio() == look.ratio
    assert 100 < picture.width() / look.ratio <= panel.browser.viewport().width()
    assert panel.browser.horizontalScrollBar().maximum() == 0


def test_no_page_is_wider_than_a_narrow_panel(panel):
    panel.resize(320, 600)
    wide = []
    for name in panel.book.titles:
        panel.open(name)
        for _ in range(20):  # a long table is laid out step by step
            if panel.browser.horizontalScrollBar().maximum() == 0:
                break
            QApplication.processEvents()
        else:
            wide.append(name)

    assert wide == []


def test_a_link_leads_to_its_page_and_back_and_forward_lead_to_and_fro(panel, qtbot):
    panel.open("block/robot.say")
    bar = panel.browser.verticalScrollBar()
    bar.setValue(bar.maximum())
    left_at = bar.value()
    panel.browser.anchorClicked.emit("help:block/text.join")
    assert panel.browser.page.name == "block/text.join"

    qtbot.mouseClick(panel.tools.back, LEFT)
    assert panel.browser.page.name == "block/robot.say"
    assert bar.value() == left_at
    qtbot.keyClick(panel.browser, KEY.Key_Right, Qt.KeyboardModifier.AltModifier)
    assert panel.browser.page.name == "block/text.join"
    qtbot.keyClick(panel.browser, KEY.Key_Backspace)
    qtbot.keyClick(panel.browser, KEY.Key_Backspace)

    assert panel.browser.page.name == "home"
    assert not panel.tools.back.isEnabled()


def test_the_keyboard_goes_from_link_to_link(panel, qtbot):
    panel.open("howto/first-steps")
    panel.browser.setFocus()
    qtbot.waitUntil(panel.browser.hasFocus)

    qtbot.keyClick(panel.browser, KEY.Key_Tab)
    qtbot.keyClick(panel.browser, KEY.Key_Return)

    assert panel.browser.page.name == "howto/run-and-stop"


def test_typing_finds_pages_and_enter_opens_the_first(panel, qtbot):
    panel.search.setFocus()

    qtbot.keyClicks(panel.search, "speak")
    qtbot.waitUntil(lambda: panel.searching.is_whole)

    assert panel.contents.isVisible()
    assert listed(panel)[0] == "block/robot.say"
    qtbot.keyClick(panel.search, KEY.Key_Return)
    assert panel.browser.page.name == "block/robot.say"
    qtbot.keyClick(panel.search, KEY.Key_Escape)
    assert panel.search.text() == ""
    assert not panel.contents.isVisible()


def test_the_arrow_keys_go_from_the_search_to_what_was_found_and_back(panel, qtbot):
    panel.search.setText("watch")
    panel.searching.finish("watch")

    qtbot.keyClick(panel.search, KEY.Key_Down)
    qtbot.waitUntil(panel.contents.found.hasFocus)
    qtbot.keyClick(panel.contents.found, KEY.Key_Down)
    qtbot.keyClick(panel.contents.found, KEY.Key_Return)

    assert panel.browser.page.name == listed(panel)[1]
    panel.contents.found.setFocus()
    panel.contents.found.setCurrentRow(0)
    qtbot.keyClick(panel.contents.found, KEY.Key_Up)
    qtbot.waitUntil(panel.search.hasFocus)


def test_a_search_that_finds_nothing_says_so(panel):
    panel.search.setText("xqzw")
    panel.searching.finish("xqzw")

    assert "xqzw" in panel.contents.found.item(0).text()
    panel.contents.choose_found()
    assert panel.browser.page.name == "home"


def test_the_contents_stand_beside_the_page_where_there_is_room(panel, qtbot):
    assert not panel.contents.isVisible()

    panel.resize(46 * panel.fontMetrics().height() + 60, 700)

    assert panel.contents.isVisible()
    assert panel.body.orientation() == Qt.Orientation.Horizontal
    assert panel.contents.width() > 10 * panel.fontMetrics().height()


def test_the_contents_of_a_narrow_panel_come_by_a_button_and_go_when_one_is_chosen(panel, qtbot):
    qtbot.mouseClick(panel.tools.contents, LEFT)
    tree = panel.contents.tree
    assert tree.isVisible()

    item = tree.topLevelItem(0).child(2)
    qtbot.waitUntil(lambda: tree.viewport().rect().contains(tree.visualItemRect(item)))
    qtbot.mouseClick(tree.viewport(), LEFT, pos=tree.visualItemRect(item).center())

    assert panel.browser.page.name == "howto/connect-nao"
    assert not panel.contents.isVisible()


def test_a_screen_reader_hears_the_example_and_the_names_of_buttons(panel):
    panel.open("block/robot.walk")

    assert "NAO walks 0.3 m forward" in panel.example.insert.accessibleDescription()
    for button in (panel.tools.back, panel.tools.print, panel.tools.contents):
        assert button.accessibleName()


def test_the_signs_of_buttons_with_words_keep_their_room_in_every_theme(panel, studio):
    panel.open("block/robot.walk")

    for theme in ("dark", "light"):
        studio.look.choose(theme)
        for button in (panel.example.insert, panel.example.try_it):
            assert button.iconSize() == icon_room(panel.fontMetrics().height())


def test_ctrl_and_the_wheel_make_words_and_pictures_larger(panel, qtbot):
    panel.open("block/robot.say")
    before = panel.browser.loadResource(2, "picture:robot.say").width()
    at = panel.browser.viewport().rect().center()
    event = QWheelEvent(
        at.toPointF(),
        panel.browser.viewport().mapToGlobal(at).toPointF(),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.ControlModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )

    QGuiApplication.sendEvent(panel.browser.viewport(), event)

    assert panel.browser.zoom > 1
    assert panel.browser.loadResource(2, "picture:robot.say").width() >= before
    panel.browser.set_zoom(99)
    assert panel.browser.zoom == 3


def test_nothing_is_loaded_from_elsewhere(panel):
    for address in ("http://example.org/x.png", "file:///etc/hostname", "picture:../x"):
        assert (
            not panel.browser.loadResource(2, address)
            or panel.browser.loadResource(2, address).isNull()
        )
    assert panel.browser.loadResource(3, "file:///etc/hostname") is None


def test_the_page_follows_the_theme_at_the_place_where_it_is_read(panel, studio):
    panel.open("howto/problems")
    bar = panel.browser.verticalScrollBar()
    bar.setValue(bar.maximum() // 2)
    read = panel.browser.cursorForPosition(QPoint(1, 1)).block().text()

    studio.look.choose("dark")

    assert panel.browser.cursorForPosition(QPoint(1, 1)).block().text() == read
    assert studio.look.theme.colour("text").name() in panel.browser.toHtml()
    studio.look.choose("light")


def test_a_page_is_printed_dark_on_light(panel, tmp_path):
    panel.open("block/robot.say")
    printer = QPrinter()
    printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
    printer.setOutputFileName(str(tmp_path / "page.pdf"))

    print_page(panel.browser, printer)

    assert (tmp_path / "page.pdf").stat().st_size > 5000


def test_the_print_button_asks_for_a_printer_and_prints(panel, tmp_path, qtbot):
    panel.open("block/robot.say")
    qtbot.mouseClick(panel.tools.print, LEFT)
    gc.collect()  # what only Python held would be gone now
    [dialog] = panel.findChildren(QPrintDialog)
    assert dialog.findChild(QLineEdit, "filename").text().endswith(".pdf")  # not a folder alone
    dialog.findChild(QLineEdit, "filename").setText(str(tmp_path / "page.pdf"))

    dialog.accept()

    assert (tmp_path / "page.pdf").stat().st_size > 5000
    qtbot.waitUntil(lambda: not panel.findChildren(QPrintDialog))


def test_the_question_for_a_printer_is_closed_and_asked_again(panel, qtbot):
    for _ in range(2):
        qtbot.mouseClick(panel.tools.print, LEFT)
        gc.collect()
        [dialog] = panel.findChildren(QPrintDialog)
        qtbot.keyClick(dialog, KEY.Key_Escape)
        qtbot.waitUntil(lambda: not panel.findChildren(QPrintDialog))

    assert panel.isVisible()


def test_a_hidden_panel_reads_nothing(canvas, studio, qtbot):
    hidden = HelpPages(canvas, studio.look, lambda: LANGUAGE)
    qtbot.addWidget(hidden)

    assert hidden._book is None
    assert not hidden.searching.is_whole
