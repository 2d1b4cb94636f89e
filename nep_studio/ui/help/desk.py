"""Opens the help where it can be seen, and answers F1 wherever it is pressed."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QCursor, QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import QApplication, QDialog, QMenu, QVBoxLayout, QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.popup import FieldPopup
from nep_studio.ui.help_card import BlockOpening
from nep_studio.ui.main_window_panels import Panels
from nep_studio.ui.words import tr

from .page_names import HOME
from .panel import HelpPanel
from .places import page_at, page_of_button, page_of_field, page_of_menu

KEY = "help_key"


class HelpWindow(QWidget):
    """The help in a window of its own: where there is no workbench, or a dialog covers it."""

    def __init__(self, panel: HelpPanel) -> None:
        super().__init__(None, Qt.WindowType.Window)
        self.setWindowTitle(tr("Help"))
        self.setAttribute(Qt.WidgetAttribute.WA_QuitOnClose, False)  # the main window decides
        self.panel = panel
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(panel)
        line = self.fontMetrics().height()
        self.resize(52 * line, 40 * line)


class HelpDesk(QObject):
    """Where help is asked for. ``try_requested`` brings an example that is to be run.

    ``panel_made`` brings the HelpPanel of a window of its own, when that is first needed.
    """

    try_requested = Signal(object)
    panel_made = Signal(object)

    def __init__(
        self,
        panel: HelpPanel,
        new_panel: Callable[[], HelpPanel],
        panels: Panels,
        opening: BlockOpening,
    ) -> None:
        super().__init__(panel)
        self.panel, self._panels, self._opening = panel, panels, opening
        self._new_panel = new_panel
        self._window: HelpWindow | None = None
        panel.try_requested.connect(self.try_requested)
        panel.left.connect(self._on_left)
        opening.page_asked.connect(self.open)
        opening.is_page_shown = lambda: panel.isVisible()
        self._canvas: Canvas = opening.canvas
        self._canvas.menu_requested.connect(self._on_menu_requested)
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.focusChanged.connect(self._on_focus_changed)

    @property
    def window(self) -> HelpWindow:
        """The help in a window of its own; it is made when it is first needed."""
        if self._window is None:
            self._window = HelpWindow(self._new_panel())
            self._window.panel.example.can_insert = False
            self._window.panel.try_requested.connect(self.try_requested)
            self.panel.destroyed.connect(self._window.deleteLater)
            self.panel_made.emit(self._window.panel)
        return self._window

    def open(self, page: str = HOME) -> None:
        """Show a page beside the canvas; where that cannot be seen, in a window."""
        if self._panels.row.isVisible() and not _is_covered(self._panels.row):
            was_shown = self.panel.isVisible()
            self._panels.show(self.panel)
            self._show(self.panel, page)
            if not was_shown and not page.startswith("?"):
                self.panel.browser.setFocus(Qt.FocusReason.OtherFocusReason)
        else:
            self.window.show()
            self.window.raise_()
            self.window.activateWindow()
            self._show(self.window.panel, page)

    def search(self) -> None:
        """Begin to search the help."""
        self.open(self.panel.trail.current or HOME)
        self.shown_panel.start_search()

    @property
    def shown_panel(self) -> HelpPanel:
        """The panel in which the help is read now."""
        window = self._window
        return window.panel if window is not None and window.isVisible() else self.panel

    def answer(self) -> None:
        """Answer F1: by the button under the mouse, else by what has the keyboard."""
        focus = QApplication.focusWidget()
        pointed = page_of_button(QApplication.widgetAt(QCursor.pos()))
        if not pointed and focus is not None and self._is_on_block(focus):
            self._opening.answer(self._canvas.selection.cursor)
        else:
            self.open(pointed or page_at(focus) or HOME)

    def listen(self, menu: QMenu) -> None:
        """Answer F1 in a menu and in the menus inside it."""
        for each in (menu, *menu.findChildren(QMenu)):
            each.installEventFilter(self)

    def _show(self, panel: HelpPanel, page: str) -> None:
        if page.startswith("?"):  # no page is known, but there may be one that says it
            panel.open(HOME)
            panel.start_search(page.removeprefix("?"))
        else:
            panel.open(page)

    def _is_on_block(self, focus: QWidget) -> bool:
        canvas = self._canvas
        is_there = focus is canvas or canvas.isAncestorOf(focus)
        chosen = canvas.selection.cursor
        return is_there and not page_of_field(canvas) and chosen in canvas.selection

    def _on_left(self) -> None:
        """Let the keyboard go on with the program."""
        self._canvas.setFocus(Qt.FocusReason.OtherFocusReason)

    def _on_menu_requested(self, place: object) -> None:
        if self._canvas.menu is not None:
            self.listen(self._canvas.menu)

    def _on_focus_changed(self, before: QWidget | None, now: QWidget | None) -> None:
        """Let dialogs and windows of their own hear F1, too."""
        top = now.window() if now is not None else None
        if not isinstance(top, QDialog | FieldPopup | HelpWindow):
            return
        if top.findChild(QShortcut, KEY) is None:
            shortcut = QShortcut(QKeySequence("F1"), top)
            shortcut.setObjectName(KEY)
            shortcut.activated.connect(lambda: self.open(page_at(QApplication.focusWidget())))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """F1 in a menu closes it and tells about the entry that is marked."""
        if not isinstance(event, QKeyEvent) or not isinstance(watched, QMenu):
            return super().eventFilter(watched, event)
        if event.type() == QEvent.Type.KeyPress and event.key() == Qt.Key.Key_F1:
            page = page_of_menu(watched)
            while (popup := QApplication.activePopupWidget()) is not None:
                popup.close()
            self.open(page or HOME)
            return True
        return super().eventFilter(watched, event)


def _is_covered(widget: QWidget) -> bool:
    """Whether a dialog keeps people from using a widget."""
    modal = QApplication.activeModalWidget()
    return modal is not None and modal is not widget.window()
