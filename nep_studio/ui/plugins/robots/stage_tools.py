"""The row of tools over the scene of the robots."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup, QResizeEvent
from PySide6.QtWidgets import QLabel, QLineEdit, QMenu, QToolButton, QWidget

from nep_core.wire.messages import Thing, ThingKind
from nep_studio.project.surroundings import LONGEST_NAME
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import icon, icon_pixmap, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout, in_row
from nep_studio.ui.words import tr

# What can be done with the thing that is chosen: name it, turn it, take it away.

ICONS: dict[ThingKind, str] = {
    "person": "user",
    "ball": "circle",
    "wall": "square",
    "mark": "target",
}


class ThingBar(QWidget):
    """``named`` gives a new name, ``turned`` by how many degrees."""

    named = Signal(str)
    turned = Signal(int)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.thing: Thing | None = None
        self.sign, self.kind = QLabel(), QLabel()
        self.name = QLineEdit(maxLength=LONGEST_NAME)
        self.name.setMinimumWidth(self.fontMetrics().averageCharWidth() * 8)
        self.left = explained(_button("rotate-ccw"), "Turn it to the left")
        self.right = explained(_button("rotate-cw"), "Turn it to the right")
        self.remove = explained(_button("trash-2"), "Take it away")
        self.close_button = explained(_button("check"), "Done")
        rows = FlowLayout(self, self.fontMetrics().height() // 5)  # it must not widen the panel
        self._what = _beside(self.sign, self.kind, self.name)
        self._hands = _beside(self.left, self.right, self.remove, self.close_button)
        rows.addWidget(self._what)
        rows.addWidget(self._hands)
        self.name.editingFinished.connect(self._on_named)
        self.left.clicked.connect(lambda: self.turned.emit(15))
        self.right.clicked.connect(lambda: self.turned.emit(-15))
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
        labelled(self.kind, text=KIND_WORDS[thing.kind])
        self.name.setVisible(thing.kind in ("person", "mark"))
        labelled(
            self.name,
            name="Number of the landmark" if thing.kind == "mark" else "Name of the person",
            placeholder="anybody" if thing.kind == "person" else "number",
        )
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


KIND_WORDS: dict[ThingKind, str] = {
    "person": "Person",
    "ball": "Red ball",
    "wall": "Wall",
    "mark": "Landmark",
}
"""What a kind of thing is called."""


def thing_words(thing: Thing) -> str:
    """A thing in a list: "Person Anna"."""
    return f"{tr(KIND_WORDS[thing.kind])} {thing.name}".strip()


def _beside(*widgets: QWidget) -> QWidget:
    """Widgets that stay in one row."""
    group = QWidget()
    in_row(*widgets, of=group, margins=0)
    return group


def _button(icon_name: str) -> QToolButton:
    button = QToolButton()
    button.setProperty("icon_name", icon_name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


VIEWS = {
    "front": "From the front",
    "side": "From the side",
    "back": "From behind",
    "top": "From above",
    "face": "Into the face",
}
"""From where the robots can be looked at, in words."""


class StageTools(QWidget):
    """``view_asked`` gives a preset, ``place_asked`` a kind, ``thing_asked`` the id of a thing.

    Whoever can do it is connected with the other buttons and actions.
    """

    view_asked = Signal(str)
    place_asked = Signal(str)
    thing_asked = Signal(str)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.view, self.place = QToolButton(), QToolButton()
        self.sound, self.large = QToolButton(), QToolButton()
        self.fit = labelled(QAction(self), text="See all")
        self.clear = labelled(QAction(self), text="Clear the walked paths")
        self.real = labelled(QAction(self), text="Connect a robot…")
        self.follow = QAction(self, checkable=True, checked=True)
        labelled(self.follow, text="Follow the robot")
        self._things: list[Thing] = []
        self._things_menu = labelled(QMenu(self), title="Choose")
        self._lay_out()
        menu = QMenu(self.view)
        for preset, words in VIEWS.items():
            labelled(menu.addAction("", partial(self.view_asked.emit, preset)), text=words)
        menu.addSeparator()
        menu.addActions([self.fit, self.follow, self.clear])
        self.view.setMenu(menu)
        self._fill_place_menu()
        self.show_things([])
        follow_words(self, self._fill_things_menu)
        self.show_sound(True)
        self.show_large(False)
        look.theme_changed.connect(self._dress)
        self._dress()

    def _lay_out(self) -> None:
        self._flow = FlowLayout(self, self.fontMetrics().height() // 5)
        labelled(self.view, text="View", name="View", tip="From where the robots are looked at")
        labelled(self.place, text="Place", name="Place", tip="Put something before the robots")
        labelled(self.sound, text="Sound", name="Sound")
        labelled(self.large, text="Large", name="Large")
        for button in (self.view, self.place, self.sound, self.large):
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            self._flow.addWidget(button)
        for button in (self.view, self.place):
            button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.sound.setCheckable(True)
        self.large.setCheckable(True)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """All in one row: where there is no room for words, the robot has it."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        buttons = (self.view, self.place, self.sound, self.large)
        for button in buttons:
            button.ensurePolished()  # before that the style sheet does not count
        for button in buttons[:2]:
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        wanted = sum(button.sizeHint().width() for button in buttons)
        if wanted + self._flow.spacing() * len(buttons) > self.width():
            for button in buttons[:2]:
                button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)

    def _fill_place_menu(self) -> None:
        menu = QMenu(self.place)
        self._placing = QActionGroup(self)
        for kind, words in KIND_WORDS.items():
            action = labelled(self._placing.addAction(""), text=words)
            action.setData(kind)
            menu.addAction(action)
        menu.addSeparator()
        menu.addMenu(self._things_menu)
        menu.addAction(self.real)
        self.place.setMenu(menu)
        self._placing.triggered.connect(lambda action: self.place_asked.emit(action.data()))

    def allow_placing(self, is_allowed: bool) -> None:
        """Let things be placed, where there is a project that keeps them."""
        self._placing.setEnabled(is_allowed)

    def show_things(self, things: list[Thing]) -> None:
        """Offer the things that are there, to be chosen without a mouse."""
        self._things = things
        self._fill_things_menu()
        self._things_menu.setEnabled(bool(things))

    def _fill_things_menu(self) -> None:
        self._things_menu.clear()
        for thing in self._things:
            sign, words = icon(ICONS[thing.kind], self._look.theme), thing_words(thing)
            ask = partial(self.thing_asked.emit, thing.id)
            self._things_menu.addAction(sign, words.replace("&", "&&"), ask)

    def show_sound(self, is_on: bool) -> None:
        """Show whether robots are heard."""
        with QSignalBlocker(self.sound):
            self.sound.setChecked(is_on)
        labelled(self.sound, tip="Robots are heard" if is_on else "Robots are not heard")
        self._dress()

    def show_large(self, is_large: bool) -> None:
        """Show whether the scene is in a window of its own."""
        with QSignalBlocker(self.large):
            self.large.setChecked(is_large)
        labelled(
            self.large, tip="Back into the panel" if is_large else "Large, in a window of its own"
        )

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
        self._fit()
        self.fit.setIcon(icon("crosshair", theme))
        self.clear.setIcon(icon("brush", theme))
        self.real.setIcon(icon("plug", theme))
        for action in self._placing.actions():
            action.setIcon(icon(ICONS[action.data()], theme))
