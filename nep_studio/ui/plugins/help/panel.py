"""The help panel: search and contents above or beside the page, ways back, and the example."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QIcon, QKeyEvent, QPageLayout, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QSplitter,
    QStackedWidget,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QTreeWidgetItemIterator,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.help.index import Findable, Hit, Index
from nep_studio.help.texts import BLOCK, CATEGORY, HOME, NODE, examples, split
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import UnknownIcon, icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row
from nep_studio.ui.widgets.questions import name_what_is_printed
from nep_studio.ui.words import is_right_to_left, tr

from .browser import ZOOM_STEP, ExampleBar, HelpBrowser
from .repository import Book, Content, Rows

if TYPE_CHECKING:
    from PySide6.QtPrintSupport import QPrinter

# The contents of the help as a tree, and what a search found as a list.

PAGE = Qt.ItemDataRole.UserRole
KIND_ICONS = {BLOCK: "blocks", CATEGORY: "layers", NODE: "network"}


class ContentsView(QStackedWidget):
    """The tree, or what was found. ``chosen`` brings the name of a page."""

    chosen = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.tree = labelled(QTreeWidget(), name="Contents of the help")
        self.tree.setHeaderHidden(True)
        self.tree.setUniformRowHeights(True)
        self.found = labelled(FoundList(), name="Pages found")
        self.found.setUniformItemSizes(True)
        for view in (self.tree, self.found):
            view.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
            view.setTextElideMode(Qt.TextElideMode.ElideRight)
            view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
            self.addWidget(view)
        self.tree.itemClicked.connect(self._on_tree_used)
        self.tree.itemActivated.connect(self._on_tree_used)
        self.found.itemClicked.connect(self.choose_found)
        self.found.itemActivated.connect(self.choose_found)

    def fill(self, contents: Iterable[Content], theme: Theme) -> None:
        """Show these contents."""
        side = self.fontMetrics().height()
        self.tree.setIconSize(QSize(side, side))
        self.found.setIconSize(QSize(side, side))
        self.tree.clear()
        for content in contents:
            item = _item(content, theme)
            self.tree.addTopLevelItem(item)
            item.setExpanded(True)

    def mark(self, name: str) -> None:
        """Show in the tree which page is shown."""
        page, marked = split(name)[0], self.tree.currentItem()
        if marked is not None and marked.data(0, PAGE) == page:
            return
        each = QTreeWidgetItemIterator(self.tree)
        while (item := each.value()) is not None:
            if item.data(0, PAGE) == page and item.childCount() == 0:
                self.tree.setCurrentItem(item)
                self.tree.scrollToItem(item)
                return
            each += 1

    def show_found(self, hits: Iterable[Hit], typed: str, theme: Theme) -> None:
        """Show what a search found, the best first."""
        self.found.clear()
        for hit in hits:
            kinds = (name for kind, name in KIND_ICONS.items() if hit.page.startswith(kind))
            item = QListWidgetItem(_icon(next(kinds, "book-open"), theme), hit.title)
            item.setData(PAGE, hit.page)
            item.setToolTip(hit.title)
            self.found.addItem(item)
        if self.found.count():
            self.found.setCurrentRow(0)
        else:
            self.found.addItem(tr("Nothing says “{typed}”. Try another word.", typed=typed))
            self.found.item(0).setFlags(Qt.ItemFlag.NoItemFlags)
        self.setCurrentWidget(self.found)

    def choose_found(self) -> None:
        """Choose what is marked among what was found."""
        item = self.found.currentItem()
        if item is not None and item.data(PAGE):
            self.chosen.emit(item.data(PAGE))

    def _on_tree_used(self, item: QTreeWidgetItem, column: int) -> None:
        if item.parent() is None:
            item.setExpanded(not item.isExpanded())
        else:
            self.chosen.emit(item.data(0, PAGE))


class FoundList(QListWidget):
    """A list whose first row is left upwards with the arrow key."""

    left_upwards = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go back to the search from the first row."""
        if event.key() == Qt.Key.Key_Up and self.currentRow() <= 0:
            self.left_upwards.emit()
        else:
            super().keyPressEvent(event)


def _item(content: Content, theme: Theme) -> QTreeWidgetItem:
    item = QTreeWidgetItem([content.title])
    item.setData(0, PAGE, content.page)
    item.setToolTip(0, content.title)
    if content.icon:
        item.setIcon(0, _icon(content.icon, theme))
    item.addChildren([_item(inner, theme) for inner in content.inside])
    return item


def _icon(name: str, theme: Theme) -> QIcon:
    try:
        return icon(name, theme)
    except UnknownIcon:  # a manifest may name one that this program does not have
        return icon("box", theme)


