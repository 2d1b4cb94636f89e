"""The help panel: search and contents above or beside the page, ways back, and the example."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from nep_studio.blocks.language import Language
from nep_studio.help.index import Hit
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.messages import announce
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .book import Book, Rows
from .browser import ZOOM_STEP, HelpBrowser
from .contents import ContentsView
from .example_bar import ExampleBar
from .page_names import HOME, split
from .searching import Searching
from .tool_row import ToolRow
from .trail import Trail

WIDE_LINES = 46
"""So many lines of text wide, the contents stand beside the page."""


CONTENTS_LINES = 15
"""How wide the contents are at least then."""


class HelpPanel(QWidget):
    """Shows the help. ``try_requested`` brings a project that a person wants to try.

    ``left`` says that the keyboard is to go on with the program.
    """

    try_requested = Signal(object)
    page_shown = Signal(str)
    left = Signal()

    def __init__(
        self,
        canvas: Canvas,
        look: Look,
        language: Language,
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
        self.body = QSplitter(Qt.Orientation.Vertical)
        self._arrange()
        self._connect()
        self.setAccessibleName(tr("Help"))
        self.setProperty("help_page", "howto/window#help")
        self._show_tools()

    @property
    def book(self) -> Book:
        """The pages; they are read when they are first needed."""
        if self._book is None:
            self._book = Book(self._language, self._shortcuts)
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

    def go_back(self) -> None:
        """Show the page before, where it was read."""
        self._step(self.trail.back)

    def go_forward(self) -> None:
        """Show the page that was gone back from."""
        self._step(self.trail.forward)

    def start_search(self, words: str = "") -> None:
        """Give the search the keyboard; with words, search for them."""
        if words:
            self.search.setText(words)
        self.search.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self.search.selectAll()

    def refresh(self) -> None:
        """Take the look in use; a hidden panel does so when it is seen."""
        self._is_stale = not self.isVisible()
        if self._is_stale:
            return
        self.tools.dress(self._look.theme)
        self.example.dress(self._look.theme)
        if self._book is not None:
            self.contents.fill(self._book.contents(), self._look.theme)
            self.browser.refresh()
            self.contents.mark(self.trail.current)
        self._fit()

    def print_page(self) -> None:
        """Ask for a printer, and print the page."""
        from .printing import ask_to_print  # printers are looked for only now

        ask_to_print(self.browser, self)

    def sizeHint(self) -> QSize:
        """Room to read."""
        line = self.fontMetrics().height()
        return QSize(24 * line, 30 * line)

    def _step(self, step: Callable[[int], bool]) -> None:
        if step(self.browser.verticalScrollBar().value()):
            self._show(self.trail.current, self.trail.place)

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

    def _show_tools(self) -> None:
        self.tools.back.setEnabled(self.trail.can_go_back)
        self.tools.forward.setEnabled(self.trail.can_go_forward)

    # Put together

    def _arrange(self) -> None:
        self.body.setChildrenCollapsible(False)
        self.body.addWidget(self.contents)
        self.body.addWidget(self.browser)
        self.body.setStretchFactor(1, 1)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(0)
        box.addWidget(self.tools)
        box.addWidget(self.body, 1)
        box.addWidget(self.example)
        self.tools.dress(self._look.theme)
        self.example.dress(self._look.theme)

    def _connect(self) -> None:
        tools = self.tools
        tools.back.clicked.connect(self.go_back)
        tools.forward.clicked.connect(self.go_forward)
        tools.home.clicked.connect(lambda: self.open(HOME))
        tools.contents.toggled.connect(self._on_contents_asked)
        tools.smaller.clicked.connect(lambda: self._zoom(1 / ZOOM_STEP))
        tools.larger.clicked.connect(lambda: self._zoom(ZOOM_STEP))
        tools.print.clicked.connect(self.print_page)
        self.search.textChanged.connect(self._on_search_changed)
        self.search.installEventFilter(self)
        self.browser.installEventFilter(self)
        self.browser.page_asked.connect(self.open)
        self.contents.chosen.connect(self._on_chosen)
        self.contents.found.left_upwards.connect(self.search.setFocus)
        self.example.try_requested.connect(self.try_requested)
        self.searching.found.connect(self._on_found)
        self._look.theme_changed.connect(self.refresh)

    def _zoom(self, factor: float) -> None:
        self.browser.set_zoom(self.browser.zoom * factor)

    def _fit(self) -> None:
        """Contents beside the page where there is room, else above it, when they are asked for."""
        is_wide = self.width() >= WIDE_LINES * self.fontMetrics().height()
        direction = Qt.Orientation.Horizontal if is_wide else Qt.Orientation.Vertical
        if self.body.orientation() != direction:
            self.body.setOrientation(direction)
        line = self.fontMetrics().height()
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
            self.contents.show_contents()
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
            self.go_back()
        elif is_alt and key == Qt.Key.Key_Right:
            self.go_forward()
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
        if not self.trail.current:
            self.open(HOME)
        elif self._is_stale:
            self.refresh()
        self.searching.begin()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put the contents where there is room."""
        super().resizeEvent(event)
        self._fit()
