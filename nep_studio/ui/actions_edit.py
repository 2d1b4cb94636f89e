"""The Edit menu, and which of its actions can be used now."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QGuiApplication, QKeySequence
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QPlainTextEdit

from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.commands import Commands
    from nep_studio.ui.find_bar import FindBar
    from nep_studio.ui.main_window import MainWindow

Key = QKeySequence.StandardKey
NEEDS_SELECTION = ("cut", "copy", "duplicate", "delete", "disable", "collapse")

NEEDS_PROJECT = (
    "select_all",
    "tidy",
    "add_page",
    "find",
    "find_next",
    "find_previous",
    "insert",
    "minimap",
    "picture",
)


def add_edit_menu(window: MainWindow) -> QMenu:
    """Make the Edit menu."""
    menu, actions = window.menuBar().addMenu(tr("&Edit")), window.actions_by_name
    add = actions.add

    def commands() -> Commands:
        return window.workbench.canvas.commands

    menu.addActions(
        [
            add("undo", tr("Undo"), lambda: commands().undo(), icon_name="undo-2", keys=Key.Undo),
            add(
                "redo",
                tr("Redo"),
                lambda: commands().redo(),
                icon_name="redo-2",
                keys=(Key.Redo, "Ctrl+Y"),
            ),
        ]
    )
    menu.addSeparator()
    cut, copy, paste = _in_texts_too(commands)
    menu.addActions(
        [
            add("cut", tr("Cut"), cut, icon_name="scissors", keys=Key.Cut),
            add("copy", tr("Copy"), copy, icon_name="copy", keys=Key.Copy),
            add("paste", tr("Paste"), paste, icon_name="clipboard-paste", keys=Key.Paste),
            add(
                "duplicate",
                tr("Duplicate"),
                lambda: commands().duplicate(),
                icon_name="copy-plus",
                keys="Ctrl+D",
            ),
            add(
                "delete",
                tr("Delete"),
                lambda: commands().delete(),
                icon_name="trash-2",
                keys=Key.Delete,
            ),
        ]
    )
    menu.addSeparator()
    menu.addActions(_about_blocks(window, commands))
    menu.addSeparator()
    menu.addActions(_finding(window))
    menu.addSeparator()
    settings = add("settings", tr("Settings…"), window.open_settings, icon_name="settings")
    settings.setMenuRole(settings.MenuRole.PreferencesRole)
    settings.setShortcuts(QKeySequence.keyBindings(Key.Preferences))
    menu.addAction(settings)
    QGuiApplication.clipboard().dataChanged.connect(window.update_actions)
    return menu


def _about_blocks(window: MainWindow, commands: Callable[[], Commands]) -> list[QAction]:
    add = window.actions_by_name.add
    return [
        add("select_all", tr("Select all"), lambda: commands().select_all(), keys=Key.SelectAll),
        add(
            "disable",
            tr("Switch off or on"),
            lambda: commands().toggle("disabled"),
            icon_name="eye-off",
        ),
        add(
            "collapse",
            tr("Fold or unfold"),
            lambda: commands().toggle("collapsed"),
            icon_name="fold-vertical",
        ),
        add(
            "tidy",
            tr("Tidy up"),
            lambda: commands().tidy(),
            icon_name="brush",
            tip=tr("Push stacks apart that overlap"),
        ),
        add(
            "add_page",
            tr("Add a page"),
            lambda: window.workbench.pages_bar.add_page(),
            icon_name="plus",
        ),
    ]


def _finding(window: MainWindow) -> list[QAction]:
    add = window.actions_by_name.add

    def find() -> FindBar:
        return window.workbench.helpers.find_bar

    def insert() -> None:
        window.workbench.helpers.insert_bar.open()

    return [
        add("find", tr("Find…"), lambda: find().open(), icon_name="search", keys=Key.Find),
        add("find_next", tr("Find next"), lambda: find().find_next(), keys=Key.FindNext),
        add(
            "find_previous",
            tr("Find previous"),
            lambda: find().find_previous(),
            keys=Key.FindPrevious,
        ),
        add("insert", tr("Insert by typing…"), insert, icon_name="keyboard", keys="Ctrl+Space"),
    ]


def _in_texts_too(commands: Callable[[], Commands]) -> tuple[Callable[[], object], ...]:
    """Cut, copy and paste: in a text that has the focus, else the blocks."""

    def do(name: str) -> object:
        focus = QApplication.focusWidget()
        if isinstance(focus, QLineEdit | QPlainTextEdit):
            return getattr(focus, name)()
        return getattr(commands(), name)()

    return tuple(lambda name=name: do(name) for name in ("cut", "copy", "paste"))


def update_edit_actions(window: MainWindow) -> None:
    """Enable what can be done, and say what undo and redo would do."""
    actions, document = window.actions_by_name, window.files.document
    is_open = document is not None
    selected = len(window.workbench.canvas.selection) if is_open else 0
    data = QGuiApplication.clipboard().mimeData()
    actions.enable(bool(selected), *NEEDS_SELECTION)
    actions.enable(is_open and data is not None and bool(data.formats()), "paste")
    actions.enable(is_open, *NEEDS_PROJECT)
    _label(
        window,
        "undo",
        document.editor.history.undo_label if document else "",
        tr("Undo"),
        "Undo “{step}”",
    )
    _label(
        window,
        "redo",
        document.editor.history.redo_label if document else "",
        tr("Redo"),
        "Redo “{step}”",
    )


def _label(window: MainWindow, name: str, step: str, plain: str, with_step: str) -> None:
    action = window.actions_by_name[name]
    words = tr(with_step, step=tr(step)) if step else plain
    action.setEnabled(bool(step))
    action.setText(words)
    action.setIconText(plain)
    action.setToolTip(words)
