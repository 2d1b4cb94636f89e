"""A large page is laid out where somebody looks; the rest follows while nobody waits."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.ui.canvas.layout import page as page_module
from nep_studio.ui.canvas.layout import page as stacks_module
from tests.blocks.block_building import B

CONTROL = Qt.KeyboardModifier.ControlModifier


def nested(depth: int) -> B:
    block = B("robot.say", {"text": "deep"})
    for _ in range(depth):
        block = B("control.repeat", bodies={"do": [block]})
    return block


@pytest.fixture
def waiting(monkeypatch, desk):
    """A page of which only what is in view is laid out, until somebody lets it rest."""
    monkeypatch.setattr(stacks_module, "MOST_AT_ONCE", 10)
    monkeypatch.setattr(page_module, "MOST_STACKS_AT_ONCE", 3)
    stacks = [[B("robot.say", {"text": str(n)}), B("control.wait")] for n in range(20)]
    shown = desk(*stacks)
    shown.canvas.later_layout.stop()
    return shown


def far_chains(shown):
    return shown.canvas.page_layout.chains


def picture(shown):
    return shown.canvas.viewport().grab().toImage()


def spread(shown) -> None:
    """Put the stacks so far below each other that most are out of view."""
    canvas = shown.canvas
    for number, stack in enumerate(shown.editor.project.stacks.values()):
        stack.y = 40.0 + number * 600
    canvas.page_layout.refresh_all()
    canvas.repaint_all()
    canvas.later_layout.stop()
    picture(shown)


def test_a_key_lays_out_no_more_than_it_shows(waiting) -> None:
    spread(waiting)

    QTest.keyClick(waiting.canvas, Qt.Key.Key_Down)

    assert waiting.canvas.selection.cursor == waiting.body(0)[0]
    assert far_chains(waiting).waiting


def test_a_change_to_all_stacks_is_shown_at_once_and_finished_later(waiting, qtbot) -> None:
    spread(waiting)
    waiting.canvas.commands.select_all()

    QTest.keyClick(waiting.canvas, Qt.Key.Key_E, CONTROL)
    shown = picture(waiting)

    assert far_chains(waiting).waiting
    waiting.canvas.repaint_all()
    assert picture(waiting) == shown
    qtbot.waitUntil(lambda: not far_chains(waiting).waiting)


def test_undoing_the_deletion_of_everything_brings_everything_back(waiting, qtbot) -> None:
    spread(waiting)
    waiting.canvas.page_layout.chains.lay_out_all()
    bounds = waiting.canvas.page_layout.bounds()
    waiting.canvas.commands.select_all()

    QTest.keyClick(waiting.canvas, Qt.Key.Key_Delete)
    empty = waiting.canvas.page_layout.bounds()
    QTest.keyClick(waiting.canvas, Qt.Key.Key_Z, CONTROL)
    qtbot.waitUntil(lambda: not far_chains(waiting).waiting)

    assert empty is None
    assert waiting.canvas.page_layout.bounds() == bounds


def test_blocks_deeper_than_was_assumed_are_shown_in_the_end(monkeypatch, desk, qtbot) -> None:
    monkeypatch.setattr(stacks_module, "MOST_AT_ONCE", 10)
    shown = desk([nested(90)])
    blocks = shown.editor.project.blocks.values()
    deepest = next(block.id for block in blocks if block.type == "robot.say")
    placed = shown.canvas.page_layout.placed(deepest)
    shown.canvas.sight.move_camera(placed.x - 10, placed.y - 10)
    shown.canvas.page_layout.refresh_all()
    shown.canvas.repaint_all()
    shown.canvas.later_layout.stop()
    early = picture(shown)
    shown.canvas.later_layout.start()
    qtbot.waitUntil(lambda: not far_chains(shown).waiting)
    QApplication.processEvents()

    late = picture(shown)

    shown.canvas.repaint_all()
    assert late == picture(shown)
    assert late != early
    assert shown.canvas.sight.hit(QPointF(20, 20)) is not None


def test_carried_blocks_come_before_the_layout_of_what_is_out_of_view(waiting) -> None:
    spread(waiting)
    waiting.carry(waiting.body(0)[1], QPointF(500, 500))

    waiting.canvas.later_layout.start()
    waiting.canvas.lay_out_more()

    assert far_chains(waiting).waiting
    waiting.mouse.release()
    for _ in range(50):  # each makes what there is time for
        waiting.canvas.lay_out_more()
    assert not far_chains(waiting).waiting


def test_dropped_blocks_are_not_pushed_away_by_stacks_that_only_seem_large(waiting) -> None:
    spread(waiting)
    block = waiting.body(0)[1]

    waiting.put(block, QPointF(300, 400))

    stack = waiting.editor.project.stack_of(block)
    place = waiting.canvas.sight.to_page(QPointF(300, 400))
    assert abs(stack.x - place.x()) < 2
    assert abs(stack.y - place.y()) < 2


def test_all_of_a_large_selection_is_carried_and_dropped(waiting) -> None:
    spread(waiting)
    places = {s.id: (s.x, s.y) for s in waiting.editor.project.stacks.values()}
    waiting.canvas.commands.select_all()

    block = waiting.body(0)[0]
    waiting.put(block, waiting.corner(block) + QPointF(200, 100))

    moved = {s.id: (s.x - 200, s.y - 100) for s in waiting.editor.project.stacks.values()}
    assert moved == {stack: pytest.approx(place) for stack, place in places.items()}


def test_a_rubber_band_over_everything_selects_the_blocks_of_all_stacks(waiting) -> None:
    waiting.canvas.sight.fit()

    waiting.mouse.drop(QPointF(2, 2), QPointF(995, 795))

    bodies = [s.body for s in waiting.editor.project.stacks.values()]
    assert set(waiting.canvas.selection.ids) == {block for body in bodies for block in body}
