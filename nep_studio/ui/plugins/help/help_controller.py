"""Opens the help where it can be seen, and answers F1 wherever it is pressed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, QUrl, Signal
from PySide6.QtGui import QAction, QCursor, QDesktopServices, QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QDialog,
    QMainWindow,
    QMenu,
    QToolButton,
    QWidget,
)

from nep_studio.blocks.program import split_slot
from nep_studio.help.texts import HOME, PROBLEMS, block_page, error_anchor, error_texts
from nep_studio.paths import first_page
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.popup import FieldPopup
from nep_studio.ui.labels import labelled
from nep_studio.ui.message_cards import MessageCard
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.widgets.layouts import LatePanel, in_column
from nep_studio.ui.words import language_code, tr
from nep_studio.ui.workbench.help_card import BlockOpening
from nep_studio.ui.workbench.palette.shelf import Shelf
from nep_studio.ui.workbench.side_panels import Panels

if TYPE_CHECKING:
    from .panel import HelpPages

# Which page of the help tells about what is under the mouse or has the keyboard.

PROPERTY = "help_page"
"""A widget or an action may name its own page by this property."""

WINDOW, KEYS, RUN = "howto/window", "howto/keyboard#canvas", "howto/run-and-stop"

PAGES_OF_ACTIONS = {
    f"{WINDOW}#files": "new open save save_as compare close quit picture print",
    f"{WINDOW}#undo": "undo redo",
    KEYS: "cut copy paste duplicate delete select_all disable collapse tidy",
    f"{WINDOW}#pages": "add_page",
    f"{WINDOW}#canvas": "zoom_in zoom_out zoom_100 zoom_fit",
    f"{WINDOW}#minimap": "minimap",
    f"{WINDOW}#panels": "reset_panels",
    f"{WINDOW}#problems": "check",
    f"{WINDOW}#find": "find find_next find_previous",
    f"{WINDOW}#insert": "insert",
    f"{WINDOW}#settings": "settings",
    f"{WINDOW}#help": "help help_contents help_search documentation about",
    f"{WINDOW}#study": "study_start study_stop study_recorded study_form study_results",
    "howto/problems#report": "report",
    "howto/keyboard#window": "shortcuts commands command_palette palette",
    "howto/first-steps": "tour",
    "howto/python": "save_python copy_python",
    f"{RUN}#run": "run",
    f"{RUN}#stop": "stop",
    f"{RUN}#pause": "pause step",
    f"{RUN}#breakpoint": "breakpoint clear_breakpoints",
    f"{RUN}#needs": "needs",
    "howto/museum": "show_mode",
    "howto/cue-panel": "cues",
    "howto/connect-watch": "connect_watch",
    "howto/teach-gestures": "teach_gesture",
    "howto/make-a-motion": "make_motion",
    "howto/drive-by-hand": "teleoperate",
}

PAGES_OF_WIDGETS = {
    f"{WINDOW}#palette": "Palette",
    f"{WINDOW}#code": "CodePane ComparingDialog",
    f"{WINDOW}#outline": "Outline",
    f"{WINDOW}#problems": "ProblemsPanel ProblemBubble",
    f"{WINDOW}#nodes": "NodesPanel",
    f"{WINDOW}#network": "NetworkPanel",
    f"{WINDOW}#sensors": "SensorsPanel FieldChooser",
    f"{WINDOW}#robots": "RobotsPanel",
    f"{WINDOW}#person": "HumanPanel",
    f"{WINDOW}#log": "LogPanel MessageArea",
    f"{WINDOW}#help": "HelpPanel HelpPages",
    f"{WINDOW}#pages": "PagesBar",
    f"{WINDOW}#find": "FindBar",
    f"{WINDOW}#insert": "InsertBar",
    f"{WINDOW}#minimap": "Minimap",
    f"{WINDOW}#canvas": "Canvas",
    f"{WINDOW}#undo": "TrashButton TrashPanel",
    f"{WINDOW}#settings": "SettingsDialog",
    f"{WINDOW}#files": "PictureDialog ProgramPrintDialog RecoveryDialog QuestionDialog",
    f"{WINDOW}#study": "QuestionnaireDialog StartDialog ResultsDialog",
    f"{RUN}#needs": "NeedsDialog",
    "howto/keyboard#window": "ShortcutsDialog CommandPalette",
    "howto/own-blocks": "MakeBlockDialog Making",
    "howto/museum": "ShowWindow ShowAtStart",
    "howto/cue-panel": "CuePanel CueBoard ArrangeDialog",
    "howto/first-steps": "StartPage",
    "howto/teach-gestures": "TrainerPanel",
    "howto/make-a-motion": "MotionRoom",
    "howto/connect-watch": "WatchDialog",
}


def _by_name(pages: dict[str, str]) -> dict[str, str]:
    return {name: page for page, names in pages.items() for name in names.split()}


_OF_ACTIONS, _OF_WIDGETS = _by_name(PAGES_OF_ACTIONS), _by_name(PAGES_OF_WIDGETS)


def page_of_action(action: QAction) -> str:
    """The page about a menu entry or a button; empty when none is known."""
    named = action.property(PROPERTY)
    return str(named) if named else _OF_ACTIONS.get(action.objectName(), "")


def page_of_menu(menu: QMenu) -> str:
    """The page about the entry of a menu that is marked; else the words of it, to search for."""
    action = menu.activeAction()
    if action is None:
        return ""
    return page_of_action(action) or "?" + action.iconText().replace("&", "")


def page_of_button(widget: QWidget | None) -> str:
    """The page about a button; empty for other widgets."""
    if isinstance(widget, QToolButton) and widget.defaultAction() is not None:
        action = widget.defaultAction()
        return page_of_action(action) or "?" + action.iconText().replace("&", "")
    if isinstance(widget, QAbstractButton) and widget.property(PROPERTY):
        return str(widget.property(PROPERTY))
    return ""


def page_at(widget: QWidget | None) -> str:
    """The page about a widget, or about the nearest one around it; empty when none is known."""
    while widget is not None:
        page = page_of_button(widget) or _page_of(widget)
        if page:
            return page
        widget = widget.parentWidget()
    return ""


def _page_of(widget: QWidget) -> str:
    if widget.property(PROPERTY):
        return str(widget.property(PROPERTY))
    if isinstance(widget, Shelf):  # the block that is marked, by the mouse before the keyboard
        return block_page(widget.marked_type) if widget.marked_type else ""
    if isinstance(widget, Canvas):
        return page_of_field(widget) or page_of_block(widget)
    if isinstance(widget, MessageCard):
        return page_of_message(widget.message.title)
    names = (each.__name__ for each in type(widget).__mro__)
    return next((_OF_WIDGETS[name] for name in names if name in _OF_WIDGETS), "")


def page_of_message(title: str) -> str:
    """The page about a message with this title, in the language in use."""
    for english in error_texts(language_code()):
        if tr(english) == title:
            return f"{PROBLEMS}#{error_anchor(english)}"
    return PROBLEMS


def page_of_field(canvas: Canvas) -> str:
    """The page of the field that is edited, at what it says about that slot."""
    place = canvas.fields.place
    if place is None or place[0] not in canvas.editor.project.blocks:
        return ""
    return block_page(canvas.editor.project.blocks[place[0]].type, split_slot(place[1])[0])


def page_of_block(canvas: Canvas) -> str:
    """The page of the block that is selected, or of the canvas."""
    blocks, cursor = canvas.editor.project.blocks, canvas.selection.cursor
    if cursor in canvas.selection and cursor in blocks:
        return block_page(blocks[cursor].type)
    return _OF_WIDGETS["Canvas"]


KEY = "help_key"


class HelpWindow(QWidget):
    """The help in a window of its own: where there is no workbench, or a dialog covers it."""

    def __init__(self, panel: HelpPages) -> None:
        super().__init__(None, Qt.WindowType.Window)
        labelled(self, window_title="Help")
        self.setAttribute(Qt.WidgetAttribute.WA_QuitOnClose, False)  # the main window decides
        self.panel = panel
        in_column(panel, of=self, margins=0)
        line = self.fontMetrics().height()
        self.resize(52 * line, 40 * line)


class HelpController(QObject):
    """Where help is asked for. ``try_requested`` brings an example that is to be run.

    ``panel_made`` brings the HelpPages beside the canvas, and those of a window of their own, when
    they are first needed.
    """

    try_requested = Signal(object)
    panel_made = Signal(object)

    def __init__(
        self,
        place: LatePanel[HelpPages],
        new_panel: Callable[[], HelpPages],
        panels: Panels,
        opening: BlockOpening,
    ) -> None:
        super().__init__(place)
        self._place, self._panels, self._opening = place, panels, opening
        self._new_panel = new_panel
        self._window: HelpWindow | None = None
        place.made.connect(self._on_made)
        opening.page_asked.connect(self.open)
        opening.is_page_shown = place.isVisible
        self._canvas: Canvas = opening.canvas
        self._canvas.news.menu_requested.connect(self._on_menu_requested)
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.focusChanged.connect(self._on_focus_changed)

    @property
    def panel(self) -> HelpPages:
        """The help beside the canvas; it is made when it is first needed."""
        return self._place.opened()

    @property
    def window(self) -> HelpWindow:
        """The help in a window of its own; it is made when it is first needed."""
        if self._window is None:
            self._window = HelpWindow(self._new_panel())
            self._window.panel.example.can_insert = False
            self._window.panel.try_requested.connect(self.try_requested)
            self._place.destroyed.connect(self._window.deleteLater)
            self.panel_made.emit(self._window.panel)
        return self._window

    def open(self, page: str = HOME) -> None:
        """Show a page beside the canvas; where that cannot be seen, in a window."""
        if self._panels.row.isVisible() and not _is_covered(self._panels.row):
            was_shown = self._place.isVisible()
            self._panels.show(self._place)
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
    def shown_panel(self) -> HelpPages:
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

    def _show(self, panel: HelpPages, page: str) -> None:
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

    def _on_made(self, panel: HelpPages) -> None:
        panel.try_requested.connect(self.try_requested)
        panel.left.connect(self._on_left)
        self.panel_made.emit(panel)

    def _on_left(self) -> None:
        """Let the keyboard go on with the program."""
        self._canvas.setFocus(Qt.FocusReason.OtherFocusReason)

    def _on_menu_requested(self, place: object) -> None:
        if self._canvas.menu is not None:
            self.listen(self._canvas.menu)

    def _on_focus_changed(self, before: QWidget | None, now: QWidget | None) -> None:
        """Let dialogs and windows of their own hear F1, too."""
        top = now.window() if now is not None else None
        if not isinstance(top, QDialog | FieldPopup | HelpWindow) or not self._is_ours(top):
            return
        if top.findChild(QShortcut, KEY) is None:
            shortcut = QShortcut(QKeySequence("F1"), top)
            shortcut.setObjectName(KEY)
            shortcut.activated.connect(lambda: self.open(page_at(QApplication.focusWidget())))

    def _is_ours(self, top: QWidget) -> bool:
        """Whether it belongs to this window, and not to another one of the same program."""
        owner = top
        while (above := owner.parentWidget()) is not None:
            owner = above
        return not isinstance(owner, QMainWindow) or owner is self._panels.row.window()

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


# Opens the documentation that comes with the program, in the person's browser.


def open_documentation(messages: Messages) -> None:
    """Show its first page in the language in use, or say why that does not go."""
    page = first_page(language_code())
    if page is None:
        sentence = tr("Its pages are not on this computer.")
        steps = [tr("In a copy of the source, tools/build_site.py makes the pages.")]
    elif QDesktopServices.openUrl(QUrl.fromLocalFile(str(page))):
        return
    else:
        sentence = tr("No browser could be started for the page {page}.", page=page)
        steps = [tr("Open that file in a browser by hand.")]
    steps.append(tr("Press F1: the help in this window has most of it."))
    title = tr("The documentation cannot be shown")
    messages.tell(Message("warning", title, sentence, tuple(steps)))
