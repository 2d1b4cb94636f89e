"""What a person does with snippets in the palette: keep, rename, delete, export, import."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QFileDialog, QMenu

from nep_studio.blocks.operations.copying import copy
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.menu_entries import MenuEntry, MenuPlace
from nep_studio.ui.snippets import ENDING, Snippet, file_stem, write_out
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

from .asking import Asking
from .entries import Entry

if TYPE_CHECKING:
    from .palette import Palette


class SnippetMenu(QObject):
    """The menu of a snippet, and the questions that go with it."""

    def __init__(self, palette: Palette) -> None:
        super().__init__(palette)
        self._palette = palette
        self.menu: QMenu | None = None
        self.asking: Asking | None = None
        palette.canvas.menu_sections.append(self._section)

    def open(self, entry: Entry, place: QPoint) -> None:
        """Open the menu of an entry, when it is a snippet."""
        snippet = entry.snippet
        if snippet is None:
            return
        palette, theme = self._palette, self._palette.canvas.theme
        if self.menu is not None:
            self.menu.deleteLater()
        self.menu = QMenu(palette)
        insert = self.menu.addAction(icon("plus", theme), tr("Insert"))
        insert.triggered.connect(lambda: palette.use(entry))
        rename = self.menu.addAction(icon("pencil", theme), tr("Rename…"))
        rename.triggered.connect(lambda: self.ask_to_rename(snippet))
        export = self.menu.addAction(icon("upload", theme), tr("Export…"))
        export.triggered.connect(lambda: self.ask_to_export(snippet))
        self.menu.addSeparator()
        delete = self.menu.addAction(icon("trash-2", theme), tr("Delete…"))
        delete.triggered.connect(lambda: self.ask_to_delete(snippet))
        self.menu.popup(place)

    def _section(self, canvas: Canvas, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of a block offers besides."""
        if place.hit is None:
            return []
        return [MenuEntry("keep", tr("Keep as a snippet…"), self.ask_to_keep, "star")]

    def ask_to_keep(self) -> None:
        """Ask for a name for the selected blocks."""
        canvas = self._palette.canvas
        if not canvas.selection.ids:
            canvas.refused.emit(tr("No blocks are selected. Select those that you want to keep."))
            return
        self._ask(tr("Name of the snippet"), tr("Keep"), self.keep, "")

    def keep(self, name: str) -> None:
        """Keep the selected blocks under a name; raises EditRefused."""
        palette, canvas = self._palette, self._palette.canvas
        ids = canvas.selection.ids
        clip = copy(canvas.editor.project, canvas.editor.language, ids, canvas.corners(ids))
        palette.snippets.keep(name, clip)
        palette.fill()
        canvas.announced.emit(tr("kept as {name}", name=name.strip()))

    def ask_to_rename(self, snippet: Snippet) -> None:
        """Ask for another name."""
        self._ask(
            tr("New name"), tr("Rename"), lambda name: self._rename(snippet, name), snippet.name
        )

    def ask_to_delete(self, snippet: Snippet) -> None:
        """Ask whether to delete a snippet: that cannot be taken back."""
        words = tr("Delete the snippet “{name}”? It cannot be brought back.", name=snippet.name)
        self._ask(words, tr("Delete"), lambda _name: self._delete(snippet), None)

    def ask_to_export(self, snippet: Snippet) -> None:
        """Ask for a file to write a snippet into."""
        start = str(self._palette.settings.last_folder / f"{file_stem(snippet.name)}{ENDING}")
        name, _filter = QFileDialog.getSaveFileName(
            self._palette, tr("Export a snippet"), start, _filters()
        )
        if name:
            self._palette.canvas.attempt(lambda: write_out(snippet, Path(name)))

    def ask_to_import(self) -> None:
        """Ask for a file to take a snippet from."""
        start = str(self._palette.settings.last_folder)
        name, _filter = QFileDialog.getOpenFileName(
            self._palette, tr("Import a snippet"), start, _filters()
        )
        if name:
            self.take_in(Path(name))

    def take_in(self, path: Path) -> None:
        """Take a snippet from a file."""
        palette = self._palette
        language = palette.canvas.editor.language
        if palette.canvas.attempt(lambda: palette.snippets.take_in(path, language)):
            palette.fill()

    def _rename(self, snippet: Snippet, name: str) -> None:
        self._palette.snippets.rename(snippet, name)
        self._palette.fill()

    def _delete(self, snippet: Snippet) -> None:
        self._palette.snippets.delete(snippet)
        self._palette.fill()

    def _ask(self, words: str, yes: str, answer: object, name: str | None) -> None:
        palette = self._palette
        assert callable(answer)
        self.asking = Asking(palette, palette.canvas.theme, words, yes, answer, name)
        self.asking.show_at(palette.mapToGlobal(QPoint(palette.width() // 3, 60)))


def _filters() -> str:
    return tr("Snippets") + f" (*{ENDING} *.nep)"
