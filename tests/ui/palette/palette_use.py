"""What a person does with the palette in tests: find a block, click it, drag it out."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from nep_studio.ui.workbench.palette.palette import Palette
from nep_studio.ui.workbench.palette.shelf import Shelf

LEFT = Qt.MouseButton.LeftButton


def type_of(palette: Palette, number: int) -> str:
    sample = palette.shelf.entries[number].sample
    return palette.shelf._stock.project.blocks[sample].type if sample else ""


def listed(palette: Palette) -> list[str]:
    return [name for n in range(len(palette.shelf.entries)) if (name := type_of(palette, n))]


def number_of(palette: Palette, block_type: str) -> int:
    count = len(palette.shelf.entries)
    return next(n for n in range(count) if type_of(palette, n) == block_type)


def grip(shelf: Shelf, number: int) -> QPoint:
    """A place on the block of an entry, scrolled into view."""
    shelf._go_to(number)
    rect = shelf.rect_of(number)
    return QPoint(rect.center().x(), rect.top() + 12)


def click(palette: Palette, block_type: str) -> None:
    place = grip(palette.shelf, number_of(palette, block_type))
    QTest.mouseClick(palette.shelf.viewport(), LEFT, pos=place)


def press_and_drag(palette: Palette, block_type: str, to_canvas: QPoint) -> None:
    """Press a block of the palette and bring it over the canvas; the button stays down."""
    viewport = palette.shelf.viewport()
    start = grip(palette.shelf, number_of(palette, block_type))
    end = viewport.mapFromGlobal(palette.canvas.viewport().mapToGlobal(to_canvas))
    QTest.mousePress(viewport, LEFT, pos=start)
    for step in (0.2, 0.6, 1.0):
        QTest.mouseMove(viewport, start + (end - start) * step)


def drop(palette: Palette, at_canvas: QPoint) -> None:
    viewport = palette.shelf.viewport()
    place = viewport.mapFromGlobal(palette.canvas.viewport().mapToGlobal(at_canvas))
    QTest.mouseRelease(viewport, LEFT, pos=place)


def types(palette: Palette) -> list[str]:
    return [block.type for block in palette.canvas.editor.project.blocks.values()]
