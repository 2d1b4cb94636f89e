"""The File menu."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QMenu

from nep_studio.ui.main_window_dialogs import export_picture
from nep_studio.ui.start_page_examples import example_files, example_title
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

Key = QKeySequence.StandardKey


def add_file_menu(window: MainWindow) -> QMenu:
    """Make the File menu."""
    menu, actions, files = (
        window.menuBar().addMenu(tr("&File")),
        window.actions_by_name,
        window.files,
    )
    menu.addAction(actions.add("new", tr("New"), files.new, icon_name="file-plus", keys=Key.New))
    open_ = actions.add("open", tr("Open…"), files.choose, icon_name="folder-open", keys=Key.Open)
    menu.addAction(open_)
    recent = menu.addMenu(icon("history", window.look.theme), tr("Open recent"))
    recent.aboutToShow.connect(lambda: fill_recent(recent, window))
    _add_examples(menu.addMenu(icon("graduation-cap", window.look.theme), tr("Examples")), window)
    menu.addSeparator()
    save = actions.add("save", tr("Save"), files.save, icon_name="save", keys=Key.Save)
    save_as = actions.add(
        "save_as",
        tr("Save as…"),
        files.save_as,
        icon_name="save-all",
        keys=(Key.SaveAs, "Ctrl+Shift+S"),
    )
    compare = actions.add(
        "compare",
        tr("Compare with the saved version…"),
        lambda: _compare(window),
        icon_name="file-text",
    )
    menu.addActions([save, save_as, compare])
    picture = actions.add(
        "picture", tr("Export picture…"), lambda: export_picture(window), icon_name="image"
    )
    menu.addAction(picture)
    menu.addSeparator()
    menu.addAction(actions.add("close", tr("Close the project"), files.close, keys=Key.Close))
    leave = actions.add(
        "quit", tr("Quit"), window.close, icon_name="power", keys=(Key.Quit, "Ctrl+Q")
    )
    menu.addAction(leave)
    return menu


def _compare(window: MainWindow) -> None:
    from nep_studio.ui.comparing import compare_with_saved  # not at a start

    compare_with_saved(window)


def fill_recent(menu: QMenu, window: MainWindow) -> None:
    """List the recent projects; a missing one says so."""
    menu.clear()
    for path in window.settings.recent_files:
        is_there = path.is_file()
        words = path.stem if is_there else tr("{name} (not there any more)", name=path.stem)
        action = menu.addAction(words.replace("&", "&&"))
        action.setToolTip(str(path))
        action.setEnabled(is_there)
        action.triggered.connect(lambda _=False, path=path: window.files.open(path))
    if menu.isEmpty():
        menu.addAction(tr("No project has been opened yet")).setEnabled(False)
    menu.setToolTipsVisible(True)


def _add_examples(menu: QMenu, window: MainWindow) -> None:
    for path in example_files():
        action = menu.addAction(example_title(path))
        action.triggered.connect(lambda _=False, path=path: window.files.open_example(path))
