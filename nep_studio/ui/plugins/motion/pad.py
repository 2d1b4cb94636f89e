"""The keys that drive a robot: held on the keyboard, or on the screen with the mouse."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .drive import KEYS, sum_of

ARROWS = {
    Qt.Key.Key_Up: "arrow-up",
    Qt.Key.Key_Down: "arrow-down",
    Qt.Key.Key_Left: "arrow-left",
    Qt.Key.Key_Right: "arrow-right",
}
Place = tuple[int, int]


class DrivePad(QFrame):
    """``changed`` gives the Drive of all that is held; ``stop_asked`` that everything is to stop.

    Whoever looks elsewhere lets go: without the focus nothing is held.
    """

    changed = Signal(object)
    stop_asked = Signal()

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._held: dict[int, None] = {}
        self.buttons: dict[int, QPushButton] = {}
        self.hint = QLabel()
        self.stop_button = QPushButton()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        labelled(self, name="Drive with the keys")
        self._lay_out()
        self._say_how()
        follow_words(self, self._say_keys)
        look.theme_changed.connect(self._dress)
        self._dress()

    @property
    def held(self) -> list[int]:
        """The keys that are held."""
        return list(self._held)

    def let_go(self) -> None:
        """Nothing is held any more."""
        if self._held:
            self._held.clear()
            self._tell()

    def hold(self, key: int) -> None:
        """Begin to hold a key."""
        if key not in self._held:
            self._held[key] = None
            self._tell()

    def release(self, key: int) -> None:
        """Let go of a key."""
        if key in self._held:
            del self._held[key]
            self._tell()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Hold a key; the space bar stops everything."""
        if event.key() == Qt.Key.Key_Space:
            if not event.isAutoRepeat():
                self.let_go()
                self.stop_asked.emit()
        elif event.key() not in KEYS or event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            self.hold(event.key())

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Let go of a key."""
        if event.key() in KEYS and not event.isAutoRepeat():
            self.release(event.key())
        else:
            super().keyReleaseEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """The keys are heard from now on."""
        super().focusInEvent(event)
        self._say_how()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Without the focus it is not heard when a key is let go."""
        super().focusOutEvent(event)
        self.let_go()
        self._say_how()

    def hideEvent(self, event: QHideEvent) -> None:
        """What is not seen is not held."""
        super().hideEvent(event)
        self.let_go()

    def changeEvent(self, event: QEvent) -> None:
        """A pad that is switched off holds nothing."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.EnabledChange and not self.isEnabled():
            self.let_go()

    def _tell(self) -> None:
        for key, button in self.buttons.items():
            button.setDown(key in self._held)
        self.changed.emit(sum_of(KEYS[key] for key in self._held))

    def _lay_out(self) -> None:
        walk: dict[int, Place] = {
            int(Qt.Key.Key_Q): (0, 0),
            int(Qt.Key.Key_Up): (0, 1),
            int(Qt.Key.Key_E): (0, 2),
            int(Qt.Key.Key_Left): (1, 0),
            int(Qt.Key.Key_Down): (1, 1),
            int(Qt.Key.Key_Right): (1, 2),
        }
        head: dict[int, Place] = {
            int(Qt.Key.Key_W): (0, 1),
            int(Qt.Key.Key_A): (1, 0),
            int(Qt.Key.Key_S): (1, 1),
            int(Qt.Key.Key_D): (1, 2),
        }
        row = QHBoxLayout()
        row.addLayout(self._group(labelled(QLabel(), text="Walk"), walk))
        row.addStretch(1)
        row.addLayout(self._group(labelled(QLabel(), text="Head"), head))
        row.addStretch(1)
        labelled(self.stop_button, text="Stop", tip="Stop everything the robot does (Space)")
        self.stop_button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.stop_button.setAutoDefault(False)
        self.stop_button.setProperty("kind", "stop")
        self.stop_button.clicked.connect(self._on_stop_clicked)
        row.addWidget(self.stop_button)
        self.hint.setWordWrap(True)
        in_column(row, self.hint, of=self)

    def _group(self, heading: QLabel, keys: dict[int, Place]) -> QVBoxLayout:
        group = QWidget()
        group.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as on every keyboard
        grid = QGridLayout(group)
        grid.setContentsMargins(0, 0, 0, 0)
        for key, (row, column) in keys.items():
            grid.addWidget(self._button(key), row, column)
        heading.setAlignment(Qt.AlignmentFlag.AlignCenter)
        box = in_column(heading, group)
        return box

    def _button(self, key: int) -> QPushButton:
        button = self.buttons[key] = QPushButton()
        line = self.fontMetrics().height()
        button.setFixedSize(round(line * 2.4), round(line * 2.1))
        button.setAutoDefault(False)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        if Qt.Key(key) not in ARROWS:
            button.setText(_named(key))
        button.pressed.connect(lambda: self.hold(key))
        button.released.connect(lambda: self.release(key))
        return button

    def _dress(self) -> None:
        for key, name in ARROWS.items():
            self.buttons[int(key)].setIcon(icon(name, self._look.theme))
        self.stop_button.setIcon(icon("square", self._look.theme, "stop_text"))

    def _say_keys(self) -> None:
        for key, words in key_words().items():
            self.buttons[key].setAccessibleName(words)
            self.buttons[key].setToolTip(f"{words} ({_named(key)})")

    def _say_how(self) -> None:
        labelled(
            self.hint,
            text="Hold a key to move the robot. Let go, and it stops."
            if self.hasFocus()
            else "Click here to drive with the keys.",
        )

    def _on_stop_clicked(self) -> None:
        self.let_go()
        self.stop_asked.emit()


def _named(key: int) -> str:
    return QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText)


def key_words() -> dict[int, str]:
    """What the keys do, in words."""
    key = Qt.Key
    return {
        int(key.Key_Up): tr("forward"),
        int(key.Key_Down): tr("back"),
        int(key.Key_Left): tr("turn left"),
        int(key.Key_Right): tr("turn right"),
        int(key.Key_Q): tr("sideways to the left"),
        int(key.Key_E): tr("sideways to the right"),
        int(key.Key_W): tr("look up"),
        int(key.Key_S): tr("look down"),
        int(key.Key_A): tr("look to the left"),
        int(key.Key_D): tr("look to the right"),
    }
