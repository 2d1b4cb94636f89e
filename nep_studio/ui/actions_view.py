"""The View and Help menus, and the toolbar."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolBar, QToolButton, QWidget

from nep_studio.settings import SYSTEM
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.running.actions import RUN_BUTTONS, RunState, dress_buttons
from nep_studio.ui.theme import icon, load_theme, themes
from nep_studio.ui.words import available_languages, tr

if TYPE_CHECKING:
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
ICON_ONLY = ("pause", "step", "zoom_out", "zoom_in", "settings", "shortcuts")


def add_view_menu(window: MainWindow) -> QMenu:
    """Make the View menu."""
    menu, add, theme = (
        window.menuBar().addMenu(tr("&View")),
        window.actions_by_name.add,
        window.look.theme,
    )
    canvas = window.workbench.canvas

    def zoom(factor: float) -> Callable[[], None]:
        return lambda: canvas.zoom(canvas.camera.scale * factor)

    menu.addActions(
        [
            add(
                "zoom_in",
                tr("Zoom in"),
                zoom(ZOOM_STEP),
                icon_name="zoom-in",
                keys=(Key.ZoomIn, "Ctrl+="),
            ),
            add(
                "zoom_out",
                tr("Zoom out"),
                zoom(1 / ZOOM_STEP),
                icon_name="zoom-out",
                keys=Key.ZoomOut,
            ),
            add("zoom_100", tr("Usual size"), window.workbench.zoom_usual, keys="Ctrl+0"),
            add("zoom_fit", tr("Show all"), canvas.fit, icon_name="maximize", keys="Ctrl+9"),
        ]
    )
    menu.addSeparator()
    panels = menu.addMenu(icon("panel-right", theme), tr("Panels"))
    panels.aboutToShow.connect(lambda: _fill_panels(panels, window))
    helpers = window.workbench.helpers
    minimap = add("minimap", tr("Minimap"), lambda: None, icon_name="map")
    minimap.setCheckable(True)
    minimap.setChecked(helpers.is_minimap_shown)
    minimap.toggled.connect(helpers.show_minimap)
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


def _fill_panels(menu: QMenu, window: MainWindow) -> None:
    """List the panels; some are added after the menu."""
    menu.clear()
    menu.addActions([panel.action for panel in window.workbench.panels.all])


def add_help_menu(window: MainWindow) -> QMenu:
    """Make the Help menu."""
    menu, add = window.menuBar().addMenu(tr("&Help")), window.actions_by_name.add
    menu.addAction(
        add(
            "shortcuts",
            tr("Keyboard shortcuts"),
            window.show_shortcuts,
            icon_name="keyboard",
            keys="Ctrl+F1",
        )
    )
    about = add("about", tr("About NEP Studio"), window.show_about, icon_name="info")
    about.setMenuRole(about.MenuRole.AboutRole)
    menu.addAction(about)
    return menu


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
    space = QWidget()
    space.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    bar.addWidget(space)
    bar.addActions([window.actions_by_name[name] for name in ("shortcuts", "settings")])
    window.addToolBar(bar)
    dress_buttons(bar)
    size_toolbar(bar)
    return bar


def size_toolbar(bar: QToolBar) -> None:
    """Let the icons be as large as the text asks for, with words where there is room for them."""
    side = round(bar.fontMetrics().height() * 1.25)
    bar.setIconSize(icon_room(side))
    bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    for name in ICON_ONLY:
        _button(bar, name).setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
    if bar.sizeHint().width() > bar.window().width():
        bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)


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
