"""The card beside a block that says what it is, and what opening a block shows."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.procedures import CALL, DEFINE
from nep_studio.blocks.program import Parameter, Procedure
from nep_studio.ui.workbench.find_bar import FindBar
from nep_studio.ui.workbench.help_card import BlockOpening, HelpCard
from tests.blocks.block_building import B, add

KEY = Qt.Key
OWN = Procedure("p1", ("greet", Parameter("a1", "who", "text")))


@pytest.fixture
def opening(canvas, window) -> BlockOpening:
    bar = FindBar(canvas)
    window.layout().addWidget(bar)
    return BlockOpening(canvas, bar)


def first_of(canvas, block_type: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == block_type)


def card() -> HelpCard:
    shown = QApplication.activePopupWidget()
    assert isinstance(shown, HelpCard)
    return shown


def double_click(canvas, block: str, qtbot) -> None:
    """Double click on the left edge of a block, where it has no field."""
    canvas.show_block(block)
    rect = canvas.sight.view_rect_of(block)
    place = rect.topLeft().toPoint() + QPoint(4, round(min(rect.height(), 30) / 2))
    assert canvas.sight.hit(place).block == block
    viewport, left = canvas.viewport(), Qt.MouseButton.LeftButton
    qtbot.mouseClick(viewport, left, pos=place)
    qtbot.mouseDClick(viewport, left, pos=place)
    qtbot.mouseRelease(viewport, left, pos=place)


def test_f1_tells_about_the_selected_block_and_escape_takes_the_card_away(canvas, opening, qtbot):
    canvas.selection.set([first_of(canvas, "robot.say")])

    qtbot.keyClick(canvas, KEY.Key_F1)

    shown = card()
    told = shown.text.toPlainText()
    assert "Show me karate" in told
    assert "The program waits here until it is done." in told
    assert "text: a text" in told
    assert "explain" in told  # a choice
    assert "nao.say(" in told
    assert shown.text.accessibleName() == told
    qtbot.keyClick(shown.text, KEY.Key_Escape)
    qtbot.waitUntil(lambda: QApplication.activePopupWidget() is None)


def test_help_of_the_menu_opens_the_card(canvas, opening, qtbot):
    block = first_of(canvas, "event.gesture")
    canvas.pointing.request_menu(
        canvas.sight.view_rect_of(block).topLeft().toPoint() + QPoint(12, 20)
    )

    help_action = next(each for each in canvas.menu.actions() if each.text() == "Help")
    canvas.menu.close()
    help_action.trigger()

    assert "It begins a stack" in card().text.toPlainText()
    card().close()


def test_f1_without_a_selected_block_shows_nothing(canvas, opening, qtbot):
    canvas.selection.clear()

    qtbot.keyClick(canvas, KEY.Key_F1)

    assert QApplication.activePopupWidget() is None


def test_a_card_is_inside_the_screen_and_reads_from_the_side_of_the_canvas(canvas, opening, qtbot):
    canvas.set_look(canvas.look.theme, canvas.look.block_font, is_mirrored=True)
    canvas.selection.set([first_of(canvas, "control.together")])

    qtbot.keyClick(canvas, KEY.Key_F1)

    shown = card()
    assert shown.layoutDirection() == Qt.LayoutDirection.RightToLeft
    assert QApplication.primaryScreen().availableGeometry().contains(shown.geometry())
    shown.close()


def test_every_block_of_the_language_has_a_card(canvas, opening):
    editor = canvas.editor
    for number, definition in enumerate(editor.language.definitions.values()):
        page = definition.page
        place = NewStack(page, f"n{number}", 0.0, 0.0, len(editor.project.pages[page]))
        block = add(editor, B(definition.id), place)

        shown = HelpCard(canvas, block)

        assert len(shown.text.toPlainText()) > 20
        shown.deleteLater()


def test_a_double_click_on_a_block_without_a_definition_opens_the_card(canvas, opening, qtbot):
    double_click(canvas, first_of(canvas, "control.together"), qtbot)

    assert "It holds other blocks" in card().text.toPlainText()
    card().close()


def test_enter_on_a_call_of_an_own_block_goes_to_its_definition(canvas, opening, qtbot):
    editor = canvas.editor
    editor.apply(AddProcedure(Procedure("p2", ("wave",)), 0))
    header = add(editor, B(f"{DEFINE}p2"), NewStack("behaviour", "s8", 0.0, 900.0, 2))
    call = add(editor, B(f"{CALL}p2"), NewStack("behaviour", "s9", 0.0, 1200.0, 3))
    canvas.selection.set([call])

    qtbot.keyClick(canvas, KEY.Key_Return)

    assert canvas.selection.ids == (header,)


def test_a_double_click_on_a_variable_shows_its_uses(canvas, opening, qtbot):
    double_click(canvas, first_of(canvas, "variable.get"), qtbot)

    assert opening._find_bar.isVisible()
    assert len(opening._find_bar.hits) == 3


def test_enter_on_a_parameter_shows_its_uses(canvas, opening, qtbot):
    editor = canvas.editor
    editor.apply(AddProcedure(OWN, 0))
    add(editor, B(f"{DEFINE}p1"), NewStack("behaviour", "s8", 0.0, 900.0, 2))
    pill = add(editor, B("my.parameter.p1.a1"), NewStack("behaviour", "s9", 0.0, 1200.0, 3))
    canvas.selection.set([pill])

    qtbot.keyClick(canvas, KEY.Key_Return)

    assert pill in opening._find_bar.hits