# The row above the help: back and forth, search, contents, size, print.


class ToolRow(QWidget):
    """Buttons, and a field to search in."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.back = explained(QToolButton(autoRaise=True), "Back")
        self.forward = explained(QToolButton(autoRaise=True), "Forward")
        self.home = explained(QToolButton(autoRaise=True), "First page of the help")
        self.contents = explained(QToolButton(autoRaise=True), "Contents")
        self.contents.setCheckable(True)
        self.smaller = explained(QToolButton(autoRaise=True), "Smaller text")
        self.larger = explained(QToolButton(autoRaise=True), "Larger text")
        self.print = explained(QToolButton(autoRaise=True), "Print this page…")
        self.search = QLineEdit(clearButtonEnabled=True)
        labelled(self.search, placeholder="Search the help", name="Search the help")
        self._sign = QAction(self.search)
        self.search.addAction(self._sign, QLineEdit.ActionPosition.LeadingPosition)
        ways = self.back, self.forward, self.home, self.contents
        sizes = self.smaller, self.larger, self.print
        buttons = in_row(*ways, 1, *sizes, spacing=0)
        gap = self.fontMetrics().height() // 4
        in_column(buttons, self.search, of=self, margins=gap, spacing=gap)

    def dress(self, theme: Theme) -> None:
        """Take the theme and the size of the text."""
        back, forward = "arrow-left", "arrow-right"
        if is_right_to_left():
            back, forward = forward, back
        names = {
            self.back: back,
            self.forward: forward,
            self.home: "house",
            self.contents: "list-tree",
            self.smaller: "zoom-out",
            self.larger: "zoom-in",
            self.print: "printer",
        }
        side = self.fontMetrics().height()
        for button, name in names.items():
            button.setIcon(icon(name, theme))
            button.setIconSize(QSize(side, side))
        self._sign.setIcon(icon("search", theme))


# The pages that were read, to go back and forth between.

MOST_STEPS = 200


@dataclass
class Step:
    """A page, and how far it was scrolled."""

    page: str
    place: int = 0


@dataclass
class Trail:
    """Where a reader has been, and where they are among that."""

    _steps: list[Step] = field(default_factory=list)
    _at: int = -1

    @property
    def current(self) -> str:
        """The page that is read; empty when none is."""
        return self._steps[self._at].page if self._at >= 0 else ""

    @property
    def place(self) -> int:
        """How far it was scrolled when it was left."""
        return self._steps[self._at].place if self._at >= 0 else 0

    @property
    def can_go_back(self) -> bool:
        """Whether there is a page before."""
        return self._at > 0

    @property
    def can_go_forward(self) -> bool:
        """Whether there is a page after."""
        return self._at < len(self._steps) - 1

    def leave(self, place: int) -> None:
        """Note how far the page is scrolled."""
        if self._at >= 0:
            self._steps[self._at].place = place

    def go(self, page: str) -> None:
        """Read another page; what was gone back from is forgotten."""
        if page == self.current:
            return
        del self._steps[self._at + 1 :]
        self._steps.append(Step(page))
        del self._steps[:-MOST_STEPS]
        self._at = len(self._steps) - 1

    def move(self, way: int, place: int) -> bool:
        """Go to the page before (-1) or after (1) one at a place; False when there is none."""
        self.leave(place)
        if not 0 <= self._at + way < len(self._steps):
            return False
        self._at += way
        return True


# Searches the help; what is searched is read a little at a time, so that nothing waits.

SLICE_S = 0.008


class Searching(QObject):
    """An index that grows while nobody needs the window. ``found`` brings hits and the words."""

    found = Signal(list, str)

    def __init__(self, book: Callable[[], Book], parent: QObject) -> None:
        super().__init__(parent)
        self._book = book
        self._index: Index | None = None
        self._waiting: Iterator[Findable] | None = None
        self._asked = ""
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self._go_on)

    @property
    def is_whole(self) -> bool:
        """Whether all pages have been read."""
        return self._index is not None and self._waiting is None

    def forget(self) -> None:
        """Forget what was read: the pages are in another language now."""
        self._index = self._waiting = None
        self._later.stop()

    def begin(self) -> None:
        """Begin to read the pages, if nobody has yet."""
        if self._index is None:
            book = self._book()
            self._index, self._waiting = book.new_index(), book.findables()
            self._later.start()

    def search(self, typed: str) -> None:
        """Tell what is found so far, and again when all pages have been read."""
        self.begin()
        self._asked = typed
        self._tell()

    def finish(self, typed: str) -> None:
        """Read what is left at once, and tell what is found."""
        self.begin()
        self._asked = typed
        while self._waiting is not None:
            self._go_on()
        self._tell()

    def _go_on(self) -> None:
        until_s = time.perf_counter() + SLICE_S
        while self._waiting is not None and time.perf_counter() < until_s:
            findable = next(self._waiting, None)
            if findable is None or self._index is None:
                self._waiting = None
            else:
                self._index.add(findable)
        if self._waiting is not None:
            self._later.start()
        elif self._asked:
            self._tell()

    def _tell(self) -> None:
        if self._index is not None:
            self.found.emit(self._index.search(self._asked), self._asked)


WIDE_LINES = 46
"""So many lines of text wide, the contents stand beside the page."""
CONTENTS_LINES = 15
"""How wide the contents are at least then."""


class HelpPages(InLines):
    """Shows the help. ``try_requested`` brings a project that a person wants to try.

    ``left`` says that the keyboard is to go on with the program.
    """

    usual_lines = (24, 30)

    try_requested = Signal(object)
    page_shown = Signal(str)
    left = Signal()

    def __init__(
        self,
        canvas: Canvas,
        look: Look,
        language: Callable[[], Language],
        shortcuts: Callable[[], Rows] = lambda: (),
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._look, self._language, self._shortcuts = look, language, shortcuts
        self._book: Book | None = None
        self._are_contents_asked = self._is_stale = False
        self.trail = Trail()
        self.tools = ToolRow(self)
        self.search = self.tools.search
        self.contents = ContentsView(self)
        self.browser = HelpBrowser(canvas, look, lambda: self.book, self)
        self.example = ExampleBar(canvas, lambda: self.book, self)
        self.searching = Searching(lambda: self.book, self)
        self.body = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False)
        self.body.addWidget(self.contents)
        self.body.addWidget(self.browser)
        self.body.setStretchFactor(1, 1)
        in_column(self.tools, (self.body, 1), self.example, of=self, margins=0, spacing=0)
        self._connect()
        labelled(self, name="Help")
        self._show_tools()
        follow_words(self, self._speak)

    @property
    def book(self) -> Book:
        """The pages; they are read when they are first needed."""
        if self._book is None:
            self._book = Book(self._language(), self._shortcuts)
            self.contents.fill(self._book.contents(), self._look.theme)
        return self._book

    # Going about

    def open(self, name: str = HOME) -> None:
        """Show a page, which can be gone back from."""
        self.trail.leave(self.browser.verticalScrollBar().value())
        self.trail.go(self.book.resolve(name))
        self._show(self.trail.current)
        self._are_contents_asked = False
        self._fit()

    def step(self, way: int) -> None:
        """Show the page before (-1), where it was read, or that was gone back from (1)."""
        if self.trail.move(way, self.browser.verticalScrollBar().value()):
            self._show(self.trail.current, self.trail.place)

    def start_search(self, words: str = "") -> None:
        """Give the search the keyboard; with words, search for them."""
        if words:
            self.search.setText(words)
        self.search.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self.search.selectAll()

    def refresh(self) -> None:
        """Take the look in use; the pages of a hidden panel do so when it is seen."""
        self.tools.dress(self._look.theme)
        self.example.dress(self._look.theme)
        self._is_stale = not self.isVisible()
        if self._is_stale:
            return
        if self._book is not None:
            self.contents.fill(self._book.contents(), self._look.theme)
            self.browser.refresh()
            self.contents.mark(self.trail.current)
        elif self.trail.current:
            self._show(self.trail.current, self.browser.verticalScrollBar().value())
            self._on_search_changed(self.search.text())
        self._fit()

    def _speak(self) -> None:
        """Read the pages in another language, from where they were read."""
        self._book = None
        self.searching.forget()
        self.refresh()

    def _show(self, name: str, place: int = 0) -> None:
        page = self.book.page(name)
        anchor = "" if place else split(name)[1]
        self.browser.show_page(page, anchor, place)
        self.example.show_example(page.example, page.title)
        self.contents.mark(name)
        self._show_tools()
        self.browser.setAccessibleName(page.title)
        announce(self, page.title)
        self.page_shown.emit(page.name)

    def _on_example_chosen(self, name: str) -> None:
        """Let the buttons below the page act on one of its examples, and be there."""
        page = self.browser.page
        if page is not None and name in examples():
            self.example.show_example(examples()[name], page.title)
            self.example.take_focus()

    def _show_tools(self) -> None:
        self.tools.back.setEnabled(self.trail.can_go_back)
        self.tools.forward.setEnabled(self.trail.can_go_forward)

    # Put together

    def _connect(self) -> None:
        tools = self.tools
        tools.back.clicked.connect(lambda: self.step(-1))
        tools.forward.clicked.connect(lambda: self.step(1))
        tools.home.clicked.connect(lambda: self.open(HOME))
        tools.contents.toggled.connect(self._on_contents_asked)
        tools.smaller.clicked.connect(lambda: self._zoom(1 / ZOOM_STEP))
        tools.larger.clicked.connect(lambda: self._zoom(ZOOM_STEP))
        tools.print.clicked.connect(lambda: ask_to_print(self.browser, self))
        self.search.textChanged.connect(self._on_search_changed)
        self.search.installEventFilter(self)
        self.browser.installEventFilter(self)
        self.browser.page_asked.connect(self.open)
        self.browser.example_chosen.connect(self._on_example_chosen)
        self.contents.chosen.connect(self._on_chosen)
        self.contents.found.left_upwards.connect(self.search.setFocus)
        self.example.try_requested.connect(self.try_requested)
        self.searching.found.connect(self._on_found)
        self._look.theme_changed.connect(self.refresh)

    def _zoom(self, factor: float) -> None:
        self.browser.set_zoom(self.browser.zoom * factor)

    def _fit(self) -> None:
        """Contents beside the page where there is room, else above it, when they are asked for."""
        line = self.fontMetrics().height()
        is_wide = self.width() >= WIDE_LINES * line
        direction = Qt.Orientation.Horizontal if is_wide else Qt.Orientation.Vertical
        if self.body.orientation() != direction:
            self.body.setOrientation(direction)
        self.contents.setMinimumWidth(CONTENTS_LINES * line if is_wide else 0)
        is_searched = bool(self.search.text().strip())
        self.contents.setVisible(is_wide or is_searched or self._are_contents_asked)
        self.tools.contents.setVisible(not is_wide)
        self.tools.contents.setChecked(self._are_contents_asked)

    # What happens

    def _on_contents_asked(self, is_asked: bool) -> None:
        if is_asked != self._are_contents_asked:
            self._are_contents_asked = is_asked
            self.search.clear()
            self._fit()

    def _on_search_changed(self, text: str) -> None:
        typed = text.strip()
        if typed:
            self.searching.search(typed)
        else:
            self.contents.setCurrentWidget(self.contents.tree)
        self._fit()

    def _on_found(self, hits: list[Hit], typed: str) -> None:
        if typed == self.search.text().strip():
            self.contents.show_found(hits, typed, self._look.theme)

    def _on_chosen(self, name: str) -> None:
        self.open(name)
        self.browser.setFocus(Qt.FocusReason.OtherFocusReason)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keys of the search and of the page."""
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            if watched is self.search and self._search_key(event):
                return True
            if watched is self.browser and self._page_key(event):
                return True
        return super().eventFilter(watched, event)

    def _search_key(self, event: QKeyEvent) -> bool:
        key, has_words = event.key(), bool(self.search.text().strip())
        if key == Qt.Key.Key_Down:
            view = self.contents.found if has_words else self.contents.tree
            view.setFocus(Qt.FocusReason.OtherFocusReason)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and has_words:
            self.searching.finish(self.search.text().strip())
            self.contents.choose_found()
        elif key == Qt.Key.Key_Escape and has_words:
            self.search.clear()
        else:
            return False
        return True

    def _page_key(self, event: QKeyEvent) -> bool:
        is_alt = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        key = event.key()
        if key == Qt.Key.Key_Backspace or (is_alt and key == Qt.Key.Key_Left):
            self.step(-1)
        elif is_alt and key == Qt.Key.Key_Right:
            self.step(1)
        elif key == Qt.Key.Key_Slash:
            self.start_search()
        elif key == Qt.Key.Key_Escape:
            self.left.emit()
        else:
            return False
        return True

    def showEvent(self, event: QShowEvent) -> None:
        """Read the first page when the panel is first seen."""
        super().showEvent(event)
        if self._is_stale:
            self.refresh()
        if not self.trail.current:
            self.open(HOME)
        self.searching.begin()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put the contents where there is room."""
        super().resizeEvent(event)
        self._fit()


# Prints a page of the help.


def ask_to_print(browser: HelpBrowser, parent: QWidget) -> None:
    """Let the person choose a printer, then print."""
    from PySide6.QtPrintSupport import QPrintDialog, QPrinter  # few people print

    printer = QPrinter()  # Qt's dialog only points at it: what is connected keeps it
    name_what_is_printed(printer, browser.accessibleName())
    dialog = QPrintDialog(printer, parent)
    dialog.accepted.connect(lambda: print_page(browser, printer))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    QDialog.open(dialog)


def print_page(browser: HelpBrowser, printer: QPrinter) -> None:
    """Print the page that is shown, dark on light."""
    layout = printer.pageLayout()
    width = layout.paintRect(QPageLayout.Unit.Point).width()
    document = browser.printed(width * 0.9)
    document.print_(printer)
    document.deleteLater()
