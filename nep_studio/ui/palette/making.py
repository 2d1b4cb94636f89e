"""Make variables and own blocks from the palette."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint

from nep_studio.blocks.procedures import DEFINE, procedure_of
from nep_studio.blocks.program import PAGES, Parameter
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.menu_entries import MenuEntry, MenuPlace
from nep_studio.ui.insert_bar_places import free_place
from nep_studio.ui.words import tr

from .asking import Asking
from .make_block import MakeBlockDialog
from .stock import Stock

if TYPE_CHECKING:
    from .palette import Palette


class Making(QObject):
    """Asks for what is needed, and makes it in one step."""

    def __init__(self, palette: Palette) -> None:
        super().__init__(palette)
        self._palette = palette
        self.asking: Asking | None = None
        self.dialog: MakeBlockDialog | None = None
        palette.canvas.menu_sections.append(self._section)

    def ask_for_variable(self) -> None:
        """Ask for the name of a new variable."""
        palette = self._palette
        words = tr("Name of the new variable")
        self.asking = Asking(
            palette, palette.canvas.theme, words, tr("Make"), self.make_variable, name=""
        )
        self.asking.show_at(palette.mapToGlobal(QPoint(palette.width() // 3, 60)))

    def make_variable(self, name: str) -> None:
        """Make a variable, and show its blocks; raises EditRefused."""
        self._palette.canvas.editor.add_variable(name.strip())
        self._palette.canvas.announced.emit(tr("variable {name} made", name=name.strip()))

    def ask_for_block(self) -> None:
        """Ask for the words and values of a new own block."""
        canvas = self._palette.canvas
        self.dialog = MakeBlockDialog(canvas, self.make_block, self._palette)
        self.dialog.open()

    def ask_to_change(self, procedure_id: str) -> None:
        """Ask for other words and values of an own block; all that use it follow, in one step."""
        canvas = self._palette.canvas

        def change(parts: Sequence[str | Parameter], gives_value: bool) -> None:
            canvas.editor.change_procedure(procedure_id, parts, gives_value=gives_value)

        procedure = canvas.editor.project.procedures[procedure_id]
        self.dialog = MakeBlockDialog(canvas, change, self._palette, procedure)
        self.dialog.open()

    def _section(self, canvas: Canvas, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of an own block, of its header and its parameters offers besides."""
        block_type = place.hit.placed.box.type if place.hit is not None else ""
        procedure = procedure_of(block_type)
        if procedure not in canvas.editor.project.procedures:
            return []
        ask = MenuEntry(
            "change_block",
            tr("Change this own block…"),
            lambda: self.ask_to_change(procedure),
            "pencil",
        )
        if not block_type.startswith(DEFINE):
            return [ask]
        delete = MenuEntry(
            "delete_own_block",
            tr("Delete this own block with its definition"),
            lambda: canvas.attempt(lambda: canvas.editor.delete_procedure(procedure)),
            "trash-2",
        )
        return [ask, delete]

    def make_block(self, parts: Sequence[str | Parameter], gives_value: bool) -> None:
        """Make an own block with its header, where one looks; raises EditRefused."""
        canvas = self._palette.canvas
        editor = canvas.editor
        kind = editor.project.kind_of_page(canvas.page)
        page = canvas.page if kind == PAGES[0] else PAGES[0]
        canvas.show_page(page)
        hat = Stock(editor)
        where = free_place(canvas, hat.clip(hat.sample("event.started")))
        place = editor.new_stack(page, where.x(), where.y())
        procedure = editor.add_procedure(parts, gives_value=gives_value, place=place)
        header = editor.project.stacks[place.stack].body[0]
        assert editor.project.blocks[header].type == DEFINE + procedure
        canvas.selection.set([header])
        canvas.show_block(header)
