"""Where the commands of the palette come from: the same actions, panels and files as the menus."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu

from nep_studio.ui.pages_bar import page_title
from nep_studio.ui.start_page_examples import example_files, example_sentence, example_title
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

from .commands import Command, Source
from .reasons import why_not

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

NOT_IN_ITSELF = "palette"


def sources_of(window: MainWindow) -> list[Source]:
    """All that a window offers by itself."""
    return [
        lambda: _actions(window),
        lambda: _pages(window),
        lambda: _panels(window),
        lambda: _examples(window),
        lambda: _recent(window),
        lambda: _choices(window),
    ]


def _actions(window: MainWindow) -> Iterator[Command]:
    menus = {action: menu for menu in window.menus.values() for action in menu.actions()}
    for name, action in window.actions_by_name.by_name.items():
        if name == NOT_IN_ITSELF or not action.isVisible():
            continue
        menu = menus.get(action)
        kind = _plain(menu.title()) if menu is not None else ""
        yield _command(f"action:{name}", action, kind, why_not(window, action))


def _command(command_id: str, action: QAction, kind: str, reason: str) -> Command:
    return Command(
        command_id,
        _plain(action.text()),
        action.trigger,
        kind,
        _native(action.shortcut()),
        action.icon(),
        _plain(f"{action.iconText()} {action.toolTip()}"),
        reason,
        action.isChecked() if action.isCheckable() else None,
    )


def _panels(window: MainWindow) -> Iterator[Command]:
    for panel in window.workbench.panels.all:
        yield _command(
            f"panel:{panel.name}", panel.action, tr("Panel"), why_not(window, panel.action)
        )


def _pages(window: MainWindow) -> Iterator[Command]:
    document, canvas = window.files.document, window.workbench.canvas
    if document is None:
        return
    for page in document.project.pages:
        yield Command(
            f"page:{page}",
            page_title(document.project, page),
            partial(canvas.show_page, page),
            tr("Page"),
            icon=icon("file", window.look.theme),
            is_on=True if page == canvas.page else None,
        )


def _examples(window: MainWindow) -> Iterator[Command]:
    for path in example_files():
        yield Command(
            f"example:{path.stem}",
            example_title(path),
            partial(window.files.open_example, path),
            tr("Example"),
            icon=icon("graduation-cap", window.look.theme),
            also=example_sentence(path),
        )


def _recent(window: MainWindow) -> Iterator[Command]:
    for path in window.settings.recent_files:
        yield Command(
            f"recent:{path}",
            path.stem,
            partial(window.files.open, path),
            tr("Recent project"),
            icon=icon("history", window.look.theme),
            also=str(path),
            why_not="" if path.is_file() else tr("It is not there any more."),
        )


def _choices(window: MainWindow) -> Iterator[Command]:
    """The choices inside menus, such as the themes and the languages."""
    for menu in window.menus.values():
        for action in menu.actions():
            inner = action.menu()
            if isinstance(inner, QMenu):
                yield from _choices_of(inner)


def _choices_of(menu: QMenu) -> Iterator[Command]:
    title = _plain(menu.title())
    for action in menu.actions():
        group = action.actionGroup()
        if group is not None and group.isExclusive():
            yield _command(f"choice:{title}:{action.data()}", action, title, "")


def _plain(words: str) -> str:
    """Words without the mark of the key that chooses them in a menu."""
    return words.replace("&&", "\0").replace("&", "").replace("\0", "&")


def _native(key: QKeySequence) -> str:
    return key.toString(QKeySequence.SequenceFormat.NativeText)
