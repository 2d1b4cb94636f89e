"""What a person sees first: room for the canvas, an empty page that says how to begin."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QTabBar

from nep_studio import paths
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.theme.icons import category_icon_name
from nep_studio.ui.words import use_language
from tests.ui.window.putting_away import put_away
from tests.ui.window_eye import WindowEye

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def fresh(window: MainWindow, qtbot) -> MainWindow:
    """The window with a new project, begun by the button of the start page."""
    QTest.mouseClick(window.start_page.new_button, LEFT)
    qtbot.waitUntil(window.workbench.canvas.isVisible)
    return window


def hint(window: MainWindow):
    return window.workbench.helpers.empty_hint


def insert(window: MainWindow, words: str) -> None:
    """Search a block in the palette and press Enter."""
    palette = window.workbench.helpers.palette
    palette.start_search()
    QTest.keyClicks(palette.search, words)
    QTest.keyClick(palette.search, Qt.Key.Key_Return)


def test_an_empty_page_says_how_one_begins(fresh: MainWindow) -> None:
    assert hint(fresh).isVisible()
    assert "/" in hint(fresh).text()


def test_the_words_on_the_empty_page_go_with_the_first_block_and_come_back(
    fresh: MainWindow, qtbot
) -> None:
    insert(fresh, "says")

    qtbot.waitUntil(lambda: not hint(fresh).isVisible())

    fresh.actions_by_name["undo"].trigger()
    qtbot.waitUntil(hint(fresh).isVisible)


def test_the_robots_page_says_what_belongs_there(fresh: MainWindow) -> None:
    fresh.workbench.canvas.show_page("robots")

    assert "robots" in hint(fresh).text()


def test_a_click_goes_through_the_words_on_the_empty_page(fresh: MainWindow) -> None:
    view = fresh.workbench.canvas.viewport()
    place = hint(fresh).geometry().center()

    assert view.childAt(place) is None
    QTest.mouseDClick(view, LEFT, pos=place)

    assert fresh.workbench.helpers.insert_bar.isVisible()


def test_an_empty_page_has_nothing_to_scroll(fresh: MainWindow) -> None:
    canvas = fresh.workbench.canvas

    bars = (canvas.horizontalScrollBar(), canvas.verticalScrollBar())

    assert all(bar.minimum() == bar.maximum() for bar in bars)


def test_blocks_that_leave_the_view_can_be_scrolled_to(fresh: MainWindow, qtbot) -> None:
    canvas = fresh.workbench.canvas
    insert(fresh, "says")

    for _ in range(30):
        QTest.keyClick(canvas, Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)

    bar = canvas.verticalScrollBar()
    bounds = canvas.page_layout.bounds()
    assert bounds is not None
    assert (bar.maximum() + canvas.viewport().height()) / canvas.sight.camera.scale >= bounds.bottom


def test_an_empty_project_has_no_problems_to_tell_of(fresh: MainWindow, qtbot) -> None:
    check = fresh.actions_by_name["check"]
    with qtbot.waitSignal(fresh.workbench.checks.found):
        fresh.workbench.checks.start()

    assert check.iconText() == "Check"

    insert(fresh, "says")
    check.trigger()  # what is only begun is told of when somebody asks
    qtbot.waitUntil(lambda: "problem" in check.iconText())


@pytest.mark.parametrize("size", [(1280, 800), (1024, 700)])
def test_the_canvas_is_the_widest_part_of_the_window(karate: MainWindow, size) -> None:
    karate.resize(*size)
    karate.workbench.panels.restore(karate.fontMetrics().height())

    workbench = karate.workbench
    others = (workbench.helpers.palette.width(), workbench.panels.areas["stage"].width())
    assert workbench.canvas.width() > max(others)


def test_the_trash_is_where_lines_end_and_the_minimap_above_it(karate: MainWindow) -> None:
    helpers, view = karate.workbench.helpers, karate.workbench.canvas.viewport()

    helpers.show_minimap(True)

    assert helpers.trash.geometry().right() > view.width() - 30
    assert not helpers.trash.geometry().intersects(helpers.minimap.geometry())


def test_a_narrow_palette_shows_the_signs_of_its_categories_alone(karate: MainWindow, qtbot):
    palette = karate.workbench.helpers.palette
    QTest.mouseClick(palette.levels.buttons["all"], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: palette.categories.isVisible())
    karate.workbench.panels.row.setSizes([400, 600, 280])
    wide = palette.categories.width()

    karate.workbench.panels.row.setSizes([200, 800, 0, 280])

    qtbot.waitUntil(lambda: palette.categories.width() < wide / 2)
    assert palette.shelf.isVisible()
    karate.workbench.panels.row.setSizes([400, 600, 0, 280])
    qtbot.waitUntil(lambda: palette.categories.width() == wide)


def test_larger_text_makes_the_blocks_of_the_palette_larger(karate: MainWindow) -> None:
    shelf = karate.workbench.helpers.palette.shelf
    karate.workbench.panels.row.setSizes([800, 300, 0, 180])
    before = shelf.rect_of(1).height()

    karate.studio.choose_text_scale(2.0)

    assert shelf.rect_of(1).height() > 1.7 * before


def test_every_category_of_the_page_has_a_sign_of_its_own(karate: MainWindow) -> None:
    categories = [c for c in karate.studio.language.categories if c.page == "behaviour"]

    signs = [category_icon_name(category.colour) for category in categories]

    assert len(set(signs)) == len(signs)


def test_categories_come_in_the_order_in_which_one_needs_them(karate: MainWindow) -> None:
    ids = [category.id for category in karate.studio.language.categories]

    assert ids[:3] == ["event", "robot_events", "robot"]
    assert ids.index("robot_camera") < ids.index("control") < ids.index("logic")


def test_a_narrow_code_pane_has_signs_with_tips_instead_of_words(karate: MainWindow) -> None:
    code = karate.workbench.code
    karate.workbench.panels.show(code)
    karate.workbench.panels.row.setSizes([400, 600, 280, 0])
    words = code.edit_button.text()

    karate.studio.choose_text_scale(2.0)
    karate.workbench.panels.row.setSizes([400, 700, 100, 80])

    assert words == "Edit"
    assert code.edit_button.text() == "" and code.edit_button.toolTip() == "Edit"
    assert code.edit_button.accessibleName() == "Edit"


def test_a_block_without_a_place_lands_beside_the_others(fresh: MainWindow) -> None:
    canvas = fresh.workbench.canvas
    for words in ("says", "set variable", "repeat"):
        canvas.selection.set([])
        insert(fresh, words)

    rects = [
        canvas.sight.view_rect_of(stack.body[0])
        for stack in fresh.files.document.project.pages[canvas.page]
    ]
    apart = [not one.intersects(other) for n, one in enumerate(rects) for other in rects[n + 1 :]]
    assert len(rects) >= 2 and all(apart)


@pytest.fixture(autouse=True)
def english():
    yield
    use_language("en")


def test_a_tiny_window_still_shows_its_canvas(karate: MainWindow, qtbot) -> None:
    karate.resize(300, 200)

    canvas = karate.workbench.canvas
    assert canvas.width() > 60 and canvas.grab(canvas.rect()).size() == canvas.size()
    assert canvas.rect().contains(QPoint(10, 10))


def test_nothing_but_the_window_is_a_window_for_a_moment(
    studio: Studio, chooser, qapp, qtbot
) -> None:
    with WindowEye(qapp) as eye:
        made = MainWindow(studio, chooser)
        qtbot.addWidget(made, before_close_func=put_away)
        made.show()
        made.start(None)
        made.files.open_example(paths.examples() / "karate_greeting.nep")
        qtbot.waitUntil(lambda: made.workbench.canvas.isVisible())
        for panel in made.workbench.panels.all:
            panel.action.setChecked(True)
            qtbot.wait(20)

    assert eye.seen == ["MainWindow"]


def test_all_blocks_stay_where_they_are_first_shown(fresh: MainWindow, qtbot) -> None:
    fresh.resize(1280, 800)
    palette = fresh.workbench.helpers.palette
    qtbot.waitUntil(lambda: fresh.workbench.canvas.width() > 700)

    QTest.mouseClick(palette.levels.buttons["all"], LEFT)
    qtbot.waitUntil(lambda: palette.categories.isVisible() and palette.shelf.width() < 250)
    first = palette.shelf.geometry()
    insert(fresh, "says")
    QTest.keyClick(palette.search, Qt.Key.Key_Escape)

    assert palette.shelf.geometry() == first
    assert first.width() > palette.categories.width()


def test_tab_goes_round_all_that_is_seen_and_each_stop_has_a_name(fresh: MainWindow, qtbot) -> None:
    canvas = fresh.workbench.canvas
    canvas.setFocus()

    stops = []
    while len(stops) < 60 and (not stops or not canvas.hasFocus()):
        stops.append(QApplication.focusWidget())
        QTest.keyClick(stops[-1], Qt.Key.Key_Tab)

    assert canvas.hasFocus(), stops[-1]
    assert len(set(stops)) == len(stops) > 12
    names = [QAccessible.queryAccessibleInterface(one).text(QAccessible.Text.Name) for one in stops]
    assert all(names), dict(zip(map(str, stops), names, strict=True))


def test_the_menu_ticks_the_panels_that_are_shown_and_puts_them_back(
    fresh: MainWindow, qtbot
) -> None:
    panels = fresh.workbench.panels
    first = [panel.name for panel in panels.all if panel.action.isChecked()]
    [menu] = [one for one in fresh.findChildren(QMenu) if one.title() == "Panels"]
    menu.aboutToShow.emit()
    shown = [action for action in menu.actions() if action.isCheckable()]
    sizes = panels.row.sizes()
    for panel in panels.all:
        if panel.name in ("CodePane", "Palette"):
            panel.action.toggle()
    panels.row.setSizes([0, 400, 300, 300])

    menu.actions()[-1].trigger()

    assert len(shown) == len(panels.all)
    assert not any(action.isIconVisibleInMenu() for action in shown)  # it would hide the tick
    assert [panel.name for panel in panels.all if panel.action.isChecked()] == first
    assert panels.row.sizes() == sizes


def test_tabs_that_were_not_seen_yet_grow_with_the_text(window: MainWindow, qtbot) -> None:
    assert window.workbench.panels.all  # they are made while the start page is shown
    window.studio.choose_text_scale(1.5)

    QTest.mouseClick(window.start_page.new_button, LEFT)
    qtbot.waitUntil(window.workbench.canvas.isVisible)

    size = QApplication.font().pointSizeF()
    tabs = window.findChildren(QTabBar)
    assert tabs and {one.font().pointSizeF() for one in tabs} == {size}
    window.studio.choose_text_scale(1.0)
