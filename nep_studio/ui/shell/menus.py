"""The window's actions: each has a name, words, perhaps an icon and keys, and is made once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QActionGroup, QGuiApplication, QKeySequence, QPalette
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QPlainTextEdit, QToolBar, QToolButton

from faults import Words, verbatim
from nep_studio.project.examples import examples
from nep_studio.settings import SYSTEM
from nep_studio.ui.labels import labelled, plain_tip
from nep_studio.ui.running.actions import (
    RUN_BUTTONS,
    RunState,
    keep_room,
    keep_width,
    style_buttons,
)
from nep_studio.ui.theme.colours import load_theme, themes
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.words import ENGLISH, available_languages, count_words, tr

from .dialogs import show_about, show_report, show_shortcuts

if TYPE_CHECKING:
    from nep_studio.blocks.checks.diagnostic import Diagnostic
    from nep_studio.ui.canvas.editing.commands import Commands
    from nep_studio.ui.theme.colours import Theme
    from nep_studio.ui.workbench.find_bar import FindBar
    from nep_studio.ui.workbench.side_panels import OwnHistory

    from .main_window import MainWindow


# The Edit menu, and which of its actions can be used now.

Key = QKeySequence.StandardKey
NEEDS_SELECTION = ("cut", "copy", "duplicate", "delete", "disable", "collapse")

NEEDS_CANVAS = (
    "select_all",
    "tidy",
    "find",
    "find_next",
    "find_previous",
    "insert",
    "minimap",
    "zoom_in",
    "zoom_out",
    "zoom_100",
    "zoom_fit",
)


def add_edit_menu(window: MainWindow) -> QMenu:
    """Make the Edit menu."""
    menu = add_menu(window, "&Edit")
    add = partial(window.actions_by_name.add, menu=menu)

    def edit() -> Commands:
        return window.workbench.canvas.commands

    def steps() -> Commands | OwnHistory:
        return window.workbench.rooms.history or edit()

    add("undo", "Undo", lambda: steps().undo(), icon_name="undo-2", keys=Key.Undo)
    add("redo", "Redo", lambda: steps().redo(), icon_name="redo-2", keys=(Key.Redo, "Ctrl+Y"))
    menu.addSeparator()
    cut, copy, paste = _in_texts_too(edit)
    add("cut", "Cut", cut, icon_name="scissors", keys=Key.Cut)
    add("copy", "Copy", copy, icon_name="copy", keys=Key.Copy)
    add("paste", "Paste", paste, icon_name="clipboard-paste", keys=Key.Paste)
    add("duplicate", "Duplicate", lambda: edit().duplicate(), icon_name="copy-plus", keys="Ctrl+D")
    add("delete", "Delete", lambda: edit().delete(), icon_name="trash-2", keys=Key.Delete)
    menu.addSeparator()
    _add_about_blocks(menu, window, edit)
    menu.addSeparator()
    _add_finding(menu, window)
    menu.addSeparator()
    settings = add("settings", "Settings…", window.open_settings, icon_name="settings")
    settings.setMenuRole(settings.MenuRole.PreferencesRole)
    settings.setShortcuts(QKeySequence.keyBindings(Key.Preferences))
    QGuiApplication.clipboard().dataChanged.connect(window.update_actions)
    return menu


def _add_about_blocks(menu: QMenu, window: MainWindow, edit: Callable[[], Commands]) -> None:
    add = partial(window.actions_by_name.add, menu=menu)
    add("select_all", "Select all", lambda: edit().select_all(), keys=Key.SelectAll)
    add("disable", "Switch off or on", lambda: edit().toggle("disabled"), icon_name="eye-off")
    add("collapse", "Fold or unfold", lambda: edit().toggle("collapsed"), icon_name="fold-vertical")
    add(
        "tidy",
        "Tidy up",
        lambda: edit().tidy(),
        icon_name="brush",
        tip="Push stacks apart that overlap",
    )
    add("add_page", "Add a page", lambda: window.workbench.pages_bar.add_page(), icon_name="plus")


def _add_finding(menu: QMenu, window: MainWindow) -> None:
    add = partial(window.actions_by_name.add, menu=menu)

    def bar() -> FindBar:
        return window.workbench.helpers.find_bar

    def insert() -> None:
        window.workbench.helpers.insert_bar.open()

    add("find", "Find…", lambda: bar().open(), icon_name="search", keys=Key.Find)
    add("find_next", "Find next", lambda: bar().step(1), keys=Key.FindNext)
    add("find_previous", "Find previous", lambda: bar().step(-1), keys=Key.FindPrevious)
    add("insert", "Insert by typing…", insert, icon_name="keyboard", keys="Ctrl+Space")


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
    workbench = window.lazy.made_workbench  # the first page does not make it: nothing is open
    room = workbench.rooms.shown if workbench else None
    is_canvas = document is not None and room is None  # blocks that nobody sees stay
    selected = len(workbench.canvas.selection.ids) if workbench and is_canvas else 0
    data = QGuiApplication.clipboard().mimeData()
    actions.enable(bool(selected), *NEEDS_SELECTION)
    actions.enable(is_canvas and data is not None and bool(data.formats()), "paste")
    actions.enable(document is not None, "add_page", "picture")
    actions.enable(is_canvas, *NEEDS_CANVAS)
    of_room = workbench.rooms.history if workbench else None
    history = of_room or (document.editor.history if document else None)
    _label(window, "undo", history.undo_label if history else "", "Undo", "Undo “{step}”")
    _label(window, "redo", history.redo_label if history else "", "Redo", "Redo “{step}”")


def _label(window: MainWindow, name: str, step: Words, plain: str, with_step: str) -> None:
    action = window.actions_by_name.by_name[name]
    words = tr(with_step, step=tr(step)) if step else tr(plain)
    action.setEnabled(bool(step))
    action.setText(words)
    action.setIconText(tr(plain))
    action.setToolTip(plain_tip(words))


def add_menu(window: MainWindow, words: str) -> QMenu:
    """Make a menu of the menu bar, with the letter that opens it."""
    return labelled(window.menuBar().addMenu(""), title=words)


def _submenu(menu: QMenu, window: MainWindow, icon_name: str, words: str) -> QMenu:
    return labelled(menu.addMenu(icon(icon_name, window.look.theme), ""), title=words)


# The File menu.


def add_file_menu(window: MainWindow) -> QMenu:
    """Make the File menu."""
    menu, files = add_menu(window, "&File"), window.files
    add = partial(window.actions_by_name.add, menu=menu)
    add("new", "New", files.new, icon_name="file-plus", keys=Key.New)
    add("open", "Open…", files.choose, icon_name="folder-open", keys=Key.Open)
    recent = _submenu(menu, window, "history", "Open recent")
    recent.aboutToShow.connect(lambda: fill_recent(recent, window))
    shown = _submenu(menu, window, "graduation-cap", "Examples")
    for example in examples():
        action = labelled(shown.addAction(""), text=example.title)
        action.triggered.connect(lambda _=False, path=example.path: files.open_example(path))
    menu.addSeparator()
    save_keys, picture = (Key.SaveAs, "Ctrl+Shift+S"), partial(window.host.ask, "exporting.picture")
    add("save", "Save", files.save, icon_name="save", keys=Key.Save)
    add("save_as", "Save as…", files.save_as, icon_name="save-all", keys=save_keys)
    compare = partial(_compare, window)
    add("compare", "Compare with the saved version…", compare, icon_name="file-text")
    add("picture", "Export picture…", picture, icon_name="image")
    menu.addSeparator()
    add("close", "Close the project", files.close, keys=Key.Close)
    add("quit", "Quit", window.close, icon_name="power", keys=(Key.Quit, "Ctrl+Q"))
    return menu


def _compare(window: MainWindow) -> None:
    from .help_dialogs import compare_with_saved

    compare_with_saved(window)


def fill_recent(menu: QMenu, window: MainWindow) -> None:
    """List the recent projects; a missing one says so."""
    menu.clear()
    for path in window.settings.recent_files:
        is_there = path.is_file()
        words = path.stem if is_there else tr("{name} (not there any more)", name=path.stem)
        action = menu.addAction(words.replace("&", "&&"))
        action.setToolTip(plain_tip(str(path)))
        action.setEnabled(is_there)
        action.triggered.connect(lambda _=False, path=path: window.files.open(path))
    if menu.isEmpty():
        menu.addAction(tr("No project has been opened yet")).setEnabled(False)
    menu.setToolTipsVisible(True)


# The View and Help menus, and the toolbar.

ZOOM_STEP = 1.2
TEXT_SCALES = (1.0, 1.15, 1.3, 1.5, 1.75, 2.0)
TOOLBAR = (
    RUN_BUTTONS,
    ("new", "open", "save"),
    ("undo", "redo"),
    ("check",),
    ("zoom_out", "zoom_fit", "zoom_in"),
)
LAST_BUTTONS = ("help", "settings")
"""At the far end."""

ICON_ONLY = ("pause", "step", "zoom_out", "zoom_in", "help", "settings")
WORDS_KEPT = (
    ("run", "stop", "check", "new", "open", "save"),
    ("run", "stop", "check"),
    RUN_BUTTONS[:2],
)
"""Which buttons keep their words, the narrower the window the fewer; Run and Stop always do."""


def add_view_menu(window: MainWindow) -> QMenu:
    """Make the View menu."""
    menu = add_menu(window, "&View")
    add = partial(window.actions_by_name.add, menu=menu)

    def zoom(factor: float) -> None:
        sight = window.workbench.canvas.sight
        sight.zoom(sight.camera.scale * factor)

    def fit() -> None:
        window.workbench.canvas.sight.fit()

    nearer, farther = partial(zoom, ZOOM_STEP), partial(zoom, 1 / ZOOM_STEP)
    add("zoom_in", "Zoom in", nearer, icon_name="zoom-in", keys=(Key.ZoomIn, "Ctrl+="))
    add("zoom_out", "Zoom out", farther, icon_name="zoom-out", keys=Key.ZoomOut)
    add("zoom_100", "Usual size", lambda: window.workbench.zoom_usual(), keys="Ctrl+0")
    add("zoom_fit", "Show all", fit, icon_name="maximize", keys="Ctrl+9")
    menu.addSeparator()
    panels = _submenu(menu, window, "panel-right", "Panels")
    window.actions_by_name.add("reset_panels", "Put the panels back", window.reset_panels)
    panels.aboutToShow.connect(lambda: _fill_panels(panels, window))
    minimap = add("minimap", "Minimap", lambda: None, icon_name="map")
    minimap.setIconVisibleInMenu(False)  # it would stand where the tick does
    minimap.setCheckable(True)
    minimap.setChecked(window.settings.is_minimap_shown)
    minimap.toggled.connect(lambda is_on: window.workbench.helpers.show_minimap(is_on))
    following = add("follow_running", "Follow the running block", lambda: None)
    following.setCheckable(True)
    following.setChecked(window.settings.follows_running)
    following.toggled.connect(lambda is_on: window.workbench.helpers.follow_running(is_on))
    add("check", "Check", window.show_problems, icon_name="circle-check", keys="F8")
    menu.addSeparator()
    _add_looks(menu, window)
    menu.addSeparator()  # before what plugins add
    return menu


def _add_looks(menu: QMenu, window: MainWindow) -> None:
    settings, studio = window.settings, window.studio
    choices = _submenu(menu, window, "contrast", "Theme")
    _add_choices(choices, _themes(), lambda: settings.theme, studio.choose_theme)
    choices = _submenu(menu, window, "languages", "Language")
    _add_choices(choices, _languages(), lambda: settings.language, studio.choose_language)
    choices = _submenu(menu, window, "type", "Size of the text")
    _add_choices(
        choices,
        [(f"{scale:g}", verbatim(f"{scale:.0%}")) for scale in TEXT_SCALES],
        lambda: f"{settings.text_scale:g}",
        lambda scale: studio.choose_text_scale(float(scale)),
    )


def add_language_of_program(menu: QMenu, window: MainWindow) -> None:
    """Let a person choose in which language a program tells numbers, truths and lists."""

    def choose(code: str) -> None:
        # Blocks are not there yet when the menu is made
        from nep_studio.blocks.edits.content import SetExtra
        from nep_studio.blocks.program import LANGUAGE

        document = window.host.services.document
        if document is not None:
            document.editor.apply(SetExtra(LANGUAGE, None if code == ENGLISH else code))

    def chosen() -> str:
        document = window.host.services.document
        return document.project.spoken_language if document is not None else ""

    choices = _submenu(menu, window, "languages", "Language of the program")
    known = [(code, verbatim(name)) for code, name in available_languages().items()]
    _add_choices(choices, known, chosen, choose)
    menu.aboutToShow.connect(lambda: choices.menuAction().setEnabled(bool(chosen())))


def _fill_panels(menu: QMenu, window: MainWindow) -> None:
    """List the panels; some are added after the menu."""
    menu.clear()
    menu.addActions([panel.action for panel in window.workbench.panels.all])
    menu.addSeparator()
    menu.addAction(window.actions_by_name["reset_panels"])


def add_help_menu(window: MainWindow) -> QMenu:
    """Make the Help menu."""
    menu, ask = add_menu(window, "&Help"), window.host.ask
    add = partial(window.actions_by_name.add, menu=menu)
    # These are there before the help, which may come a moment later
    answer = partial(ask, "help.answer")
    add("help", "Help", answer, icon_name="circle-question-mark", keys="F1")
    add("help_contents", "Contents of the help", lambda: ask("help.open"), icon_name="book-open")
    add("help_search", "Search the help…", lambda: ask("help.search"), icon_name="search")
    pages = partial(ask, "help.documentation")
    add("documentation", "Documentation in the browser", pages, icon_name="external-link")
    menu.addSeparator()
    keys = partial(show_shortcuts, window)
    add("shortcuts", "Keyboard shortcuts", keys, icon_name="keyboard", keys="Ctrl+F1")
    add("report", "Report for support…", lambda: show_report(window), icon_name="file-text")
    about = add("about", "About NEP Studio", lambda: show_about(window), icon_name="info")
    about.setMenuRole(about.MenuRole.AboutRole)
    return menu


def add_toolbar(window: MainWindow) -> QToolBar:
    """Make the toolbar: few big clear buttons."""
    bar = labelled(QToolBar(window), window_title="Tools")
    bar.setObjectName("tools")
    bar.setMovable(False)
    bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
    for number, names in enumerate(TOOLBAR):
        if number:
            bar.addSeparator()
        bar.addActions([window.actions_by_name[name] for name in names])
    bar.addWidget(RunState(window.look, bar))
    bar.addActions([window.actions_by_name[name] for name in LAST_BUTTONS])
    window.addToolBar(bar)
    style_buttons(bar, window.look)
    dress_toolbar(bar)
    return bar


def dress_toolbar(bar: QToolBar) -> None:
    """Let the icons be as large as the text asks for."""
    side = round(bar.fontMetrics().height() * 1.25)
    bar.setIconSize(icon_room(side))
    # The button behind which a bar keeps what it has no room for: Qt's is black
    more = bar.findChild(QToolButton, "qt_toolbar_ext_button")
    if more is not None:
        more.setIcon(icon("chevron-down", bar.palette().color(QPalette.ColorRole.WindowText)))
        more.setIconSize(QSize(side, side))  # Qt makes it as narrow as it likes
        labelled(more, tip="More", name="More")
    size_toolbar(bar)


def size_toolbar(bar: QToolBar) -> None:
    """Show words beside the icons where there is room for them."""
    buttons = {
        action.objectName(): cast(QToolButton, bar.widgetForAction(action))
        for action in bar.actions()
        if action.objectName()
    }
    all_words = [name for name in buttons if name not in ICON_ONLY]
    for kept in (all_words, *WORDS_KEPT):
        for name, button in buttons.items():
            style = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
            if name not in kept:
                style = Qt.ToolButtonStyle.ToolButtonIconOnly
            button.ensurePolished()  # else it has not its size yet
            button.setToolButtonStyle(style)
        keep_width(buttons["run"])
        keep_room(buttons["check"], check_words())
        for sign in bar.findChildren(RunState):
            sign.be_tight(kept == WORDS_KEPT[-1])
        if (layout := bar.layout()) is not None:
            layout.invalidate()  # it would keep the width that it had with other words
        if bar.sizeHint().width() <= bar.window().width():
            return


def _themes() -> list[tuple[str, Words]]:
    return [(SYSTEM, "Like the computer's"), *((name, load_theme(name).title) for name in themes())]


def _languages() -> list[tuple[str, Words]]:
    named = available_languages().items()
    return [(SYSTEM, "Like the computer's"), *((code, verbatim(name)) for code, name in named)]


def _add_choices(
    menu: QMenu,
    choices: Iterable[tuple[str, Words]],
    chosen: Callable[[], str],
    choose: Callable[[str], object],
) -> None:
    """One of several, with a mark before the one that is chosen, here or elsewhere."""
    group = QActionGroup(menu)
    for value, words in choices:
        action = labelled(menu.addAction(""), text=words)
        action.setCheckable(True)
        action.setData(value)
        group.addAction(action)

    def mark() -> None:
        for action in group.actions():
            action.setChecked(action.data() == chosen())

    mark()
    menu.aboutToShow.connect(mark)
    group.triggered.connect(lambda action: choose(action.data()))


# What the action that checks says on the toolbar.

WIDEST_COUNT = 88
"""As many problems as are told in the widest of usual words."""


def check_words() -> tuple[str, ...]:
    """All that the action says, so that nothing beside it moves when the count changes."""
    counts = (count_words(count, "1 problem", "{n} problems") for count in (1, WIDEST_COUNT))
    return (tr("Check"), *counts)


def style_check(
    check: QAction, problems: Sequence[Diagnostic], theme: Theme, *, is_open: bool
) -> None:
    """Let the action that checks say how many problems there are, and how bad they are."""
    worst = next(iter(problems), None)
    colour = "success" if worst is None else worst.severity
    sign = "circle-check" if worst is None else "triangle-alert"
    check.setIcon(icon(sign, theme.colour(colour)) if is_open else icon(sign, theme))
    words = count_words(len(problems), "1 problem", "{n} problems")
    check.setIconText(words if problems else tr("Check"))
    check.setToolTip(words if problems else tr("Nothing to correct"))
