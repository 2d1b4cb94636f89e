"""The palette: a search box, how many blocks are shown, their categories, and their list."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QMenu, QToolButton, QWidget

from nep_studio.blocks.editor import Editor, History
from nep_studio.blocks.edits import Edit
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.errors import EditRefused, PackError
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import copy
from nep_studio.blocks.operations.finding import folded
from nep_studio.blocks.packs import Pack
from nep_studio.blocks.program import FIRST_BLOCKS, Changes, Project
from nep_studio.project.library import Library
from nep_studio.settings import Settings
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import Asking
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.placing import insert_clip
from nep_studio.ui.workbench.snippets import ENDING, Snippet, Snippets, file_stem, write_out

from . import entries
from .categories import CategoryColumn, add_delete_area, is_taking
from .entries import Drawer, Entry, Stock
from .levels import Level, LevelBar, can_be_first, changed_first, chosen_level, first_types
from .make_block import Making
from .shelf import Shelf

# The blocks that a person used last, newest first.

MOST_RECENT = 8


def recent_types(settings: Settings, language: Language, kind: str) -> list[str]:
    """The types used last that belong on a kind of page and that there still are."""
    known = (language.definitions.get(name) for name in settings.recent_blocks)
    return [one.id for one in known if one is not None and one.page == kind][:MOST_RECENT]


def remember_types(settings: Settings, types: Iterable[str]) -> bool:
    """Put types of blocks first; own blocks belong to one project only and are left out.

    Gives whether the list is another one now.
    """
    before = settings.recent_blocks
    used = [name for name in dict.fromkeys(types) if name.count(".") == 1]
    after = [*used, *(name for name in before if name not in used)][: 3 * MOST_RECENT]
    if after == before:
        return False
    settings.recent_blocks = after
    return True


# Find blocks of the palette by what a person types.

MOST_FOUND = 60


def found_samples(stock: Stock, samples: Iterable[str], typed: str, project: Project) -> list[str]:
    """The samples that fit what is typed, the best first.

    First those whose sentences are meant, also by other words and with a letter wrong; then
    those that have all the words anywhere: in a choice, in the name of the category.
    """
    from nep_studio.blocks.typing_in.suggesting import suggestions  # it reads Python

    meant = suggestions(typed, stock.language, project, limit=MOST_FOUND)
    rank: dict[str, int] = {}
    for suggestion in meant:
        rank.setdefault(suggestion.block_type, len(rank))
    words = folded(typed).split()
    ranked = []
    for number, sample in enumerate(dict.fromkeys(samples)):
        place = rank.get(stock.project.blocks[sample].type)
        if place is not None:
            ranked.append((place, number, sample))
        elif all(word in _said(stock, sample) for word in words):
            ranked.append((MOST_FOUND, number, sample))
    return [sample for _place, _number, sample in sorted(ranked)]


def _said(stock: Stock, sample: str) -> str:
    return folded(f"{stock.words(sample)} {stock.definition(sample).category.title}")


# What a person does with what is in the palette: choose the first blocks; keep, rename, delete,
# export and import snippets.


class EntryMenu(QObject):
    """The menu of a block or a snippet, and the questions that go with it."""

    def __init__(self, palette: Palette) -> None:
        super().__init__(palette)
        self._palette = palette
        self.menu: QMenu | None = None
        self.asking: Asking | None = None
        palette.canvas.menu_sections.append(self._section)

    def open(self, entry: Entry, place: QPoint) -> None:
        """Open the menu of an entry, when it is a block or a snippet."""
        snippet = entry.snippet
        if snippet is None and not entry.sample:
            return
        palette, theme = self._palette, self._palette.canvas.look.theme
        if self.menu is not None:
            self.menu.deleteLater()
        self.menu = QMenu(palette)
        add = self.menu.addAction
        add(icon("plus", theme), tr("Insert"), lambda: palette.use(entry))
        if snippet is None:
            self._add_of_library(self.menu, palette.shelf.pack_of(entry))
            self._add_of_first(self.menu, palette.shelf.type_of(entry))
            self.menu.popup(place)
            return
        add(icon("pencil", theme), tr("Rename…"), lambda: self.ask_to_rename(snippet))
        add(icon("upload", theme), tr("Export…"), lambda: self.ask_to_export(snippet))
        self.menu.addSeparator()
        add(icon("trash-2", theme), tr("Delete…"), lambda: self.ask_to_delete(snippet))
        self.menu.popup(place)

    def _add_of_first(self, menu: QMenu, block_type: str) -> None:
        """What makes the first blocks of this project others; it is kept with the project."""
        canvas = self._palette.canvas
        editor, theme = canvas.editor, canvas.look.theme
        project, language = editor.project, editor.language
        if not can_be_first(language, block_type):
            return

        def keep(edit: SetExtra) -> None:
            canvas.attempt(lambda: editor.apply(edit, "choose the first blocks"))

        change = changed_first(project, language, block_type)
        is_first = block_type in first_types(project, language)
        words = (
            tr("Take away from the first blocks") if is_first else tr("Put among the first blocks")
        )
        sign = icon("minus" if is_first else "blocks", theme)
        menu.addSeparator()
        act = menu.addAction(sign, words, lambda: keep(change) if change is not None else None)
        act.setEnabled(change is not None)
        if FIRST_BLOCKS in project.extra:
            usual = SetExtra(FIRST_BLOCKS, None)
            menu.addAction(icon("undo-2", theme), tr("The usual first blocks"), lambda: keep(usual))

    def _add_of_library(self, menu: QMenu, pack: Pack | None) -> None:
        """What takes the pack of a block out of the person's library."""
        if pack is not None:
            words = tr("Take “{pack}” out of my library…", pack=pack.title)
            sign = icon("trash-2", self._palette.canvas.look.theme)
            menu.addAction(sign, words.replace("&", "&&"), lambda: self.ask_to_take_out(pack))

    def ask_to_take_out(self, pack: Pack) -> None:
        """Ask whether a pack leaves the library: that cannot be taken back."""
        words = tr(
            "Take “{pack}” out of your library? Projects that have its blocks keep them.",
            pack=pack.title,
        )
        self._ask(words, tr("Take out"), lambda _name: self._take_out(pack), None)

    def _take_out(self, pack: Pack) -> None:
        palette = self._palette
        try:
            palette.library.remove(pack, palette.canvas.editor.language)
        except PackError as error:  # the question says why, and stays
            raise EditRefused(error.sentence, checklist=error.checklist) from error
        palette.fill()

    def _section(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of a block offers besides."""
        if place.hit is None:
            return []
        return [MenuEntry("keep", tr("Keep as a snippet…"), self.ask_to_keep, "star")]

    def ask_to_keep(self) -> None:
        """Ask for a name for the selected blocks."""
        canvas = self._palette.canvas
        if not canvas.selection.ids:
            canvas.news.refused.emit(
                tr("No blocks are selected. Select those that you want to keep.")
            )
            return
        self._ask(tr("Name of the snippet"), tr("Keep"), self.keep, "")

    def keep(self, name: str) -> None:
        """Keep the selected blocks under a name; raises EditRefused."""
        palette, canvas = self._palette, self._palette.canvas
        ids = canvas.selection.ids
        clip = copy(
            canvas.editor.project, canvas.editor.language, ids, canvas.page_layout.corners(ids)
        )
        palette.snippets.keep(name, clip)
        palette.fill()
        canvas.news.announced.emit(tr("kept as {name}", name=name.strip()))

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
        title, parent = tr("Export a snippet"), self._palette
        name, _filter = QFileDialog.getSaveFileName(parent, title, start, _filters())
        if name:
            self._palette.canvas.attempt(lambda: write_out(snippet, Path(name)))

    def ask_to_import(self) -> None:
        """Ask for a file to take a snippet from."""
        start = str(self._palette.settings.last_folder)
        title, parent = tr("Import a snippet"), self._palette
        name, _filter = QFileDialog.getOpenFileName(parent, title, start, _filters())
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

    def _ask(self, words: str, yes: str, answer: Callable[[str], object], name: str | None) -> None:
        palette = self._palette
        self.asking = Asking(palette, palette.canvas.look.theme, words, yes, answer, name)
        self.asking.show_at(palette.mapToGlobal(QPoint(palette.width() // 3, 60)))


def _filters() -> str:
    return tr("Snippets") + f" (*{ENDING} *.nep)"


WIDEST = 16_777_215
"""What Qt takes for no limit."""


SHELF_LINES = 13.5
"""How wide the list of blocks wants to be, in lines of text."""

LEAST_SHELF_LINES = 11.0
"""Where the list would be narrower, the categories leave their names away."""


class Palette(QWidget):
    """The blocks that belong on the page of a canvas: the first ones, more of them, or all.

    ``narrowed`` says that it became a narrow column of signs, or wide again; ``room_asked`` that
    it wants another width, for that or because it shows more blocks or fewer.
    """

    narrowed = Signal(bool)
    room_asked = Signal()

    def __init__(
        self,
        canvas: Canvas,
        settings: Settings,
        snippets: Snippets | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.canvas = canvas
        self.settings = settings
        self.snippets = snippets or Snippets(settings.folder / "snippets")
        self.search = labelled(QLineEdit(self), placeholder="Search blocks", name="Search blocks")
        self.library = Library(settings.folder / "library")
        self._sign = QAction(self.search)
        self.fold = QToolButton(self)
        self.categories = CategoryColumn(self)
        self.shelf = labelled(Shelf(canvas, self), name="Blocks to use")
        self.making = Making(self)
        self.snippet_menu = EntryMenu(self)
        self.is_narrow = False
        self.level = chosen_level(settings)
        self.levels = LevelBar(self.level, self)
        self._recent: list[str] | None = None
        """What is listed as used last: it may be older than what was, so that nothing moves."""
        self._drawers: list[Drawer] = []
        self._history: History | None = None
        self._goes_to_top = False
        self._later = QTimer(self, singleShot=True, interval=0)
        self.fold.setAutoRaise(True)
        self.search.setClearButtonEnabled(True)
        self.search.addAction(self._sign, QLineEdit.ActionPosition.LeadingPosition)
        top = in_row(self.fold, (self.search, 1), margins=(4, 4, 4, 2))
        switch = in_row((self.levels, 1), margins=(4, 0, 4, 4))
        below = in_row(self.categories, (self.shelf, 1), spacing=0)
        in_column(top, switch, (below, 1), of=self, margins=0, spacing=0)
        self._connect()
        add_delete_area(canvas, self)
        labelled(self, name="Palette")
        self.refresh()
        follow_words(self, self._say)

    # What is shown

    def refresh(self) -> None:
        """Take the theme, the direction and the project of the canvas."""
        self._sign.setIcon(icon("search", self.canvas.look.theme))
        self._recent = None
        self._listen()
        self.shelf.refresh()
        self._say()

    def _say(self) -> None:
        self._show_fold()
        self.fill()

    def fill(self, *, to_top: bool = False) -> None:
        """Show the blocks for the page, or those that are searched for, when somebody looks."""
        editor = self.canvas.editor
        kind = editor.project.kind_of_page(self.canvas.page)
        if self._recent is None or not self._is_at_hand():
            self._recent = recent_types(self.settings, editor.language, kind)
        recent = self._recent
        level = self.level if kind == "behaviour" else "all"  # other pages have few blocks
        self._drawers = entries.drawers_of(
            editor,
            kind,
            level,
            has_recent=bool(recent),
            has_snippets=self.snippets.are_any,
            has_library=self.library.are_any,
        )
        self.categories.show_drawers(self._drawers, self.canvas.look.theme)
        self._fit()
        self._goes_to_top |= to_top
        self.shelf.fill_later(partial(self._fill_shelf, editor, kind, level, recent))

    def _fill_shelf(self, editor: Editor, kind: str, level: Level, recent: Sequence[str]) -> None:
        stock = Stock(editor, self.library.packs(editor.language))
        typed = self.search.text().strip()
        if typed:
            of_page = (one.id for one in editor.language.categories if one.page == kind)
            samples = [sample for category in of_page for sample in stock.offered(category)]
            found = found_samples(stock, samples, typed, editor.project)
            shown = entries.found_entries(stock, found, typed, level)
        else:
            kept = self.snippets.all(editor.language)
            shown = entries.entries_of(stock, self._drawers, level, recent, kept)
        self.shelf.show_entries(stock, shown, to_top=self._goes_to_top or bool(typed))
        self._goes_to_top = False

    def open_drawer(self, drawer: str) -> None:
        """Show a category; a narrow palette becomes wide."""
        self.set_narrow(False)
        if drawer == entries.RECENT:
            self._recent = None
            self.fill()
        if self.search.text():
            self.search.clear()
        self.shelf.show_drawer(drawer)
        self.categories.mark(drawer)

    def offer(self, drawer: str) -> None:
        """Show a category, with all blocks where it has none among fewer."""
        if all(one.id != drawer for one in self._drawers):
            self.set_level("all")
        self.open_drawer(drawer)

    def set_level(self, level: Level) -> None:
        """Show the first blocks, more of them, or all; that is how it is at the next start, too."""
        if level == self.level:
            return
        self.level = self.settings.palette_level = level
        self.levels.show_level(level)
        self._recent = None
        self.fill(to_top=True)
        self.room_asked.emit()

    def set_narrow(self, is_narrow: bool) -> None:
        """Become a narrow column of signs, or wide again."""
        if is_narrow == self.is_narrow:
            return
        self.is_narrow = is_narrow
        self.search.setVisible(not is_narrow)
        self.levels.setVisible(not is_narrow)
        self.shelf.setVisible(not is_narrow)
        self._fit()
        self._show_fold()
        self.narrowed.emit(is_narrow)
        self.room_asked.emit()

    def sizeHint(self) -> QSize:
        """Room for the categories and most blocks."""
        line = self.fontMetrics().height()
        if self.is_narrow:
            return QSize(self.maximumWidth(), 30 * line)
        signs = self.categories.wide_width if self._has_categories else 0
        return QSize(signs + round(SHELF_LINES * line), 30 * line)

    @property
    def _has_categories(self) -> bool:
        """Whether the categories stand beside the list: the first blocks need no way to them."""
        return self.is_narrow or self.level != "first"

    # What it does

    def use(self, entry: Entry) -> None:
        """Insert the blocks of an entry, or do what a button says."""
        if entry.kind == "button":
            self._press(entry.action)
            return
        clip = self.shelf.clip_of(entry)
        if clip is not None:
            insert_clip(self.canvas, clip)

    def start_search(self, letter: str = "") -> None:
        """Give the search box the keyboard, and a first letter."""
        self.set_narrow(False)
        self.search.setFocus(Qt.FocusReason.ShortcutFocusReason)
        if letter:
            self.search.setText(letter)
        else:
            self.search.selectAll()

    def _press(self, action: str) -> None:
        if action == entries.MAKE_BLOCK:
            self.making.ask_for_block()
        elif action == entries.NEW_VARIABLE:
            self.making.ask_for_variable()
        elif action == entries.KEEP_SNIPPET:
            self.snippet_menu.ask_to_keep()
        else:
            self.snippet_menu.ask_to_import()

    # Put together

    def _connect(self) -> None:
        canvas = self.canvas
        self.search.textChanged.connect(lambda: self.fill(to_top=True))
        self.search.installEventFilter(self)
        self.fold.clicked.connect(lambda: self.set_narrow(not self.is_narrow))
        self.levels.chosen.connect(self.set_level)
        self.categories.opened.connect(self.open_drawer)
        self.shelf.chosen.connect(self.use)
        self.shelf.typed.connect(self.start_search)
        self.shelf.left_upwards.connect(self.search.setFocus)
        self.shelf.drawer_shown.connect(lambda drawer: self.categories.mark(drawer.id))
        self.shelf.menu_asked.connect(self.snippet_menu.open)
        canvas.news.page_changed.connect(self._on_page_changed)
        canvas.news.delete_area_entered.connect(self._on_delete_area_entered)
        self._later.timeout.connect(self.fill)

    def _fit(self) -> None:
        """Be no wider than the signs while the palette is narrow; give the list its room."""
        self.categories.setVisible(self._has_categories)
        self.categories.set_narrow(self.is_narrow or self._is_tight())
        # names that are shown for the first time may be wider than they were measured
        self.categories.set_narrow(self.is_narrow or self._is_tight())
        widest = self.categories.maximumWidth() + 4 if self.is_narrow else WIDEST
        if widest != self.maximumWidth():
            self.setMaximumWidth(widest)
            if self.is_narrow:  # the signs have another size: a new font, the first look
                self.room_asked.emit()

    def _is_tight(self) -> bool:
        """Whether the names of the categories would leave the list too little room."""
        least = self.categories.wide_width + LEAST_SHELF_LINES * self.fontMetrics().height()
        return self.width() < least

    def _show_fold(self) -> None:
        is_wide = not self.is_narrow
        side = self.fontMetrics().height()
        self.fold.setIcon(icon("panel-left", self.canvas.look.theme))
        self.fold.setIconSize(QSize(side, side))
        labelled(self.fold, tip="Make the palette narrow" if is_wide else "Show the blocks")
        self.fold.setAccessibleName(self.fold.toolTip())

    def _listen(self) -> None:
        """Hear of the changes of the project that the canvas shows now."""
        history = self.canvas.editor.history
        if history is self._history:
            return
        if self._history is not None:
            self._history.unlisten(self._on_whole_changed)
            self._history.unrecord(self._on_edits)
        self._history = history
        history.listen(self._on_whole_changed, is_of_whole=True)
        history.record(self._on_edits)

    def _on_whole_changed(self, changes: Changes) -> None:
        self._later.start()

    def _on_edits(self, edits: tuple[Edit, ...]) -> None:
        """Remember what was used: the first block of what was made."""
        made = [edit for edit in edits if isinstance(edit, CreateBlocks)]
        types = [b.type for edit in made for b in edit.blocks if b.id == edit.roots[0]]
        if types and remember_types(self.settings, types):
            self._later.start()

    def _is_at_hand(self) -> bool:
        """Whether a hand is at the palette: then nothing in it may move."""
        return self.underMouse() or self.shelf.hasFocus() or _is_pressed()

    def leaveEvent(self, event: QEvent) -> None:
        """List what was used last, now that the pointer is elsewhere."""
        super().leaveEvent(event)
        if not _is_pressed():
            self._recent = None
        self._later.start()

    def _on_page_changed(self, page: str) -> None:
        self._recent = None
        self._listen()
        self.fill(to_top=True)

    def _on_delete_area_entered(self, is_over: bool) -> None:
        self.shelf.set_delete(is_over and is_taking(self.canvas, self))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show the names of the categories where there is room for them."""
        super().resizeEvent(event)
        self._fit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """In the search box, Down goes to the list, Enter inserts the first, Esc clears."""
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        key = event.key()
        if key == Qt.Key.Key_Down:
            self.shelf.setFocus(Qt.FocusReason.OtherFocusReason)
            self.shelf.choose_first()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.search.text():
            self.shelf.choose_first()
            if self.shelf.current is not None:
                self.use(self.shelf.current)
        elif key == Qt.Key.Key_Escape and self.search.text():
            self.search.clear()
        else:
            return super().eventFilter(watched, event)
        return True


def _is_pressed() -> bool:
    """Whether something is being dragged."""
    return QApplication.mouseButtons() != Qt.MouseButton.NoButton
