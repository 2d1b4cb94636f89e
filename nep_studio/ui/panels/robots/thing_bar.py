"""What can be done with the thing that is chosen: name it, turn it, take it away."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QToolButton, QWidget

from nep_core.messages import Thing, ThingKind
from nep_studio.surroundings import LONGEST_NAME
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look, icon, icon_pixmap
from nep_studio.ui.words import tr

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
