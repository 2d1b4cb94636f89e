"""Which page of the help tells about what is under the mouse or has the keyboard."""

from __future__ import annotations

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QAbstractButton, QMenu, QToolButton, QWidget

from nep_studio.blocks.program import split_slot
from nep_studio.help.texts import error_texts
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.messages_card import MessageCard
from nep_studio.ui.palette.shelf import Shelf
from nep_studio.ui.words import language_code, tr

from .page_names import PROBLEMS, block_page, error_anchor

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
    "howto/museum": "show_mode show_at_start startup",
    "howto/cue-panel": "cues",
    "howto/connect-watch": "connect_watch",
}

PAGES_OF_WIDGETS = {
    f"{WINDOW}#palette": "Palette",
    f"{WINDOW}#code": "CodePane ComparingDialog",
    f"{WINDOW}#outline": "Outline",
    f"{WINDOW}#problems": "ProblemsPanel ProblemBubble",
    f"{WINDOW}#nodes": "NodesPanel",
    f"{WINDOW}#network": "NetworkPanel",
    f"{WINDOW}#sensors": "SensorsPanel FieldChooser",
    f"{WINDOW}#robots": "RobotsPanel HumanPanel",
    f"{WINDOW}#log": "LogPanel MessageArea",
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
    "howto/museum": "ShowWindow StartupDialog",
    "howto/cue-panel": "CuePanel CueBoard ArrangeDialog",
    "howto/first-steps": "StartPage",
    "howto/teach-gestures": "TrainerPanel",
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
    if isinstance(widget, Shelf):
        return page_of_sample(widget)
    if isinstance(widget, Canvas):
        return page_of_field(widget) or page_of_block(widget)
    if isinstance(widget, MessageCard):
        return page_of_message(widget.message.title)
    names = (each.__name__ for each in type(widget).__mro__)
    return next((_OF_WIDGETS[name] for name in names if name in _OF_WIDGETS), "")


def page_of_message(title: str) -> str:
    """The page about a message with this title, in the language in use."""
    known = (each for each in error_texts(language_code()) if tr(each) == title)
    found = next(known, None)
    return f"{PROBLEMS}#{error_anchor(found)}" if found is not None else PROBLEMS


def page_of_sample(shelf: Shelf) -> str:
    """The page of the block of the palette that is marked, by the mouse before the keyboard."""
    sample_type = shelf.marked_type
    return block_page(sample_type) if sample_type else ""


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
