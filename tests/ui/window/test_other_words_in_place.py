"""A change of language tells all words of the window again, in place: nothing is made anew."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, QPoint, Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QMenu, QTabBar, QWidget
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

from nep_studio import paths
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from nep_studio.ui.widgets.layouts import ReadingLabel
from nep_studio.ui.words import PSEUDO, tr
from tests.conftest import a_part_of
from tests.ui.window.conftest import Chooser
from tests.ui.window.putting_away import put_away

KARATE = paths.examples() / "karate_greeting.nep"
PLUGINS = "nep_studio.ui.plugins."
LEFT_OUT: tuple[str, ...] = ()
"""What is in these modules does not tell its words again in place yet."""

TEXTS = (
    "text",
    "title",
    "windowTitle",
    "iconText",
    "toolTip",
    "placeholderText",
    "accessibleName",
    "accessibleDescription",
)
Said = tuple[str, str, str]
"""Whose words they are, what of it, and how they go."""


def words_of(thing: QObject) -> Iterator[Said]:
    """All words of a window, however deep; how deep depends on the room."""
    place = f"{type(thing).__name__} {thing.objectName()}"
    for kind in TEXTS:
        said = getattr(thing, kind, None)
        if callable(said) and isinstance(words := said(), str) and words:
            yield place, kind, words
    yield from ((place, "item", words) for words in items_of(thing))
    for child in parts_of(thing):
        yield from words_of(child)


def items_of(thing: QObject) -> Iterator[str]:
    if isinstance(thing, QTabBar):
        for index in range(thing.count()):
            yield from (thing.tabText(index), thing.tabToolTip(index))
            yield thing.accessibleTabName(index)
    elif isinstance(thing, QComboBox):
        yield from (thing.itemText(index) for index in range(thing.count()))


def parts_of(thing: QObject) -> list[QObject]:
    """The widgets and actions in it; some are in an object that is neither."""
    found: list[QObject] = []
    for one in thing.children():
        found += [one] if isinstance(one, QWidget | QAction) else one.findChildren(QAction)
    return [one for one in found if not is_left_out(one)]


def is_left_out(thing: QObject) -> bool:
    """Not yet in place, or a panel that nobody sees: it does no work before somebody looks."""
    module = type(thing).__module__
    is_hidden = isinstance(thing, QWidget) and not thing.isVisible()
    return module.startswith(LEFT_OUT) or (is_hidden and module.startswith(PLUGINS))


def widgets_of(thing: QObject) -> Iterator[QWidget]:
    for part in parts_of(thing):
        if isinstance(part, QWidget):
            yield part
        yield from widgets_of(part)


def opened(studio: Studio, qtbot: QtBot) -> MainWindow:
    """A window with a project and all panels, large enough for all words."""
    made = MainWindow(studio, Chooser())
    qtbot.addWidget(made, before_close_func=put_away)
    made.resize(2400, 1400)
    made.show()
    made.start(None)
    made.files.open(KARATE)  # an example would be in the language of the window
    made.workbench.panels.show(made.workbench.code)
    made.workbench.panels.show(made.workbench.problems)
    made.workbench.panels.row.setSizes([600, 800, 600, 400])
    qtbot.waitUntil(lambda: "Impressive" in made.workbench.code.text.toPlainText())
    return made


Differences = tuple[list[Said], list[Said]]


def differences(one: QWidget, other: QWidget) -> Differences:
    ours, theirs = set(words_of(one)), set(words_of(other))
    return sorted(ours - theirs), sorted(theirs - ours)


def settled_differences(one: QWidget, other: QWidget) -> Differences:
    """Those that stay: some words come a moment later, as the Python and the problems do."""
    for _ in range(60):
        if differences(one, other) == ([], []):
            break
        QTest.qWait(50)
    return differences(one, other)


@pytest.mark.parametrize("codes", a_part_of([["ja", PSEUDO, "en", "de"], ["de"], [PSEUDO]]))
def test_all_words_are_those_of_a_window_that_was_made_in_the_language(
    studio: Studio, qtbot: QtBot, codes: list[str]
) -> None:
    window = opened(studio, qtbot)
    for code in codes:
        studio.choose_language(code)
        QTest.qWait(20)
    fresh = opened(studio, qtbot)

    assert settled_differences(window, fresh) == ([], [])


def test_all_panels_speak_the_language_when_somebody_looks(studio: Studio, qtbot: QtBot) -> None:
    window = opened(studio, qtbot)
    for panel in window.workbench.panels.all:
        window.workbench.panels.show(panel.widget)
    studio.choose_language("de")
    fresh = opened(studio, qtbot)

    for ours, theirs in zip(window.workbench.panels.all, fresh.workbench.panels.all, strict=True):
        for one, panel in ((window, ours), (fresh, theirs)):
            one.workbench.panels.show(panel.widget)
            one.workbench.panels.row.setSizes([600, 800, 600, 400])
            one.workbench.panels.column.setSizes([500, 900])
        differ = settled_differences(ours.widget, theirs.widget)
        assert (ours.name, differ) == (theirs.name, ([], []))


def test_the_comparison_finds_words_that_stay_behind(studio: Studio, qtbot: QtBot) -> None:
    window, fresh = opened(studio, qtbot), opened(studio, qtbot)
    window.workbench.code.copy_button.setText("left behind")

    ours, _ = differences(window, fresh)

    assert "left behind" in [words for _, _, words in ours]


def test_nothing_is_made_anew(studio: Studio, qtbot: QtBot) -> None:
    window = opened(studio, qtbot)
    before = list(widgets_of(window))

    for code in ("de", "ja", PSEUDO, "en"):
        studio.choose_language(code)
        QTest.qWait(50)

    assert [type(one).__name__ for one in before if not isValid(one)] == []
    assert [one for one in before if one not in set(widgets_of(window))] == []


def test_the_place_and_what_is_selected_stay(karate: MainWindow, qtbot: QtBot) -> None:
    canvas, palette = karate.workbench.canvas, karate.workbench.helpers.palette
    block = karate.files.document.project.pages["behaviour"][1].body[2]
    canvas.selection.set([block])
    canvas.commands.duplicate()
    canvas.selection.set([block])
    canvas.sight.zoom(1.3)
    canvas.sight.move_camera(40.0, 60.0)
    camera = (canvas.sight.camera.x, canvas.sight.camera.y, canvas.sight.camera.scale)
    QTest.qWait(50)  # now what was used last is in the palette, too
    palette.open_drawer("control")
    palette.search.setFocus()

    for code in ("de", "ja", "en"):
        karate.studio.choose_language(code)
        QTest.qWait(20)

    now = canvas.sight.camera
    assert (now.x, now.y, now.scale) == camera
    assert canvas.selection.ids == (block,)
    assert karate.files.document.editor.history.undo_label
    assert palette.shelf.shown_drawer().id == "control"
    assert karate.focusWidget() is palette.search


def press_in_menu(menu: QMenu, words: str) -> None:
    """Choose an entry of an open menu with the mouse."""
    action = next(one for one in menu.actions() if one.text().replace("&", "") == words)
    menu.popup(menu.parentWidget().mapToGlobal(QPoint(0, 0)))
    QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(action).center())
    menu.close()


def test_a_language_chosen_with_the_mouse_keeps_the_window(
    karate: MainWindow, qtbot: QtBot
) -> None:
    workbench = karate.workbench
    canvas, panels = workbench.canvas, workbench.panels
    karate.resize(1250, 740)
    panels.show(workbench.problems)
    qtbot.wait(50)
    left, middle, beside, right = panels.row.sizes()
    panels.row.setSizes([left + 40, middle - 70, beside, right + 30])
    document = karate.files.document
    canvas.selection.set([document.project.pages["behaviour"][1].body[2]])
    canvas.commands.duplicate()
    qtbot.wait(200)
    camera = canvas.sight.camera

    def kept() -> list[object]:
        return [
            karate.size(),
            panels.row.sizes(),
            panels.column.sizes(),
            [panel.name for panel in panels.all if panel.widget.isVisible()],
            canvas.selection.ids,
            (camera.x, camera.y, camera.scale),
            document.editor.history.position,
            [note.text for note in document.project.notes.values()],
            document.project.name,
            karate.isWindowModified(),
        ]

    before = kept()
    titles = {menu.title(): menu for menu in karate.menus["view"].findChildren(QMenu)}
    press_in_menu(titles["Language"], "Deutsch")
    qtbot.wait(200)

    assert karate.menus["file"].title() == "&Datei"
    assert karate.files.document is document
    assert kept() == before


def test_a_language_chosen_in_the_settings_leaves_them_open(karate: MainWindow) -> None:
    karate.open_settings()
    [dialog] = karate.findChildren(SettingsDialog)
    before = karate.size()

    dialog.language.setFocus()
    while dialog.language.currentData() != "de":
        QTest.keyClick(dialog.language, Qt.Key.Key_Down)
    QTest.qWait(100)

    assert dialog.isVisible() and karate.size() == before
    assert dialog.windowTitle() == tr("Settings") == "Einstellungen"
    assert dialog.focusWidget() is dialog.language
    dialog.accept()


def test_an_example_opens_in_the_language_of_the_window(window: MainWindow, qtbot: QtBot) -> None:
    window.studio.choose_language("de")

    QTest.mouseClick(window.start_page.cards[KARATE], Qt.MouseButton.LeftButton)
    window.workbench.panels.show(window.workbench.code)

    qtbot.waitUntil(lambda: "Karateschlag" in window.workbench.code.text.toPlainText())
    project = window.files.document.project
    assert (project.name, project.spoken_language) == ("Karate-Gruß", "de")
    assert "Zuerst ändern" in next(iter(project.notes.values())).text
    assert not window.files.document.is_modified


def test_a_new_block_says_hello_in_the_language_of_the_window(window: MainWindow) -> None:
    window.studio.choose_language("de")
    QTest.mouseClick(window.start_page.new_button, Qt.MouseButton.LeftButton)
    bar = window.workbench.helpers.insert_bar

    QTest.keyClick(window.workbench.canvas, Qt.Key.Key_Space, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(bar.line, "sagt")
    QTest.keyClick(bar.line, Qt.Key.Key_Return)

    blocks = window.files.document.project.blocks.values()
    assert [one.fields["text"] for one in blocks if one.type == "robot.say"] == ["Hallo"]


def test_what_is_searched_for_stays(karate: MainWindow) -> None:
    palette, bar = karate.workbench.helpers.palette, karate.workbench.helpers.find_bar
    palette.search.setText("wait")
    bar.open("karate")
    hits = bar.hits

    karate.studio.choose_language("de")
    QTest.qWait(20)

    assert palette.search.text() == "wait"
    assert (bar.isVisible(), bar.line.text()) == (True, "karate")
    assert bar.hits == hits != ()


def test_what_is_being_typed_in_a_field_stays(karate: MainWindow) -> None:
    canvas = karate.workbench.canvas
    project = karate.files.document.project
    block = next(one.id for one in project.blocks.values() if one.type == "robot.say")
    canvas.fields.open(block, "text")
    editor = canvas.fields.widget
    editor.setText("Hello, wor")
    editor.textEdited.emit(editor.text())
    english = editor.accessibleName()

    karate.studio.choose_language("de")
    QTest.qWait(20)

    assert canvas.fields.widget is editor and editor.text() == "Hello, wor"
    assert editor.accessibleName() not in ("", english)
    canvas.fields.cancel()
    assert project.blocks[block].fields["text"] != "Hello, wor"


def test_an_open_choice_is_told_in_other_words(karate: MainWindow) -> None:
    canvas = karate.workbench.canvas
    project = karate.files.document.project
    block = next(one.id for one in project.blocks.values() if one.type == "robot.do")
    canvas.fields.open(block, "posture")

    karate.studio.choose_language("de")

    assert canvas.fields.place == (block, "posture")
    assert canvas.fields.widget.search.placeholderText() == tr("Type to search")
    canvas.fields.close()


def test_python_that_is_being_written_stays(karate: MainWindow) -> None:
    code = karate.workbench.code
    code.begin_editing()
    code.text.setPlainText("# not finished")

    karate.studio.choose_language("de")
    QTest.qWait(20)

    assert code.is_editing and code.text.toPlainText() == "# not finished"
    assert code.apply_button.accessibleName() == tr("Apply")


def test_the_blocks_are_read_from_the_right_and_from_the_left_again(karate: MainWindow) -> None:
    workbench = karate.workbench
    areas, stage = workbench.panels.areas, workbench.panels.stage

    karate.studio.choose_language(PSEUDO)
    QTest.qWait(20)
    mirrored = (workbench.canvas.look.measures.is_mirrored, areas["left"].x() > stage.x())
    karate.studio.choose_language("en")
    QTest.qWait(20)
    usual = (workbench.canvas.look.measures.is_mirrored, areas["left"].x() > stage.x())

    assert (mirrored, usual) == ((True, True), (False, False))
    assert karate.layoutDirection() == Qt.LayoutDirection.LeftToRight


def test_the_panels_are_put_back_without_being_made_anew(karate: MainWindow) -> None:
    panels = karate.workbench.panels
    widgets = [panel.widget for panel in panels.all]
    code = next(panel for panel in panels.all if panel.widget is karate.workbench.code)
    problems = next(panel for panel in panels.all if panel.widget is karate.workbench.problems)
    code.action.setChecked(True)
    problems.action.setChecked(True)
    karate.workbench.helpers.palette.set_narrow(True)

    karate.reset_panels()

    assert not code.action.isChecked() and not problems.action.isChecked()
    assert not karate.workbench.helpers.palette.is_narrow
    assert [panel.widget for panel in panels.all] == widgets
    assert not karate.settings.is_chosen(code.name)


def test_the_first_page_stays_in_its_place_in_other_words(
    window: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    mine = tmp_path / "mine.nep"
    mine.write_bytes(KARATE.read_bytes())
    window.settings.add_recent(mine)
    window.files.recent_changed.emit()
    page = window.start_page
    cards, card = list(page.cards.values()), page.recent_cards[mine]
    qtbot.waitUntil(lambda: card.picture.pixmap().width() >= card.picture_size().width())
    page.verticalScrollBar().setValue(150)
    before = card.picture.pixmap().cacheKey()

    window.studio.choose_language("ja")

    qtbot.waitUntil(lambda: card.picture.pixmap().cacheKey() != before)
    assert list(page.cards.values()) == cards and page.recent_cards[mine] is card
    assert page.verticalScrollBar().value() == 150


def test_headings_of_the_first_page_begin_where_reading_begins(window: MainWindow) -> None:
    heading = window.start_page.cards[KARATE].findChild(ReadingLabel)

    window.studio.choose_language(PSEUDO)
    mirrored = heading.alignment()
    window.studio.choose_language("en")

    assert mirrored & Qt.AlignmentFlag.AlignRight and mirrored & Qt.AlignmentFlag.AlignAbsolute
    assert heading.alignment() & Qt.AlignmentFlag.AlignLeft
