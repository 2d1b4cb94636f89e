"""The row of tools over the scene of the robots."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QMenu, QToolButton, QWidget

from nep_core.wire.messages import Thing, ThingKind
from nep_studio.project.surroundings import LONGEST_NAME
from nep_studio.ui.theme.icons import icon, icon_pixmap, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout
from nep_studio.ui.words import tr

# What can be done with the thing that is chosen: name it, turn it, take it away.

ICONS: dict[ThingKind, str] = {
    "person": "user",
    "ball": "circle",
    "wall": "square",
    "mark": "target",
}


class ThingBar(QWidget):
    """``named`` gives a new name, ``turned`` by how many degrees, ``removed`` that it is to go."""

    named = Signal(str)
    turned = Signal(int)
    removed = Signal()
    closed = Signal()

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.thing: Thing | None = None
        self.sign, self.kind = QLabel(), QLabel()
        self.name = QLineEdit()
        self.name.setMaxLength(LONGEST_NAME)
        self.name.setMinimumWidth(self.fontMetrics().averageCharWidth() * 8)
        self.left = _button(tr("Turn it to the left"), "rotate-ccw")
        self.right = _button(tr("Turn it to the right"), "rotate-cw")
        self.remove = _button(tr("Take it away"), "trash-2")
        self.close_button = _button(tr("Done"), "check")
        rows = FlowLayout(self, self.fontMetrics().height() // 5)  # it must not widen the panel
        self._what = _beside(self.sign, self.kind, self.name)
        self._hands = _beside(self.left, self.right, self.remove, self.close_button)
        rows.addWidget(self._what)
        rows.addWidget(self._hands)
        self.name.editingFinished.connect(self._on_named)
        self.left.clicked.connect(lambda: self.turned.emit(15))
        self.right.clicked.connect(lambda: self.turned.emit(-15))
        self.remove.clicked.connect(self.removed)
        self.close_button.clicked.connect(self.closed)
        look.theme_changed.connect(self._dress)
        self._dress()

    def show_thing(self, thing: Thing | None) -> None:
        """Show what can be done with this; nothing for None."""
        if thing == self.thing and thing is not None:
            return
        is_other = thing is None or self.thing is None or thing.id != self.thing.id
        self.thing = thing
        self.setVisible(thing is not None)
        if thing is None:
            return
        self.kind.setText(kind_words(thing.kind))
        has_name = thing.kind in ("person", "mark")
        self.name.setVisible(has_name)
        what = tr("Number of the landmark") if thing.kind == "mark" else tr("Name of the person")
        self.name.setAccessibleName(what)
        self.name.setPlaceholderText(tr("anybody") if thing.kind == "person" else tr("number"))
        for button in (self.left, self.right):
            button.setVisible(thing.kind != "ball")
        if is_other or not self.name.hasFocus():
            with QSignalBlocker(self.name):
                self.name.setText(thing.name)
        self._dress()

    def _on_named(self) -> None:
        if self.thing is not None and self.name.text().strip() != self.thing.name:
            self.named.emit(self.name.text().strip())

    def _dress(self) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        for button in (self.left, self.right, self.remove, self.close_button):
            button.setIcon(icon(str(button.property("icon_name")), theme))
            button.setIconSize(icon_room(line))
        self._what.setMinimumHeight(self._hands.sizeHint().height())
        if self.thing is not None:
            name, ratio = ICONS[self.thing.kind], self.devicePixelRatioF()
            self.sign.setPixmap(icon_pixmap(name, theme.colour("muted"), line, ratio))


def kind_words(kind: ThingKind) -> str:
    """What a kind of thing is called."""
    return {
        "person": tr("Person"),
        "ball": tr("Red ball"),
        "wall": tr("Wall"),
        "mark": tr("Landmark"),
    }[kind]


def thing_words(thing: Thing) -> str:
    """A thing in a list: "Person Anna"."""
    return f"{kind_words(thing.kind)} {thing.name}".strip()


def _beside(*widgets: QWidget) -> QWidget:
    """Widgets that stay in one row."""
    group = QWidget()
    row = QHBoxLayout(group)
    row.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        row.addWidget(widget)
    return group


def _button(words: str, icon_name: str) -> QToolButton:
    button = QToolButton()
    button.setToolTip(words)
    button.setAccessibleName(words)
    button.setProperty("icon_name", icon_name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


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
