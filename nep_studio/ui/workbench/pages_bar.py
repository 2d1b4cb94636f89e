"""The tabs: a project's pages (show, add, rename, move, delete), and the rooms beside them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QLineEdit, QMenu, QTabBar, QToolButton, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.project import AddPage, MovePage, RenamePage
from nep_studio.blocks.operations.states import add_tree
from nep_studio.blocks.program import PAGES, Project
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

from .side_panels import Rooms

KIND_ICONS = {"behaviour": "blocks", "robots": "bot", "nodes": "network"}
BEGINNING = (40.0, 40.0)
"""Where the first block of a page is put."""


class PagesBar(QWidget):
    """Shows one page of an editor, or one room, as chosen.

    ``page_chosen`` asks to see another page; ``tree_begun`` says that it is one with a behaviour
    tree, to which blocks of trees are to be added. ``attempt`` makes a change and tells the person
    why not when it is refused. The pages that set robots and nodes up have a tab once somebody
    wants to see them, until it is closed.
    """

    page_chosen = Signal(str)
    tree_begun = Signal()

    def __init__(
        self,
        editor: Editor,
        look: Look,
        attempt: Callable[[Callable[[], object]], bool],
        rooms: Rooms,
    ) -> None:
        super().__init__()
        self._look, self._attempt, self._rooms = look, attempt, rooms
        self._editor = editor
        self._page = PAGES[0]
        self._wanted: set[str] = set()
        """The pages for setting up that have been looked at."""
        self.tabs = PageTabs(self)
        self.add_button = labelled(QToolButton(), tip="Another page", name="Another page")
        self.add_button.clicked.connect(self._show_more)
        in_row(self.tabs, self.add_button, 1, of=self, margins=0, spacing=0)
        self._connect()
        editor.history.listen(self._fill, is_of_whole=True)
        follow_words(self, self._fill)

    def _connect(self) -> None:
        self.tabs.currentChanged.connect(self._on_current_changed)
        self.tabs.moved_to.connect(self._on_moved_to)
        self.tabs.renamed.connect(self.rename_page)
        self.tabs.customContextMenuRequested.connect(self._on_menu_requested)
        self._look.theme_changed.connect(self._fill)
        self._rooms.changed.connect(self._fill)

    def set_editor(self, editor: Editor) -> None:
        """Show the pages of another project."""
        self._editor.history.unlisten(self._fill)
        self._editor = editor
        editor.history.listen(self._fill, is_of_whole=True)
        self._page = PAGES[0]
        self._wanted.clear()
        self._fill()

    def show_page(self, page: str) -> None:
        """Mark the page that is shown now; it has a tab from now on."""
        self._page = page
        if page in PAGES[1:]:
            self._wanted.add(page)
        self._fill()

    def pages(self) -> list[str]:
        """The pages that have a tab, in their order."""
        project = self._editor.project
        return [page for page in project.pages if self._has_tab(page)]

    def _has_tab(self, page: str) -> bool:
        return page not in PAGES[1:] or page in self._wanted

    def add_page(self) -> None:
        """Add a page for behaviour behind the last one of those, and show it."""
        edit = self._new_page(lambda number: tr("Behaviour {number}", number=number), 2)
        if self._attempt(lambda: self._editor.apply(edit)):
            self.page_chosen.emit(edit.page)

    def add_tree_page(self) -> None:
        """Add a page on which a behaviour tree is begun, as one step, and show it."""

        def title(number: int) -> str:
            several = tr("Behaviour tree {number}", number=number)
            return several if number > 1 else tr("Behaviour tree")

        edit = self._new_page(title, 1)

        def add() -> None:
            with self._editor.transaction("add a behaviour tree"):
                self._editor.apply(edit)
                add_tree(self._editor, edit.page, BEGINNING)

        if self._attempt(add):
            self.page_chosen.emit(edit.page)
            self.tree_begun.emit()

    def _new_page(self, title: Callable[[int], str], number: int) -> AddPage:
        """A page behind the last one for behaviour; its title, from a number on, is no other's."""
        project = self._editor.project
        taken = {page_title(project, page) for page in project.pages}
        kinds = [project.kind_of_page(page) for page in project.pages]
        position = len(kinds) - kinds[::-1].index("behaviour")
        while (named := title(number)) in taken:
            number += 1
        return AddPage(project.new_id("page"), named, position)

    def rename_page(self, index: int, title: str) -> None:
        """Give a page another title; an empty one is the title it has by itself."""
        page = list(self._editor.project.pages)[index]
        if title == page_title(self._editor.project, page):
            return
        edit = RenamePage(page, "" if title == own_title(page) else title)
        self._attempt(lambda: self._editor.apply(edit))
        self._fill()

    def delete_page(self, index: int) -> None:
        """Delete a page with all that is on it; it can be undone."""
        page = list(self._editor.project.pages)[index]
        self._attempt(lambda: self._editor.delete_page(page))

    def _fill(self, _changed: object = None) -> None:
        project, theme, tabs = self._editor.project, self._look.theme, self.tabs
        pages, rooms = list(project.pages), self._rooms.open
        self.add_button.setIcon(icon("plus", theme))
        tabs.blockSignals(True)
        while tabs.count() > len(pages) + len(rooms):
            tabs.removeTab(tabs.count() - 1)
        while tabs.count() < len(pages) + len(rooms):
            tabs.addTab("")
        for index, page in enumerate(pages):
            sign = icon(KIND_ICONS[project.kind_of_page(page)], theme)
            tabs.show_tab(index, page_title(project, page), sign)
            tabs.setTabData(index, page)
            tabs.setTabVisible(index, self._has_tab(page))
            close = partial(self.close_page, page) if page in self._wanted else None
            tabs.let_close(index, close, theme)
        for index, room in enumerate(rooms, len(pages)):
            sign = self._rooms.signs.get(room, QIcon())
            tabs.show_tab(index, tr(self._rooms.titles[room]), sign)
            tabs.setTabData(index, room)
            tabs.setTabVisible(index, True)
            tabs.let_close(index, partial(self._rooms.close_asked.emit, room), theme)
        shown = self._rooms.shown
        if shown is not None and shown in rooms:
            tabs.setCurrentIndex(len(pages) + rooms.index(shown))
        elif self._page in pages:
            tabs.setCurrentIndex(pages.index(self._page))
        tabs.blockSignals(False)
        if self._page not in pages:
            self.page_chosen.emit(PAGES[0])

    def close_page(self, page: str) -> None:
        """Take the tab of a page for setting up away; the page stays as it is."""
        self._wanted.discard(page)
        if self._page == page:
            self.page_chosen.emit(PAGES[0])
        self._fill()

    def _on_current_changed(self, index: int) -> None:
        shown = self.tabs.tabData(index)
        if isinstance(shown, str):
            self.page_chosen.emit(shown)
        elif isinstance(shown, QWidget):
            self._rooms.setCurrentWidget(shown)

    def _on_moved_to(self, page_index: int, position: int) -> None:
        pages = list(self._editor.project.pages)
        if page_index < len(pages):  # rooms have their order
            self._page = pages[page_index]
            edit = MovePage(self._page, min(position, len(pages) - 1))
            self._attempt(lambda: self._editor.apply(edit))
        self._fill()

    def _on_menu_requested(self, point: QPoint) -> None:
        index = self.tabs.tabAt(point)
        if 0 <= index < len(self._editor.project.pages):
            self.menu(index).popup(self.tabs.mapToGlobal(point))

    def _show_more(self) -> None:
        below = self.add_button.rect().bottomLeft()
        self.more().popup(self.add_button.mapToGlobal(below))

    def more(self) -> QMenu:
        """What can have a tab besides: a new page, those for setting up, the rooms."""
        menu, theme = QMenu(self), self._look.theme
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        sign = icon(KIND_ICONS["behaviour"], theme)
        menu.addAction(sign, tr("New page for behaviour"), self.add_page)
        sign = icon("list-tree", theme)
        menu.addAction(sign, tr("New page for a behaviour tree"), self.add_tree_page)
        menu.addSeparator()
        for page in PAGES[1:]:
            title = page_title(self._editor.project, page).replace("&", "&&")
            show = partial(self.page_chosen.emit, page)
            menu.addAction(icon(KIND_ICONS[page], theme), title, show)
        menu.addSeparator()
        for room, name in self._rooms.titles.items():
            show = partial(self._rooms.open_asked.emit, room)
            menu.addAction(self._rooms.signs[room], tr(name), show)
        return menu

    def menu(self, index: int) -> QMenu:
        """What can be done with a page."""
        menu, theme = QMenu(self), self._look.theme
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        pages = list(self._editor.project.pages)
        tabs, move = self.tabs, self._on_moved_to
        menu.addAction(icon("pencil", theme), tr("Rename…"), lambda: tabs.edit_title(index))
        sign = icon("arrow-left", theme)
        left = menu.addAction(sign, tr("Move left"), lambda: move(index, index - 1))
        left.setEnabled(index > 0)
        sign = icon("arrow-right", theme)
        right = menu.addAction(sign, tr("Move right"), lambda: move(index, index + 1))
        right.setEnabled(index < len(pages) - 1)
        menu.addSeparator()
        sign = icon("trash-2", theme)
        delete = menu.addAction(sign, tr("Delete the page"), lambda: self.delete_page(index))
        delete.setEnabled(pages[index] not in PAGES)
        return menu


