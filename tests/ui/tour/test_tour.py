"""The tour over the real widgets: what is done there is really done, and nobody is trapped."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import ActionRequest
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.ui.plugins.tour.tour import Tour, place_of, say_block
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import PSEUDO

LEFT = Qt.MouseButton.LeftButton
RUN_MS = 30_000
PALETTE, DRAG, WORDS, RUN, SEE = range(5)


@pytest.fixture
def begun(window: MainWindow, tour: Tour, qtbot: QtBot) -> Tour:
    """The first step."""
    tour.start()
    qtbot.waitUntil(lambda: tour.is_running)
    return tour


def click(button: QWidget) -> None:
    QTest.mouseClick(button, LEFT)


def go_to(tour: Tour, number: int) -> None:
    while tour.number < number:
        click(tour.bubble.next_button)


def drag_say_block(window: MainWindow) -> None:
    """Take "NAO says" out of the palette and let it go under the "when" block."""
    canvas, shelf = window.workbench.canvas, window.workbench.helpers.palette.shelf
    wanted = (
        number
        for number, entry in enumerate(shelf.entries)
        if entry.drawer.id == "robot" and entry.kind == "block"
    )
    rect = shelf.rect_of(next(wanted))
    hat = canvas.sight.view_rect_of(canvas.editor.project.pages["behaviour"][0].body[0])
    is_mirrored = canvas.look.measures.is_mirrored
    side = -1 if is_mirrored else 1
    start = (rect.topRight() if is_mirrored else rect.topLeft()) + QPoint(5 * side, 10)
    corner = (hat.bottomRight() if is_mirrored else hat.bottomLeft()).toPoint()
    end = corner + QPoint(9 * side, 18)
    end = shelf.viewport().mapFromGlobal(canvas.viewport().mapToGlobal(end))
    QTest.mousePress(shelf.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, start)
    for step in (0.1, 0.4, 0.7, 1.0):
        QTest.mouseMove(shelf.viewport(), start + (end - start) * step)
    QTest.mouseRelease(shelf.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, end)


def test_the_start_page_offers_the_tour_once(window: MainWindow, tour: Tour, qtbot: QtBot) -> None:
    offer = window.start_page.tour_offer
    assert offer.isVisible()

    click(offer.take_button)

    qtbot.waitUntil(lambda: tour.is_running)
    assert window.settings.tour_done
    window.files.close()
    assert window.start_page.isVisible() and not offer.isVisible()


def test_who_wants_no_tour_is_not_asked_again(window: MainWindow, tour: Tour) -> None:
    click(window.start_page.tour_offer.leave_button)

    assert window.settings.tour_done
    assert not window.start_page.tour_offer.isVisible()
    assert not tour.is_running


def test_the_steps_wait_for_what_is_really_done(
    window: MainWindow, begun: Tour, qtbot: QtBot
) -> None:
    canvas = window.workbench.canvas
    click(begun.bubble.next_button)
    assert begun.number == DRAG

    drag_say_block(window)
    qtbot.waitUntil(lambda: begun.number == WORDS)
    canvas.fields.open(say_block(window.host).id, "text")
    QTest.keyClick(canvas.fields.widget, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(canvas.fields.widget, "Good day")
    assert begun.number == WORDS
    QTest.keyClick(canvas.fields.widget, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: begun.number == RUN)
    assert say_block(window.host).fields["text"] == "Good day"


def test_run_really_runs_what_was_made_in_the_tour(
    window: MainWindow, begun: Tour, qtbot: QtBot
) -> None:
    go_to(begun, RUN)
    runner, asked = window.running.runner, []
    runner.arrived.connect(lambda batch: asked.extend(one for _, one in batch))

    click(window.toolbar.widgetForAction(window.actions_by_name["run"]))

    qtbot.waitUntil(lambda: begun.number == SEE, timeout=RUN_MS)
    qtbot.waitUntil(lambda: runner.state == "idle", timeout=RUN_MS)
    requests = [one for one in asked if isinstance(one, ActionRequest)]
    said = [one.args["text"] for one in requests if one.action == "say"]
    assert said == ["Hello"]


def test_who_presses_next_gets_what_the_next_step_needs(window: MainWindow, begun: Tour) -> None:
    go_to(begun, WORDS)

    assert say_block(window.host).type == "robot.say"
    assert begun.veil.hole.height() < window.workbench.canvas.height() / 2


def test_a_step_that_is_done_already_stays_when_one_goes_back(
    window: MainWindow, begun: Tour, qtbot: QtBot
) -> None:
    go_to(begun, WORDS)

    click(begun.bubble.back_button)
    begun._on_look()

    assert begun.number == DRAG
    assert begun.bubble.back_button.isEnabled()


def test_each_step_shows_a_place_that_the_bubble_leaves_free(
    window: MainWindow, begun: Tour
) -> None:
    for number in range(5):
        go_to(begun, number)
        hole, bubble = begun.veil.hole, begun.bubble.geometry()

        assert not hole.isEmpty()
        assert window.rect().contains(bubble)
        if number != DRAG:  # there the whole page is shown
            assert not bubble.intersects(hole)


def test_a_hidden_panel_is_shown(window: MainWindow, tour: Tour, qtbot: QtBot) -> None:
    palette = window.workbench.helpers.palette
    palette.set_narrow(True)
    for panel in window.workbench.panels.all:
        panel.action.setChecked(False)

    tour.start()

    qtbot.waitUntil(lambda: tour.is_running)
    assert palette.isVisible() and not palette.is_narrow
    qtbot.waitUntil(lambda: palette.width() > palette.categories.width())
    qtbot.waitUntil(lambda: tour.veil.hole == place_of(window.host, palette))


def test_the_veil_follows_the_window(window: MainWindow, begun: Tour, qtbot: QtBot) -> None:
    window.resize(820, 610)

    qtbot.waitUntil(lambda: begun.veil.geometry() == window.rect())
    palette = window.workbench.helpers.palette
    qtbot.waitUntil(lambda: begun.veil.hole == place_of(window.host, palette) & window.rect())
    assert window.rect().contains(begun.bubble.geometry())


def test_the_mouse_goes_through_the_veil(window: MainWindow, begun: Tour) -> None:
    at = window.workbench.canvas.viewport().mapTo(window, QPoint(200, 200))

    assert window.childAt(at) is window.workbench.canvas.viewport()


def test_esc_ends_it_from_the_bubble_and_from_the_page(
    window: MainWindow, begun: Tour, qtbot: QtBot
) -> None:
    QTest.keyClick(begun.bubble.next_button, Qt.Key.Key_Escape)
    assert not begun.is_running and begun.bubble.isHidden() and begun.veil.isHidden()

    begun.start()
    qtbot.waitUntil(lambda: begun.is_running)
    window.workbench.canvas.setFocus()
    QTest.keyClick(window.windowHandle(), Qt.Key.Key_Escape)
    assert not begun.is_running


def test_esc_in_a_field_closes_the_field_only(window: MainWindow, begun: Tour) -> None:
    go_to(begun, WORDS)
    canvas = window.workbench.canvas
    canvas.fields.open(say_block(window.host).id, "text")

    QTest.keyClick(window.windowHandle(), Qt.Key.Key_Escape)

    assert canvas.fields.widget is None
    assert begun.is_running


def test_done_ends_it_and_the_program_stays(window: MainWindow, begun: Tour) -> None:
    go_to(begun, SEE)

    click(begun.bubble.next_button)

    assert not begun.is_running
    assert say_block(window.host) is not None
    assert window.workbench.canvas.hasFocus()


def test_another_project_ends_it(window: MainWindow, begun: Tour) -> None:
    window.files.new()

    assert window.files.document.project.name != "First steps" and not begun.is_running


def test_work_that_is_not_saved_is_asked_about_first(
    karate: MainWindow, tour: Tour, answer: Callable[[QWidget, str], None], qtbot: QtBot
) -> None:
    editor = karate.workbench.canvas.editor
    editor.apply(RenameProject("Mine"))

    tour.start()
    answer(karate, "Cancel")

    assert not tour.is_running
    assert karate.workbench.canvas.editor is editor


def test_the_tour_goes_on_in_another_language_from_right_to_left(
    window: MainWindow, begun: Tour, qtbot: QtBot
) -> None:
    window.studio.choose_language(PSEUDO)
    qtbot.waitUntil(lambda: begun.bubble.next_button.text().startswith("["))
    palette = window.workbench.helpers.palette
    qtbot.waitUntil(lambda: begun.veil.hole == place_of(window.host, palette) & window.rect())
    click(begun.bubble.next_button)

    drag_say_block(window)

    qtbot.waitUntil(lambda: begun.number == WORDS)
    assert window.rect().contains(begun.bubble.geometry())


def test_the_keyboard_reaches_every_button(window: MainWindow, begun: Tour) -> None:
    go_to(begun, DRAG)
    bubble = begun.bubble
    bubble.leave_button.setFocus()

    reached = [window.focusWidget()]
    for _ in range(2):
        QTest.keyClick(window.focusWidget(), Qt.Key.Key_Tab)
        reached.append(window.focusWidget())

    assert reached == [bubble.leave_button, bubble.back_button, bubble.next_button]
    assert bubble.accessibleName().startswith("Step 2 of 5. Drag a block.")


def test_dots_and_words_change_with_the_step(begun: Tour) -> None:
    names = []
    for number in range(5):
        go_to(begun, number)
        names.append(begun.bubble.accessibleName())

    assert all(one != other for one, other in pairwise(names))
    assert begun.bubble.next_button.text() == "Done"
