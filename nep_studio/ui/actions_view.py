"""The View and Help menus, and the toolbar."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QActionGroup, QKeySequence, QPalette
from PySide6.QtWidgets import QMenu, QToolBar, QToolButton

from nep_studio.settings import SYSTEM, Settings
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.main_window_dialogs import show_about, show_report, show_shortcuts
from nep_studio.ui.running.actions import RUN_BUTTONS, RunState, dress_buttons, keep_width
from nep_studio.ui.theme import icon, load_theme, themes
from nep_studio.ui.words import available_languages, tr

if TYPE_CHECKING:
    from nep_studio.ui.help.desk import HelpDesk
    from nep_studio.ui.main_window import MainWindow

Key = QKeySequence.StandardKey
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
    menu, add, theme = (
        window.menuBar().addMenu(tr("&View")),
        window.actions_by_name.add,
        window.look.theme,
    )

    def zoom(factor: float) -> None:
        canvas = window.workbench.canvas
        canvas.zoom(canvas.camera.scale * factor)

    menu.addActions(
        [
            add(
                "zoom_in",
                tr("Zoom in"),
                lambda: zoom(ZOOM_STEP),
                icon_name="zoom-in",
                keys=(Key.ZoomIn, "Ctrl+="),
            ),
            add(
                "zoom_out",
                tr("Zoom out"),
                lambda: zoom(1 / ZOOM_STEP),
                icon_name="zoom-out",
                keys=Key.ZoomOut,
            ),
            add("zoom_100", tr("Usual size"), lambda: window.workbench.zoom_usual(), keys="Ctrl+0"),
            add(
                "zoom_fit",
                tr("Show all"),
                lambda: window.workbench.canvas.fit(),
                icon_name="maximize",
                keys="Ctrl+9",
            ),
        ]
    )
    menu.addSeparator()
    panels = menu.addMenu(icon("panel-right", theme), tr("Panels"))
    panels.aboutToShow.connect(lambda: _fill_panels(panels, window))
    minimap = add("minimap", tr("Minimap"), lambda: None, icon_name="map")
    minimap.setCheckable(True)
    minimap.setChecked(is_minimap_shown(window.settings))
    minimap.toggled.connect(lambda is_on: window.workbench.helpers.show_minimap(is_on))
    menu.addAction(minimap)
    check = add("check", tr("Check"), window.show_problems, icon_name="circle-check", keys="F8")
    check.setToolTip(tr("Show what is not right yet"))
    menu.addAction(check)
    menu.addSeparator()
    _add_choices(
        menu.addMenu(icon("contrast", theme), tr("Theme")),
        _themes(),
        window.settings.theme,
        window.studio.choose_theme,
    )
    _add_choices(
        menu.addMenu(icon("languages", theme), tr("Language")),
        _languages(),
        window.settings.language,
        window.studio.choose_language,
    )
    scales = [(f"{scale:g}", f"{scale:.0%}") for scale in TEXT_SCALES]
    chosen = f"{window.settings.text_scale:g}"
    _add_choices(
        menu.addMenu(icon("type", theme), tr("Size of the text")),
        scales,
        chosen,
        lambda scale: window.studio.choose_text_scale(float(scale)),
    )
    return menu


def is_minimap_shown(settings: Settings) -> bool:
    """Whether the person left the minimap open."""
    return settings.is_shown("Minimap", default=False)


def _fill_panels(menu: QMenu, window: MainWindow) -> None:
    """List the panels; some are added after the menu."""
    menu.clear()
    menu.addActions([panel.action for panel in window.workbench.panels.all])


def add_help_menu(window: MainWindow) -> QMenu:
    """Make the Help menu."""
    menu, add = window.menuBar().addMenu(tr("&Help")), window.actions_by_name.add
    menu.addActions(_help_actions(window))
    menu.addSeparator()
    menu.addAction(
        add(
            "shortcuts",
            tr("Keyboard shortcuts"),
            lambda: show_shortcuts(window),
            icon_name="keyboard",
            keys="Ctrl+F1",
        )
    )
    report = tr("Report for support…")
    menu.addAction(add("report", report, lambda: show_report(window), icon_name="file-text"))
    about = add("about", tr("About NEP Studio"), lambda: show_about(window), icon_name="info")
    about.setMenuRole(about.MenuRole.AboutRole)
    menu.addAction(about)
    return menu


def _help_actions(window: MainWindow) -> list[QAction]:
    """They are there before the help, which may come a moment later."""
    add, sign = window.actions_by_name.add, "circle-question-mark"

    def desk() -> HelpDesk:
        return window.later.help_desk

    def browse() -> None:
        from nep_studio.ui.help.documentation import open_documentation

        open_documentation(window.messages)

    contents, search = tr("Contents of the help"), tr("Search the help…")
    pages = tr("Documentation in the browser")
    return [
        add("help", tr("Help"), lambda: desk().answer(), icon_name=sign, keys="F1"),
        add("help_contents", contents, lambda: desk().open(), icon_name="book-open"),
        add("help_search", search, lambda: desk().search(), icon_name="search"),
        add("documentation", pages, browse, icon_name="external-link"),
    ]


def add_toolbar(window: MainWindow) -> QToolBar:
    """Make the toolbar: few big clear buttons."""
    bar = QToolBar(tr("Tools"), window)
    bar.setObjectName("tools")
    bar.setMovable(False)
    bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
    for number, names in enumerate(TOOLBAR):
        if number:
            bar.addSeparator()
        bar.addActions([window.actions_by_name[name] for name in names])
    bar.addWidget(RunState(window, bar))
    bar.addActions([window.actions_by_name[name] for name in LAST_BUTTONS])
    window.addToolBar(bar)
    dress_buttons(bar, window.look)
    size_toolbar(bar)
    return bar


def size_toolbar(bar: QToolBar) -> None:
    """Let the icons be as large as the text asks for, with words where there is room for them."""
    side = round(bar.fontMetrics().height() * 1.25)
    bar.setIconSize(icon_room(side))
    _dress_rest(bar, side)
    names = [action.objectName() for action in bar.actions() if action.objectName()]
    all_words = [name for name in names if name not in ICON_ONLY]
    for kept in (all_words, *WORDS_KEPT):
        for name in names:
            style = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
            if name not in kept:
                style = Qt.ToolButtonStyle.ToolButtonIconOnly
            _button(bar, name).ensurePolished()  # else it has not its size yet
            _button(bar, name).setToolButtonStyle(style)
        keep_width(_button(bar, "run"))
        for sign in bar.findChildren(RunState):
            sign.be_tight(kept == WORDS_KEPT[-1])
        if (layout := bar.layout()) is not None:
            layout.invalidate()  # it would keep the width that it had with other words
        if bar.sizeHint().width() <= bar.window().width():
            return


def _dress_rest(bar: QToolBar, side: int) -> None:
    """The button behind which a bar keeps what it has no room for: Qt's is black."""
    more = bar.findChild(QToolButton, "qt_toolbar_ext_button")
    if more is not None:
        more.setIcon(icon("chevron-down", bar.palette().color(QPalette.ColorRole.WindowText)))
        more.setIconSize(QSize(side, side))  # Qt makes it as narrow as it likes
        more.setToolTip(tr("More"))
        more.setAccessibleName(tr("More"))


def _button(bar: QToolBar, name: str) -> QToolButton:
    action = next(action for action in bar.actions() if action.objectName() == name)
    button = bar.widgetForAction(action)
    assert isinstance(button, QToolButton)
    return button


def _themes() -> list[tuple[str, str]]:
    named = [(name, tr(load_theme(name).title)) for name in themes()]
    return [(SYSTEM, tr("Like the computer's")), *named]


def _languages() -> list[tuple[str, str]]:
    return [(SYSTEM, tr("Like the computer's")), *available_languages().items()]


def _add_choices(
    menu: QMenu, choices: Iterable[tuple[str, str]], chosen: str, choose: Callable[[str], object]
) -> None:
    """One of several, with a mark before it."""
    group = QActionGroup(menu)
    for value, words in choices:
        action = menu.addAction(words)
        action.setCheckable(True)
        action.setChecked(value == chosen)
        action.setData(value)
        group.addAction(action)
    group.triggered.connect(lambda action: choose(action.data()))
