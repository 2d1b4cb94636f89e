"""Deleted blocks can be brought back, and the trash takes blocks."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from nep_studio.ui.workbench.trash import TrashButton

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def trash(canvas) -> TrashButton:
    button = TrashButton(canvas)
    button.show()
    return button


def first_of(canvas, block_type: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == block_type)


def delete(canvas, block_type: str) -> None:
    canvas.selection.set([first_of(canvas, block_type)])
    canvas.commands.delete()


def types(canvas) -> list[str]:
    return sorted(block.type for block in canvas.editor.project.blocks.values())


def test_deleted_blocks_are_counted_and_listed_newest_first(canvas, trash):
    delete(canvas, "robot.do")
    delete(canvas, "control.together")

    titles = [entry.text for entry in trash.panel.shelf.entries]

    assert titles[0].startswith("do together and")
    assert titles[1].startswith("NAO takes the posture")
    assert "2" in trash.accessibleName()


def test_a_press_on_the_trash_opens_the_list_and_closes_it(canvas, trash):
    QTest.mouseClick(trash, LEFT)
    was_open = trash.panel.isVisible()

    QTest.mouseClick(trash, LEFT)

    assert was_open
    assert not trash.panel.isVisible()


def test_escape_closes_the_list(canvas, trash, qtbot):
    trash.click()

    qtbot.keyClick(trash.panel.shelf, Qt.Key.Key_Escape)

    assert not trash.panel.isVisible()
    qtbot.waitUntil(canvas.hasFocus)


def test_the_empty_list_says_what_belongs_there(canvas, trash):
    assert "brought back" in trash.panel.shelf.entries[0].text
    assert not trash.panel.restore.isEnabled()


def test_restore_brings_back_what_was_deleted_last(canvas, trash):
    before = types(canvas)
    delete(canvas, "control.together")

    trash.click()
    QTest.mouseClick(trash.panel.restore, LEFT)

    assert types(canvas) == before
    assert canvas.editor.project.blocks[canvas.selection.ids[0]].type == "control.together"
    assert not trash.trash.clips


def test_enter_restores_what_the_keyboard_is_at(canvas, trash, qtbot):
    delete(canvas, "robot.do")
    delete(canvas, "control.together")
    trash.click()
    trash.panel.shelf.choose_first()
    qtbot.keyClick(trash.panel.shelf, Qt.Key.Key_Down)

    qtbot.keyClick(trash.panel.shelf, Qt.Key.Key_Return)

    assert "robot.do" in types(canvas)
    assert "control.together" not in types(canvas)


def test_deleted_blocks_are_dragged_back(canvas, trash):
    delete(canvas, "robot.do")
    trash.click()
    viewport = trash.panel.shelf.viewport()
    start = trash.panel.shelf.rect_of(0).topLeft() + QPoint(30, 45)
    end = viewport.mapFromGlobal(canvas.viewport().mapToGlobal(QPoint(800, 60)))

    QTest.mousePress(viewport, LEFT, pos=start)
    QTest.mouseMove(viewport, (start + end) / 2)
    QTest.mouseMove(viewport, end)
    QTest.mouseRelease(viewport, LEFT, pos=end)

    assert "robot.do" in types(canvas)


def test_the_list_survives_undo(canvas, trash):
    delete(canvas, "robot.do")
    canvas.editor.history.undo()
    canvas.editor.history.undo()

    assert len(trash.trash.clips) == 1


def test_what_is_brought_back_can_be_undone(canvas, trash):
    delete(canvas, "robot.do")
    before = types(canvas)
    trash.trash.restore(trash.trash.clips[0][0])

    canvas.editor.history.undo()

    assert types(canvas) == before


def test_blocks_come_back_on_a_page_of_their_kind(canvas, trash):
    delete(canvas, "robot.do")
    canvas.show_page("nodes")

    trash.trash.restore(trash.trash.clips[0][0])

    assert canvas.page == "behaviour"


def test_blocks_dropped_on_the_trash_are_deleted_and_it_says_so(canvas, trash):
    block = first_of(canvas, "robot.say")
    place = canvas.sight.view_rect_of(block).topLeft().toPoint() + QPoint(10, 24)
    over = canvas.viewport().mapFromGlobal(trash.mapToGlobal(trash.rect().center()))

    QTest.mousePress(canvas.viewport(), LEFT, pos=place)
    QTest.mouseMove(canvas.viewport(), place + QPoint(20, 20))
    QTest.mouseMove(canvas.viewport(), over)
    was_taking = trash._is_taking
    QTest.mouseRelease(canvas.viewport(), LEFT, pos=over)

    assert was_taking and not trash._is_taking
    assert block not in canvas.editor.project.blocks
    assert len(trash.trash.clips) == 1


def test_forget_all_empties_the_list(canvas, trash):
    delete(canvas, "robot.do")
    trash.click()

    QTest.mouseClick(trash.panel.empty, LEFT)

    assert not trash.trash.clips


def test_the_list_keeps_the_last_fifty(canvas, trash):
    for _ in range(60):
        canvas.selection.set([first_of(canvas, "robot.do")])
        canvas.commands.delete()
        canvas.editor.history.undo()

    assert len(trash.trash.clips) == 50
