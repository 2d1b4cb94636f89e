"""The row of tools over the scene of the robots."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from nep_core.messages import Thing, ThingKind
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr

from .thing_bar import ICONS, kind_words, thing_words

KINDS: tuple[ThingKind, ...] = ("person", "ball", "wall", "mark")


class StageTools(QWidget):
    """Tells what was asked for.

    ``view_asked`` gives a preset, ``follow_switched`` whether a robot is followed, ``place_asked``
    a kind of thing, ``thing_asked`` the id of one, ``sound_switched`` whether robots are heard.
    """

    view_asked = Signal(str)
    fit_asked = Signal()
    follow_switched = Signal(bool)
    place_asked = Signal(str)
    thing_asked = Signal(str)
    clear_asked = Signal()
    sound_switched = Signal(bool)
    large_switched = Signal(bool)
    connecting_asked = Signal()

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.view, self.place = QToolButton(), QToolButton()
        self.sound, self.large = QToolButton(), QToolButton()
        self.fit = QAction(tr("See all"), self)
        self.clear = QAction(tr("Clear the walked paths"), self)
        self.real = QAction(tr("Connect a robot…"), self)
        self.follow = QAction(tr("Follow the robot"), self, checkable=True, checked=True)
        self._things_menu = QMenu(tr("Choose"), self)
        self._lay_out()
        self._fill_view_menu()
        self._fill_place_menu()
        self._connect()
        self.show_things([])
        self.show_sound(True)
        self.show_large(False)
        look.theme_changed.connect(self._dress)
        self._dress()

    def _lay_out(self) -> None:
        flow = FlowLayout(self, self.fontMetrics().height() // 5)
        named = (
            (self.view, tr("View"), tr("From where the robots are looked at")),
            (self.place, tr("Place"), tr("Put something before the robots")),
            (self.sound, tr("Sound"), ""),
            (self.large, tr("Large"), ""),
        )
        for button, words, tip in named:
            button.setText(words)
            button.setToolTip(tip)
            button.setAccessibleName(words)
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            flow.addWidget(button)
        for button in (self.view, self.place):
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.sound.setCheckable(True)
        self.large.setCheckable(True)

    def _fill_view_menu(self) -> None:
        menu = QMenu(self.view)
        presets = {
            "front": tr("From the front"),
            "side": tr("From the side"),
            "back": tr("From behind"),
            "top": tr("From above"),
            "face": tr("Into the face"),
        }
        for preset, words in presets.items():
            menu.addAction(words).triggered.connect(partial(self._ask_view, preset))
        menu.addSeparator()
        menu.addActions([self.fit, self.follow, self.clear])
        self.view.setMenu(menu)

    def _ask_view(self, preset: str) -> None:
        self.view_asked.emit(preset)

    def _fill_place_menu(self) -> None:
        menu = QMenu(self.place)
        self._placing = QActionGroup(self)
        for kind in KINDS:
            action = self._placing.addAction(kind_words(kind))
            action.setData(kind)
            menu.addAction(action)
        menu.addSeparator()
        menu.addMenu(self._things_menu)
        menu.addAction(self.real)
        self.place.setMenu(menu)
        self._placing.triggered.connect(lambda action: self.place_asked.emit(action.data()))

    def _connect(self) -> None:
        self.fit.triggered.connect(self.fit_asked)
        self.follow.toggled.connect(self.follow_switched)
        self.clear.triggered.connect(self.clear_asked)
        self.sound.clicked.connect(self.sound_switched)
        self.large.clicked.connect(self.large_switched)
        self.real.triggered.connect(self.connecting_asked)

    def allow_placing(self, is_allowed: bool) -> None:
        """Let things be placed, where there is a project that keeps them."""
        self._placing.setEnabled(is_allowed)

    def show_things(self, things: list[Thing]) -> None:
        """Offer the things that are there, to be chosen without a mouse."""
        self._things_menu.clear()
        for thing in things:
            action = self._things_menu.addAction(icon(ICONS[thing.kind], self._look.theme), "")
            action.setText(thing_words(thing).replace("&", "&&"))
            action.triggered.connect(partial(self._ask_thing, thing.id))
        self._things_menu.setEnabled(bool(things))

    def _ask_thing(self, thing_id: str) -> None:
        self.thing_asked.emit(thing_id)

    def show_sound(self, is_on: bool) -> None:
        """Show whether robots are heard."""
        with QSignalBlocker(self.sound):
            self.sound.setChecked(is_on)
        self.sound.setToolTip(tr("Robots are heard") if is_on else tr("Robots are not heard"))
        self._dress()

    def show_large(self, is_large: bool) -> None:
        """Show whether the scene is in a window of its own."""
        with QSignalBlocker(self.large):
            self.large.setChecked(is_large)
        words = tr("Back into the panel") if is_large else tr("Large, in a window of its own")
        self.large.setToolTip(words)

    def show_follow(self, is_on: bool) -> None:
        """Show whether a robot is followed."""
        with QSignalBlocker(self.follow):
            self.follow.setChecked(is_on)

    def _dress(self) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        icons = (
            (self.view, "eye"),
            (self.place, "plus"),
            (self.sound, "volume-2" if self.sound.isChecked() else "volume-x"),
            (self.large, "maximize"),
        )
        for button, name in icons:
            button.setIcon(icon(name, theme, "selection_text" if button.isChecked() else "text"))
            button.setIconSize(icon_room(line))
        self.fit.setIcon(icon("crosshair", theme))
        self.clear.setIcon(icon("brush", theme))
        self.real.setIcon(icon("plug", theme))
        for action in self._placing.actions():
            action.setIcon(icon(ICONS[action.data()], theme))