class PageTabs(QTabBar):
    """Tabs that can be dragged, and whose titles can be edited in place."""

    moved_to = Signal(int, int)
    renamed = Signal(int, str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMovable(True)
        self.setExpanding(False)
        self.setUsesScrollButtons(True)
        labelled(self, name="Pages")
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.title_edit: QLineEdit | None = None
        self._dragged: list[object] = []

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Remember the order of the tabs: a drag may change it."""
        self._dragged = self._order()
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Tell where the dragged tab has gone, once, when it is let go."""
        super().mouseReleaseEvent(event)
        before, after, self._dragged = self._dragged, self._order(), []
        current = self.currentIndex()
        if before and before != after:
            self.moved_to.emit(before.index(after[current]), current)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Edit the title."""
        index = self.tabAt(event.position().toPoint())
        if index >= 0:
            self.edit_title(index)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """F2 edits the title of the page that is shown."""
        if event.key() == Qt.Key.Key_F2:
            self.edit_title(self.currentIndex())
        else:
            super().keyPressEvent(event)

    def show_tab(self, index: int, title: str, sign: QIcon) -> None:
        """Let a tab look so."""
        self.setTabText(index, title.replace("&", "&&"))
        self.setTabIcon(index, sign)

    def let_close(self, index: int, close: Callable[[], object] | None, theme: Theme) -> None:
        """Give a tab a button that closes it; None takes the button away."""
        side = QTabBar.ButtonPosition.RightSide
        if close is None:
            self.setTabButton(index, side, None)
            return
        button, line = QToolButton(self), self.fontMetrics().height()
        button.setProperty("kind", "on_tab")
        explained(button, "Close this tab")
        button.setIcon(icon("x", theme))
        button.setIconSize(QSize(line * 3 // 4, line * 3 // 4))
        button.setFixedSize(line, line)  # no higher than the words: else all tabs grow
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.clicked.connect(close)
        self.setTabButton(index, side, button)

    def edit_title(self, index: int) -> None:
        """Put a line edit over a tab; Enter and leaving it keep the title, Esc does not."""
        if not isinstance(self.tabData(index), str):
            return  # a room
        title = self.tabText(index).replace("&&", "&")
        edit = self.title_edit = _TitleEdit(title, self)
        edit.setGeometry(self.tabRect(index))
        edit.selectAll()
        edit.show()
        edit.setFocus()
        edit.ended.connect(lambda title: self._on_edited(index, title))

    def _on_edited(self, index: int, title: str) -> None:
        if self.title_edit is not None:
            self.title_edit.deleteLater()
            self.title_edit = None
            if title:
                self.renamed.emit(index, title)

    def _order(self) -> list[object]:
        return [self.tabData(index) for index in range(self.count())]


class _TitleEdit(QLineEdit):
    """``ended`` gives the new title; an empty one when nothing is to change."""

    ended = Signal(str)

    def __init__(self, title: str, parent: QWidget) -> None:
        super().__init__(title, parent)
        self.setMaxLength(60)
        labelled(self, name="Title of the page")
        self.editingFinished.connect(lambda: self.ended.emit(self.text().strip()))

    def event(self, event: QEvent) -> bool:
        """Esc leaves the title as it was."""
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            self.ended.emit("")
            return True
        return super().event(event)


def own_title(page: str) -> str:
    """The title that a page has by itself."""
    titles = {"behaviour": tr("Behaviour"), "robots": tr("Robots"), "nodes": tr("Nodes")}
    return titles.get(page, tr("Behaviour"))


def page_title(project: Project, page: str) -> str:
    """What stands on the tab of a page."""
    return project.page_titles.get(page) or own_title(page)
