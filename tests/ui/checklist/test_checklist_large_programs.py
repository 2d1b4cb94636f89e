"""The checklist, large programs: what people ask for most often."""

from __future__ import annotations

from pathlib import Path
from statistics import median

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.files import load, save
from nep_studio.ui.canvas.painting.painter import BlockPainter
from tests.blocks.block_building import B
from tests.ui.checklist.person import Key, PaintedPixels, Person, say, story


def test_a_drag_step_paints_the_same_in_a_program_of_any_size(
    person: Person, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Top ask 1: large programs must stay fluid (20,000 blocks)."""
    painted: list[int] = []
    paint = BlockPainter.paint

    def counting(self, painter, boxes, scale) -> None:
        found = list(boxes)
        painted.append(len(found))
        paint(self, painter, found, scale)

    monkeypatch.setattr(BlockPainter, "paint", counting)

    def painted_in_a_drag() -> tuple[int, float]:
        """How many boxes, and at a usual step how many pixels, are painted."""
        person.qtbot.waitUntil(lambda: not person.canvas.later_layout.isActive(), timeout=60_000)
        for _ in range(3):  # the palette shows what was used last
            QApplication.processEvents()
        block = person.body()[2]
        place = person.carry(block, QPoint(120, 300))
        QApplication.processEvents()
        painted.clear()
        pixels = PaintedPixels()
        person.canvas.viewport().installEventFilter(pixels)
        counts = []
        for step in range(1, 20):
            before = pixels.count
            person.move(place + QPoint(3 * step, 2 * step))
            QApplication.processEvents()
            counts.append(pixels.count - before)
        person.canvas.viewport().removeEventFilter(pixels)
        person.key(Key.Key_Escape)
        person.release(place)
        return sum(painted), median(counts)

    person.make(story())
    small = painted_in_a_drag()
    long = [B("event.started"), *(say(str(n)) for n in range(99))]
    with person.editor.transaction("many"):
        person.make(*[long] * 200)
        for number, stack in enumerate(person.project.pages["behaviour"][1:]):
            column, row = divmod(number, 20)
            person.editor.apply(MoveStack(stack.id, 700.0 + 400 * column, 4000.0 * row))
    person.look_at_corner()
    assert len(person.project.blocks) > 20_000
    large = painted_in_a_drag()

    assert large[0] <= small[0] < 20
    assert small[1] == large[1] < 40_000


def test_a_stack_of_ten_thousand_statements_is_saved_and_opened(
    person: Person, tmp_path: Path
) -> None:
    """Top ask 1: a long stack is saved, opened, dragged and undone."""
    with person.editor.transaction("many"):
        person.make([B("event.started"), *(B("control.wait") for _ in range(9_999))])
    path, before = tmp_path / "long.nep", person.file

    save(person.project, path)
    person.window.files.document.close()
    person.window.files.document = None
    person.window.files.open(path)
    person.qtbot.waitUntil(lambda: person.window.files.document is not None, timeout=20_000)

    assert person.file == before
    assert len(load(path, person.editor.language).pages["behaviour"]) == 1
    person.look_at_corner()
    person.put(person.body()[1], QPoint(450, 300))
    assert [len(stack.body) for stack in person.project.pages["behaviour"]] == [1, 9_999]
    assert person.undo() == before
